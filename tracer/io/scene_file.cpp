// Our own scene format: JSON with comments. assets/scene.schema.json describes it.
#include "tracer/error.h"
#include "tracer/io/file_bytes.h"
#include "tracer/io/formats.h"
#include "tracer/io/json_value.h"
#include "tracer/io/load_steps.h"
#include "tracer/io/mesh_build.h"
#include "tracer/io/model_library.h"
#include "tracer/io/references.h"
#include "tracer/io/scene_arrays.h"
#include "tracer/io/scene_looks.h"
#include "tracer/io/scene_numbers.h"
#include "tracer/io/scene_shapes.h"
#include "tracer/io/scene_values.h"

#include <fmt/format.h>

#include <set>
#include <string>
#include <unordered_map>
#include <utility>

namespace raypick {

namespace {

constexpr NumberRule kMask{0.0, 4294967295.0, true, "a whole number from 0 to 4294967295"};

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
    std::optional<Sides> sides;         // likewise
};

// Reads one file. All entries are read before any is placed, because an instance may come before
// what it is an instance of.
class SceneReader {
public:
    SceneReader(const std::filesystem::path& file, const LoadOptions& options)
        : file_(file),
          options_(options),
          result_(begin_scene(options)),
          images_{file.parent_path(), file.string(), &result_.warnings},
          models_(result_, options) {}

    LoadedScene read(const JsonFile& json) {
        const JsonValue root(json);
        if (!root.is_object()) root.refuse("a scene (an object)");
        check_version(root);
        root.only_keys("a scene",
                       Keys{"$schema", "raypick", "origin", "background", "environment", "ambient",
                            "camera", "cameras", "lights", "textures", "materials", "meshes",
                            "sphere_sets", "cone_sets", "objects"});
        read_settings(root);
        read_views(root);
        read_looks(root);
        read_geometry(root);
        if (const auto objects = root.find("objects")) read_objects(objects->elements());
        if (options_.progress != nullptr) *options_.progress = 1.0f;
        return std::move(result_);
    }

private:
    void read_settings(const JsonValue& root) {
        Scene& scene = result_.scene;
        if (const auto schema = root.find("$schema")) (void)schema->text();
        if (const auto value = root.find("origin")) {
            scene.origin = read_point(*value);
            result_.keeps_origin = true;
        }
        if (const auto value = root.find("background")) scene.background = read_colour(*value);
        if (const auto value = root.find("ambient")) scene.ambient = read_colour(*value);
        if (const auto value = root.find("environment")) {
            scene.environment = read_environment(*value, images_);
        }
    }

    void read_views(const JsonValue& root) {
        Scene& scene = result_.scene;
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

    void read_looks(const JsonValue& root) {
        if (const auto textures = root.find("textures")) {
            read_entries(*textures, textures_, [this](const JsonValue& value, std::string name) {
                load_step(options_, 0.0f);
                return add_texture(result_.scene,
                                   read_scene_texture(value, std::move(name), images_));
            });
        }
        if (const auto materials = root.find("materials")) {
            read_entries(*materials, materials_, [this](const JsonValue& value, std::string name) {
                return add_material(result_.scene,
                                    read_material(value, std::move(name), textures_));
            });
        }
    }

    // What several objects may use.
    void read_geometry(const JsonValue& root) {
        if (const auto meshes = root.find("meshes")) {
            read_entries(*meshes, meshes_, [this](const JsonValue& value, const std::string& name) {
                value.only_keys("a mesh",
                                Keys{"name", "positions", "triangles", "normals", "uvs", "parts"});
                load_step(options_, 0.0f);
                return add_piece(mesh_piece(value, name));
            });
        }
        if (const auto sets = root.find("sphere_sets")) {
            read_entries(*sets, sphere_sets_,
                         [this](const JsonValue& value, const std::string& name) {
                             value.only_keys("a set of spheres", Keys{"name", "spheres", "parts"});
                             load_step(options_, 0.0f);
                             return add_piece(spheres_piece(value, name));
                         });
        }
        if (const auto sets = root.find("cone_sets")) {
            read_entries(
                *sets, cone_sets_, [this](const JsonValue& value, const std::string& name) {
                    value.only_keys("a set of cones", Keys{"name", "cones", "capped", "parts"});
                    load_step(options_, 0.0f);
                    return add_piece(cones_piece(value, name));
                });
        }
    }

    std::uint32_t add_piece(ModelPiece piece) {
        shared_pieces_.push_back(std::move(piece));
        return static_cast<std::uint32_t>(shared_pieces_.size() - 1);
    }

    [[nodiscard]] MaterialReader material_reader() {
        return [this](const JsonValue& value) { return read_material_use(value, "part"); };
    }

    // A mesh as it is written: flat if it has no normals.
    ModelPiece mesh_piece(const JsonValue& value, const std::string& name) {
        InlineMesh mesh = read_inline_mesh(value, material_reader());
        const MeshId id =
            add_mesh(result_.scene, make_mesh(name, std::move(mesh.data), std::move(mesh.parts)));
        return {"", "", MeshInstance{id}, translate(mesh.origin), kNoMaterial};
    }

    ModelPiece spheres_piece(const JsonValue& value, const std::string& name) {
        InlineSet set = read_inline_spheres(value, material_reader());
        const SetId id = add_sphere_set(
            result_.scene, make_sphere_set(name, std::move(set.elements), std::move(set.parts)));
        return {"", "", SphereSetInstance{id}, translate(set.origin), kNoMaterial};
    }

    ModelPiece cones_piece(const JsonValue& value, const std::string& name) {
        InlineSet set = read_inline_cones(value, material_reader());
        bool capped = false;
        if (const auto key = value.find("capped")) capped = key->truth();
        const SetId id = add_cone_set(result_.scene, make_cone_set(name, std::move(set.elements),
                                                                   capped, std::move(set.parts)));
        return {"", "", ConeSetInstance{id}, translate(set.origin), kNoMaterial};
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
        const std::string type = object.need("type").one_of(kObjectTypes);
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
        } else if (type == "spheres") {
            check_spheres_keys(object);
            const auto set = object.find("set");
            entry.pieces.push_back(set ? shared_pieces_[sphere_sets_.read(*set)]
                                       : spheres_piece(object, entry.name));
        } else if (type == "cones") {
            check_cones_keys(object);
            const auto set = object.find("set");
            entry.pieces.push_back(set ? shared_pieces_[cone_sets_.read(*set)]
                                       : cones_piece(object, entry.name));
        } else {
            entry.pieces.push_back({"", "", read_shape(object, type), {}, kNoMaterial});
        }
        if (const auto value = object.find("sides")) entry.sides = read_sides(*value);
        if (const auto value = object.find("material")) {
            entry.material = read_material_use(*value, entry.name);
        }
        return entry;
    }

    std::vector<ModelPiece> read_mesh(const JsonValue& object, Entry& entry) {
        check_mesh_keys(object);
        if (const auto mesh = object.find("mesh")) return {shared_pieces_[meshes_.read(*mesh)]};
        const std::optional<JsonValue> file = object.find("file");
        if (!file) return {smooth_mesh_piece(object, entry.name)};
        const std::filesystem::path path = file_.parent_path() / file->text();
        if (!entry.named_by_file) entry.name = path.stem().string();
        return read_model(*file, path);
    }

    // A mesh without normals gets them by the crease angle.
    ModelPiece smooth_mesh_piece(const JsonValue& object, const std::string& name) {
        InlineMesh mesh = read_inline_mesh(object, material_reader());
        MeshData data = with_shading_normals(std::move(mesh.data), options_.crease_degrees);
        const MeshId id =
            add_mesh(result_.scene, make_mesh(name, std::move(data), std::move(mesh.parts)));
        return {"", "", MeshInstance{id}, translate(mesh.origin), kNoMaterial};
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

    // The name or number of a material, or a material written where it is used.
    MaterialId read_material_use(const JsonValue& value, const std::string& object_name) {
        if (value.is_string() || value.is_number()) return materials_.read(value);
        if (!value.is_object()) value.refuse("the name of a material or a material");
        return add_material(result_.scene, read_material(value, object_name, textures_));
    }

    // What an instance repeats.
    const Entry& original(const JsonValue& instance) {
        const JsonValue of = instance.need("of");
        const std::string& name = of.text();
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
        const auto own_path = object.find("path");
        const std::string path = own_path ? own_path->text() : "/" + name;
        for (const ModelPiece& piece : looks.pieces) {
            Object placed;
            placed.name = many ? name + "/" + piece.name : name;
            placed.path = many ? path + piece.path : path;
            placed.shape = piece.shape;
            // Not even a sign of a zero may change where nothing is to be applied.
            placed.world_from_object = piece.model_from_object.is_identity()
                                           ? world_from_entry
                                           : world_from_entry * piece.model_from_object;
            if (!inverse(placed.world_from_object)) {
                object.fail("its transform flattens it: scales this large or small don't work");
            }
            placed.material = material != kNoMaterial ? material : piece.material;
            placed.sides = entry.sides.value_or(looks.sides.value_or(piece.sides));
            if (const auto mask = object.find("mask")) {
                placed.mask = static_cast<std::uint32_t>(mask->whole_number(kMask));
            }
            if (&piece == looks.pieces.data()) take_id(object);
            add_object(result_.scene, std::move(placed));
        }
    }

    // Sees to it that the next object gets the id that the file gives it. Ids of a file count from
    // the first one that the session has free.
    void take_id(const JsonValue& object) {
        const auto value = object.find("id");
        if (!value) return;
        const ObjectId least = result_.scene.next_object_id - options_.first_object_id;
        const double most = 4294967294.0 - static_cast<double>(options_.first_object_id);
        const std::string words = fmt::format("a whole number, at least {}: ids ascend", least);
        const NumberRule rule{static_cast<double>(least), most, true, words};
        result_.scene.next_object_id =
            options_.first_object_id + static_cast<ObjectId>(value->whole_number(rule));
    }

    std::filesystem::path file_;
    LoadOptions options_;
    LoadedScene result_;
    ImageFolder images_;
    ModelLibrary models_;
    References textures_{"texture"};
    References materials_{"material"};
    // Ids are indices into shared_pieces_.
    References meshes_{"mesh"};
    References sphere_sets_{"set of spheres"};
    References cone_sets_{"set of cones"};
    std::vector<ModelPiece> shared_pieces_;
    std::vector<Entry> entries_;
    std::unordered_map<std::string, std::vector<std::size_t>> by_name_;  // named_by_file only
};

}  // namespace

LoadedScene load_scene_file(const std::filesystem::path& file, const LoadOptions& options) {
    const FileText text(file);
    const JsonFile json{file.string(), parse_json(file.string(), text.view()), text.view()};
    return SceneReader(file, options).read(json);
}

}  // namespace raypick
