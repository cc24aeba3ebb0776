// Many at once against one by one: the same to the bit, for every instruction set.
#include "tracer/accel/sphere_surfaces.h"

#include "tests/tracer_scenes.h"
#include "tracer/accel/trace_rays.h"

#include <gtest/gtest.h>

#include <cstring>

namespace raypick {
namespace {

bool same_bits(const glm::vec3& a, const glm::vec3& b) {
    return std::memcmp(&a, &b, sizeof(a)) == 0;
}

void expect_same(const SurfacePoint& got, const SurfacePoint& wanted) {
    EXPECT_TRUE(same_bits(got.position, wanted.position));
    EXPECT_TRUE(same_bits(got.position_error, wanted.position_error));
    EXPECT_TRUE(same_bits(got.geometric_normal, wanted.geometric_normal));
    EXPECT_TRUE(same_bits(got.shading_normal, wanted.shading_normal));
    EXPECT_EQ(got.uv, wanted.uv);
    EXPECT_EQ(got.front_face, wanted.front_face);
    EXPECT_EQ(got.material, wanted.material);
}

// A set and single ones, some inside of others, all far from the origin with `away`.
Scene spheres(double scale, const glm::dvec3& away) {
    Scene scene;
    Random random(3);
    std::vector<glm::vec4> set;
    for (int i = 0; i < 60; ++i) {
        const glm::dvec3 centre = away + scale * 2.0 * random.direction();
        set.emplace_back(glm::vec3(centre), static_cast<float>(scale * (0.1 + 0.01 * i)));
    }
    place(scene, SphereSetInstance{add_sphere_set(scene, make_sphere_set("set", std::move(set)))});
    for (int i = 0; i < 6; ++i)
        place(scene, Sphere{away + scale * 2.5 * random.direction(), scale * 0.3});
    return scene;
}

// Works out what `count` rays hit, and returns how many hits there were.
std::size_t compare(const Accel& accel, SphereSurfaces& surfaces, std::size_t count) {
    const Scene& scene = accel.scene();
    const std::vector<Ray> rays = rays_through(accel.bounds(), 7, count);
    std::vector<Hit> hits(rays.size());
    accel.intersect(rays, hits);
    std::vector<SurfacePoint> got(rays.size());
    std::size_t met = 0;
    surfaces.clear();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].valid()) continue;
        const std::size_t index = object_index(scene, hits[i].object);
        const HitObject at{scene.objects[index], accel.object_from_world(index), kNoMaterial,
                           false};
        EXPECT_TRUE(SphereSurfaces::takes(at));
        surfaces.add(scene, at, rays[i], hits[i], got[i]);
        ++met;
    }
    surfaces.find();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits[i].valid()) expect_same(got[i], surface_point(scene, rays[i], hits[i]));
    }
    return met;
}

class SphereSurfacesBy : public testing::TestWithParam<std::string> {
protected:
    SphereSurfacesBy() { use_instruction_set(GetParam()); }
    ~SphereSurfacesBy() override { use_instruction_set(""); }
};

TEST_P(SphereSurfacesBy, AreThoseOfSurfacePointToTheBit) {
    SphereSurfaces surfaces;
    for (const double scale : {1e-4, 1.0, 1e5}) {
        for (const glm::dvec3& away : {glm::dvec3(0.0), scale * glm::dvec3(3e4, -2e4, 1e4)}) {
            const Accel accel = accel_of(spheres(scale, away));
            EXPECT_GT(compare(accel, surfaces, 4000), 1500u);
            for (const std::size_t count : {0u, 1u, 2u, 3u, 7u, 17u})
                compare(accel, surfaces, count);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, SphereSurfacesBy, testing::ValuesIn(instruction_sets()),
                         [](const auto& tested) { return tested.param; });

TEST(SphereSurfaces, TakesWhatNothingMovesAndNoTextureNeeds) {
    Scene scene;
    place(scene, Sphere{});
    place(scene, Sphere{}, kNoMaterial, translate({1, 0, 0}));
    place_mesh(scene, ball_data(0));
    const Transform identity;
    const Transform moved = translate({-1, 0, 0});
    EXPECT_TRUE(SphereSurfaces::takes({scene.objects[0], identity, kNoMaterial, false}));
    EXPECT_FALSE(SphereSurfaces::takes({scene.objects[0], identity, kNoMaterial, true}));
    EXPECT_FALSE(SphereSurfaces::takes({scene.objects[1], moved, kNoMaterial, false}));
    EXPECT_FALSE(SphereSurfaces::takes({scene.objects[2], identity, kNoMaterial, false}));
}

}  // namespace
}  // namespace raypick
