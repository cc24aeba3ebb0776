// Wavefront OBJ: objects, groups, materials.
#include "tracer/io/file_bytes.h"
#include "tracer/io/formats.h"
#include "tracer/io/load_steps.h"
#include "tracer/io/mesh_build.h"
#include "tracer/io/mtl_file.h"
#include "tracer/io/mtl_textures.h"
#include "tracer/io/obj_file.h"
#include "tracer/io/polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace raypick {

namespace {

constexpr std::uint32_t kNone = ObjCorner::kNoIndex;

// Gives equal corners of one object the same vertex number: a list for each position.
class CornerMerger {
public:
    explicit CornerMerger(std::size_t positions) : first_(positions, kNone) {}

    // Forgets the object before.
    void clear() {
        for (const ObjCorner& corner : vertices_)
            first_[corner.position] = kNone;
        vertices_.clear();
        next_.clear();
    }

    std::uint32_t vertex(const ObjCorner& corner) {
        std::uint32_t* link = &first_[corner.position];
        while (*link != kNone) {
            const ObjCorner& known = vertices_[*link];
            if (known.uv == corner.uv && known.normal == corner.normal) return *link;
            link = &next_[*link];
        }
        const auto vertex = static_cast<std::uint32_t>(vertices_.size());
        *link = vertex;
        vertices_.push_back(corner);
        next_.push_back(kNone);
        return vertex;
    }

    [[nodiscard]] const std::vector<ObjCorner>& vertices() const { return vertices_; }

private:
    std::vector<std::uint32_t> first_;  // vertex of each position
    std::vector<std::uint32_t> next_;   // of each vertex: another of the same position
    std::vector<ObjCorner> vertices_;
};

// The runs that make one object, in file order.
struct ObjObject {
    std::string name;
    std::vector<std::size_t> runs;
};

// Objects are what `o` names; in files without `o`, what `g` names. A group that is opened again
// goes on; faces before the first name belong to an object named like the file.
std::vector<ObjObject> collect_objects(const ObjFile& obj, const std::string& file_stem) {
    const bool by_object = std::any_of(obj.runs.begin(), obj.runs.end(),
                                       [](const ObjRun& run) { return run.object >= 0; });
    const std::vector<std::string>& names = by_object ? obj.objects : obj.groups;
    std::vector<ObjObject> objects;
    std::map<int, std::size_t> place;
    for (std::size_t i = 0; i < obj.runs.size(); ++i) {
        const int key = by_object ? obj.runs[i].object : obj.runs[i].group;
        const auto [entry, is_new] = place.try_emplace(key, objects.size());
        if (is_new) {
            const bool named = key >= 0 && !names[static_cast<std::size_t>(key)].empty();
            objects.push_back({named ? names[static_cast<std::size_t>(key)] : file_stem, {}});
        }
        objects[entry->second].runs.push_back(i);
    }
    return objects;
}

glm::dvec3 origin_of(const ObjFile& obj) {
    PointBounds bounds;
    for (const ObjCorner& corner : obj.corners)
        bounds.extend(obj.positions[corner.position]);
    return storage_origin(bounds);
}

class ObjAssembler {
public:
    ObjAssembler(const std::filesystem::path& file, const LoadOptions& options, const ObjFile& obj,
                 LoadedScene& loaded)
        : file_(file),
          options_(options),
          obj_(obj),
          loaded_(loaded),
          origin_(origin_of(obj)),
          merger_(obj.positions.size()),
          textures_(loaded, file),
          material_ids_(obj.materials.size()) {}

    void assemble() {
        read_libraries();
        const std::vector<ObjObject> objects =
            collect_objects(obj_, clean_name(file_.stem().string()));
        for (std::size_t i = 0; i < objects.size(); ++i) {
            load_step(options_,
                      0.6f + 0.2f * static_cast<float>(i) / static_cast<float>(objects.size()));
            add(objects[i]);
        }
        textures_.finish(options_, 0.8f, 1.0f);
        warn_of_materials();
    }

private:
    void read_libraries() {
        for (const std::string& names : obj_.libraries) {
            const MtlPaths paths = find_mtl(file_, names);
            for (const std::filesystem::path& path : paths.found)
                read_mtl(path, library_, loaded_.warnings);
            for (const std::string& name : paths.missing) {
                loaded_.warnings.push_back(
                    warning(file_, fmt::format("material library \"{}\" is missing: its materials "
                                               "are shown grey",
                                               clean_name(name))));
                library_missing_ = true;
            }
        }
    }

    void add(const ObjObject& object) {
        merger_.clear();
        MeshData data;
        std::vector<Part> parts;
        for (const std::size_t run : object.runs)
            add_run(run, data, parts);
        add_vertices(data);
        data = with_shading_normals(std::move(data), options_.crease_degrees);
        place_mesh(loaded_.scene, origin_,
                   make_mesh(object.name, std::move(data), std::move(parts)));
    }

    void add_run(std::size_t run, MeshData& data, std::vector<Part>& parts) {
        const auto first = static_cast<std::uint32_t>(data.triangles.size());
        for (std::uint32_t face = obj_.runs[run].first_face; face < obj_.run_end(run); ++face)
            add_face(face, data);
        const auto count = static_cast<std::uint32_t>(data.triangles.size()) - first;
        const MaterialId material = material_of(obj_.runs[run].material);
        if (!parts.empty() && parts.back().material == material) {
            parts.back().count += count;
        } else {
            parts.push_back({first, count, material});
        }
    }

    void add_face(std::uint32_t face, MeshData& data) {
        const ObjCorner* corners = &obj_.corners[obj_.face_begin[face]];
        const auto count = obj_.face_begin[face + 1] - obj_.face_begin[face];
        numbers_.clear();
        for (std::size_t i = 0; i < count; ++i)
            numbers_.push_back(merger_.vertex(corners[i]));
        if (count == 3) {
            data.triangles.emplace_back(numbers_[0], numbers_[1], numbers_[2]);
            return;
        }
        points_.clear();
        for (std::size_t i = 0; i < count; ++i)
            points_.push_back(obj_.positions[corners[i].position]);
        for (const glm::uvec3& t : splitter_.split(points_))
            data.triangles.emplace_back(numbers_[t.x], numbers_[t.y], numbers_[t.z]);
    }

    void add_vertices(MeshData& data) {
        const std::vector<ObjCorner>& vertices = merger_.vertices();
        const bool uvs = std::any_of(vertices.begin(), vertices.end(),
                                     [](const ObjCorner& v) { return v.uv != kNone; });
        const bool normals = std::any_of(vertices.begin(), vertices.end(),
                                         [](const ObjCorner& v) { return v.normal != kNone; });
        data.positions.reserve(vertices.size());
        if (uvs) data.uvs.reserve(vertices.size());
        if (normals) data.normals.reserve(vertices.size());
        for (const ObjCorner& v : vertices) {
            data.positions.emplace_back(obj_.positions[v.position] - origin_);
            if (uvs) data.uvs.push_back(v.uv == kNone ? glm::vec2(0.0f) : obj_.uvs[v.uv]);
            if (normals) {
                data.normals.push_back(v.normal == kNone ? glm::vec3(0.0f)
                                                         : obj_.normals[v.normal]);
            }
        }
    }

    // Materials come into the scene when first used.
    MaterialId material_of(int number) {
        if (number < 0) return kNoMaterial;
        std::optional<MaterialId>& id = material_ids_[static_cast<std::size_t>(number)];
        if (id) return *id;
        const std::string& name = obj_.materials[static_cast<std::size_t>(number)];
        const auto found = library_.find(name);
        Material material;
        material.name = name;
        if (found != library_.end()) {
            material = material_from(found->second);
        } else {
            unknown_.push_back(name);
        }
        id = add_material(loaded_.scene, std::move(material));
        if (found != library_.end()) textures_.request(*id, found->second);
        return *id;
    }

    void warn_of_materials() {
        if (library_missing_ || unknown_.empty()) return;  // told already, or nothing to tell
        if (obj_.libraries.empty()) {
            loaded_.warnings.push_back(
                warning(file_, "uses materials but names no library: they are shown grey"));
            return;
        }
        for (const std::string& name : unknown_) {
            loaded_.warnings.push_back(
                warning(file_, fmt::format("material \"{}\" is in no library: shown grey", name)));
        }
    }

    const std::filesystem::path& file_;
    const LoadOptions& options_;
    const ObjFile& obj_;
    LoadedScene& loaded_;
    glm::dvec3 origin_;
    CornerMerger merger_;
    MtlTextures textures_;
    PolygonSplitter splitter_;
    MtlLibrary library_;
    std::vector<std::optional<MaterialId>> material_ids_;
    std::vector<std::string> unknown_;
    bool library_missing_ = false;
    std::vector<std::uint32_t> numbers_;
    std::vector<glm::dvec3> points_;
};

}  // namespace

LoadedScene load_obj(const std::filesystem::path& file, const LoadOptions& options) {
    LoadedScene loaded = begin_scene(options);
    const ObjFile obj = parse_obj(file, options, loaded.warnings);
    ObjAssembler(file, options, obj, loaded).assemble();
    return loaded;
}

}  // namespace raypick
