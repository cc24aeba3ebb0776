// Groups of rays that follow one another in deep trees, and those among them that go another way:
// bit for bit the answers of the same rays one by one.
#include "tests/each_instruction_set.h"
#include "tests/ray_batches.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace raypick {
namespace {

class AccelRuns : public OnInstructionSet {};

constexpr ImageSize kImage{32, 64};  // two runs

// So many triangles lie behind each other that a group opens many nodes.
Scene deep_scene() {
    Scene scene;
    place_mesh(scene, soup_data(3, 20000, 0.05));
    return scene;
}

// From where all may hit something.
const glm::dvec3 kFrom(0.6, -0.4, 0.5);

void expect_in_runs(const Scene& scene) {
    const Accel accel = accel_of(scene);
    const std::vector<Ray> rays = rays_of_one_octant(accel, kImage, kFrom);
    expect_as_one_by_one(accel, rays);
    expect_shadows_as_one_by_one(accel, rays);
}

TEST_P(AccelRuns, OneMesh) {
    expect_in_runs(deep_scene());
}

TEST_P(AccelRuns, MeshesAmongOthers) {
    Scene scene = deep_scene();
    for (int i = 0; i < 20; ++i)
        place_mesh(scene, soup_data(10 + static_cast<std::uint64_t>(i), 400, 0.05));
    place(scene, MeshInstance{0}, kNoMaterial, translate({0.4, 0.1, 0.0}) * rotate(70, {1, 2, 3}));
    place(scene, MeshInstance{0}, kNoMaterial, translate({-0.3, 0.0, 0.2}) * scale({1, -2, 1}));
    expect_in_runs(scene);
}

// The tree over them is deep, and they have none.
TEST_P(AccelRuns, ManyObjects) {
    Scene scene;
    Random random(5);
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 centre = random.point(glm::dvec3(-1.0), glm::dvec3(1.0));
        if (i % 2 == 0) {
            place(scene, Sphere{centre, 0.02});
        } else {
            place(scene, Box{centre, centre + 0.03});
        }
    }
    const Accel accel = accel_of(scene);
    expect_as_one_by_one(accel, rays_of_one_octant(accel, kImage, kFrom));
}

TEST_P(AccelRuns, SetsOfSpheres) {
    Random random(6);
    constexpr std::size_t kSpheres = 20000;
    std::vector<glm::vec4> spheres;
    spheres.reserve(kSpheres);
    while (spheres.size() < kSpheres) {
        spheres.emplace_back(glm::vec3(random.point(glm::dvec3(-1.0), glm::dvec3(1.0))), 0.006f);
    }
    Scene scene;
    place(scene, SphereSetInstance{add_sphere_set(scene, make_sphere_set("set", spheres))});
    expect_in_runs(scene);
}

// Some rays of every group, none of those at the corners of its pixels, look elsewhere or begin
// elsewhere, in the octant of the others.
TEST_P(AccelRuns, RaysUnlikeTheOthers) {
    const Accel accel = accel_of(deep_scene());
    std::vector<Ray> rays = rays_of_one_octant(accel, kImage, kFrom);
    for (std::size_t first = 0; first + 64 <= rays.size(); first += 64) {
        const std::size_t group = first / 64;
        for (const std::size_t i : {1 + group % 18, 20 + group % 24, 45 + group % 18}) {
            Ray& odd = rays[first + i];
            if (group % 2 == 0) {
                odd.direction = glm::normalize(odd.direction + glm::vec3(0.0f, 0.4f, 0.0f));
            } else {
                odd.origin.y += 0.3f * accel.bounds().extent().y;
            }
        }
    }
    expect_as_one_by_one(accel, rays);
    expect_shadows_as_one_by_one(accel, rays);
}

// The corners say nothing of the rest, or what they say is no number.
TEST_P(AccelRuns, CornersUnlikeTheOthers) {
    const Accel accel = accel_of(deep_scene());
    std::vector<Ray> rays = rays_of_one_octant(accel, kImage, kFrom);
    for (std::size_t i = 0; i < rays.size(); i += 64) {
        const std::size_t kind = i / 1024 % 4;
        if (kind == 0) rays[i].direction = -rays[i].direction;
        if (kind == 1) rays[i].origin.y = std::numeric_limits<float>::quiet_NaN();
        if (kind == 2) rays[i].direction = {0.0f, 0.0f, 0.0f};
        if (kind == 3) rays[i].origin.x = 1e30f;
    }
    expect_as_one_by_one(accel, rays);
}

RAYPICK_ON_EACH_INSTRUCTION_SET(AccelRuns);

}  // namespace
}  // namespace raypick
