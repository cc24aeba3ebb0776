// Many at once against one by one: the same to the bit, for every instruction set.
#include "tracer/accel/shape_surfaces.h"

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

// A set of spheres and single ones, some inside of others, and rectangles, some of them smaller
// than their rims where `away` takes all far from the origin.
Scene shapes(double scale, const glm::dvec3& away) {
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
    for (int i = 0; i < 20; ++i) {
        const double side = scale * (i % 2 == 0 ? 2.0 : 0.3);
        place(scene, Rectangle{away + scale * 2.0 * random.direction(), side * random.direction(),
                               0.5 * side * random.direction()});
    }
    return scene;
}

// Works out what `count` rays hit, and returns how many hits there were.
std::size_t compare(const Accel& accel, ShapeSurfaces& surfaces, std::size_t count) {
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
        const ShapeSurfaces::Kind kind = ShapeSurfaces::kind(at);
        EXPECT_NE(kind, ShapeSurfaces::Kind::other);
        surfaces.add(kind, scene, at, rays[i], hits[i], got[i]);
        ++met;
    }
    surfaces.find();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits[i].valid()) expect_same(got[i], surface_point(scene, rays[i], hits[i]));
    }
    return met;
}

class ShapeSurfacesBy : public testing::TestWithParam<std::string> {
protected:
    ShapeSurfacesBy() { use_instruction_set(GetParam()); }
    ~ShapeSurfacesBy() override { use_instruction_set(""); }
};

TEST_P(ShapeSurfacesBy, AreThoseOfSurfacePointToTheBit) {
    ShapeSurfaces surfaces;
    for (const double scale : {1e-4, 1.0, 1e5}) {
        for (const glm::dvec3& away : {glm::dvec3(0.0), scale * glm::dvec3(3e4, -2e4, 1e4)}) {
            const Accel accel = accel_of(shapes(scale, away));
            EXPECT_GT(compare(accel, surfaces, 4000), 1500u);
            for (const std::size_t count : {0u, 1u, 2u, 3u, 7u, 17u})
                compare(accel, surfaces, count);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, ShapeSurfacesBy, testing::ValuesIn(instruction_sets()),
                         [](const auto& tested) { return tested.param; });

TEST(ShapeSurfaces, TakesWhatNothingMovesAndNoTextureNeeds) {
    Scene scene;
    place(scene, Sphere{});
    place(scene, Sphere{}, kNoMaterial, translate({1, 0, 0}));
    place_mesh(scene, ball_data(0));
    place(scene, Rectangle{});
    const Transform identity;
    const Transform moved = translate({-1, 0, 0});
    using Kind = ShapeSurfaces::Kind;
    const auto kind = [&](std::size_t object, const Transform& placed, bool textured) {
        return ShapeSurfaces::kind({scene.objects[object], placed, kNoMaterial, textured});
    };
    EXPECT_EQ(kind(0, identity, false), Kind::sphere);
    EXPECT_EQ(kind(0, identity, true), Kind::other);
    EXPECT_EQ(kind(1, moved, false), Kind::other);
    EXPECT_EQ(kind(2, identity, false), Kind::other);
    EXPECT_EQ(kind(3, identity, false), Kind::rectangle);
    EXPECT_EQ(kind(3, identity, true), Kind::other);
}

}  // namespace
}  // namespace raypick
