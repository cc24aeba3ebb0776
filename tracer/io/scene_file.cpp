// Our own scene format: JSON with comments. assets/scene.schema.json describes it.
#include "tracer/error.h"
#include "tracer/io/file_bytes.h"
#include "tracer/io/formats.h"
#include "tracer/io/json_value.h"
#include "tracer/io/load_steps.h"
#include "tracer/io/mesh_build.h"
#include "tracer/io/model_library.h"
#include "tracer/io/scene_values.h"

#include <fmt/format.h>

#include <set>
#include <string>
#include <unordered_map>
#include <utility>

namespace raypick {

namespace {

using Keys = std::vector<std::string_view>;

void check_version(const JsonValue& root) {
    const std::optional<JsonValue> version = root.find("raypick");
    if (!version) root.fail("\"raypick\": 1 is missing: the mark and version of a raypick scene");
    if (!version->equals(1)) version->refuse("1, the version that this program reads");
}

// An entry of "objects" stands for these things, before it is placed. A mesh entry may hold many.
struct Entry {
    std::string name;
    bool named_by_file = false;  // and not after its type
    bool is_instance = false;
    std::vector<ModelPiece> pieces;
    MaterialId material = kNoMaterial;  // overrides that of the pieces
};

// Reads one file. All entries are read before any is placed, because an instance may come before
// what it is an instance of.
class SceneReader {
public:
    SceneReader(const std::filesystem::path& file, const LoadOptions& options)
        : file_(file),
          file_name_(file.string()),
          options_(options),
          result_(begin_scene(options)),
          models_(result_, options) {}

    LoadedScene read(const Json& json) {
        const JsonValue root(file_name_, json);
        if (!root.is_object()) root.refuse("a scene (an object)");
        check_version(root);
        root.only_keys("a scene", Keys{"$schema", "raypick", "background", "ambient", "camera",
                                       "cameras", "lights", "materials", "objects"});
        read_settings(root);
        if (const auto materials = root.find("materials")) read_materials(*materials);
        if (const auto objects = root.find("objects")) read_objects(objects->elements());
        if (options_.progress != nullptr) *options_.progress = 1.0f;
        return std::move(result_);
    }

private:
    void read_settings(const JsonValue& root) {
        Scene& scene = result_.scene;
        if (const auto schema = root.find("$schema")) (void)schema->text();
        if (const auto value = root.find("background")) scene.background = read_colour(*value);
        if (const auto value = root.find("ambient")) scene.ambient = read_colour(*value);
        if (const auto value = root.find("camera")) {
            scene.cameras.push_back(read_camera(*value, "camera"));
        }
        if (const auto values = root.find("cameras")) {
            for (const JsonValue& value : values->elements()) {
                const std::string name = fmt::format("camera {}", scene.cameras.size() + 1);
                scene.cameras.push_back(read_camera(value, name));
            }
        }
        if (const auto values = root.find("lights")) {
            for (const JsonValue& value : values->elements()) {
                scene.lights.push_back(read_light(value));
            }
        }
    }

    void read_materials(const JsonValue& materials) {
        for (const auto& [name, value] : materials.members()) {
            materials_[name] = add_material(result_.scene, read_material(value, name));
        }
    }

    void read_objects(const std::vector<JsonValue>& objects) {
        expect_models(objects);
        entries_.reserve(objects.size());
        for (const JsonValue& object : objects) {
            if (options_.stop.stop_requested()) throw Cancelled();
            entries_.push_back(read_entry(object));
            const Entry& entry = entries_.back();
            if (entry.named_by_file) by_name_[entry.name].push_back(entries_.size() - 1);
        }
        for (std::size_t i = 0; i < objects.size(); ++i)
            place(objects[i], entries_[i]);
    }

    // Counts the model files ahead, for the progress. What is wrong is found later.
    void expect_models(const std::vector<JsonValue>& objects) {
        std::set<std::string> files;
        for (const JsonValue& object : objects) {
            if (!object.is_object()) continue;
            if (const auto file = object.find("file"); file && file->is_string()) {
                files.insert(file->text());
            }
        }
        models_.expect(files.size());
    }

    Entry read_entry(const JsonValue& object) {
        if (!object.is_object()) object.refuse("an object with a type");
        const std::string type = object.need("type").one_of(
            Keys{"sphere", "plane", "triangle", "box", "mesh", "instance"});
        Entry entry;
        entry.name = type;
        if (const auto name = object.find("name")) {
            entry.name = name->text();
            entry.named_by_file = true;
        }
        entry.is_instance = type == "instance";
        if (entry.is_instance) {
            check_instance_keys(object);
        } else if (type == "mesh") {
            entry.pieces = read_mesh(object, entry);
        } else {
            entry.pieces.push_back({"", "", read_shape(object, type), {}, kNoMaterial});
        }
        if (const auto value = object.find("material")) {
            entry.material = read_material_use(*value, entry.name);
        }
        return entry;
    }

    static Shape read_shape(const JsonValue& object, const std::string& type) {
        if (type == "sphere") return read_sphere(object);
        if (type == "plane") return read_plane(object);
        if (type == "triangle") return read_triangle(object);
        return read_box(object);
    }

    std::vector<ModelPiece> read_mesh(const JsonValue& object, Entry& entry) {
        check_mesh_keys(object);
        const std::optional<JsonValue> file = object.find("file");
        if (!file) {
            InlineMesh inline_mesh = read_inline_mesh(object);
            MeshData data =
                with_shading_normals(std::move(inline_mesh.data), options_.crease_degrees);
            const MeshId mesh = add_mesh(result_.scene, make_mesh(entry.name, std::move(data)));
            return {{"", "", MeshInstance{mesh}, translate(inline_mesh.origin), kNoMaterial}};
        }
        const std::filesystem::path path = file_.parent_path() / file->text();
        if (!entry.named_by_file) entry.name = path.stem().string();
        return read_model(*file, path);
    }

    std::vector<ModelPiece> read_model(const JsonValue& value, const std::filesystem::path& path) {
        try {
            const std::vector<ModelPiece>& pieces = models_.pieces(path);
            if (pieces.empty()) throw FileError(path.string(), "holds no object");
            return pieces;
        } catch (const Cancelled&) {
            throw;
        } catch (const Error& error) {
            value.fail(error.what());
        }
    }

    // The name of a material, or a material written where it is used.
    MaterialId read_material_use(const JsonValue& value, const std::string& object_name) {
        if (value.is_object()) {
            return add_material(result_.scene, read_material(value, object_name));
        }
        if (!value.is_string()) value.refuse("the name of a material or a material");
        const std::string name = value.text();
        const auto found = materials_.find(name);
        if (found != materials_.end()) return found->second;
        Keys known;
        for (const auto& [known_name, id] : materials_)
            known.push_back(known_name);
        value.fail(fmt::format("there is no material \"{}\"{}", name, did_you_mean(name, known)));
    }

    // What an instance repeats.
    const Entry& original(const JsonValue& instance) {
        const JsonValue of = instance.need("of");
        const std::string name = of.text();
        const auto found = by_name_.find(name);
        if (found == by_name_.end()) {
            Keys known;
            for (const auto& [known_name, indices] : by_name_)
                known.push_back(known_name);
            of.fail(fmt::format("there is no object \"{}\"{}", name, did_you_mean(name, known)));
        }
        const std::vector<std::size_t>& indices = found->second;
        if (indices.size() > 1) {
            of.fail(fmt::format("/objects/{} and /objects/{} are both called \"{}\"", indices[0],
                                indices[1], name));
        }
        const Entry& entry = entries_[indices[0]];
        if (entry.is_instance) {
            of.fail(
                fmt::format("\"{}\" is an instance itself: name what it is an instance of", name));
        }
        return entry;
    }

    void place(const JsonValue& object, const Entry& entry) {
        const Entry& looks = entry.is_instance ? original(object) : entry;
        const std::string& name =
            entry.is_instance && !entry.named_by_file ? looks.name : entry.name;
        const MaterialId material = entry.material != kNoMaterial ? entry.material : looks.material;
        const Transform world_from_entry = read_transform(object);
        const bool many = looks.pieces.size() > 1;
        for (const ModelPiece& piece : looks.pieces) {
            Object placed;
            placed.name = many ? name + "/" + piece.name : name;
            placed.path = many ? "/" + name + piece.path : "/" + name;
            placed.shape = piece.shape;
            placed.world_from_object = world_from_entry * piece.model_from_object;
            if (!inverse(placed.world_from_object)) {
                object.fail("its transform flattens it: scales this large or small don't work");
            }
            placed.material = material != kNoMaterial ? material : piece.material;
            add_object(result_.scene, std::move(placed));
        }
    }

    std::filesystem::path file_;
    std::string file_name_;
    LoadOptions options_;
    LoadedScene result_;
    ModelLibrary models_;
    std::unordered_map<std::string, MaterialId> materials_;
    std::vector<Entry> entries_;
    std::unordered_map<std::string, std::vector<std::size_t>> by_name_;  // named_by_file only
};

}  // namespace

LoadedScene load_scene_file(const std::filesystem::path& file, const LoadOptions& options) {
    const Json json = parse_json(file.string(), FileText(file).view());
    return SceneReader(file, options).read(json);
}

}  // namespace raypick
