// What is ruled out before intersect_triangle is asked: never a hit, on any instruction set, and
// nearly everything else, wherever it stands in its patch.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/triangle_filter_test.cpp"
#include <hwy/foreach_target.h>

#include "tests/brute_force.h"
#include "tests/each_instruction_set.h"
#include "tests/one_leaf.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/simd/group_boxes-inl.h"
#include "tracer/accel/simd/group_triangles-inl.h"
#include "tracer/accel/simd/triangle_filter-inl.h"
#include "tracer/accel/trace_rays.h"
#include "tracer/geometry/triangle_test.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace raypick::HWY_NAMESPACE {
namespace {

std::uint32_t rays_filter(const TrianglePatch& patch, const Ray& ray, float reach) {
    return TriangleFilter(ray.origin, ray.direction).may_hit(patch, reach, ray.t_max);
}

std::uint32_t sheared_filter(const TrianglePatch& patch, const Ray& ray, float reach) {
    const ObjectRay local{glm::dvec3(ray.origin), glm::dvec3(ray.direction)};
    return TriangleFilter(shear(local)).may_hit(patch, reach, ray.t_max);
}

// Bit 31 of groups_filter: not all that it should have set is set.
constexpr std::uint32_t kNotSet = 1u << 31u;

// Of no more than 64 rays in one octant, up to the largest t_max.
std::uint32_t groups_filter(const TrianglePatch& patch, std::span<const Ray> rays, float reach) {
    GroupRays group{};
    float t_far = 0.0f;
    for (std::size_t i = 0; i < kGroup; ++i) {
        const Ray& ray = rays[std::min(i, rays.size() - 1)];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            group.origin[axis][i] = ray.origin[static_cast<int>(axis)];
            group.direction[axis][i] = ray.direction[static_cast<int>(axis)];
        }
        t_far = std::max(t_far, ray.t_max);
    }
    group.invert();
    const GroupSpace space(group, first_rays(rays.size()), 0.0f, reach);
    GroupTriangles triangles;
    triangles.edge_error.fill(-1.0f);
    std::uint32_t left = 0;
    for (std::size_t i = 0; i < patch.triangles; i += kTrianglesAtOnce)
        left |= set_triangles(space, t_far, patch, i, triangles) << i;
    left &= (1u << patch.triangles) - 1u;
    // Rays that go through a patch one by one look at all of it.
    const std::span all(triangles.edge_error.data(), patch.triangles);
    return left | (left != 0 && std::ranges::count(all, -1.0f) > 0 ? kNotSet : 0u);
}

}  // namespace
}  // namespace raypick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raypick {
namespace {

HWY_EXPORT(rays_filter);
HWY_EXPORT(sheared_filter);
HWY_EXPORT(groups_filter);

class TriangleFilters : public OnInstructionSet {};

// A few triangles on at most sixteen corners, in a patch of their own.
struct Patch {
    Mesh mesh;
    TrianglePatches patches;

    explicit Patch(MeshData data) : mesh(make_mesh("mesh", std::move(data))) {
        WideBvh bvh = one_leaf(mesh);
        patches = take_triangles(bvh, mesh, 1, {});
    }
    [[nodiscard]] const TrianglePatch& only() const { return patches.at(0); }
};

// `count` triangles about as large as they are apart, on shared corners.
MeshData some_triangles(std::uint64_t seed, std::size_t count, double size, double offset) {
    Random random(seed);
    MeshData data;
    for (int i = 0; i < 16; ++i) {
        const glm::dvec3 at = random.point(glm::dvec3(-size), glm::dvec3(size));
        data.positions.emplace_back(at + offset);
    }
    while (data.triangles.size() < count) {
        const glm::uvec3 t(random.below(16), random.below(16), random.below(16));
        if (t.x != t.y && t.y != t.z && t.z != t.x) data.triangles.push_back(t);
    }
    return data;
}

std::optional<float> hit_of(const Patch& patch, std::uint32_t i, const Ray& ray) {
    const ObjectRay local{glm::dvec3(ray.origin), glm::dvec3(ray.direction)};
    const TrianglePatch& all = patch.only();
    const auto hit =
        intersect_triangle(shear(local), glm::dvec3(all.position(i, 0)),
                           glm::dvec3(all.position(i, 1)), glm::dvec3(all.position(i, 2)));
    if (!hit || !(static_cast<float>(hit->t) > 0.0f)) return std::nullopt;
    return static_cast<float>(hit->t);
}

std::uint32_t hits_of(const Patch& patch, const Ray& ray) {
    std::uint32_t hits = 0;
    for (std::uint32_t i = 0; i < patch.only().triangles; ++i)
        hits |= (hit_of(patch, i, ray) ? 1u : 0u) << i;
    return hits;
}

float reach_of(const Patch& patch, const Ray& ray) {
    float reach =
        std::max({std::abs(ray.origin.x), std::abs(ray.origin.y), std::abs(ray.origin.z)});
    for (const glm::vec3& p : patch.mesh.positions)
        reach = std::max({reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return reach;
}

// Towards corners, edges and within, as exactly as float can, from far away and from close by.
std::vector<Ray> rays_at_triangles(const Patch& patch, std::uint64_t seed, double size) {
    Random random(seed);
    std::vector<Ray> rays;
    const std::array<glm::dvec3, 4> weights{
        {{1, 0, 0}, {0.5, 0.5, 0}, {0.3, 0.7, 0}, {0.2, 0.3, 0.5}}};
    for (const glm::uvec3& t : patch.mesh.triangles) {
        for (const glm::dvec3& w : weights) {
            const glm::dvec3 target = w.x * glm::dvec3(patch.mesh.positions[t.x]) +
                                      w.y * glm::dvec3(patch.mesh.positions[t.y]) +
                                      w.z * glm::dvec3(patch.mesh.positions[t.z]);
            for (const double least : {-6.0, -1.0}) {
                const double away = size * std::pow(10.0, random.between(least, least + 5.0));
                rays.push_back(ray_towards(glm::vec3(target + away * random.direction()), target));
            }
        }
    }
    return rays;
}

TEST_P(TriangleFilters, RuleNoHitOut) {
    int hits = 0;
    for (std::uint64_t seed = 0; seed < 500; ++seed) {
        const double size = std::pow(10.0, static_cast<double>(seed % 7) * 3.0 - 9.0);
        const double offset = seed % 3 == 0 ? 1000.0 * size : 0.0;
        SCOPED_TRACE(testing::Message() << "seed " << seed << " size " << size);
        const Patch patch(some_triangles(seed, 1 + seed % 8, size, offset));
        for (Ray ray : rays_at_triangles(patch, seed, size)) {
            const float reach = reach_of(patch, ray);
            if (reach < 1e11f) {
                const std::uint32_t left =
                    HWY_DYNAMIC_DISPATCH(groups_filter)(patch.only(), {&ray, 1}, reach);
                ASSERT_EQ(hits_of(patch, ray) & ~left, 0u) << to_text(ray);
            }
            for (std::uint32_t i = 0; i < patch.only().triangles; ++i) {
                const auto hit = hit_of(patch, i, ray);
                if (!hit) continue;
                ++hits;
                ray.t_max = *hit;  // and no further
                const std::uint32_t left =
                    HWY_DYNAMIC_DISPATCH(rays_filter)(patch.only(), ray, reach) &
                    HWY_DYNAMIC_DISPATCH(sheared_filter)(patch.only(), ray, reach);
                ASSERT_NE((left >> i) & 1u, 0u) << to_text(ray);
            }
        }
    }
    EXPECT_GT(hits, 10000);
}

// Rays side by side with this one, each with an origin of its own, in its octant.
std::vector<Ray> bundle_around(const Ray& ray, double spread, Random& random) {
    std::vector<Ray> rays{ray};
    while (rays.size() < 64) {
        Ray other = ray;
        other.origin += glm::vec3(spread * random.direction());
        for (int axis = 0; axis < 3; ++axis) {
            const double along = ray.direction[axis] + random.between(-0.01, 0.01);
            other.direction[axis] = std::copysign(static_cast<float>(along), ray.direction[axis]);
        }
        if (rays.size() % 4 == 1) other.direction[2] = std::copysign(0.0f, ray.direction.z);
        rays.push_back(other);
    }
    return rays;
}

TEST_P(TriangleFilters, OfSeveralOriginsRuleNoHitOutButManyOthers) {
    int hits = 0;
    int ruled_out = 0;
    int triangles = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const double size = std::pow(10.0, static_cast<double>(seed % 5) * 3.0 - 6.0);
        const double offset = seed % 3 == 0 ? 1000.0 * size : 0.0;
        SCOPED_TRACE(testing::Message() << "seed " << seed << " size " << size);
        MeshData data = some_triangles(seed, 8, size, offset);
        if (seed % 4 == 1) {  // flat
            for (glm::vec3& p : data.positions)
                p.z = static_cast<float>(offset);
        }
        const Patch patch(std::move(data));
        Random random(seed);
        for (const Ray& ray : rays_at_triangles(patch, seed, size)) {
            const double spread = size * std::pow(10.0, random.between(-8.0, -1.0));
            std::vector<Ray> rays = bundle_around(ray, spread, random);
            std::uint32_t wanted = 0;
            for (Ray& one : rays) {
                float last = 0.0f;
                for (std::uint32_t i = 0; i < patch.only().triangles; ++i)
                    last = std::max(last, hit_of(patch, i, one).value_or(0.0f));
                one.t_max = last;  // and no further
                const std::uint32_t its = hits_of(patch, one);
                wanted |= its;
                hits += its != 0 ? 1 : 0;
            }
            const std::uint32_t left =
                HWY_DYNAMIC_DISPATCH(groups_filter)(patch.only(), rays, reach_of(patch, ray));
            ASSERT_EQ(wanted & ~left, 0u) << to_text(ray);
            ASSERT_LT(left, 1u << 8u) << "a triangle was left as it was";
            ruled_out += 8 - std::popcount(left);
            triangles += 8;
        }
    }
    EXPECT_GT(hits, 50000);
    EXPECT_GT(ruled_out, triangles / 4);
}

// How often each place of a patch is let through without a hit.
void expect_rare(const std::array<int, 8>& idle, int rays) {
    for (std::size_t i = 0; i < idle.size(); ++i)
        EXPECT_LE(idle[i], rays / 100) << "place " << i;
}

TEST_P(TriangleFilters, RuleNearlyAllOthersOut) {
    std::array<int, 8> idle{};
    std::array<int, 8> idle_sheared{};
    std::array<int, 8> idle_group{};
    int rays = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const Patch patch(some_triangles(seed, 8, 1.0, 0.0));
        for (const Ray& ray : rays_through({glm::vec3(-1.0f), glm::vec3(1.0f)}, seed, 20)) {
            const auto count = [&](std::uint32_t let_through, std::array<int, 8>& places) {
                for (std::size_t i = 0; i < 8; ++i)
                    places[i] += static_cast<int>((let_through >> i) & 1u);
            };
            const std::uint32_t wanted = hits_of(patch, ray);
            const float reach = reach_of(patch, ray);
            ++rays;
            // What lies behind is for intersect_triangle to see.
            Ray back = ray;
            back.direction = -ray.direction;
            const std::uint32_t neither = ~(wanted | hits_of(patch, back));
            count(HWY_DYNAMIC_DISPATCH(rays_filter)(patch.only(), ray, reach) & neither, idle);
            count(HWY_DYNAMIC_DISPATCH(sheared_filter)(patch.only(), ray, reach) & neither,
                  idle_sheared);
            count(HWY_DYNAMIC_DISPATCH(groups_filter)(patch.only(), {&ray, 1}, reach) & neither,
                  idle_group);
        }
    }
    expect_rare(idle, rays);
    expect_rare(idle_sheared, rays);
    expect_rare(idle_group, rays);
}

TEST_P(TriangleFilters, RuleOutWhatIsTooFarAway) {
    std::array<int, 8> idle{};
    int rays = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const Patch patch(some_triangles(seed, 8, 1.0, 0.0));
        for (Ray ray : rays_through({glm::vec3(-1.0f), glm::vec3(1.0f)}, seed, 20)) {
            ray.t_max = 1e-3f;
            const std::uint32_t let_through =
                HWY_DYNAMIC_DISPATCH(rays_filter)(patch.only(), ray, reach_of(patch, ray));
            ++rays;
            for (std::size_t i = 0; i < 8; ++i)
                idle[i] += static_cast<int>((let_through >> i) & 1u);
        }
    }
    expect_rare(idle, rays);
}

RAYPICK_ON_EACH_INSTRUCTION_SET(TriangleFilters);

}  // namespace
}  // namespace raypick
#endif
