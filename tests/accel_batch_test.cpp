// Batches of rays, on every instruction set that this machine has: bit for bit the answers of the
// same rays one by one, and those of brute force.
#include "tests/brute_force.h"
#include "tests/each_instruction_set.h"
#include "tests/ray_batches.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/accel/trace_rays.h"
#include "tracer/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

namespace raypick {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

class AccelBatch : public OnInstructionSet {};

Scene mixed_scene() {
    Scene scene;
    place_mesh(scene, soup_data(3, 300, 0.5), kNoMaterial, scale({1.5, -1.0, 1.0}));
    place(scene, MeshInstance{0}, kNoMaterial, translate({0.2, 0.1, 0.0}));
    place(scene, MeshInstance{0}, kNoMaterial, translate({0.2, 0.1, 0.0}));
    place(scene, MeshInstance{0}, kNoMaterial, translate({3, 1, 0}) * rotate(130.0, {1, 2, 3}));
    place_mesh(scene, ball_data(4));
    place(scene, Sphere{{1.0, 0.0, 0.0}, 0.7});
    place(scene, Box{{-0.2, -0.2, -0.2}, {0.9, 0.3, 0.3}});
    place(scene, Torus{}, kNoMaterial, translate({-2, 0, 0}) * rotate(40.0, {1, 1, 0}));
    place(scene, Cone{{2, 0, 2}, {2, 2, 2}, 0.7, 0.2, true});
    place(scene, Plane{{0.0, 1.0, 0.1}, 1.5});
    return scene;
}

TEST_P(AccelBatch, Soups) {
    for (const double size : {1.0, 0.1, 0.01}) {
        SCOPED_TRACE(size);
        Scene scene;
        place_mesh(scene, soup_data(7, 2000, size));
        expect_all_ways(scene, 11);
        if (HasFatalFailure()) return;
    }
}

TEST_P(AccelBatch, TrianglesSmallerThanAPixel) {
    Scene scene;
    place_mesh(scene, ball_data(7));  // 131072 triangles
    const Accel accel = accel_of(scene);
    expect_as_one_by_one(accel,
                         coherent_rays(accel.bounds(), {64, 64}, Projection::perspective, 5));
}

// Directions in an instance's space are as long as its scale is small.
TEST_P(AccelBatch, InstancesOfEveryScale) {
    for (const double k : {1e-20, 1e-14, 1e-9, 1e-4, 1e4, 1e9, 1e15, 1e17}) {
        SCOPED_TRACE(k);
        const auto size = static_cast<float>(1.0 / k);
        MeshData data = soup_data(5, 500, 0.4);
        for (glm::vec3& p : data.positions)
            p *= size;
        std::vector<glm::vec4> spheres;
        Random random(3);
        for (int i = 0; i < 300; ++i) {
            const glm::vec3 centre(random.point(glm::dvec3(-1.0), glm::dvec3(1.0)));
            spheres.emplace_back(size * centre, size * 0.1f);
        }
        Scene scene;
        place_mesh(scene, data, kNoMaterial, scale(glm::dvec3(k)));
        const SetId set = add_sphere_set(scene, make_sphere_set("set", spheres));
        place(scene, SphereSetInstance{set}, kNoMaterial,
              translate({2, 0, 0}) * scale(glm::dvec3(k)));
        expect_all_ways(scene, 21);
        if (HasFatalFailure()) return;
    }
}

// From so far away that rounding in double is more than a float's last place of the small thing.
TEST_P(AccelBatch, EdgesSeenFromFarAway) {
    Scene scene;
    const double half = 1e-3;
    place(scene, Box{glm::dvec3(-half), glm::dvec3(half)}, kNoMaterial, rotate(33.0, {0, 1, 0}));
    place(scene, Box{}, kNoMaterial, translate({-5, 0, 0}));
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    const float edge = object_bounds(accel.scene(), accel.scene().objects[0]).max.x;
    std::vector<Ray> rays;
    for (int ulp = -320; ulp < 320; ++ulp) {
        Ray ray;
        ray.origin = {edge * (1.0f + static_cast<float>(ulp) * 0x1p-23f), 0.0f, 1e7f};
        ray.direction = {0.0f, 0.0f, -1.0f};
        rays.push_back(ray);
    }
    expect_as_one_by_one(accel, rays);
    for (const Ray& ray : rays)
        ASSERT_EQ(complaint(accel.intersect(ray), brute.all(ray)), "") << to_text(ray);
}

// Many small ones, some that overlap, large ones around the eye, and all of it stretched as well.
TEST_P(AccelBatch, SphereSets) {
    Random random(12);
    std::vector<glm::vec4> spheres;
    for (int i = 0; i < 3000; ++i) {
        const double size = i % 10 == 0 ? 0.3 : 0.02;
        spheres.emplace_back(glm::vec3(random.point(glm::dvec3(-1.0), glm::dvec3(1.0))),
                             static_cast<float>(size * (0.2 + random.unit())));
    }
    spheres.emplace_back(0.0f, 0.0f, 0.0f, 1.4f);
    spheres.push_back(spheres.front());
    for (const Sides sides : {Sides::both, Sides::front_only, Sides::back_only}) {
        Scene scene;
        const SetId set = add_sphere_set(scene, make_sphere_set("set", spheres));
        place(scene, SphereSetInstance{set});
        place(scene, SphereSetInstance{set}, kNoMaterial,
              translate({3, 0, 1}) * rotate(70.0, {1, 2, 3}) * scale({1.5, -0.5, 1.0}));
        for (Object& object : scene.objects)
            object.sides = sides;
        expect_all_ways(scene, 14);
        if (HasFatalFailure()) return;
    }
}

// Rays that graze spheres, on either side of where float can tell.
TEST_P(AccelBatch, RimsOfSpheres) {
    std::vector<glm::vec4> spheres;
    for (int i = 0; i < 30; ++i)
        spheres.emplace_back(0.3f * static_cast<float>(i % 6), 0.3f * static_cast<float>(i / 6),
                             0.1f * static_cast<float>(i % 3),
                             0.1f + 0.001f * static_cast<float>(i));
    Scene scene;
    place(scene, SphereSetInstance{add_sphere_set(scene, make_sphere_set("set", spheres))});
    const Accel accel = accel_of(scene);
    const glm::dvec3 eye(0.5, 0.6, 4.0);
    std::vector<Ray> rays;
    for (const glm::vec4& sphere : spheres) {
        const glm::dvec3 centre(sphere.x, sphere.y, sphere.z);
        const glm::dvec3 along = glm::normalize(centre - eye);
        const glm::dvec3 u = glm::normalize(glm::cross(along, glm::dvec3(0, 1, 0)));
        const glm::dvec3 v = glm::cross(along, u);
        const double sine = static_cast<double>(sphere.w) / glm::distance(centre, eye);
        for (int i = 0; i < 640; ++i) {
            const double rim = sine * (1.0 + (i % 64 - 32) * 3e-8);
            const double turn = 0.01 * i;
            rays.push_back(
                ray_towards(glm::vec3(eye), eye + std::sqrt(1.0 - rim * rim) * along +
                                                rim * (std::cos(turn) * u + std::sin(turn) * v)));
        }
    }
    expect_as_one_by_one(accel, rays);
}

// Rays that touch spheres in one point, where they see neither a front nor a back.
TEST_P(AccelBatch, TangentsOfSpheres) {
    std::vector<glm::vec4> spheres;
    for (int i = 0; i < 36; ++i)
        spheres.emplace_back(4 * (i % 6), 4 * (i / 6), 0, i % 2 == 0 ? 1.0f : 0.5f);
    Scene scene;
    place(scene, SphereSetInstance{add_sphere_set(scene, make_sphere_set("set", spheres))});
    const Accel accel = accel_of(scene);
    std::vector<Ray> rays;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float way : {-1.0f, 1.0f}) {
            for (const glm::vec4& sphere : spheres) {
                glm::vec3 along(0.0f);
                glm::vec3 beside(0.0f);
                along[axis] = way;
                beside[(axis + 1) % 3] = sphere.w;
                rays.push_back({glm::vec3(sphere) + beside - 2.0f * along, along});
            }
        }
    }
    for (const Sides sides : {Sides::both, Sides::front_only, Sides::back_only}) {
        RayQuery query;
        query.sides = sides;
        expect_as_one_by_one(accel, rays, query,
                             sides == Sides::front_only ? Hits::perhaps : Hits::some);
    }
}

TEST_P(AccelBatch, AllShapesAndInstances) {
    expect_all_ways(mixed_scene(), 3);
}

// Every ray through an edge or a vertex, and each triangle twice.
TEST_P(AccelBatch, EdgesVerticesAndTies) {
    Scene scene;
    MeshData data = ball_data(2);
    const std::vector<glm::uvec3> once = data.triangles;
    data.triangles.insert(data.triangles.end(), once.rbegin(), once.rend());
    place_mesh(scene, data);
    place_mesh(scene, ball_data(2));
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    std::vector<Ray> rays;
    for (const glm::uvec3& t : once) {
        const glm::vec3 a = data.positions[t.x];
        const glm::vec3 b = data.positions[t.y];
        for (const glm::vec3& target : {a, 0.5f * (a + b), b})
            rays.push_back(ray_towards({0.01f, 0.02f, 0.03f}, glm::dvec3(target)));
    }
    expect_as_one_by_one(accel, rays);
    std::vector<Hit> hits(rays.size());
    accel.intersect(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i)
        ASSERT_EQ(complaint(hits[i], brute.all(rays[i])), "") << to_text(rays[i]);
}

// Shadow rays that begin on triangles, some of which have no area and are never hit.
TEST_P(AccelBatch, RaysThatBeginOnTheSurface) {
    Scene scene;
    MeshData data = soup_data(15, 400, 0.4);
    for (std::size_t i = 0; i < 40; ++i) {
        glm::uvec3 flat = data.triangles[i];
        flat.z = flat.y;
        data.triangles.push_back(flat);
    }
    place_mesh(scene, data);
    scene.objects[0].sides = Sides::front_only;
    place(scene, MeshInstance{0}, kNoMaterial, translate({0.5, 0, 0}) * rotate(50, {1, 1, 0}));
    const Accel accel = accel_of(scene);
    std::vector<Ray> rays;
    for (const Ray& eye : coherent_rays(accel.bounds(), {32, 32}, Projection::perspective, 3)) {
        const auto hit = accel.intersect(eye);
        if (!hit) continue;
        rays.push_back(ray_towards(eye.at(hit->t), {3, 4, 5}));
    }
    ASSERT_GT(rays.size(), 200u);
    expect_as_one_by_one(accel, rays);
}

TEST_P(AccelBatch, TinyAndHugeScenesAndFarOnes) {
    for (const double size : {1e-15, 1e-9, 1e-4, 1e4, 1e9, 1e14}) {
        SCOPED_TRACE(size);
        Scene scene;
        MeshData data = soup_data(5, 500, 0.2);
        for (glm::vec3& p : data.positions)
            p *= static_cast<float>(size);
        place_mesh(scene, data);
        expect_all_ways(scene, 4);
        if (HasFatalFailure()) return;
    }
    Scene far;
    place_mesh(far, soup_data(6, 500, 0.2), kNoMaterial, translate({1e6, -2e6, 3e5}));
    expect_all_ways(far, 5);
}

TEST_P(AccelBatch, MirrorRays) {
    Scene scene;
    place_mesh(scene, ball_data(5));
    place_mesh(scene, soup_data(9, 1000, 0.3), kNoMaterial, translate({2, 0, 0}));
    const Accel accel = accel_of(scene);
    std::vector<Ray> rays;
    for (const Ray& eye : coherent_rays(accel.bounds(), {48, 48}, Projection::perspective, 8)) {
        const auto hit = accel.intersect(eye);
        if (!hit) continue;
        const glm::vec3 p = eye.at(hit->t * 0.9999f);
        rays.push_back(ray_towards(p, glm::dvec3(p + glm::normalize(p))));
    }
    expect_as_one_by_one(accel, rays);
}

TEST_P(AccelBatch, SidesMasksAndIntervals) {
    Scene scene = mixed_scene();
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        scene.objects[i].sides =
            i % 3 == 0 ? Sides::both : (i % 3 == 1 ? Sides::front_only : Sides::back_only);
        scene.objects[i].mask = static_cast<std::uint32_t>(1 + i % 2);
    }
    const Accel accel = accel_of(scene);
    std::vector<Ray> rays = coherent_rays(accel.bounds(), {24, 32}, Projection::perspective, 6);
    Random random(1);
    for (Ray& ray : rays) {
        ray.t_min = static_cast<float>(random.unit() * 2.0);
        ray.t_max = static_cast<float>(random.unit() * 10.0);
    }
    for (const Sides sides : {Sides::both, Sides::front_only, Sides::back_only}) {
        for (const std::uint32_t mask : {1u, 2u, 3u, 4u}) {
            RayQuery query;
            query.sides = sides;
            query.mask = mask;
            expect_as_one_by_one(accel, rays, query, mask == 4 ? Hits::perhaps : Hits::some);
            if (HasFatalFailure()) return;
        }
    }
}

TEST_P(AccelBatch, ClipPlanesAndAccept) {
    const Accel accel = accel_of(mixed_scene());
    const std::vector<Ray> rays =
        coherent_rays(accel.bounds(), {24, 32}, Projection::perspective, 6);
    const ClipPlane plane{{1, 0, 0}, 0.1f};
    RayQuery query;
    query.clip_planes = {&plane, 1};
    expect_as_one_by_one(accel, rays, query);
    const auto odd = [](const Hit& hit) { return hit.primitive % 2 == 1; };
    query.accept = odd;
    expect_as_one_by_one(accel, rays, query);
}

TEST_P(AccelBatch, HolesLetRaysThrough) {
    Scene scene;
    const MaterialId material = add_sieve(scene);
    place(scene, Rectangle{}, material);
    MeshData data;
    data.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    data.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    data.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (int i = 0; i < 5; ++i)
        place_mesh(scene, data, material, translate({0.1 * i, 0.2 * i, 0.0}));
    const Accel accel = accel_of(scene);
    const std::vector<Ray> rays =
        coherent_rays(accel.bounds(), {48, 64}, Projection::perspective, 2);
    expect_as_one_by_one(accel, rays);  // brute force knows nothing of holes
    expect_as_one_by_one(accel, rays_through(accel.bounds(), 3, 1000));
    // Some rays go through the holes of all, and some don't.
    std::vector<Hit> hits(rays.size());
    accel.intersect(rays, hits);
    const auto met =
        std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.valid(); });
    EXPECT_GT(met, 100);
}

// In groups, and each on its own way.
// Sets that stand in two places have trees of their own; the others: see joined_sets_test.cpp.
TEST_P(AccelBatch, HolesOfSetsLetRaysThrough) {
    Random random(31);
    std::vector<glm::vec4> spheres;
    std::vector<glm::vec4> ends;
    for (int i = 0; i < 150; ++i) {
        const auto at = [&] { return glm::vec3(random.point(glm::dvec3(-1.0), glm::dvec3(1.0))); };
        spheres.emplace_back(at(), 0.2f);
        ends.emplace_back(at(), 0.1f);
        ends.emplace_back(at(), 0.05f);
    }
    Scene scene;
    const MaterialId material = add_sieve(scene);
    place(scene, SphereSetInstance{add_sphere_set(scene, make_sphere_set("", spheres))}, material);
    place(scene, ConeSetInstance{add_cone_set(scene, make_cone_set("", ends, true))}, material);
    place(scene, SphereSetInstance{0}, material, translate({0.5, 0.0, 0.0}));
    place(scene, ConeSetInstance{0}, material, translate({0.0, 0.5, 0.0}));
    const Accel accel = accel_of(scene);
    const std::vector<Ray> scattered = rays_through(accel.bounds(), 32, 2000);
    expect_as_one_by_one(accel, scattered);
    expect_as_one_by_one(accel,
                         coherent_rays(accel.bounds(), {24, 32}, Projection::perspective, 33));
    // What is hit first is not always what is hit first where it isn't cut out.
    for (Object& object : scene.objects)
        object.material = kNoMaterial;
    const Accel whole = accel_of(scene);
    const auto other = std::count_if(scattered.begin(), scattered.end(), [&](const Ray& ray) {
        return accel.intersect(ray) != whole.intersect(ray);
    });
    EXPECT_GT(other, 100);
}

TEST_P(AccelBatch, OddSizesAndRaysThatAreNone) {
    const Accel accel = accel_of(mixed_scene());
    std::vector<Ray> rays = coherent_rays(accel.bounds(), {16, 32}, Projection::perspective, 9);
    Random random(2);
    for (std::size_t i = 0; i < rays.size(); i += 7) {
        Ray& ray = rays[i];
        switch (i % 10) {
            case 0:
                ray.origin.x = kNaN;
                break;
            case 1:
                ray.direction.y = kNaN;
                break;
            case 2:
                ray.direction = glm::vec3(0.0f);
                break;
            case 3:
                ray.direction.z = kInfinity;
                break;
            case 4:
                ray.t_min = ray.t_max;
                break;
            case 5:
                ray.t_min = kNaN;
                break;
            case 6:
                ray.t_min = -5.0f;
                break;
            case 7:
                ray.direction *= 3.0f;
                ray.t_max = kNaN;
                break;
            case 8:
                ray.t_max = kNaN;
                break;
            default:
                ray.direction.x = -0.0f;
                break;
        }
    }
    rays[0].t_max = kNaN;
    for (const std::size_t count :
         {0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u, 15u, 16u, 17u, 63u, 64u, 65u, 200u, 500u}) {
        SCOPED_TRACE(count);
        expect_as_one_by_one(accel, {rays.begin(), rays.begin() + static_cast<long>(count)}, {},
                             count < 15 ? Hits::perhaps : Hits::some);
        if (HasFatalFailure()) return;
    }
    expect_as_one_by_one(accel_of(Scene{}), rays, {}, Hits::perhaps);
}

RAYPICK_ON_EACH_INSTRUCTION_SET(AccelBatch);

TEST(InstructionSets, AreNamedAndCheckedAlways) {
    ASSERT_FALSE(instruction_sets().empty());
    EXPECT_THAT(
        [] { use_instruction_set("MMX"); },
        testing::ThrowsMessage<Error>(testing::AllOf(
            testing::HasSubstr("\"MMX\""), testing::HasSubstr(instruction_sets().front()))));
}

}  // namespace
}  // namespace raypick
