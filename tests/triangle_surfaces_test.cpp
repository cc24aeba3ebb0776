// Many at once against one by one: the same to the bit, for every instruction set.
#include "tracer/accel/triangle_surfaces.h"

#include "tests/tracer_scenes.h"

#include <gtest/gtest.h>

#include <hwy/highway.h>

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

// Slivers and large ones, flat and smooth, some with normals that point the wrong way.
Scene triangles(double scale) {
    MeshData soup = soup_data(3, 300, 0.8);
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

// Works out what `count` rays hit, and returns how many hits there were.
std::size_t compare(const Accel& accel, TriangleSurfaces& surfaces, std::size_t count) {
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
        EXPECT_TRUE(TriangleSurfaces::takes(at));
        surfaces.add(scene, at, rays[i], hits[i], got[i]);
        ++met;
    }
    surfaces.find(scene);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits[i].valid()) expect_same(got[i], surface_point(scene, rays[i], hits[i]));
    }
    return met;
}

TEST(TriangleSurfaces, AreThoseOfSurfacePointToTheBit) {
    const std::int64_t supported = hwy::SupportedTargets();
    for (std::int64_t left = supported; left != 0; left &= left - 1) {
        const std::int64_t target = left & -left;
        SCOPED_TRACE(hwy::TargetName(target));
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        TriangleSurfaces surfaces;
        for (const double scale : {1e-4, 1.0, 1e5}) {
            const Accel accel = accel_of(triangles(scale));
            EXPECT_GT(compare(accel, surfaces, 4000), 2000u);
            for (const std::size_t count : {0u, 1u, 2u, 3u, 7u, 17u})
                compare(accel, surfaces, count);
        }
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

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

TEST(TriangleSurfaces, TakesWhatNothingMovesAndNoTextureNeeds) {
    Scene scene;
    place_mesh(scene, ball_data(0));
    place_mesh(scene, ball_data(0), kNoMaterial, translate({1, 0, 0}));
    place(scene, Sphere{});
    const Transform identity;
    const Transform moved = translate({-1, 0, 0});
    EXPECT_TRUE(TriangleSurfaces::takes({scene.objects[0], identity, kNoMaterial, false}));
    EXPECT_FALSE(TriangleSurfaces::takes({scene.objects[0], identity, kNoMaterial, true}));
    EXPECT_FALSE(TriangleSurfaces::takes({scene.objects[1], moved, kNoMaterial, false}));
    EXPECT_FALSE(TriangleSurfaces::takes({scene.objects[2], identity, kNoMaterial, false}));
}

}  // namespace
}  // namespace raypick
