// glTF 2.0: the node tree, cameras and lights.
#include "tracer/error.h"
#include "tracer/io/formats.h"
#include "tracer/io/gltf_document.h"
#include "tracer/io/gltf_lights.h"
#include "tracer/io/gltf_material.h"
#include "tracer/io/gltf_mesh.h"
#include "tracer/io/gltf_textures.h"
#include "tracer/io/load_steps.h"
#include "tracer/io/mesh_build.h"
#include "tracer/parallel/parallel.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace raypick {

namespace {

Transform matrix_transform(const JsonValue& json) {
    const std::vector<JsonValue> numbers = json.elements(16, "16 numbers");
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i)
        matrix[i / 4][i % 4] = real_number(numbers[static_cast<std::size_t>(i)]);
    const glm::dvec4 bottom(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
    if (glm::distance(bottom, glm::dvec4(0.0, 0.0, 0.0, 1.0)) > 1e-6) {
        json.fail("the bottom row must be 0, 0, 0, 1");
    }
    return from_matrix(matrix);
}

glm::dvec3 vector_or(const JsonValue& node, std::string_view key, const glm::dvec3& otherwise) {
    const std::optional<JsonValue> json = node.find(key);
    if (!json) return otherwise;
    const std::vector<JsonValue> xyz = json->elements(3, "three numbers");
    return {real_number(xyz[0]), real_number(xyz[1]), real_number(xyz[2])};
}

glm::dmat3 rotation_of(const JsonValue& node) {
    const std::optional<JsonValue> json = node.find("rotation");
    if (!json) return glm::dmat3(1.0);
    const std::vector<JsonValue> xyzw = json->elements(4, "four numbers: a quaternion x, y, z, w");
    const glm::dquat q(real_number(xyzw[3]), real_number(xyzw[0]), real_number(xyzw[1]),
                       real_number(xyzw[2]));
    if (!(glm::length(q) > 0.0)) json->fail("the quaternion must not be 0");
    return glm::mat3_cast(glm::normalize(q));
}

Transform node_transform(const JsonValue& node) {
    if (const std::optional<JsonValue> matrix = node.find("matrix")) {
        return matrix_transform(*matrix);
    }
    Transform transform = scale(vector_or(node, "scale", glm::dvec3(1.0)));
    transform.linear = rotation_of(node) * transform.linear;
    transform.translation = vector_or(node, "translation", glm::dvec3(0.0));
    return transform;
}

class GltfReader {
public:
    GltfReader(const std::filesystem::path& file, const LoadOptions& options)
        : file_(file),
          options_(options),
          document_(file),
          loaded_(begin_scene(options)),
          textures_(loaded_) {}

    LoadedScene read() {
        read_materials();
        read_meshes();
        mesh_ids_.resize(document_.array("meshes").size());
        visited_.resize(document_.array("nodes").size());
        for (std::size_t i = roots().size(); i-- > 0;)
            todo_.push_back({roots()[i], Transform(), ""});
        while (!todo_.empty()) {
            const Visit visit = std::move(todo_.back());
            todo_.pop_back();
            read_node(visit);
        }
        expose_gltf_lights(loaded_.scene);
        textures_.finish(options_, kNodesDone, 1.0f);
        warn_of_rest();
        return std::move(loaded_);
    }

private:
    // A node on its way into the scene.
    struct Visit {
        std::size_t node = 0;
        Transform world_from_parent;
        std::string parent_path;
        int depth = 1;
    };

    // Every node's path names all its ancestors; no model's tree is anywhere near as deep.
    static constexpr int kMaxDepth = 1000;

    // Of the progress; the rest are textures.
    static constexpr float kMeshesDone = 0.65f;
    static constexpr float kNodesDone = 0.7f;

    // What became of a mesh: it was read, or can't be, or nobody has tried.
    struct MeshOutcome {
        std::optional<GltfMesh> mesh;
        std::exception_ptr complaint;
    };

    void read_materials() {
        const std::vector<JsonValue>& materials = document_.array("materials");
        for (std::size_t i = 0; i < materials.size(); ++i) {
            GltfMaterial material = read_gltf_material(document_, materials[i], loaded_.warnings);
            if (material.name.empty()) material.name = fmt::format("material{}", i);
            uv_sets_.push_back(material.uv_set());
            const MaterialId id = add_material(loaded_.scene, material_from(material));
            textures_.request(id, std::move(material));
        }
    }

    // Those that nodes show, side by side. A complaint about one is raised where a node asks for
    // it.
    void read_meshes() {
        mesh_outcomes_.resize(document_.array("meshes").size());
        const std::vector<std::size_t> shown = shown_meshes();
        std::atomic<std::size_t> done = 0;
        parallel_for(shown.size(), 0, options_.stop, [&](std::size_t i) {
            MeshOutcome& outcome = mesh_outcomes_[shown[i]];
            try {
                outcome.mesh = read_gltf_mesh(document_, shown[i], mesh_name(shown[i]), uv_sets_);
            } catch (...) {
                outcome.complaint = std::current_exception();
            }
            if (options_.progress == nullptr) return;
            options_.progress->store(kMeshesDone * static_cast<float>(++done) /
                                     static_cast<float>(shown.size()));
        });
    }

    [[nodiscard]] std::vector<std::size_t> shown_meshes() const {
        std::vector<bool> is_shown(mesh_outcomes_.size());
        for (const JsonValue& node : document_.array("nodes")) {
            try {
                const std::optional<JsonValue> mesh = node.find("mesh");
                if (mesh) is_shown[document_.index(*mesh, "meshes")] = true;
            } catch (const FileError&) {
                // Raised again if the node is reached.
            }
        }
        std::vector<std::size_t> shown;
        for (std::size_t i = 0; i < is_shown.size(); ++i) {
            if (is_shown[i]) shown.push_back(i);
        }
        return shown;
    }

    // The nodes of the scene that the file shows; without scenes, all that are nobody's child.
    const std::vector<std::size_t>& roots() {
        if (roots_) return *roots_;
        roots_.emplace();
        const std::optional<JsonValue> scenes = document_.root().find("scenes");
        const std::optional<JsonValue> shown = document_.root().find("scene");
        if (!scenes && !shown) {
            find_parentless();
            return *roots_;
        }
        std::vector<JsonValue> all;
        if (scenes) all = scenes->elements();
        const std::uint64_t number = shown ? whole_number(*shown) : 0;
        if (number >= all.size()) {
            (shown ? *shown : *scenes).fail(fmt::format("scene {} does not exist", number));
        }
        if (all.size() > 1) {
            warn(fmt::format("of {} scenes, /scenes/{} is shown", all.size(), number));
        }
        append_nodes(all[static_cast<std::size_t>(number)], "nodes", *roots_);
        return *roots_;
    }

    void find_parentless() {
        const std::vector<JsonValue>& nodes = document_.array("nodes");
        std::vector<bool> is_child(nodes.size());
        for (const JsonValue& node : nodes) {
            std::vector<std::size_t> children;
            append_nodes(node, "children", children);
            for (const std::size_t child : children)
                is_child[child] = true;
        }
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (!is_child[i]) roots_->push_back(i);
        }
        if (roots_->empty() && !nodes.empty()) {
            document_.root().need("nodes").fail("every node is a child: they must form trees");
        }
    }

    void append_nodes(const JsonValue& json, std::string_view key,
                      std::vector<std::size_t>& nodes) const {
        const std::optional<JsonValue> list = json.find(key);
        if (!list) return;
        for (const JsonValue& reference : list->elements())
            nodes.push_back(document_.index(reference, "nodes"));
    }

    void read_node(const Visit& visit) {
        const float share =
            static_cast<float>(++nodes_read_) / static_cast<float>(visited_.size() + 1);
        load_step(options_, kMeshesDone + (kNodesDone - kMeshesDone) * share);
        const JsonValue& node = document_.array("nodes")[visit.node];
        if (visited_[visit.node]) node.fail("is reached twice: the nodes must form trees");
        visited_[visit.node] = true;
        if (visit.depth > kMaxDepth) {
            node.fail(fmt::format("lies more than {} nodes deep", kMaxDepth));
        }
        const Transform world = visit.world_from_parent * node_transform(node);
        check_place(node, world);
        const std::string name = node_name(node, visit.node);
        const std::string path = unique_path(visit.parent_path + '/' + name);
        if (node.find("mesh")) add_object_of(node, world, name, path);
        if (const auto camera = node.find("camera")) add_camera(*camera, node, world);
        if (const auto light = extension(node, "KHR_lights_punctual")) {
            add_light(light->need("light"), node, world, path);
        }
        has_skins_ |= node.find("skin").has_value();
        std::vector<std::size_t> children;
        append_nodes(node, "children", children);
        // The last first, because the latest visit is made next.
        for (std::size_t i = children.size(); i-- > 0;)
            todo_.push_back({children[i], world, path, visit.depth + 1});
    }

    // Where a node comes to lie with all those above it.
    static void check_place(const JsonValue& node, const Transform& world) {
        for (const glm::dvec3& v : {world.linear[0], world.linear[1], world.linear[2]}) {
            if (!is_coordinate(v)) node.fail("its scale: " + coordinate_complaint(v));
        }
        if (!is_coordinate(world.translation)) {
            node.fail("its place: " + coordinate_complaint(world.translation));
        }
    }

    // Node name, else mesh name, else "mesh3"; without a mesh "node3".
    std::string node_name(const JsonValue& node, std::size_t index) const {
        std::string name = name_of(node);
        if (!name.empty()) return name;
        const std::optional<JsonValue> mesh = node.find("mesh");
        if (!mesh) return fmt::format("node{}", index);
        return mesh_name(document_.index(*mesh, "meshes"));
    }

    std::string mesh_name(std::size_t mesh) const {
        const std::string name = name_of(document_.array("meshes")[mesh]);
        return name.empty() ? fmt::format("mesh{}", mesh) : name;
    }

    std::string unique_path(const std::string& path) {
        int& uses = path_uses_[path];
        if (++uses == 1) return path;
        std::string numbered = fmt::format("{}#{}", path, uses);
        while (!path_uses_.try_emplace(numbered, 1).second)
            numbered = fmt::format("{}#{}", path, ++path_uses_[path]);
        return numbered;
    }

    void add_object_of(const JsonValue& node, const Transform& world, const std::string& name,
                       const std::string& path) {
        const std::size_t mesh = document_.index(node.need("mesh"), "meshes");
        const std::optional<MeshId> id = mesh_id(mesh);
        if (!id) return;
        if (!inverse(world)) {
            warn(fmt::format("/nodes of path {}: scaled to nothing, so it is not shown", path));
            return;
        }
        Object object;
        object.name = name;
        object.path = path;
        object.shape = MeshInstance{*id};
        object.world_from_object = world;
        add_object(loaded_.scene, std::move(object));
    }

    // Each mesh is there once, however many nodes show it. Nothing if it has no triangles.
    std::optional<MeshId> mesh_id(std::size_t index) {
        std::optional<std::optional<MeshId>>& known = mesh_ids_[index];
        if (known) return *known;
        MeshOutcome& outcome = mesh_outcomes_[index];
        if (outcome.complaint) std::rethrow_exception(outcome.complaint);
        GltfMesh mesh = *std::exchange(outcome.mesh, std::nullopt);
        has_lines_ |= mesh.has_lines;
        has_morphs_ |= mesh.has_morphs;
        known.emplace();
        if (!mesh.mesh.triangles.empty()) *known = add_mesh(loaded_.scene, std::move(mesh.mesh));
        return *known;
    }

    void add_camera(const JsonValue& reference, const JsonValue& node, const Transform& world) {
        const std::size_t index = document_.index(reference, "cameras");
        const JsonValue& json = document_.array("cameras")[index];
        NamedCamera named;
        named.name = name_of(node).empty() ? name_of(json) : name_of(node);
        if (named.name.empty()) named.name = fmt::format("camera{}", index);
        read_projection(json, named.camera);
        const glm::dvec3 forward = glm::normalize(world.vector({0.0, 0.0, -1.0}));
        const glm::dvec3 up = glm::normalize(world.vector({0.0, 1.0, 0.0}));
        if (std::isnan(forward.x) || std::isnan(up.x)) {
            warn(fmt::format("/cameras/{} \"{}\" is scaled to nothing: left out", index,
                             named.name));
            return;
        }
        named.camera.eye = world.translation;
        named.camera.at = world.translation + forward;
        named.camera.up = up;
        loaded_.scene.cameras.push_back(std::move(named));
    }

    static void read_projection(const JsonValue& json, Camera& camera) {
        if (const std::optional<JsonValue> orthographic = json.find("orthographic")) {
            // Half of what scenes hold.
            constexpr NumberRule kSize{kSmallestPositive, 0.5 * kLargestCoordinate, true,
                                       "a positive number"};
            camera.projection = Projection::orthographic;
            camera.height = 2.0 * orthographic->need("ymag").number(kSize);
            return;
        }
        constexpr NumberRule kAngle{0.0, 3.1415926, false, "an angle between 0 and pi"};
        camera.fovy = glm::degrees(json.need("perspective").need("yfov").number(kAngle));
    }

    void add_light(const JsonValue& reference, const JsonValue& node, const Transform& world,
                   const std::string& path) {
        if (auto light = read_gltf_light(document_, reference, node, world)) {
            loaded_.scene.lights.push_back(*std::move(light));
        } else {
            warn(fmt::format("/nodes of path {}: a light scaled to nothing is left out", path));
        }
    }

    void warn(const std::string& text) { loaded_.warnings.push_back(warning(file_, text)); }

    void warn_of_rest() {
        const bool animated = document_.root().find("animations").has_value();
        if (animated || has_skins_ || has_morphs_) {
            warn("animations, skins and morph targets are not read: shown in the rest pose");
        }
        if (has_lines_) warn("points and lines are not shown");
        for (const std::string& name : document_.unread_extensions())
            warn("the extension " + name + " is not read");
        if (loaded_.scene.objects.empty()) warn("has no triangles: nothing to show");
    }

    std::filesystem::path file_;
    const LoadOptions& options_;
    GltfDocument document_;
    LoadedScene loaded_;
    GltfTextures textures_;
    std::vector<int> uv_sets_;  // of each material
    std::optional<std::vector<std::size_t>> roots_;
    std::vector<Visit> todo_;
    std::vector<bool> visited_;
    std::vector<MeshOutcome> mesh_outcomes_;
    std::vector<std::optional<std::optional<MeshId>>> mesh_ids_;
    std::unordered_map<std::string, int> path_uses_;
    std::size_t nodes_read_ = 0;
    bool has_lines_ = false;
    bool has_morphs_ = false;
    bool has_skins_ = false;
};

}  // namespace

LoadedScene load_gltf(const std::filesystem::path& file, const LoadOptions& options) {
    return GltfReader(file, options).read();
}

}  // namespace raypick
