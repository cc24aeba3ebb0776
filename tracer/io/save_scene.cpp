#include "tracer/io/save_scene.h"

#include "tracer/error.h"
#include "tracer/io/json_writer.h"
#include "tracer/io/saved_members.h"
#include "tracer/io/saved_values.h"
#include "tracer/temporary_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace raypick {

namespace {

class SceneWriter {
public:
    SceneWriter(const Scene& scene, std::ostream& out, const SaveOptions& options)
        : scene_(scene), json_(out), options_(options), steps_(steps_of(scene)) {}

    void write() {
        json_.open_object();
        json_.key("raypick");
        json_.whole_number(1);
        write_settings();
        write_list("cameras", scene_.cameras, [&](const NamedCamera& c) { write_value(json_, c); });
        write_list("lights", scene_.lights, [&](const Light& light) { write_value(json_, light); });
        write_list("textures", scene_.textures, [&](const Texture& t) { write_value(json_, t); });
        write_list("materials", scene_.materials,
                   [&](const Material& material) { write_value(json_, material); });
        write_list("meshes", scene_.meshes, [&](const Mesh& mesh) { write_value(json_, mesh); });
        write_list("sphere_sets", scene_.sphere_sets,
                   [&](const SphereSet& set) { write_value(json_, set); });
        write_list("cone_sets", scene_.cone_sets,
                   [&](const ConeSet& set) { write_value(json_, set); });
        ObjectId next_id = 0;
        write_list("objects", scene_.objects, [&](const Object& object) {
            write_value(json_, object, next_id);
            next_id = object.id + 1;
        });
        json_.close_object();
        json_.finish();
    }

private:
    static std::size_t steps_of(const Scene& scene) {
        return scene.textures.size() + scene.meshes.size() + scene.sphere_sets.size() +
               scene.cone_sets.size() + scene.objects.size() + scene.materials.size() +
               scene.lights.size() + scene.cameras.size();
    }

    void write_settings() {
        write_member(json_, "origin", scene_.origin);
        write_member(json_, "background", scene_.background);
        write_member(json_, "ambient", scene_.ambient);
        if (std::holds_alternative<std::monostate>(scene_.environment)) return;
        json_.key("environment");
        write_value(json_, scene_.environment);
    }

    template <typename Things, typename Write>
    void write_list(std::string_view key, const Things& things, const Write& write) {
        if (things.empty()) return;
        json_.key(key);
        json_.open_array();
        for (const auto& thing : things) {
            step();
            write(thing);
        }
        json_.close_array();
    }

    void step() {
        if (options_.stop.stop_requested()) throw Cancelled();
        ++steps_done_;
        if (options_.progress == nullptr) return;
        *options_.progress = static_cast<float>(steps_done_) / static_cast<float>(steps_);
    }

    const Scene& scene_;
    JsonWriter json_;
    const SaveOptions& options_;
    std::size_t steps_;
    std::size_t steps_done_ = 0;
};

}  // namespace

void save_scene(const Scene& scene, const std::filesystem::path& file, const SaveOptions& options) {
    check_scene(scene);
    TemporaryFile temporary(file);
    errno = 0;
    std::ofstream out(temporary.path(), std::ios::binary);
    if (out) SceneWriter(scene, out, options).write();
    out.close();
    if (!out) {
        const char* const reason = errno != 0 ? std::strerror(errno) : "unknown reason";
        throw FileError(file.string(), std::string("can't be written: ") + reason);
    }
    temporary.rename();
    if (options.progress != nullptr) *options.progress = 1.0f;
}

}  // namespace raypick
