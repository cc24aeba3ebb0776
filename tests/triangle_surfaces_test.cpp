// Many at once against one by one: the same to the bit, for every instruction set.
#include "tracer/accel/triangle_surfaces.h"

#include "tests/each_instruction_set.h"
#include "tests/same_surfaces.h"
#include "tests/tracer_scenes.h"

#include <gtest/gtest.h>

#include <variant>

namespace raypick {
namespace {

// Slivers and large ones, flat and smooth, some with normals that point the wrong way, and some in
// the planes of the axes, whose zeros have signs.
Scene triangles(double scale) {
    MeshData soup = soup_data(3, 300, 0.8);
    MeshData smooth = ball_data(3);
    smooth.normals = smooth.positions;
    smooth.normals[5] = -smooth.normals[5];
    smooth.normals[9] = glm::vec3(0.0f);
    MeshData planes;
    planes.positions = {{-1, 0, 1}, {1, 0, 1}, {1, -0.0f, -1}, {0, 1, 1}, {-0.0f, -1, 1}};
    planes.triangles = {{0, 1, 2}, {0, 2, 1}, {3, 4, 2}, {4, 3, 2}, {0, 1, 3}, {1, 0, 4}};
    for (MeshData* data : {&soup, &smooth, &planes}) {
        for (glm::vec3& p : data->positions)
            p *= static_cast<float>(scale);
    }
    Scene scene;
    place_mesh(scene, soup);
    place_mesh(scene, smooth);
    place_mesh(scene, planes);
    return scene;
}

Compared compare(const Accel& accel, std::size_t count) {
    TriangleSurfaces surfaces;
    return compare_surfaces(
        accel, count,
        [&](std::size_t lane, const HitObject& at, const Hit& hit) {
            EXPECT_TRUE(TriangleSurfaces::takes(at));
            const auto& instance = std::get<MeshInstance>(at.object.shape);
            surfaces.add(lane, accel.scene().meshes[instance.mesh], hit);
        },
        [&](SurfaceRows& rows) { return surfaces.find(rows); });
}

class TriangleSurfacesBy : public OnInstructionSet {};

TEST_P(TriangleSurfacesBy, AreThoseOfSurfacePointToTheBit) {
    for (const double scale : {1e-30, 1e-4, 1.0, 1e5}) {
        const Accel accel = accel_of(triangles(scale));
        EXPECT_GT(compare(accel, 4000).same, 2000u);
        for (const std::size_t count : {0u, 1u, 2u, 3u, 7u, 17u})
            compare(accel, count);
    }
}

RAYPICK_ON_EACH_INSTRUCTION_SET(TriangleSurfacesBy);

// Coordinates so large beside the triangles that most of these lie within the rim.
TEST(TriangleSurfaces, LeaveThoseNearTheEdges) {
    MeshData data = soup_data(3, 300, 0.8);
    for (glm::vec3& p : data.positions)
        p += glm::vec3(2e4f, -3e4f, 1e4f);
    Scene scene;
    place_mesh(scene, data);
    EXPECT_GT(compare(accel_of(scene), 4000).left, 500u);
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
