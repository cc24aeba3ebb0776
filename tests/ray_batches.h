// Batches of rays whose answers are compared with those of the same rays one by one.
#pragma once

#include "tests/brute_force.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/geometry/camera.h"

#include <glm/vector_relational.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace raypick {

// Rays side by side, in squares of pixels, from outside of the scene and from within.
inline std::vector<Ray> coherent_rays(const Bounds& bounds, ImageSize size, Projection projection,
                                      std::uint64_t seed) {
    Random random(seed);
    std::vector<Ray> rays;
    for (const double distance : {3.0, 0.9, 0.2}) {
        Camera camera;
        camera.at =
            glm::dvec3(bounds.centre()) + 0.1 * glm::dvec3(bounds.extent()) * random.direction();
        camera.eye =
            glm::dvec3(bounds.centre()) +
            distance * static_cast<double>(glm::length(bounds.extent())) * random.direction();
        camera.projection = projection;
        camera.near = 1e-3 * static_cast<double>(glm::length(bounds.extent()));
        camera.height = 1.5 * static_cast<double>(glm::length(bounds.extent()));
        const RayGenerator generator(camera, size);
        for (const Pixel& pixel : pixels_in_squares(size))
            rays.push_back(generator.ray(pixel_centre(pixel)));
    }
    return rays;
}

// All in one octant of directions, from as many of its extents beside the scene's centre, which
// fills the image.
inline std::vector<Ray> rays_of_one_octant(const Accel& accel, ImageSize size,
                                           const glm::dvec3& from) {
    const Bounds& bounds = accel.bounds();
    std::vector<Ray> rays;
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        Camera camera;
        camera.at = glm::dvec3(bounds.centre());
        camera.eye = camera.at + from * glm::dvec3(bounds.extent());
        camera.fovy = 12.0;
        camera.projection = projection;
        camera.height = 0.25 * static_cast<double>(bounds.extent().y);
        const RayGenerator generator(camera, size);
        for (const Pixel& pixel : pixels_in_squares(size))
            rays.push_back(generator.ray(pixel_centre(pixel)));
    }
    for (const Ray& ray : rays) {
        EXPECT_TRUE(glm::all(glm::lessThan(ray.direction * glm::vec3(from), glm::vec3(0.0f))))
            << to_text(ray);
    }
    return rays;
}

// All of them towards one point, as shadow rays go.
inline std::vector<Ray> shadow_rays(const Accel& accel, const std::vector<Ray>& eye_rays,
                                    const glm::vec3& light) {
    std::vector<Ray> rays;
    for (const Ray& eye : eye_rays) {
        const auto hit = accel.intersect(eye);
        if (!hit) continue;
        Ray ray = ray_towards(eye.at(hit->t * 0.9999f), glm::dvec3(light));
        ray.t_max = glm::distance(ray.origin, light);
        rays.push_back(ray);
    }
    return rays;
}

enum class Hits { some, perhaps };

inline void expect_as_one_by_one(const Accel& accel, const std::vector<Ray>& rays,
                                 const RayQuery& query = {}, Hits wanted = Hits::some) {
    // Of rays that miss, too, all is set.
    std::vector<Hit> hits(rays.size(), Hit{3, 5, 0.5f, glm::vec2(0.25f), true});
    std::vector<std::uint8_t> blocked(rays.size(), 7);
    accel.intersect(rays, hits, query);
    accel.occluded(rays, blocked, query);
    int found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit alone = accel.intersect(rays[i], query).value_or(Hit{});
        found += alone.valid() ? 1 : 0;
        ASSERT_EQ(hits[i], alone) << i << ": " << to_text(rays[i]);
        ASSERT_EQ(blocked[i], alone.valid() ? 1 : 0) << i << ": " << to_text(rays[i]);
        ASSERT_EQ(accel.occluded(rays[i], query), alone.valid()) << i << ": " << to_text(rays[i]);
    }
    if (wanted == Hits::some) {
        EXPECT_GT(found, 0);
    }
}

// The same of rays that end at a point, whether it is said of them or not.
inline void expect_as_one_by_one_towards(const Accel& accel, const glm::vec3& end,
                                         const std::vector<Ray>& rays, const RayQuery& query = {}) {
    std::vector<std::uint8_t> blocked(rays.size(), 7);
    std::vector<std::uint8_t> wanted(rays.size(), 7);
    accel.occluded_towards(end, rays, blocked, query);
    accel.occluded(rays, wanted, query);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(blocked[i], wanted[i]) << i << ": " << to_text(rays[i]);
        ASSERT_EQ(accel.occluded(rays[i], query), wanted[i] != 0) << i << ": " << to_text(rays[i]);
    }
}

// Shadow rays of lights beside the scene, within it, far away, and where they don't go.
inline void expect_shadows_as_one_by_one(const Accel& accel, const std::vector<Ray>& eye_rays,
                                         const RayQuery& query = {}) {
    const Bounds& bounds = accel.bounds();
    const glm::vec3 extent = bounds.extent();
    for (const glm::vec3& light : {bounds.max + 0.3f * extent, bounds.centre() + 0.1f * extent,
                                   bounds.min - 15.0f * extent, bounds.max + 1e5f * extent}) {
        std::vector<Ray> rays = shadow_rays(accel, eye_rays, light);
        expect_as_one_by_one_towards(accel, light, rays, query);
        expect_as_one_by_one_towards(accel, light + 0.01f * extent, rays, query);
        for (std::size_t i = 0; i < rays.size(); i += 7)
            rays[i].t_min = 0.5f * rays[i].t_max;
        for (std::size_t i = 3; i < rays.size(); i += 7)
            rays[i].t_max *= 0.25f;
        expect_as_one_by_one_towards(accel, light, rays, query);
    }
}

// Batches, rays one by one and brute force agree on rays of every kind.
inline void expect_all_ways(const Accel& accel, std::uint64_t seed) {
    const BruteForce brute(accel.scene());
    std::vector<Ray> rays = coherent_rays(accel.bounds(), {24, 32}, Projection::perspective, seed);
    for (const Ray& ray : rays_through(accel.bounds(), seed, 300))
        rays.push_back(ray);
    const std::vector<Ray> parallel =
        coherent_rays(accel.bounds(), {16, 16}, Projection::orthographic, seed);
    rays.insert(rays.end(), parallel.begin(), parallel.end());
    expect_as_one_by_one(accel, rays);
    expect_as_one_by_one(accel, shadow_rays(accel, rays, accel.bounds().max * 1.3f));
    expect_shadows_as_one_by_one(accel, rays);
    for (std::size_t i = 0; i < rays.size(); i += 5) {
        ASSERT_EQ(complaint(accel.intersect(rays[i]), brute.all(rays[i])), "") << to_text(rays[i]);
    }
}

inline void expect_all_ways(const Scene& scene, std::uint64_t seed) {
    expect_all_ways(accel_of(scene), seed);
}

}  // namespace raypick
