// Many at once against one by one: the same to the bit, for every instruction set.
#include "tracer/accel/triangle_surfaces.h"

#include "tests/each_instruction_set.h"
#include "tests/same_surfaces.h"
#include "tests/tracer_scenes.h"

#include <gtest/gtest.h>

namespace raypick {
namespace {

// Slivers and large ones, flat and smooth, some with normals that point the wrong way or without
// uv.
Scene triangles(double scale) {
    MeshData soup = soup_data(3, 300, 0.8);
    for (std::size_t i = 0; i < soup.positions.size(); ++i)
        soup.uvs.emplace_back(i % 7 < 2 ? glm::vec2(0.5f) : glm::vec2(soup.positions[i]));
    MeshData smooth = ball_data(3);
    smooth.normals = smooth.positions;
    smooth.normals[5] = -smooth.normals[5];
    smooth.normals[9] = glm::vec3(0.0f);
    for (MeshData* data : {&soup, &smooth}) {
        for (glm::vec3& p : data->positions)
            p *= static_cast<float>(scale);
    }
    Scene scene;
    place_mesh(scene, soup);
    place_mesh(scene, smooth);
    return scene;
}

std::size_t compare(const Accel& accel, TriangleSurfaces& surfaces, std::size_t count,
                    bool textured = false) {
    surfaces.clear();
    return compare_surfaces(
        accel, count,
        [&](const HitObject& at, const Ray& ray, const Hit& hit, SurfacePoint& surface) {
            EXPECT_TRUE(TriangleSurfaces::takes(at));
            surfaces.add(accel.scene(), at, ray, hit, surface);
        },
        [&] { surfaces.find(accel.scene()); }, textured);
}

class TriangleSurfacesBy : public OnInstructionSet {};

TEST_P(TriangleSurfacesBy, AreThoseOfSurfacePointToTheBit) {
    TriangleSurfaces surfaces;
    for (const double scale : {1e-4, 1.0, 1e5}) {
        const Accel accel = accel_of(triangles(scale));
        for (const bool textured : {false, true})
            EXPECT_GT(compare(accel, surfaces, 4000, textured), 2000u);
        for (const std::size_t count : {0u, 1u, 2u, 3u, 7u, 17u})
            compare(accel, surfaces, count);
    }
}

RAYPICK_ON_EACH_INSTRUCTION_SET(TriangleSurfacesBy);

// Coordinates so large beside the triangles that all of these lie within the rim.
TEST(TriangleSurfaces, NearTheEdgesToo) {
    MeshData data = soup_data(3, 300, 0.8);
    for (glm::vec3& p : data.positions)
        p += glm::vec3(2e4f, -3e4f, 1e4f);
    Scene scene;
    place_mesh(scene, data);
    TriangleSurfaces surfaces;
    EXPECT_GT(compare(accel_of(scene), surfaces, 4000), 500u);
}

TEST(TriangleSurfaces, TakesWhatNothingMoves) {
    Scene scene;
    place_mesh(scene, ball_data(0));
    place_mesh(scene, ball_data(0), kNoMaterial, translate({1, 0, 0}));
    place(scene, Sphere{});
    const Transform identity;
    const Transform moved = translate({-1, 0, 0});
    EXPECT_TRUE(TriangleSurfaces::takes({scene.objects[0], identity, kNoMaterial, false}));
    EXPECT_TRUE(TriangleSurfaces::takes({scene.objects[0], identity, kNoMaterial, true}));
    EXPECT_FALSE(TriangleSurfaces::takes({scene.objects[1], moved, kNoMaterial, false}));
    EXPECT_FALSE(TriangleSurfaces::takes({scene.objects[2], identity, kNoMaterial, false}));
}

}  // namespace
}  // namespace raypick
