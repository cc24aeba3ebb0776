#include "tests/bench/embree_renderer.h"

#ifdef RAYPICK_HAS_EMBREE

#include "tests/bench/crew.h"
#include "tests/bench/embree_shading.h"
#include "tests/bench/flush_denormals.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <variant>

namespace raypick::bench {

namespace {

constexpr int kTile = 32;
constexpr double kGap = 2e-5;  // of the scene's size

Look look_of(const Material& material) {
    Look look{&material, false, material.reflects(), material.transmits()};
    for (std::size_t slot = 0; slot < kMapSlots; ++slot) {
        if (slot != static_cast<std::size_t>(MapSlot::normal) && material.maps[slot])
            look.mapped = true;
    }
    return look;
}

glm::vec3 fade_of(const Attenuation& a) {
    return glm::vec3(glm::dvec3(a.constant, a.linear, a.quadratic));
}

Lamp lamp_of(const Light& light) {
    if (const auto* point = std::get_if<PointLight>(&light)) {
        return {glm::vec3(point->position), point->colour, fade_of(point->attenuation), false};
    }
    if (const auto* sun = std::get_if<DirectionalLight>(&light)) {
        const glm::vec3 to_sun(-glm::normalize(sun->direction));
        return {to_sun, sun->colour, {1.0f, 0.0f, 0.0f}, true};
    }
    throw std::invalid_argument("the renderer on Embree knows point and directional lights");
}

// Directions of a perspective camera's rays, without the division by their length.
struct Lens {
    glm::vec3 eye{0.0f};
    glm::vec3 corner{0.0f};  // to the top left corner of the image
    glm::vec3 right{0.0f};   // a pixel's step
    glm::vec3 down{0.0f};

    Lens(const Camera& camera, ImageSize size) {
        const CameraFrame frame = camera_frame(camera);
        const double height = 2.0 * std::tan(glm::radians(camera.fovy) / 2.0);
        const double width = height * size.aspect();
        eye = glm::vec3(camera.eye);
        corner = glm::vec3(-0.5 * width * frame.vx + 0.5 * height * frame.vy - frame.vz);
        right = glm::vec3(width / size.cols * frame.vx);
        down = glm::vec3(-height / size.rows * frame.vy);
    }

    [[nodiscard]] glm::vec3 through(int row, int col) const {
        return glm::normalize(corner + (static_cast<float>(col) + 0.5f) * right +
                              (static_cast<float>(row) + 0.5f) * down);
    }
};

}  // namespace

EmbreeRenderer::EmbreeRenderer(std::shared_ptr<const EmbreeScene> scene, const Camera& camera)
    : scene_(std::move(scene)), camera_(camera) {
    if (camera.projection != Projection::perspective) {
        throw std::invalid_argument("the renderer on Embree knows perspective cameras");
    }
    for (MaterialId id = 0; id < source().materials.size(); ++id)
        looks_.push_back(look_of(source().materials[id]));
    looks_.push_back(look_of(material(source(), kNoMaterial)));
    for (const Object& object : source().objects)
        add_surface(object);
    for (const Light& light : effective_lights(source(), camera))
        lamps_.push_back(lamp_of(light));
    const Bounds bounds = scene_bounds(source());
    gap_ = static_cast<float>(kGap * static_cast<double>(glm::length(bounds.extent())));
}

void EmbreeRenderer::add_surface(const Object& object) {
    Surface surface;
    if (const auto* instance = std::get_if<MeshInstance>(&object.shape)) {
        const Mesh& mesh = source().meshes[instance->mesh];
        if (!mesh.normals.empty() || !mesh.uvs.empty()) surface.mesh = &mesh;
        const auto object_from_world = inverse(object.world_from_object);
        surface.normal_from_object = glm::mat3(glm::transpose(object_from_world->linear));
        const auto uses = std::count_if(
            source().objects.begin(), source().objects.end(), [instance](const Object& other) {
                const auto* use = std::get_if<MeshInstance>(&other.shape);
                return use != nullptr && use->mesh == instance->mesh;
            });
        surface.is_instance = uses > 1;
    }
    const auto look = [&](std::uint32_t primitive) {
        const MaterialId id = material_id(source(), object, primitive);
        return std::min(id, static_cast<MaterialId>(looks_.size() - 1));
    };
    const std::uint32_t count =
        parts_of(source(), object.shape).size() > 1 ? primitive_count(source(), object) : 1;
    for (std::uint32_t i = 0; i < count; ++i)
        surface.looks.push_back(look(i));
    surfaces_.push_back(std::move(surface));
}

std::vector<glm::vec3> EmbreeRenderer::render(ImageSize size, const RenderSettings& settings,
                                              int threads) const {
    std::vector<glm::vec3> colour(size.pixel_count());
    const Lens lens(camera_, size);
    const int columns = (size.cols + kTile - 1) / kTile;
    const int rows = (size.rows + kTile - 1) / kTile;
    const auto tiles = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    share_out(tiles, threads, [&](std::size_t, std::size_t tile) {
        const FlushDenormals mode;
        EmbreeShading shading(*this, settings);
        const int top = static_cast<int>(tile) / columns * kTile;
        const int left = static_cast<int>(tile) % columns * kTile;
        for (int row = top; row < std::min(size.rows, top + kTile); ++row) {
            for (int col = left; col < std::min(size.cols, left + kTile); ++col) {
                const Ray ray{lens.eye, lens.through(row, col)};
                colour[size.index({row, col})] = shading.eye_ray(ray);
            }
        }
    });
    return colour;
}

}  // namespace raypick::bench

#endif
