// Surface points worked out many at once, held against surface_point() to the bit.
#pragma once

#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/accel/surface.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace raypick {

inline bool same_bits(const glm::vec3& a, const glm::vec3& b) {
    return std::memcmp(&a, &b, sizeof(a)) == 0;
}

inline void expect_same(const SurfacePoint& got, const SurfacePoint& wanted) {
    EXPECT_TRUE(same_bits(got.position, wanted.position));
    EXPECT_TRUE(same_bits(got.position_error, wanted.position_error));
    EXPECT_TRUE(same_bits(got.geometric_normal, wanted.geometric_normal));
    EXPECT_TRUE(same_bits(got.shading_normal, wanted.shading_normal));
    EXPECT_EQ(got.uv, wanted.uv);
    EXPECT_EQ(got.front_face, wanted.front_face);
    EXPECT_EQ(got.material, wanted.material);
}

inline void expect_same_uv(const SurfacePoint& got, const SurfacePoint& wanted) {
    EXPECT_EQ(got.texture_uv, wanted.texture_uv);
    EXPECT_TRUE(same_bits(got.dpdu, wanted.dpdu));
    EXPECT_TRUE(same_bits(got.dpdv, wanted.dpdv));
}

// Lets add(object, ray, hit, surface) have what `count` rays hit, expects the surfaces after
// find(), and returns how many hits there were.
template <typename Add, typename Find>
std::size_t compare_surfaces(const Accel& accel, std::size_t count, const Add& add,
                             const Find& find, bool textured = false) {
    const Scene& scene = accel.scene();
    const std::vector<Ray> rays = rays_through(accel.bounds(), 7, count);
    std::vector<Hit> hits(rays.size());
    accel.intersect(rays, hits);
    std::vector<SurfacePoint> got(rays.size());
    std::size_t met = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].valid()) continue;
        const std::size_t index = object_index(scene, hits[i].object);
        add(HitObject{scene.objects[index], accel.object_from_world(index), kNoMaterial, textured},
            rays[i], hits[i], got[i]);
        ++met;
    }
    find();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].valid()) continue;
        const SurfacePoint wanted = surface_point(scene, rays[i], hits[i]);
        expect_same(got[i], wanted);
        if (textured) expect_same_uv(got[i], wanted);
    }
    return met;
}

}  // namespace raypick
