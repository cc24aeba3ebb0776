// Scenes that are hard on trees, on every instruction set that this machine has: objects in each
// other's way, triangles in one place, needles, and rays that float can't hold.
#include "tests/brute_force.h"
#include "tests/each_instruction_set.h"
#include "tests/ray_batches.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/accel/trace_rays.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace raypick {
namespace {

class AccelCrowds : public OnInstructionSet {};

// Every hit along a ray is found exactly once.
void expect_all_hits(const Accel& accel, const BruteForce& brute, const std::vector<Ray>& rays,
                     const RayQuery& query = {}) {
    const auto name = [](const auto& hit) { return std::pair(hit.object, hit.primitive); };
    std::size_t found = 0;
    for (const Ray& ray : rays) {
        std::vector<std::pair<ObjectId, std::uint32_t>> got;
        std::vector<std::pair<ObjectId, std::uint32_t>> wanted;
        for (const Hit& hit : accel.intersect_all(ray, query))
            got.push_back(name(hit));
        for (const Candidate& candidate : brute.all(ray, query))
            wanted.push_back(name(candidate));
        std::sort(got.begin(), got.end());
        std::sort(wanted.begin(), wanted.end());
        ASSERT_EQ(got, wanted) << to_text(ray);
        found += got.size();
    }
    EXPECT_GT(found, 0u);
}

std::vector<glm::vec4> small_spheres(std::uint64_t seed, int count) {
    Random random(seed);
    std::vector<glm::vec4> spheres;
    for (int i = 0; i < count; ++i)
        spheres.emplace_back(glm::vec3(random.point(glm::dvec3(-1.0), glm::dvec3(1.0))), 0.05f);
    return spheres;
}

// Forty meshes through one another that stand where their shapes do, so that the top tree holds
// parts of them; some of them twice, some elsewhere, one a single triangle, one none.
Scene crowd() {
    Scene scene;
    for (std::uint64_t seed = 0; seed < 40; ++seed)
        place_mesh(scene, soup_data(seed, 20 + 13 * static_cast<std::uint32_t>(seed), 0.3));
    place_mesh(scene, ball_data(4));
    place_mesh(scene, soup_data(50, 1, 1.0));
    place_mesh(scene, MeshData{});
    for (MeshId mesh = 0; mesh < 6; ++mesh) {
        place(scene, MeshInstance{mesh});
        place(scene, MeshInstance{mesh + 6}, kNoMaterial,
              translate({0.3, 0.1 * mesh, 0.0}) * rotate(40.0 * mesh, {1, 2, 3}));
    }
    const SetId set = add_sphere_set(scene, make_sphere_set("set", small_spheres(1, 300)));
    place(scene, SphereSetInstance{set});
    place(scene, SphereSetInstance{set}, kNoMaterial, translate({0.5, 0.5, 0.0}));
    place(scene, Sphere{{0.2, 0.0, 0.0}, 0.4});
    place(scene, Plane{{0.0, 1.0, 0.1}, 0.9});
    return scene;
}

TEST_P(AccelCrowds, ObjectsInEachOthersWay) {
    const Scene scene = crowd();
    expect_all_ways(scene, 17);
    if (HasFatalFailure()) return;
    const Accel accel = accel_of(scene);
    expect_all_hits(accel, BruteForce(scene), rays_through(accel.bounds(), 5, 150));
}

TEST_P(AccelCrowds, MasksAndSidesOfObjectsInEachOthersWay) {
    Scene scene = crowd();
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        scene.objects[i].mask = static_cast<std::uint32_t>(1 + i % 3);
        scene.objects[i].sides = i % 5 == 0 ? Sides::front_only : Sides::both;
    }
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    std::vector<Ray> rays = coherent_rays(accel.bounds(), {16, 32}, Projection::perspective, 6);
    const std::vector<Ray> others = rays_through(accel.bounds(), 6, 200);
    rays.insert(rays.end(), others.begin(), others.end());
    for (std::size_t i = 0; i < rays.size(); i += 3)
        rays[i].t_min = 0.8f;
    const ClipPlane plane{{1, 0, 0}, 0.1f};
    for (const std::uint32_t mask : {1u, 2u, 3u}) {
        RayQuery query;
        query.mask = mask;
        expect_as_one_by_one(accel, rays, query);
        expect_all_hits(accel, brute, others, query);
        query.clip_planes = {&plane, 1};
        expect_as_one_by_one(accel, rays, query);
        if (HasFatalFailure()) return;
    }
}

// More than a byte can count, and nothing tells them apart.
TEST_P(AccelCrowds, TrianglesInOnePlace) {
    for (const std::uint32_t count : {8u, 9u, 300u}) {
        SCOPED_TRACE(count);
        MeshData data = soup_data(1, 100, 0.3);
        data.positions.insert(data.positions.end(), {{-1, -1, 0.2f}, {1, -1, 0.2f}, {0, 1, 0.2f}});
        data.triangles.insert(data.triangles.begin() + 50, count, {300, 301, 302});
        Scene scene;
        place_mesh(scene, data);
        MeshData sole;
        sole.positions = {{-1, -1, 0.5f}, {1, -1, 0.5f}, {0, 1, 0.5f}};
        sole.triangles.assign(count, {0, 1, 2});
        place_mesh(scene, sole);
        place(scene, MeshInstance{1}, kNoMaterial, rotate(90.0, {0, 1, 0}));
        expect_all_ways(scene, 23);
        if (HasFatalFailure()) return;
        const Accel accel = accel_of(scene);
        const Ray through{{0.01f, 0.02f, 0.501f}, {0, 0, -1}};
        expect_all_hits(accel, BruteForce(scene), {through});
        EXPECT_GE(accel.intersect_all(through).size(), 2 * count);
        EXPECT_EQ(accel.intersect(through)->object, accel.scene().objects[1].id);
        EXPECT_EQ(accel.intersect(through)->primitive, 0u);
    }
}

TEST_P(AccelCrowds, Needles) {
    for (const double width : {1e-3, 1e-6, 1e-7}) {
        SCOPED_TRACE(width);
        Random random(8);
        MeshData data;
        for (std::uint32_t i = 0; i < 2000; ++i) {
            const glm::dvec3 from = random.point(glm::dvec3(-1.0), glm::dvec3(1.0));
            data.positions.emplace_back(from);
            data.positions.emplace_back(from + width * random.direction());
            data.positions.emplace_back(random.point(glm::dvec3(-1.0), glm::dvec3(1.0)));
            data.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
        }
        Scene scene;
        place_mesh(scene, data);
        const Accel accel = accel_of(scene);
        std::vector<Ray> rays;
        const glm::vec3 eye(0.3f, 0.2f, 4.0f);
        for (std::uint32_t i = 0; i < 2000; ++i) {
            const glm::dvec3 on = 0.3 * glm::dvec3(data.positions[3 * i]) +
                                  0.3 * glm::dvec3(data.positions[3 * i + 1]) +
                                  0.4 * glm::dvec3(data.positions[3 * i + 2]);
            rays.push_back(ray_towards(eye, on));
        }
        expect_as_one_by_one(accel, rays);
        const BruteForce brute(scene);
        for (std::size_t i = 0; i < rays.size(); i += 7)
            ASSERT_EQ(complaint(accel.intersect(rays[i]), brute.all(rays[i])), "") << i;
        if (HasFatalFailure()) return;
    }
}

// Coordinates a million times as large as the triangles: float's last place is an eighth of them.
TEST_P(AccelCrowds, SmallTrianglesFarFromTheOrigin) {
    for (const bool turned : {false, true}) {
        SCOPED_TRACE(turned);
        MeshData data = soup_data(9, 800, 1.0);
        for (glm::vec3& position : data.positions)
            position = 4.0f * position + glm::vec3(1e6f, -1e6f, 1.5e6f);
        Scene scene;
        place_mesh(scene, data, kNoMaterial, turned ? rotate(30.0, {1, 2, 3}) : Transform{});
        place_mesh(scene, data, kNoMaterial, turned ? rotate(30.0, {1, 2, 3}) : Transform{});
        expect_all_ways(scene, 31);
        if (HasFatalFailure()) return;
    }
}

// Rays with nothing in common, in batches of every size, on objects twice in the same place.
TEST_P(AccelCrowds, BatchesOfEverySizeWithTies) {
    Scene scene;
    place_mesh(scene, soup_data(2, 300, 0.6));
    place_mesh(scene, ball_data(3), kNoMaterial, rotate(10.0, {0, 1, 0}));
    place(scene, MeshInstance{0});
    place(scene, MeshInstance{1}, kNoMaterial, rotate(10.0, {0, 1, 0}));
    place(scene, MeshInstance{0});
    place(scene, Plane{{0.0, 1.0, 0.1}, 0.5});
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    const std::vector<Ray> far_apart = rays_through(accel.bounds(), 12, 131);
    const std::vector<Ray> close =
        coherent_rays(accel.bounds(), {16, 16}, Projection::perspective, 4);
    for (std::size_t count = 1; count <= 130; ++count) {
        SCOPED_TRACE(count);
        const auto end = static_cast<long>(count);
        expect_as_one_by_one(accel, {far_apart.begin(), far_apart.begin() + end}, {},
                             Hits::perhaps);
        expect_as_one_by_one(accel, {close.begin(), close.begin() + end}, {}, Hits::perhaps);
        if (HasFatalFailure()) return;
    }
    std::vector<Hit> hits(far_apart.size());
    accel.intersect(far_apart, hits);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const auto hit = hits[i].valid() ? std::optional(hits[i]) : std::nullopt;
        ASSERT_EQ(complaint(hit, brute.all(far_apart[i])), "") << to_text(far_apart[i]);
    }
}

// Taken into the space of such an object, a ray's origin or direction is more than float can hold.
TEST_P(AccelCrowds, RaysThatFloatCannotHoldInObjectSpace) {
    for (const float size : {1e25f, 1e30f, 1e36f}) {
        SCOPED_TRACE(size);
        MeshData data = soup_data(5, 500, 0.4);
        for (glm::vec3& position : data.positions)
            position *= size;
        std::vector<glm::vec4> spheres = small_spheres(3, 100);
        for (glm::vec4& sphere : spheres)
            sphere *= size;
        Scene scene;
        const Transform shrunk = scale(glm::dvec3(1.0 / static_cast<double>(size)));
        place_mesh(scene, data, kNoMaterial, shrunk);
        place_mesh(scene, data, kNoMaterial, translate({0.5, 0.5, 0.0}) * shrunk);
        place(scene, SphereSetInstance{add_sphere_set(scene, make_sphere_set("set", spheres))},
              kNoMaterial, shrunk);
        const Accel accel = accel_of(scene);
        const BruteForce brute(scene);
        for (const float far : {1.0f, 1e3f, 1e9f, 1e13f}) {
            SCOPED_TRACE(far);
            std::vector<Ray> rays = rays_through(accel.bounds(), 3, 100);
            for (Ray& ray : rays)
                ray = ray_towards(ray.origin - far * ray.direction, glm::dvec3(ray.origin));
            expect_as_one_by_one(accel, rays, {}, far > 1e3f ? Hits::perhaps : Hits::some);
            if (HasFatalFailure()) return;
            for (const Ray& ray : rays)
                ASSERT_EQ(complaint(accel.intersect(ray), brute.all(ray)), "") << to_text(ray);
        }
    }
}

// Boxes within boxes, all of which a ray from their common corner meets: as much waits on the way
// down as can, in the top tree and then in the innermost object.
TEST_P(AccelCrowds, BoxesWithinBoxes) {
    const auto add_triangle = [](MeshData& data, double size) {
        const auto s = static_cast<float>(size);
        const auto first = static_cast<std::uint32_t>(data.positions.size());
        data.positions.insert(data.positions.end(), {{0, 0, 0}, {s, s, 0}, {s, 0, s}});
        data.triangles.emplace_back(first, first + 1, first + 2);
    };
    Scene scene;
    for (int i = 0; i < 360; ++i) {
        MeshData one;
        add_triangle(one, std::pow(10.0, 18.0 - 0.1 * i));
        place_mesh(scene, one);
    }
    MeshData many;
    for (int i = 0; i < 3600; ++i)
        add_triangle(many, std::pow(10.0, 18.0 - 0.01 * i));
    many.positions.insert(many.positions.end(), {{1e18f, 0, 0}, {0, 1e18f, 0}, {0, 0, 1e18f}});
    many.triangles.emplace_back(many.positions.size() - 3, many.positions.size() - 2,
                                many.positions.size() - 1);
    place_mesh(scene, many, kNoMaterial, scale(glm::dvec3(1e-37)));
    const Accel accel = accel_of(scene);
    std::vector<Ray> rays(20, Ray{glm::vec3(0.0f), glm::normalize(glm::vec3(1.0f))});
    for (std::size_t i = 0; i < rays.size(); ++i)
        rays[i].direction.x -= 0.01f * static_cast<float>(i);
    const auto any = [](const Hit&) { return true; };
    RayQuery one_by_one;
    one_by_one.accept = any;
    expect_as_one_by_one(accel, rays, one_by_one);
    expect_as_one_by_one(accel, rays);
    EXPECT_EQ(accel.intersect(rays[0])->primitive, 3600u);
}

RAYPICK_ON_EACH_INSTRUCTION_SET(AccelCrowds);

}  // namespace
}  // namespace raypick
