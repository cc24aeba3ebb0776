#include "tests/bench/tachyon_scene.h"

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <variant>

namespace raypick::bench {

namespace {

[[noreturn]] void no_equivalent(const std::string& what) {
    throw std::invalid_argument("for Tachyon: " + what);
}

std::string text(const glm::dvec3& v) {
    return fmt::format("{:.9g} {:.9g} {:.9g}", v.x, v.y, v.z);
}

float largest(const glm::vec3& v) {
    return std::max({v.x, v.y, v.z});
}

// Tachyon's image is 1 / zoom high at distance 1.
std::string camera_text(const Camera& camera, int depth) {
    const CameraFrame frame = camera_frame(camera);
    return fmt::format(
        "Camera\n  Zoom {:.9g}\n  Aspectratio 1.0\n  Antialiasing 0\n  Raydepth {}\n"
        "  Center {}\n  Viewdir {}\n  Updir {}\nEnd_Camera\n",
        0.5 / std::tan(glm::radians(camera.fovy) / 2.0), depth, text(camera.eye), text(-frame.vz),
        text(frame.vy));
}

std::string light_text(const Light& light) {
    const auto* point = std::get_if<PointLight>(&light);
    if (point == nullptr) no_equivalent("a light that is no point");
    return fmt::format("Light Center {} Rad 0.0001 Color {}\n", text(point->position),
                       text(glm::dvec3(point->colour)));
}

// One colour, scaled by how much of it is diffused, mirrored, not let through.
std::string texture_text(const Material& material, const glm::vec3& ambient, std::size_t index) {
    const float diffuse = std::max(largest(material.diffuse), 1e-3f);
    return fmt::format(
        "TexDef m{} Ambient {:.6g} Diffuse {:.6g} Specular {:.6g} Opacity {:.6g} "
        "Phong Plastic {:.6g} Phong_size {:.6g} Color {} TexFunc 0\n",
        index, largest(material.ambient * ambient) / diffuse, diffuse, largest(material.reflect),
        1.0f - largest(material.transmit), largest(material.specular), material.shininess,
        text(glm::dvec3(material.diffuse / diffuse)));
}

class ObjectWriter {
public:
    ObjectWriter(std::ofstream& out, const Scene& scene) : out_(out), scene_(scene) {}

    void write(const Object& object) {
        if (const auto* spheres = std::get_if<SphereSetInstance>(&object.shape)) {
            const SphereSet& set = scene_.sphere_sets[spheres->set];
            for (std::uint32_t i = 0; i < set.spheres.size(); ++i)
                sphere(object, i, set.spheres[i]);
        } else if (const auto* instance = std::get_if<MeshInstance>(&object.shape)) {
            const Mesh& mesh = scene_.meshes[instance->mesh];
            for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
                triangle(object, i, mesh);
        } else {
            no_equivalent("object " + object.name);
        }
    }

private:
    [[nodiscard]] std::string look(const Object& object, std::uint32_t primitive) const {
        const MaterialId id = material_id(scene_, object, primitive);
        return fmt::format("m{}", std::min(std::size_t{id}, scene_.materials.size()));
    }

    void sphere(const Object& object, std::uint32_t primitive, const glm::vec4& ball) {
        out_ << fmt::format("Sphere Center {} Rad {:.9g} {}\n",
                            text(object.world_from_object.point(glm::dvec3(ball))), ball.w,
                            look(object, primitive));
    }

    void triangle(const Object& object, std::uint32_t primitive, const Mesh& mesh) {
        const glm::uvec3& t = mesh.triangles[primitive];
        const auto corner = [&](std::uint32_t i) {
            return text(object.world_from_object.point(glm::dvec3(mesh.positions[i])));
        };
        out_ << fmt::format("Tri V0 {} V1 {} V2 {} {}\n", corner(t.x), corner(t.y), corner(t.z),
                            look(object, primitive));
    }

    std::ofstream& out_;
    const Scene& scene_;
};

}  // namespace

void write_tachyon_scene(const std::filesystem::path& file, const Scene& scene,
                         const Camera& camera, int depth) {
    std::ofstream out(file);
    out << "Begin_Scene\nResolution 64 64\nShader_Mode Full\nEnd_Shader_Mode\n"
        << camera_text(camera, depth);
    for (const Light& light : scene.lights)
        out << light_text(light);
    out << "Background " << text(glm::dvec3(scene.background)) << '\n';
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        out << texture_text(scene.materials[i], scene.ambient, i);
    out << texture_text(material(scene, kNoMaterial), scene.ambient, scene.materials.size());
    ObjectWriter writer(out, scene);
    for (const Object& object : scene.objects)
        writer.write(object);
    out << "End_Scene\n";
}

}  // namespace raypick::bench
