// Surface points worked out many at once, held against surface_point() to the bit.
#pragma once

#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/accel/surface_rows.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace raypick {

inline bool same_bits(const glm::vec3& a, const glm::vec3& b) {
    return std::memcmp(&a, &b, sizeof(a)) == 0;
}

// Position, bound and normals.
inline void expect_same_place(const SurfacePoint& got, const SurfacePoint& wanted) {
    EXPECT_TRUE(same_bits(got.position, wanted.position));
    EXPECT_TRUE(same_bits(got.position_error, wanted.position_error));
    EXPECT_TRUE(same_bits(got.geometric_normal, wanted.geometric_normal));
    EXPECT_TRUE(same_bits(got.shading_normal, wanted.shading_normal));
}

inline void expect_same(const SurfacePoint& got, const SurfacePoint& wanted) {
    expect_same_place(got, wanted);
    EXPECT_EQ(got.uv, wanted.uv);
    EXPECT_EQ(got.texture_uv, wanted.texture_uv);
    EXPECT_TRUE(same_bits(got.dpdu, wanted.dpdu));
    EXPECT_TRUE(same_bits(got.dpdv, wanted.dpdv));
    EXPECT_EQ(got.front_face, wanted.front_face);
    EXPECT_EQ(got.material, wanted.material);
}

struct Compared {
    std::size_t same = 0;
    std::size_t left = 0;  // for a closer look
};

// Lets add(lane, object, hit) have what `count` rays hit, block by block, and expects the points
// after find(rows), which returns bits of those left for a closer look.
template <typename Add, typename Find>
Compared compare_surfaces(const Accel& accel, std::size_t count, const Add& add, const Find& find) {
    const Scene& scene = accel.scene();
    const std::vector<Ray> rays = rays_through(accel.bounds(), 7, count);
    std::vector<Hit> hits(rays.size());
    accel.intersect(rays, hits);
    Compared compared;
    SurfaceRows rows;
    std::vector<std::size_t> of_lane;
    const auto compare = [&] {
        const std::uint32_t left = find(rows);
        for (std::size_t lane = 0; lane < rows.count; ++lane) {
            if ((left >> lane & 1u) != 0) {
                ++compared.left;
                continue;
            }
            ++compared.same;
            SurfacePoint got;
            rows.take(lane, got);
            const std::size_t i = of_lane[lane];
            expect_same_place(got, surface_point(scene, rays[i], hits[i]));
        }
        EXPECT_EQ(left >> rows.count, 0u);
        rows.clear();
        of_lane.clear();
    };
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].valid()) continue;
        const std::size_t index = object_index(scene, hits[i].object);
        of_lane.push_back(i);
        add(rows.add(rays[i], hits[i]),
            HitObject{scene.objects[index], accel.object_from_world(index), kNoMaterial, false},
            hits[i]);
        if (rows.full()) compare();
    }
    compare();
    return compared;
}

}  // namespace raypick
