#include "tracer/accel/accel.h"

#include "tests/brute_force.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/trees.h"
#include "tracer/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

namespace raypick {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Asks the same ray both ways.
void expect_brute(const Accel& accel, const BruteForce& brute, const Ray& ray,
                  const RayQuery& query = {}) {
    const std::vector<Candidate> candidates = brute.all(ray, query);
    const std::optional<Hit> hit = accel.intersect(ray, query);
    const std::string wrong = complaint(hit, candidates);
    EXPECT_EQ(wrong, "") << to_text(ray);
    EXPECT_EQ(accel.occluded(ray, query), !candidates.empty()) << to_text(ray);
}

void expect_brute(const Scene& scene, std::uint64_t seed, std::size_t count) {
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    for (const Ray& ray : rays_through(accel.bounds(), seed, count)) {
        expect_brute(accel, brute, ray);
        if (testing::Test::HasFailure()) return;
    }
}

// One of each shape, stretched, mirrored and turned, two of them twice in the same place.
Scene shapes_scene() {
    Scene scene;
    place(scene, Sphere{{1.0, 0.0, 0.0}, 0.7});
    place(scene, Sphere{}, kNoMaterial,
          translate({-1.0, 0.5, 0.2}) * rotate(30.0, {1, 1, 0}) * scale({0.3, 1.0, -0.6}));
    place(scene, Box{}, kNoMaterial, translate({0.0, -1.0, 0.5}) * rotate(50.0, {0, 1, 1}));
    place(scene, Box{{-0.2, -0.2, -0.2}, {0.9, 0.3, 0.3}});
    place(scene, Triangle{{-2, -2, -1}, {2, -2, -1}, {0, 2, -1}});
    place(scene, Triangle{{-2, -2, -1}, {2, -2, -1}, {0, 2, -1}});
    place_mesh(scene, soup_data(3, 300, 0.5), kNoMaterial, scale({1.5, -1.0, 1.0}));
    place(scene, MeshInstance{0}, kNoMaterial, translate({0.2, 0.1, 0.0}));
    place(scene, MeshInstance{0}, kNoMaterial, translate({0.2, 0.1, 0.0}));
    place(scene, Plane{{0.0, 1.0, 0.1}, 1.5});
    return scene;
}

TEST(Accel, EmptySceneIsMissed) {
    const Accel accel = accel_of(Scene{});
    EXPECT_TRUE(accel.bounds().empty());
    EXPECT_FALSE(accel.intersect(Ray{}).has_value());
    EXPECT_FALSE(accel.occluded(Ray{}));
    EXPECT_TRUE(accel.intersect_all(Ray{}).empty());
    EXPECT_EQ(accel.stats().triangles, 0u);
}

TEST(Accel, EmptyMeshIsMissed) {
    Scene scene;
    place_mesh(scene, MeshData{});
    place(scene, Sphere{});
    const Accel accel = accel_of(scene);
    const std::optional<Hit> hit = accel.intersect(ray_towards({0, 0, 5}, {0, 0, 0}));
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->object, 1u);
    EXPECT_EQ(hit->t, 4.0f);
}

TEST(Accel, OneTriangle) {
    Scene scene;
    MeshData data;
    data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.triangles = {{0, 1, 2}};
    const ObjectId id = place_mesh(scene, data);
    const Accel accel = accel_of(scene);
    Ray ray;
    ray.origin = {0.25f, 0.5f, 2.0f};
    const std::optional<Hit> hit = accel.intersect(ray);
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(*hit, (Hit{id, 0, 2.0f, {0.25f, 0.5f}, true}));
    EXPECT_EQ(accel.stats().triangles, 1u);
    EXPECT_LE(glm::distance(accel.bounds().min, glm::vec3(0.0f)), 1e-6f);
    EXPECT_LE(glm::distance(accel.bounds().max, glm::vec3(1.0f, 1.0f, 0.0f)), 1e-6f);
}

TEST(Accel, IdenticalTrianglesGoToTheLowest) {
    Scene scene;
    MeshData data;
    data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    // All windings and starts of one triangle, many times over.
    for (int i = 0; i < 200; ++i) {
        data.triangles.insert(data.triangles.end(), {{2, 0, 1}, {0, 2, 1}, {1, 2, 0}});
    }
    const ObjectId first = place_mesh(scene, data);
    place(scene, MeshInstance{0});
    const Accel accel = accel_of(scene);
    for (const auto& ray : rays_through(accel.bounds(), 4, 500)) {
        const std::optional<Hit> hit = accel.intersect(ray);
        if (!hit) continue;
        EXPECT_EQ(hit->object, first);
        EXPECT_EQ(hit->primitive, 0u);
    }
    Ray ray;
    ray.origin = {0.25f, 0.25f, 2.0f};
    EXPECT_EQ(accel.intersect_all(ray).size(), 1200u);
}

TEST(Accel, NearlyEqualDistancesTie) {
    // Object 0 lies behind object 1 by a relative gap; within kTieGap object 0 wins all the same.
    for (const double gap : {0.0, 1e-6, 1.9e-6, 2.1e-6, 1e-5}) {
        Scene scene;
        const ObjectId behind = place(scene, Plane{{0, 0, 1}, 10.0 * (1.0 + gap)});
        const ObjectId before = place(scene, Plane{{0, 0, 1}, 10.0});
        const Accel accel = accel_of(scene);
        const std::optional<Hit> hit = accel.intersect(Ray{});
        ASSERT_TRUE(hit.has_value());
        EXPECT_EQ(hit->object, gap < kTieGap ? behind : before) << gap;
        EXPECT_EQ(hit->t, static_cast<float>(gap < kTieGap ? 10.0 * (1.0 + gap) : 10.0));
    }
}

TEST(Accel, TiesAreMeasuredFromTheClosest) {
    // A chain of planes, each within the gap of the next, but not of the closest.
    Scene scene;
    for (int i = 0; i < 5; ++i) {
        place(scene, Plane{{0, 0, 1}, 10.0 * (1.0 + (4 - i) * 1.5e-6)});
    }
    const std::optional<Hit> hit = accel_of(scene).intersect(Ray{});
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->object, 3u) << "4 is closest, 3 ties with it, 2 does not";
}

TEST(Accel, ZeroAreaTrianglesAreNeverHit) {
    Scene scene;
    MeshData data;
    data.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, 0, 0}, {0, 1, 0}};
    data.triangles = {{0, 0, 0}, {0, 1, 2}, {1, 1, 3}, {0, 1, 3}};
    place_mesh(scene, data);
    const Accel accel = accel_of(scene);
    Ray ray;
    ray.origin = {0.25f, 0.25f, 2.0f};
    ASSERT_TRUE(accel.intersect(ray).has_value());
    EXPECT_EQ(accel.intersect(ray)->primitive, 3u) << "degenerate ones keep their number";
    expect_brute(scene, 1, 1000);
}

TEST(Accel, CoplanarTriangles) {
    Random random(6);
    MeshData data;
    for (std::uint32_t i = 0; i < 900; ++i) {
        data.positions.emplace_back(random.between(-1, 1), 0.25, random.between(-1, 1));
    }
    for (std::uint32_t i = 0; i < 300; ++i)
        data.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    Scene scene;
    place_mesh(scene, data);
    expect_brute(scene, 2, 3000);
    // Along the plane, inside it and just above: no hit, no crash.
    const Accel accel = accel_of(scene);
    Ray ray;
    ray.origin = {-5.0f, 0.25f, 0.0f};
    ray.direction = {1.0f, 0.0f, 0.0f};
    EXPECT_FALSE(accel.intersect(ray).has_value());
}

TEST(Accel, EqualsBruteForceOnSoups) {
    struct Case {
        std::uint32_t count;
        double size;
    };
    for (const Case c : {Case{2, 1.0}, Case{3, 1.0}, Case{5, 1.0}, Case{17, 0.6}, Case{300, 0.3},
                         Case{5000, 0.05}, Case{5000, 1.0}}) {
        for (std::uint64_t seed = 0; seed < 3; ++seed) {
            SCOPED_TRACE(c.count);
            SCOPED_TRACE(seed);
            Scene scene;
            place_mesh(scene, soup_data(seed, c.count, c.size));
            expect_brute(scene, seed, 3000);
        }
    }
}

TEST(Accel, EqualsBruteForceOnAllShapes) {
    expect_brute(shapes_scene(), 8, 20000);
}

TEST(Accel, EqualsBruteForceAtEveryScale) {
    for (const double s : {1e-4, 1e-2, 1e3, 1e6}) {
        SCOPED_TRACE(s);
        Scene scene;
        place_mesh(scene, soup_data(9, 500, 0.4), kNoMaterial, scale({s, s, s}));
        place(scene, Sphere{{0.2 * s, 0.0, 0.0}, 0.3 * s});
        place(scene, Box{{-0.5 * s, -0.5 * s, -0.5 * s}, {0.0, 0.1 * s, 0.2 * s}});
        expect_brute(scene, 9, 3000);
    }
}

TEST(Accel, EqualsBruteForceFarFromTheOrigin) {
    Scene scene;
    MeshData data = soup_data(10, 500, 0.4);
    for (glm::vec3& p : data.positions)
        p += glm::vec3(3000.0f, -2000.0f, 1000.0f);
    place_mesh(scene, data);
    expect_brute(scene, 10, 3000);
}

// From so far that a ray's float rounding is as big as the triangles it is aimed at: the tree must
// not leave out what the exact test would hit.
TEST(Accel, EqualsBruteForceFromFarAway) {
    for (const double distance : {1e2, 1e4, 1e6}) {
        for (const bool instanced : {false, true}) {
            SCOPED_TRACE(distance);
            SCOPED_TRACE(instanced);
            const Transform world_from_object =
                instanced ? rotate(33.0, {1, 2, 3}) * scale({1.0, 0.7, 1.9}) : Transform{};
            Scene scene;
            place_mesh(scene, soup_data(5, 2000, 0.02), kNoMaterial, world_from_object);
            const Accel accel = accel_of(scene);
            const BruteForce brute(scene);
            const Mesh& mesh = scene.meshes[0];
            Random random(6);
            for (int i = 0; i < 2000; ++i) {
                const glm::uvec3 t = mesh.triangles[random.below(mesh.triangles.size())];
                const glm::dvec3 middle =
                    (glm::dvec3(mesh.positions[t.x]) + glm::dvec3(mesh.positions[t.y]) +
                     glm::dvec3(mesh.positions[t.z])) /
                    3.0;
                const glm::vec3 from(distance * random.direction());
                expect_brute(accel, brute, ray_towards(from, world_from_object.point(middle)));
                if (HasFailure()) return;
            }
        }
    }
}

TEST(Accel, EqualsBruteForceOnRaysThroughVerticesAndEdges) {
    Scene scene;
    place_mesh(scene, ball_data(3));
    place_mesh(scene, ball_data(2), kNoMaterial, scale({0.9, 1.3, 0.7}));
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    const Mesh& mesh = scene.meshes[0];
    Random random(12);
    for (int i = 0; i < 5000; ++i) {
        const glm::uvec3 t = mesh.triangles[random.below(mesh.triangles.size())];
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 b(mesh.positions[t.y]);
        const glm::dvec3 target = i % 2 == 0 ? a : a + random.unit() * (b - a);
        expect_brute(accel, brute, ray_towards(glm::vec3(4.0 * random.direction()), target));
        if (HasFailure()) return;
    }
}

TEST(Accel, RaysWithZeroComponentsAndStartsOnBoxes) {
    // Cubes of triangles on a grid: their faces lie exactly on the boxes of the tree, rays run
    // along faces, edges and start on corners.
    Scene scene;
    MeshData data;
    for (std::uint32_t i = 0; i < 27; ++i) {
        const glm::vec3 at(glm::uvec3(i % 3, i / 3 % 3, i / 9));
        const auto base = static_cast<std::uint32_t>(data.positions.size());
        for (const glm::vec3& p : octahedron_data().positions) {
            data.positions.push_back(at + 0.5f * p);
        }
        for (const glm::uvec3& t : octahedron_data().triangles)
            data.triangles.push_back(t + base);
    }
    place_mesh(scene, data);
    place(scene, Box{{0, 0, 0}, {1, 1, 1}});
    place(scene, Box{{1, 0, 0}, {2, 1, 1}});
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    const std::array<float, 7> places{-1.0f, -0.5f, 0.0f, 0.5f, 1.0f, 1.5f, 2.5f};
    const std::array<float, 4> steps{-1.0f, -0.0f, 0.0f, 1.0f};
    for (const float x : places) {
        for (const float y : places) {
            for (const float z : places) {
                for (int d = 0; d < 64; ++d) {
                    const auto step = [&](int shift) {
                        return steps[static_cast<std::size_t>((d >> shift) & 3)];
                    };
                    const glm::vec3 direction(step(0), step(2), step(4));
                    if (direction == glm::vec3(0.0f)) continue;
                    Ray ray;
                    ray.origin = {x, y, z};
                    ray.direction = glm::normalize(direction);
                    expect_brute(accel, brute, ray);
                    if (HasFailure()) return;
                }
            }
        }
    }
}

TEST(Accel, RaysThatAreNoRaysMiss) {
    const Accel accel = accel_of(shapes_scene());
    const Ray good = ray_towards({0, 0, 5}, {0, 0, 0});
    ASSERT_TRUE(accel.intersect(good).has_value());
    const auto expect_miss = [&](const Ray& ray) {
        EXPECT_FALSE(accel.intersect(ray).has_value()) << to_text(ray);
        EXPECT_FALSE(accel.occluded(ray)) << to_text(ray);
        EXPECT_TRUE(accel.intersect_all(ray).empty()) << to_text(ray);
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (const float bad : {kNaN, kInfinity, -kInfinity}) {
            Ray ray = good;
            ray.origin[axis] = bad;
            if (std::isnan(bad)) expect_miss(ray);
            static_cast<void>(accel.intersect(ray));  // no crash, no hang
            ray = good;
            ray.direction[axis] = bad;
            if (std::isnan(bad)) expect_miss(ray);
            const std::optional<Hit> hit = accel.intersect(ray);
            EXPECT_TRUE(!hit || std::isfinite(hit->t));
        }
    }
    Ray ray = good;
    ray.direction = glm::vec3(0.0f);
    expect_miss(ray);
    ray = good;
    ray.t_min = kNaN;
    expect_miss(ray);
    ray = good;
    ray.t_max = kNaN;
    expect_miss(ray);
    ray = good;
    ray.t_max = -1.0f;
    expect_miss(ray);
    ray = good;
    ray.t_min = kInfinity;
    expect_miss(ray);
}

TEST(Accel, TheIntervalIsOpen) {
    Scene scene;
    place(scene, Plane{{0, 0, 1}, 4.0});
    place(scene, Plane{{0, 0, 1}, 8.0});
    const Accel accel = accel_of(scene);
    const auto first = [&](float t_min, float t_max) {
        Ray ray;
        ray.t_min = t_min;
        ray.t_max = t_max;
        const std::optional<Hit> hit = accel.intersect(ray);
        EXPECT_EQ(accel.occluded(ray), hit.has_value());
        EXPECT_EQ(accel.intersect_all(ray).empty(), !hit.has_value());
        return hit ? hit->t : -1.0f;
    };
    EXPECT_EQ(first(0.0f, kInfinity), 4.0f);
    EXPECT_EQ(first(4.0f, kInfinity), 8.0f);
    EXPECT_EQ(first(std::nextafter(4.0f, 0.0f), kInfinity), 4.0f);
    EXPECT_EQ(first(4.0f, 8.0f), -1.0f);
    EXPECT_EQ(first(4.0f, std::nextafter(8.0f, 9.0f)), 8.0f);
    EXPECT_EQ(first(0.0f, 4.0f), -1.0f);
    EXPECT_EQ(first(8.0f, kInfinity), -1.0f);
}

TEST(Accel, TieWinnersLieWithinTheInterval) {
    // The lower id ties but is cut off by t_max: it must not win.
    Scene scene;
    place(scene, Plane{{0, 0, 1}, 10.0 * (1.0 + 1e-6)});
    const ObjectId before = place(scene, Plane{{0, 0, 1}, 10.0});
    Ray ray;
    ray.t_max = std::nextafter(10.0f, 11.0f);
    const std::optional<Hit> hit = accel_of(scene).intersect(ray);
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->object, before);
}

TEST(Accel, RandomIntervalsEqualBruteForce) {
    const Scene scene = shapes_scene();
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    Random random(13);
    for (Ray ray : rays_through(accel.bounds(), 13, 5000)) {
        ray.t_min = static_cast<float>(random.between(0.0, 4.0));
        ray.t_max = ray.t_min + static_cast<float>(random.between(0.0, 4.0));
        expect_brute(accel, brute, ray);
        if (HasFailure()) return;
    }
}

TEST(Accel, MasksHideObjects) {
    Scene scene = shapes_scene();
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        scene.objects[i].mask = 1u << (i % 3);
    }
    scene.objects[2].mask = 0;
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    for (const std::uint32_t mask : {0u, 1u, 2u, 4u, 6u, 0xffffffffu}) {
        RayQuery query;
        query.mask = mask;
        for (const Ray& ray : rays_through(accel.bounds(), 14, 1000)) {
            expect_brute(accel, brute, ray, query);
            if (HasFailure()) return;
        }
    }
}

TEST(Accel, SidesCull) {
    const Scene scene = shapes_scene();
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    for (const Sides sides : {Sides::front_only, Sides::back_only}) {
        RayQuery query;
        query.sides = sides;
        for (const Ray& ray : rays_through(accel.bounds(), 15, 2000)) {
            expect_brute(accel, brute, ray, query);
            const std::optional<Hit> hit = accel.intersect(ray, query);
            if (hit) {
                EXPECT_EQ(hit->front_face, sides == Sides::front_only);
            }
            if (HasFailure()) return;
        }
    }
}

TEST(Accel, MirroredMeshesKeepTheirOutside) {
    Scene scene;
    place_mesh(scene, ball_data(2), kNoMaterial, scale({-2.0, 1.0, 1.0}));
    const Accel accel = accel_of(scene);
    const std::optional<Hit> out = accel.intersect(ray_towards({0, 0, 5}, {0.1, 0.1, 0}));
    ASSERT_TRUE(out.has_value());
    EXPECT_TRUE(out->front_face);
    const std::optional<Hit> in = accel.intersect(ray_towards({0, 0, 0}, {1, 0.3, 0.2}));
    ASSERT_TRUE(in.has_value());
    EXPECT_FALSE(in->front_face);
}

TEST(Accel, ClipPlanesCut) {
    // The front half of a sphere is cut away: the ray meets the inside of the back half.
    Scene ball;
    place(ball, Sphere{});
    const Accel clipped = accel_of(ball);
    const std::array<ClipPlane, 1> back_half{ClipPlane{{0, 0, -1}, 0.0f}};
    RayQuery cut;
    cut.clip_planes = back_half;
    const std::optional<Hit> hit = clipped.intersect(ray_towards({0, 0, 5}, {0, 0, 0}), cut);
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->t, 6.0f);
    EXPECT_FALSE(hit->front_face);

    const Scene scene = shapes_scene();
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    const std::array<ClipPlane, 2> planes{ClipPlane{{0.31f, 0.72f, -0.4f}, 0.123f},
                                          ClipPlane{{-2.0f, 0.1f, 0.6f}, 0.77f}};
    RayQuery query;
    query.clip_planes = planes;
    for (const Ray& ray : rays_through(accel.bounds(), 16, 5000)) {
        expect_brute(accel, brute, ray, query);
        if (HasFailure()) return;
    }
}

TEST(Accel, AcceptRefusesHits) {
    const Scene scene = shapes_scene();
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    const auto odd_ones = [](const Hit& hit) { return hit.primitive % 2 == 1 || hit.uv.x > 0.6f; };
    RayQuery query;
    query.accept = AcceptHit(odd_ones);
    for (const Ray& ray : rays_through(accel.bounds(), 17, 5000)) {
        expect_brute(accel, brute, ray, query);
        const std::optional<Hit> hit = accel.intersect(ray, query);
        if (hit) {
            EXPECT_TRUE(odd_ones(*hit));
        }
        if (HasFailure()) return;
    }
    const auto never = [](const Hit&) { return false; };
    query.accept = AcceptHit(never);
    EXPECT_FALSE(accel.intersect(ray_towards({0, 0, 5}, {0, 0, 0}), query).has_value());
    EXPECT_FALSE(accel.occluded(ray_towards({0, 0, 5}, {0, 0, 0}), query));
}

TEST(Accel, AcceptSeesRealHits) {
    const Scene scene = shapes_scene();
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    for (const Ray& ray : rays_through(accel.bounds(), 18, 500)) {
        std::vector<Hit> wanted;
        for (const Candidate& c : brute.all(ray))
            wanted.push_back(c.rounded());
        const auto known = [&](const Hit& hit) {
            EXPECT_NE(std::find(wanted.begin(), wanted.end(), hit), wanted.end()) << to_text(hit);
            return true;
        };
        RayQuery query;
        query.accept = AcceptHit(known);
        static_cast<void>(accel.intersect(ray, query));
        static_cast<void>(accel.occluded(ray, query));
        if (HasFailure()) return;
    }
}

TEST(Accel, AllHitsInOrder) {
    const Scene scene = shapes_scene();
    const Accel accel = accel_of(scene);
    const BruteForce brute(scene);
    for (const Ray& ray : rays_through(accel.bounds(), 19, 5000)) {
        std::vector<Candidate> wanted = brute.all(ray);
        std::sort(wanted.begin(), wanted.end(), [](const Candidate& a, const Candidate& b) {
            return std::tuple(static_cast<float>(a.t), a.object, a.primitive) <
                   std::tuple(static_cast<float>(b.t), b.object, b.primitive);
        });
        const std::vector<Hit> got = accel.intersect_all(ray);
        ASSERT_EQ(got.size(), wanted.size()) << to_text(ray);
        for (std::size_t i = 0; i < got.size(); ++i) {
            if (i > 0) {
                EXPECT_LE(got[i - 1].t, got[i].t);
            }
            const Hit hit = wanted[i].rounded();
            // Equal after rounding, one before the other in double: either order is by t.
            const bool there = std::find(got.begin(), got.end(), hit) != got.end();
            EXPECT_TRUE(there) << to_text(ray) << "\nlacks " << to_text(hit);
            if (got[i].t < kInfinity && (i + 1 == got.size() || got[i].t != got[i + 1].t) &&
                (i == 0 || got[i].t != got[i - 1].t)) {
                EXPECT_EQ(got[i], hit) << to_text(ray);
            }
        }
        if (HasFailure()) return;
    }
}

TEST(Accel, AllHitsTakeTheQuery) {
    Scene scene;
    place(scene, Sphere{});
    place(scene, Sphere{{0, 0, -3}, 1.0});
    scene.objects[0].mask = 1u;
    scene.objects[1].mask = 2u;
    const Accel accel = accel_of(scene);
    const Ray ray = ray_towards({0, 0, 5}, {0, 0, 0});
    ASSERT_EQ(accel.intersect_all(ray).size(), 4u);
    EXPECT_EQ(accel.intersect_all(ray)[3].t, 9.0f);
    RayQuery query;
    query.sides = Sides::front_only;
    EXPECT_EQ(accel.intersect_all(ray, query).size(), 2u);
    query.mask = 2u;
    ASSERT_EQ(accel.intersect_all(ray, query).size(), 1u);
    EXPECT_EQ(accel.intersect_all(ray, query)[0].object, 1u);
}

TEST(Accel, BatchesAnswerAsOneByOne) {
    const Scene scene = shapes_scene();
    const Accel accel = accel_of(scene);
    const std::array<ClipPlane, 1> planes{ClipPlane{{0.31f, 0.72f, -0.4f}, 0.123f}};
    RayQuery culled;
    culled.sides = Sides::back_only;
    culled.clip_planes = planes;
    for (const std::size_t count : {0u, 1u, 3u, 8u, 63u, 64u, 65u, 1000u}) {
        std::vector<Ray> rays = rays_through(accel.bounds(), 20 + count, count);
        if (count > 10) rays[7].origin.x = kNaN;
        for (const RayQuery& query : {RayQuery{}, culled}) {
            std::vector<Hit> hits(count, Hit{7, 7, 7.0f, {}, true});
            std::vector<std::uint8_t> blocked(count, 9);
            accel.intersect(rays, hits, query);
            accel.occluded(rays, blocked, query);
            for (std::size_t i = 0; i < count; ++i) {
                const std::optional<Hit> single = accel.intersect(rays[i], query);
                EXPECT_EQ(hits[i].valid(), single.has_value());
                if (single) {
                    EXPECT_EQ(hits[i], *single);
                }
                EXPECT_EQ(blocked[i], single ? 1 : 0);
            }
        }
    }
}

TEST(Accel, InstancesMeasureInWorldUnits) {
    // The same ball once as world-space vertices and once through a transform.
    const Transform world_from_object =
        translate({0.3, -0.2, 0.1}) * rotate(40.0, {1, 2, 3}) * scale({0.5, 2.0, -1.0});
    MeshData moved = ball_data(3);
    for (glm::vec3& p : moved.positions)
        p = glm::vec3(world_from_object.point(glm::dvec3(p)));
    Scene direct;
    place_mesh(direct, moved);
    Scene instanced;
    place_mesh(instanced, ball_data(3), kNoMaterial, world_from_object);
    const Accel a = accel_of(direct);
    const Accel b = accel_of(instanced);
    int compared = 0;
    for (const Ray& ray : rays_through(a.bounds(), 21, 2000)) {
        const std::optional<Hit> hit = a.intersect(ray);
        const std::optional<Hit> other = b.intersect(ray);
        if (!hit || !other) continue;  // on a silhouette the rounded vertices decide
        if (hit->primitive != other->primitive) continue;
        EXPECT_NEAR(hit->t, other->t, 2e-5f);
        ++compared;
    }
    EXPECT_GT(compared, 1000);
}

TEST(Accel, MovingAnObjectKeepsTheTrees) {
    Scene scene = shapes_scene();
    auto before = std::make_unique<Accel>(std::make_shared<const Scene>(scene));
    scene.objects[7].world_from_object =
        translate({0.5, 0.5, 0.5}) * scale({1.0, 2.0, -0.5}) * rotate(20.0, {1, 0, 0});
    scene.objects[0].world_from_object = translate({0.0, 1.0, 0.0});
    const auto after = std::make_shared<const Scene>(scene);
    const Accel reused(after, {}, before.get());
    before.reset();  // the new one must not need the old one
    const Accel fresh(after);
    const BruteForce brute(*after);
    for (const Ray& ray : rays_through(fresh.bounds(), 22, 3000)) {
        EXPECT_EQ(fresh.intersect(ray), reused.intersect(ray)) << to_text(ray);
        expect_brute(reused, brute, ray);
        if (HasFailure()) return;
    }
    EXPECT_EQ(fresh.stats().nodes, reused.stats().nodes);
}

TEST(Accel, MovingAnObjectDoesNotRebuildItsMesh) {
    Scene scene;
    place_mesh(scene, ball_data(3));
    place(scene, Sphere{{3.0, 0.0, 0.0}, 1.0});
    const SceneTrees before = build_trees(scene, {}, nullptr);
    scene.objects[0].world_from_object = translate({0.1, 0.0, 0.0});
    EXPECT_EQ(build_trees(scene, {}, &before).meshes[0], before.meshes[0]);
    EXPECT_NE(build_trees(scene, {}, nullptr).meshes[0], before.meshes[0]);
    scene.meshes[0] = make_mesh("other", ball_data(3));
    EXPECT_NE(build_trees(scene, {}, &before).meshes[0], before.meshes[0]);
}

// The corners are this test's own: what it writes into them after the first tree was built is where
// a tree that was taken over does not look for them.
TEST(Accel, TakesTheTreesOfTheOneBefore) {
    MeshData data = ball_data(1);
    Scene scene;
    add_mesh(scene, borrow_mesh("ball", data.positions, data.triangles));
    place(scene, MeshInstance{0});
    const auto shared = std::make_shared<const Scene>(scene);
    const Accel before(shared);
    for (glm::vec3& corner : data.positions)
        corner.x += 10.0f;
    const Ray ray = ray_towards({10, 0, 5}, {10, 0, 0});
    EXPECT_TRUE(Accel(shared).intersect(ray).has_value());
    EXPECT_FALSE(Accel(shared, {}, &before).intersect(ray).has_value());
}

TEST(Accel, TreesMadeSoonerGiveTheSameHits) {
    Scene scene = shapes_scene();
    place_mesh(scene, soup_data(4, 20000, 0.1));
    const auto shared = std::make_shared<const Scene>(scene);
    const Accel slow(shared);
    const Accel soon(shared, {.quality = TreeQuality::first});
    for (const Ray& ray : rays_through(slow.bounds(), 3, 5000))
        ASSERT_EQ(soon.intersect(ray), slow.intersect(ray)) << to_text(ray);
}

TEST(Accel, TreesMadeSoonerAreNotTakenForBetterOnes) {
    Scene scene;
    place_mesh(scene, soup_data(4, 20000, 0.1));
    const auto shared = std::make_shared<const Scene>(scene);
    const Accel slow(shared);
    const Accel soon(shared, {.quality = TreeQuality::first});
    EXPECT_NE(soon.stats().nodes, slow.stats().nodes);
    EXPECT_EQ(Accel(shared, {}, &soon).stats().nodes, slow.stats().nodes);
    EXPECT_EQ(Accel(shared, {.quality = TreeQuality::first}, &slow).stats().nodes,
              slow.stats().nodes);
}

TEST(Accel, RemovedAndAddedObjects) {
    Scene scene = shapes_scene();
    const Accel before(std::make_shared<const Scene>(scene));
    scene.objects.erase(scene.objects.begin() + 2);
    place_mesh(scene, ball_data(2), kNoMaterial, translate({0.0, 0.0, 1.0}));
    const auto edited = std::make_shared<const Scene>(scene);
    const Accel after(edited, {}, &before);
    const BruteForce brute(*edited);
    for (const Ray& ray : rays_through(after.bounds(), 23, 3000)) {
        const std::optional<Hit> hit = after.intersect(ray);
        if (hit) {
            EXPECT_NE(hit->object, 2u);
        }
        expect_brute(after, brute, ray);
        if (HasFailure()) return;
    }
}

TEST(Accel, BoundsLeaveOutPlanes) {
    Scene scene;
    place(scene, Plane{});
    EXPECT_TRUE(accel_of(scene).bounds().empty());
    place(scene, Sphere{{1.0, 2.0, 3.0}, 0.5});
    const Accel accel = accel_of(scene);
    EXPECT_NEAR(accel.bounds().min.x, 0.5f, 1e-6f);
    EXPECT_NEAR(accel.bounds().max.y, 2.5f, 1e-6f);
    EXPECT_NEAR(accel.bounds().max.z, 3.5f, 1e-6f);
}

TEST(Accel, KnowsItsScene) {
    const auto scene = std::make_shared<const Scene>(shapes_scene());
    Accel accel(scene);
    EXPECT_EQ(&accel.scene(), scene.get());
    EXPECT_EQ(accel.shared_scene(), scene);
    const Accel moved(std::move(accel));
    EXPECT_EQ(&moved.scene(), scene.get());
    EXPECT_TRUE(moved.intersect(ray_towards({0, 0, 5}, {0, 0, 0})).has_value());
    EXPECT_GT(moved.stats().bytes, 0u);
    EXPECT_EQ(moved.stats().triangles, 300u) << "of unique meshes";
}

TEST(Accel, RefusesABrokenScene) {
    Scene dangling;
    place(dangling, MeshInstance{4});
    EXPECT_THROW(accel_of(dangling), Error);
    Scene flat;
    place(flat, Sphere{}, kNoMaterial, scale({1.0, 0.0, 1.0}));
    EXPECT_THROW(accel_of(flat), Error);
    Scene negative;
    place(negative, Sphere{{0, 0, 0}, -1.0});
    EXPECT_THROW(accel_of(negative), Error);
}

}  // namespace
}  // namespace raypick
