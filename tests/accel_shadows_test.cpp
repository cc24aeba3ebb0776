// Shadow rays of one light, which go through the trees backwards, on every instruction set that
// this machine has: the answers of the same rays one by one and of brute force.
#include "tests/brute_force.h"
#include "tests/each_instruction_set.h"
#include "tests/ray_batches.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/accel/surface.h"
#include "tracer/accel/trace_rays.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace raypick {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

class AccelShadows : public OnInstructionSet {};

// From where eye rays meet the scene, off the surface or right on it, to the light.
std::vector<Ray> rays_from_surfaces(const Accel& accel, const glm::vec3& light, bool off,
                                    std::uint64_t seed) {
    std::vector<Ray> rays;
    for (const Ray& eye : coherent_rays(accel.bounds(), {32, 48}, Projection::perspective, seed)) {
        const auto hit = accel.intersect(eye);
        if (!hit) continue;
        const SurfacePoint point = surface_point(accel.scene(), eye, *hit);
        const glm::vec3 direction = light - point.position;
        Ray ray =
            ray_towards(off ? offset_origin(point, direction) : point.position, glm::dvec3(light));
        ray.t_max = glm::length(direction) * (1.0f - 1e-6f);
        rays.push_back(ray);
    }
    return rays;
}

void expect_brute_answers(const Accel& accel, const BruteForce& brute, const glm::vec3& light,
                          const std::vector<Ray>& rays, const RayQuery& query = {}) {
    std::vector<std::uint8_t> blocked(rays.size(), 7);
    accel.occluded_towards(light, rays, blocked, query);
    std::size_t found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool wanted = !brute.all(rays[i], query).empty();
        ASSERT_EQ(blocked[i], wanted ? 1 : 0) << i << ": " << to_text(rays[i]);
        found += wanted ? 1 : 0;
    }
    EXPECT_GT(found, 0u);
    EXPECT_LT(found, rays.size());
}

// One mesh as it is, turned, stretched, mirrored, and with one of its sides only.
Scene placed_soups() {
    Scene scene;
    place_mesh(scene, soup_data(3, 600, 0.3));
    place(scene, MeshInstance{0}, kNoMaterial, translate({2, 0, 0}) * rotate(50, {1, 1, 0}));
    place(scene, MeshInstance{0}, kNoMaterial, translate({0, 2, 0}) * scale({3.0, 0.2, 1.0}));
    place(scene, MeshInstance{0}, kNoMaterial, translate({0, 0, 2}) * scale({-1.0, 1.0, 1.0}));
    place(scene, MeshInstance{0}, kNoMaterial, translate({-2, 0, 0}) * scale(glm::dvec3(1e-3)));
    return scene;
}

TEST_P(AccelShadows, OfMeshesInAllPlaces) {
    const Scene scene = placed_soups();
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    for (const glm::vec3& light : {glm::vec3(4, 5, 6), glm::vec3(0.1f, 0.2f, 0.3f),
                                   glm::vec3(2, 0, 0), glm::vec3(-60, 10, 20)}) {
        for (const bool off : {true, false}) {
            const std::vector<Ray> rays = rays_from_surfaces(accel, light, off, 5);
            ASSERT_GT(rays.size(), 500u);
            expect_brute_answers(accel, brute, light, rays);
            if (HasFailure()) return;
        }
    }
}

TEST_P(AccelShadows, OfOneSide) {
    Scene scene = placed_soups();
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
        scene.objects[i].sides = i % 2 == 0 ? Sides::front_only : Sides::back_only;
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    const glm::vec3 light(3, 4, -5);
    const std::vector<Ray> rays = rays_from_surfaces(accel, light, true, 6);
    for (const Sides sides : {Sides::both, Sides::front_only, Sides::back_only}) {
        RayQuery query;
        query.sides = sides;
        expect_brute_answers(accel, brute, light, rays, query);
        if (HasFailure()) return;
    }
}

// Rays along edges and through vertices of a grid, towards a light in its plane, on one of its
// vertices, and just above.
TEST_P(AccelShadows, OfLightsOnTheTriangles) {
    MeshData data;
    constexpr std::uint32_t kSide = 17;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i)
        data.positions.emplace_back(static_cast<float>(i % kSide) - 8.0f,
                                    i / kSide == 4 && i % 3 == 0 ? 0.5f : 0.0f,
                                    static_cast<float>(i / kSide) - 8.0f);
    for (std::uint32_t i = 0; i < kSide * (kSide - 1); ++i) {
        if (i % kSide == kSide - 1) continue;
        data.triangles.emplace_back(i, i + kSide, i + 1);
        data.triangles.emplace_back(i + 1, i + kSide, i + kSide + 1);
    }
    Scene scene;
    place_mesh(scene, data);
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    for (const glm::vec3& light : {glm::vec3(0, 0, 0), glm::vec3(20, 0, 0.5f), glm::vec3(1, 3, 2),
                                   glm::vec3(0, 1e-6f, 0), glm::vec3(3, 0.25f, -4)}) {
        std::vector<Ray> rays;
        for (int i = 0; i < 640; ++i) {
            const glm::vec3 from(0.25f * static_cast<float>(i % 32) - 4.0f,
                                 i % 5 == 0 ? 0.0f : 0.125f,
                                 0.25f * static_cast<float>(i / 32) - 4.0f);
            if (from == light) continue;
            Ray ray = ray_towards(from, glm::dvec3(light));
            // Not where a vertex lies, as brute force compares before it rounds.
            ray.t_max = glm::distance(from, light) * (i % 2 == 0 ? 1.0f - 1e-6f : 1.0f + 1e-6f);
            rays.push_back(ray);
        }
        std::vector<std::uint8_t> blocked(rays.size(), 7);
        accel.occluded_towards(light, rays, blocked);
        for (std::size_t i = 0; i < rays.size(); ++i)
            ASSERT_EQ(blocked[i], brute.all(rays[i]).empty() ? 0 : 1) << i << to_text(rays[i]);
    }
}

// Where float coordinates are coarse, and the light nearer than that or very far away.
TEST_P(AccelShadows, FarFromTheOrigin) {
    MeshData data = ball_data(4);
    for (glm::vec3& p : data.positions)
        p = p * 3.0f + glm::vec3(20000.0f, -30000.0f, 10000.0f);
    Scene scene;
    place_mesh(scene, data);
    place(scene, MeshInstance{0}, kNoMaterial, translate({1.5, 2.0, 1.0}));
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    const glm::vec3 centre = accel.bounds().centre();
    for (const float distance : {1.0f, 4.0f, 100.0f, 1e6f}) {
        const glm::vec3 light = centre + distance * glm::normalize(glm::vec3(1, 2, 3));
        expect_brute_answers(accel, brute, light, rays_from_surfaces(accel, light, true, 7));
        if (HasFailure()) return;
    }
}

// More of other shapes among them, which are met forwards.
TEST_P(AccelShadows, AmongSpheresAndCones) {
    Scene scene = placed_soups();
    Random random(5);
    std::vector<glm::vec4> spheres;
    for (int i = 0; i < 100; ++i)
        spheres.emplace_back(glm::vec3(random.point(glm::dvec3(-2.0), glm::dvec3(2.0))), 0.1f);
    const SetId set = add_sphere_set(scene, make_sphere_set("set", spheres));
    place(scene, SphereSetInstance{set});
    place(scene, SphereSetInstance{set}, kNoMaterial, translate({1, 1, 0}) * rotate(20, {0, 1, 0}));
    place(scene, Torus{}, kNoMaterial, translate({-2, 0, 0}) * rotate(40.0, {1, 1, 0}));
    place(scene, Plane{{0.0, 1.0, 0.1}, 1.5});
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    const glm::vec3 light(3, 4, 5);
    expect_brute_answers(accel, brute, light, rays_from_surfaces(accel, light, true, 8));
}

// What doesn't end at the light, or nowhere, is answered as well.
TEST_P(AccelShadows, OfRaysThatGoElsewhere) {
    const Accel accel = accel_of(placed_soups());
    const glm::vec3 light(3, 4, 5);
    const std::vector<Ray> rays = rays_from_surfaces(accel, light, true, 9);
    const auto expect_changed = [&](const auto& change) {
        std::vector<Ray> changed = rays;
        for (std::size_t i = 0; i < changed.size(); i += 3)
            change(changed[i]);
        expect_as_one_by_one_towards(accel, light, changed);
    };
    expect_changed([](Ray& ray) { ray.t_max = kInfinity; });
    expect_changed([](Ray& ray) { ray.t_max *= 1.5f; });
    expect_changed([](Ray& ray) { ray.t_min = 0.9f * ray.t_max; });
    expect_changed([](Ray& ray) { ray.t_min = -1.0f; });
    expect_changed([](Ray& ray) { ray.t_max = 0.0f; });
    expect_changed([](Ray& ray) { ray.direction = -ray.direction; });
    expect_changed([](Ray& ray) { ray.direction.x += 1e-4f; });
    expect_changed([](Ray& ray) { ray.direction *= 0.75f; });
    expect_changed([](Ray& ray) { ray.direction.y = kNaN; });
    expect_changed([](Ray& ray) { ray.origin.x = kInfinity; });
    for (const glm::vec3& wrong : {-light, light * 1.001f, glm::vec3(kNaN), glm::vec3(kInfinity)})
        expect_as_one_by_one_towards(accel, wrong, rays);
    expect_as_one_by_one_towards(accel, light, {});
    expect_as_one_by_one_towards(accel, light, {rays.begin(), rays.begin() + 13});
}

RAYPICK_ON_EACH_INSTRUCTION_SET(AccelShadows);

}  // namespace
}  // namespace raypick
