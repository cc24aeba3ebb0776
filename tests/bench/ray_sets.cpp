#include "tests/bench/ray_sets.h"

#include "tests/random.h"
#include "tracer/accel/surface.h"
#include "tracer/geometry/pixel.h"

#include <glm/geometric.hpp>

namespace raypick::bench {

namespace {

std::vector<Ray> primary_rays(const Camera& camera, ImageSize size) {
    const RayGenerator generator(camera, size);
    std::vector<Ray> rays;
    rays.reserve(size.pixel_count());
    for (const Pixel& pixel : pixels_in_squares(size))
        rays.push_back(generator.ray(pixel_centre(pixel)));
    return rays;
}

constexpr float kGap = 2e-5f;  // of the scene's size

// Begins as far from the surface as floats need that are less exact than ours, so that nobody hits
// it again.
Ray leaving(const SurfacePoint& surface, const glm::vec3& direction, float gap) {
    Ray ray;
    ray.origin = offset_origin(surface, direction);
    ray.direction = direction;
    ray.t_min = gap;
    return ray;
}

// None from a surface that looks away from the light: a renderer wouldn't send one.
void add_shadow_ray(std::vector<Ray>& rays, const SurfacePoint& surface, const glm::vec3& incoming,
                    const glm::dvec3& light, float gap) {
    const glm::dvec3 way = light - glm::dvec3(surface.position);
    const double distance = glm::length(way);
    const glm::vec3 direction(way / distance);
    const float side = glm::dot(surface.geometric_normal, incoming) < 0.0f ? 1.0f : -1.0f;
    if (!(side * glm::dot(surface.geometric_normal, direction) > 0.0f)) return;
    Ray ray = leaving(surface, direction, gap);
    ray.t_max = static_cast<float>(distance * (1.0 - 1e-5));
    rays.push_back(ray);
}

void add_mirror_ray(std::vector<Ray>& rays, const SurfacePoint& surface, const glm::vec3& incoming,
                    float gap) {
    const glm::vec3& n = surface.geometric_normal;
    const glm::vec3 mirrored = incoming - 2.0f * glm::dot(incoming, n) * n;
    rays.push_back(leaving(surface, glm::normalize(mirrored), gap));
}

std::vector<Ray> random_rays(const Bounds& bounds, std::size_t count) {
    Random random(4);
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        ray.origin = glm::vec3(random.point(glm::dvec3(bounds.min), glm::dvec3(bounds.max)));
        ray.direction = glm::vec3(random.direction());
    }
    return rays;
}

}  // namespace

RaySets make_ray_sets(const Accel& accel, const View& view, ImageSize size) {
    RaySets sets;
    sets.primary = primary_rays(view.camera, size);
    std::vector<Hit> hits(sets.primary.size());
    accel.intersect(sets.primary, hits);
    const float gap = kGap * glm::length(accel.bounds().extent());
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].valid()) continue;
        const SurfacePoint surface = surface_point(*view.scene, sets.primary[i], hits[i]);
        add_shadow_ray(sets.shadow, surface, sets.primary[i].direction, view.light, gap);
        add_mirror_ray(sets.mirror, surface, sets.primary[i].direction, gap);
    }
    sets.random = random_rays(accel.bounds(), size.pixel_count() / 2);
    return sets;
}

}  // namespace raypick::bench
