#include "tests/bench/scenes.h"

#include "tests/bench/command.h"
#include "tracer/accel/accel.h"
#include "tracer/io/load.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>
#include <utility>

namespace raypick::bench {

namespace {

std::string path_of(const std::string& name) {
    static constexpr std::array<std::pair<const char*, const char*>, 6> kPaths{{
        {"bunny", "stanford/bunny_binary.ply"},
        {"sponza", "sponza/sponza.obj"},
        {"kitchen", "bitterli/kitchen.glb"},
        {"scopia", "scopia/scopia_grid.ply.gz"},
        {"balls", "spd/balls.nff"},
        {"rings", "spd/rings.nff"},
    }};
    for (const auto& [known, path] : kPaths) {
        if (name == known) return path;
    }
    return name;
}

// Beside this program, where it is found again the next time.
std::optional<std::filesystem::path> unpacked(const std::filesystem::path& file, Report& report) {
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
    const std::filesystem::path target = program.parent_path() / file.stem();
    if (std::filesystem::exists(target)) return target;
    // By another name until it is whole.
    const std::string part = target.string() + ".part";
    if (run_shell(fmt::format("gzip -dc '{}' > '{}'", file.string(), part)).exit_code != 0) {
        report.missing(fmt::format("{}: gzip can't unpack it", file.string()));
        return std::nullopt;
    }
    std::filesystem::rename(part, target);
    return target;
}

// What both tracers can have.
void simplify(Scene& scene) {
    for (Object& object : scene.objects)
        object.sides = Sides::both;
    for (ConeSet& set : scene.cone_sets)
        set.capped = true;
    for (Material& material : scene.materials) {
        material.opacity = 1.0f;
        material.map(MapSlot::opacity) = {};
    }
}

std::optional<Scene> load_model(const std::string& name, Report& report) {
    const auto file = model_file(name, report);
    if (!file) return std::nullopt;
    Scene scene = load_scene(*file).scene;
    simplify(scene);
    return scene;
}

View finish(const std::string& name, Scene scene, const Camera& camera, const glm::dvec3& light) {
    if (scene.lights.empty()) scene.lights.emplace_back(PointLight{"lamp", light});
    const auto* lamp = std::get_if<PointLight>(&scene.lights.front());
    View view{name, nullptr, camera, lamp == nullptr ? light : lamp->position};
    view.camera.near = near_for_bounds(camera, scene_bounds(scene));
    view.scene = std::make_shared<const Scene>(std::move(scene));
    return view;
}

constexpr ImageSize kShape{1080, 1920};

// Close up: the model fills half of the view.
View object_view(const std::string& name, Scene scene) {
    const Bounds bounds = scene_bounds(scene);
    Camera camera = frame_bounds(bounds, {-0.25, -0.3, -1.0}, {0, 1, 0}, 40.0, kShape.aspect());
    camera.fovy = 23.0;
    const glm::dvec3 light =
        glm::dvec3(bounds.centre()) + glm::dvec3(bounds.extent()) * glm::dvec3(-0.8, 1.5, 1.2);
    return finish(name, std::move(scene), camera, light);
}

Camera courtyard_camera() {
    return {.eye = {-11.0, 3.0, -0.4}, .at = {10.0, 5.0, 0.6}, .fovy = 60.0};
}
constexpr glm::dvec3 kCourtyardLight{2.0, 11.0, 0.3};

View courtyard_view(const std::string& name, Scene scene) {
    return finish(name, std::move(scene), courtyard_camera(), kCourtyardLight);
}

// The camera of the file, a lamp in front of it.
View file_view(const std::string& name, Scene scene) {
    const Camera camera = default_camera(scene, kShape);
    const CameraFrame frame = camera_frame(camera);
    const glm::dvec3 light = camera.eye - 0.8 * frame.vz + 0.4 * frame.vy - 0.3 * frame.vx;
    return finish(name, std::move(scene), camera, light);
}

// From above, all of it: most triangles are smaller than a pixel.
View overview(const std::string& name, Scene scene) {
    const Bounds bounds = scene_bounds(scene);
    const Camera camera = default_camera(scene, kShape);
    const double size = glm::length(glm::dvec3(bounds.extent()));
    return finish(name, std::move(scene), camera, camera.eye + glm::dvec3(0.0, 0.3 * size, 0.0));
}

MaterialId add_mirror(Scene& scene) {
    Material mirror;
    mirror.name = "mirror";
    mirror.diffuse = mirror.ambient = glm::vec3(0.2f);
    mirror.reflect = glm::vec3(0.6f);
    return add_material(scene, mirror);
}

void add_floor(Scene& scene, const glm::dvec3& centre, double size) {
    Object floor;
    floor.name = "mirror floor";
    floor.shape = Rectangle{centre + glm::dvec3(-size, 0.0, size), glm::dvec3(2.0 * size, 0.0, 0.0),
                            glm::dvec3(0.0, 0.0, -2.0 * size)};
    floor.material = add_mirror(scene);
    add_object(scene, std::move(floor));
}

View bunny_on_mirror(Scene scene) {
    const Bounds bounds = scene_bounds(scene);
    glm::dvec3 below(bounds.centre());
    below.y = static_cast<double>(bounds.min.y);
    View view = object_view("bunny_mirror", scene);
    add_floor(scene, below, 3.0 * static_cast<double>(glm::length(bounds.extent())));
    view.camera.fovy = 38.0;  // so that the mirror is seen
    return finish("bunny_mirror", std::move(scene), view.camera, view.light);
}

// The mirror lies just above the floor under the camera.
View sponza_on_mirror(Scene scene) {
    Ray down;
    down.origin = glm::vec3(courtyard_camera().eye);
    down.direction = {0.0f, -1.0f, 0.0f};
    const auto floor = Accel(std::make_shared<const Scene>(scene)).intersect(down);
    glm::dvec3 at = courtyard_camera().eye;
    if (floor) at.y -= static_cast<double>(floor->t) - 0.005;
    add_floor(scene, {0.0, at.y, 0.0}, 18.0);
    return courtyard_view("sponza_mirror", std::move(scene));
}

// Each triangle into four at the middles of its edges.
MeshData subdivided(const MeshData& coarse) {
    MeshData fine;
    fine.positions = coarse.positions;
    fine.triangles.reserve(4 * coarse.triangles.size());
    std::unordered_map<std::uint64_t, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const std::uint64_t edge = std::uint64_t{std::min(a, b)} << 32u | std::max(a, b);
        const auto next = static_cast<std::uint32_t>(fine.positions.size());
        const auto [at, fresh] = middles.try_emplace(edge, next);
        if (fresh) fine.positions.push_back(0.5f * (fine.positions[a] + fine.positions[b]));
        return at->second;
    };
    for (const glm::uvec3& t : coarse.triangles) {
        const glm::uvec3 m{middle(t.x, t.y), middle(t.y, t.z), middle(t.z, t.x)};
        fine.triangles.insert(fine.triangles.end(),
                              {{t.x, m.x, m.z}, {m.x, t.y, m.y}, {m.z, m.y, t.z}, m});
    }
    return fine;
}

View fine_bunny(const Scene& coarse) {
    MeshData data;
    data.positions.assign(coarse.meshes[0].positions.begin(), coarse.meshes[0].positions.end());
    data.triangles.assign(coarse.meshes[0].triangles.begin(), coarse.meshes[0].triangles.end());
    for (int i = 0; i < 3; ++i)
        data = subdivided(data);
    Scene scene;
    const MeshId mesh = add_mesh(scene, make_mesh("bunny", std::move(data)));
    Object object;
    object.name = "bunny";
    object.shape = MeshInstance{mesh};
    object.world_from_object = coarse.objects[0].world_from_object;
    add_object(scene, std::move(object));
    // The same view as of the coarse one.
    return object_view("bunny64", std::move(scene));
}

Material lattice_material(int kind) {
    Material material;
    material.specular = glm::vec3(0.3f);
    material.diffuse = material.ambient = glm::vec3(0.7f, 0.4f, 0.3f);
    if (kind == 0) {
        material.diffuse = material.ambient = glm::vec3(0.15f);
        material.reflect = glm::vec3(0.7f);
    } else if (kind == 1) {
        material.diffuse = material.ambient = glm::vec3(0.05f);
        material.reflect = glm::vec3(0.1f);
        material.transmit = glm::vec3(0.8f);
        material.ior = 1.5f;
    }
    return material;
}

// Every third ball is a mirror, of glass, matt; one set for each, so that an object has one look.
View lattice() {
    constexpr int kSide = 9;
    Scene scene;
    scene.background = {0.3f, 0.4f, 0.6f};
    std::array<std::vector<glm::vec4>, 3> balls;
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
        const glm::ivec3 cell(i % kSide, i / kSide % kSide, i / (kSide * kSide));
        const auto kind = static_cast<std::size_t>((cell.x + cell.y + cell.z) % 3);
        balls[kind].emplace_back(glm::vec3(cell) - 0.5f * (kSide - 1), 0.3f);
    }
    for (std::size_t kind = 0; kind < balls.size(); ++kind) {
        Object object;
        object.name = "balls";
        object.shape = SphereSetInstance{
            add_sphere_set(scene, make_sphere_set("balls", std::move(balls[kind])))};
        object.material = add_material(scene, lattice_material(static_cast<int>(kind)));
        add_object(scene, std::move(object));
    }
    for (const glm::dvec3& at : {glm::dvec3(-9, 14, 12), glm::dvec3(12, 9, 9)})
        scene.lights.emplace_back(PointLight{"lamp", at, glm::vec3(0.6f)});
    const Camera camera{.eye = {7.0, 6.0, 10.0}, .at = {0.0, -0.5, 0.0}, .fovy = 45.0};
    return finish("lattice", std::move(scene), camera, {});
}

}  // namespace

std::optional<std::filesystem::path> model_file(const std::string& name, Report& report) {
    const std::filesystem::path file = report.options().models / path_of(name);
    if (!std::filesystem::exists(file)) {
        report.missing(fmt::format("model {}", file.string()));
        return std::nullopt;
    }
    return file.extension() == ".gz" ? unpacked(file, report) : file;
}

std::optional<View> open_view(const std::string& name, Report& report) {
    if (name == "lattice") return lattice();
    const std::string model = name.substr(0, name.find_first_of("_6"));
    std::optional<Scene> scene = load_model(model, report);
    if (!scene) return std::nullopt;
    if (name == "bunny") return object_view(name, std::move(*scene));
    if (name == "bunny64") return fine_bunny(*scene);
    if (name == "bunny_mirror") return bunny_on_mirror(std::move(*scene));
    if (name == "sponza") return courtyard_view(name, std::move(*scene));
    if (name == "sponza_mirror") return sponza_on_mirror(std::move(*scene));
    if (name == "scopia") return overview(name, std::move(*scene));
    return file_view(name, std::move(*scene));
}

}  // namespace raypick::bench
