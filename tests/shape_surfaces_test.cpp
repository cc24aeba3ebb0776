// Many at once against one by one: the same to the bit, for every instruction set.
#include "tracer/accel/shape_surfaces.h"

#include "tests/each_instruction_set.h"
#include "tests/same_surfaces.h"
#include "tests/tracer_scenes.h"

#include <gtest/gtest.h>

namespace raypick {
namespace {

// A set of spheres and single ones, some inside of others.
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

// Some of them smaller than their rims where `away` takes all far from the origin.
Scene rectangles(double scale, const glm::dvec3& away) {
    Scene scene;
    Random random(5);
    for (int i = 0; i < 20; ++i) {
        const double side = scale * (i % 2 == 0 ? 2.0 : 0.3);
        place(scene, Rectangle{away + scale * 2.0 * random.direction(), side * random.direction(),
                               0.5 * side * random.direction()});
    }
    return scene;
}

// Of the hits on shapes of this kind.
std::size_t compare(const Accel& accel, ShapeSurfaces::Kind kind, std::size_t count) {
    ShapeSurfaces surfaces;
    const Compared compared = compare_surfaces(
        accel, count,
        [&](std::size_t lane, const HitObject& at, const Hit& hit) {
            EXPECT_EQ(ShapeSurfaces::kind(at), kind);
            surfaces.add(lane, accel.scene(), at.object.shape, hit.primitive);
        },
        [&](SurfaceRows& rows) {
            if (kind == ShapeSurfaces::Kind::sphere) surfaces.find_spheres(rows);
            if (kind == ShapeSurfaces::Kind::rectangle) surfaces.find_rectangles(rows);
            return 0u;
        });
    return compared.same;
}

class ShapeSurfacesBy : public OnInstructionSet {};

TEST_P(ShapeSurfacesBy, AreThoseOfSurfacePointToTheBit) {
    for (const double scale : {1e-30, 1e-4, 1.0, 1e5}) {
        for (const glm::dvec3& away : {glm::dvec3(0.0), scale * glm::dvec3(3e4, -2e4, 1e4)}) {
            const Accel round = accel_of(spheres(scale, away));
            const Accel flat = accel_of(rectangles(scale, away));
            EXPECT_GT(compare(round, ShapeSurfaces::Kind::sphere, 3000), 1200u);
            EXPECT_GT(compare(flat, ShapeSurfaces::Kind::rectangle, 3000), 400u);
            for (const std::size_t count : {0u, 1u, 2u, 3u, 7u, 17u}) {
                compare(round, ShapeSurfaces::Kind::sphere, count);
                compare(flat, ShapeSurfaces::Kind::rectangle, count);
            }
        }
    }
}

RAYPICK_ON_EACH_INSTRUCTION_SET(ShapeSurfacesBy);

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
