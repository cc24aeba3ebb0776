// Small scenes in code for the tracer's tests.
#pragma once

#include "tests/random.h"
#include "tracer/accel/accel.h"
#include "tracer/scene/scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace raypick {

// From one point towards another, unit direction.
inline Ray ray_towards(const glm::vec3& from, const glm::dvec3& to) {
    Ray ray;
    ray.origin = from;
    ray.direction = glm::vec3(glm::normalize(to - glm::dvec3(from)));
    return ray;
}

inline ObjectId place(Scene& scene, const Shape& shape, MaterialId material = kNoMaterial,
                      const Transform& world_from_object = {}) {
    Object object;
    object.shape = shape;
    object.material = material;
    object.world_from_object = world_from_object;
    return add_object(scene, std::move(object));
}

inline ObjectId place_mesh(Scene& scene, MeshData data, MaterialId material = kNoMaterial,
                           const Transform& world_from_object = {}) {
    const MeshId mesh = add_mesh(scene, make_mesh("mesh", std::move(data)));
    return place(scene, MeshInstance{mesh}, material, world_from_object);
}

// Cut out in a checker's pattern.
inline MaterialId add_sieve(Scene& scene) {
    Material sieve;
    Texture checker;
    checker.source = Checker{glm::vec4(1.0f), glm::vec4(0.0f)};
    sieve.map(MapSlot::opacity).texture = add_texture(scene, checker);
    sieve.map(MapSlot::opacity).u_row = {8, 0, 0};
    sieve.map(MapSlot::opacity).v_row = {0, 8, 0};
    return add_material(scene, sieve);
}

inline Accel accel_of(Scene scene) {
    return Accel(std::make_shared<const Scene>(std::move(scene)));
}

// A material that gives off nothing: tests switch on the one term that they look at.
inline Material black_material() {
    Material material;
    material.ambient = glm::vec3(0.0f);
    material.diffuse = glm::vec3(0.0f);
    return material;
}

inline Material glowing_material(const glm::vec3& colour) {
    Material material = black_material();
    material.emissive = colour;
    return material;
}

inline MeshData octahedron_data() {
    MeshData data;
    data.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    data.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                      {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    return data;
}

// Splits each triangle into four and pushes the new vertices onto the unit sphere.
inline MeshData subdivided(const MeshData& coarse) {
    MeshData fine;
    fine.positions = coarse.positions;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [at, fresh] = middles.try_emplace(
            std::minmax(a, b), static_cast<std::uint32_t>(fine.positions.size()));
        if (fresh) {
            const glm::dvec3 sum = glm::dvec3(fine.positions[a]) + glm::dvec3(fine.positions[b]);
            fine.positions.emplace_back(glm::normalize(sum));
        }
        return at->second;
    };
    for (const glm::uvec3& t : coarse.triangles) {
        const std::uint32_t ab = middle(t.x, t.y);
        const std::uint32_t bc = middle(t.y, t.z);
        const std::uint32_t ca = middle(t.z, t.x);
        fine.triangles.insert(fine.triangles.end(),
                              {{t.x, ab, ca}, {ab, t.y, bc}, {ca, bc, t.z}, {ab, bc, ca}});
    }
    return fine;
}

// A closed, convex mesh on the unit sphere: 8 * 4^levels triangles.
inline MeshData ball_data(int levels) {
    MeshData data = octahedron_data();
    for (int level = 0; level < levels; ++level)
        data = subdivided(data);
    return data;
}

// Unconnected triangles in the cube [-1, 1]^3, edges up to about `size`.
inline MeshData soup_data(std::uint64_t seed, std::uint32_t count, double size) {
    Random random(seed);
    MeshData data;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::dvec3 corner = random.point(glm::dvec3(-1.0), glm::dvec3(1.0));
        data.positions.emplace_back(corner);
        data.positions.emplace_back(corner + size * random.unit() * random.direction());
        data.positions.emplace_back(corner + size * random.unit() * random.direction());
        data.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return data;
}

// Rays as a scene with these bounds meets them: from outside and from inside, aimed at random
// points, and every fourth parallel to an axis.
inline std::vector<Ray> rays_through(const Bounds& bounds, std::uint64_t seed, std::size_t count) {
    Random random(seed);
    const glm::dvec3 min(bounds.min);
    const glm::dvec3 max(bounds.max);
    const double radius = 0.5 * glm::length(max - min);
    std::vector<Ray> rays;
    while (rays.size() < count) {
        const glm::dvec3 target = random.point(min, max);
        const bool outside = rays.size() % 2 == 0;
        const glm::dvec3 from = outside ? glm::dvec3(bounds.centre()) +
                                              random.between(1.0, 3.0) * radius * random.direction()
                                        : random.point(min, max);
        Ray ray = ray_towards(glm::vec3(from), target);
        if (rays.size() % 4 == 3) {
            ray.direction = glm::vec3(0.0f);
            ray.direction[static_cast<int>(random.below(3))] = random.unit() < 0.5 ? 1.0f : -1.0f;
        }
        rays.push_back(ray);
    }
    return rays;
}

}  // namespace raypick
