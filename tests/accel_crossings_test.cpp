// What batches of rays cross of things that let light through, on every instruction set that this
// machine has: bit for bit what single rays hit.
#include "tests/each_instruction_set.h"
#include "tests/ray_batches.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/accel/crossings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

namespace raypick {
namespace {

using ::testing::ElementsAre;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

class AccelCrossings : public OnInstructionSet {};

constexpr MaterialId kGlass = 0;
constexpr MaterialId kStone = 1;
constexpr MaterialId kLace = 2;     // stone with holes
constexpr MaterialId kCurtain = 3;  // glass with holes

Scene scene_of_materials() {
    Scene scene;
    const TextureId holes = add_texture(scene, {"holes", Checker{}});
    for (int i = 0; i < 4; ++i) {
        Material material;
        if (i >= 2) {
            material.alpha_mode = AlphaMode::cut_out;
            material.alpha_cutoff = 0.5f;
            TextureMap& map = material.maps[static_cast<std::size_t>(MapSlot::opacity)];
            map.texture = holes;
            map.u_row = {5.0f, 0.0f, 0.1f};
            map.v_row = {0.0f, 5.0f, 0.2f};
        }
        add_material(scene, material);
    }
    return scene;
}

Clearness clear_in(const Scene& scene) {
    return clearness(scene, {1, 0, 0, 1, 0});
}

struct Tally {
    std::size_t blocked = 0;
    std::size_t crossing = 0;
    std::size_t free = 0;
};

void expect_as_single(const Accel& accel, const Clearness& clear, const Ray& ray,
                      const RayQuery& query, bool blocked, std::span<const Hit> crossed) {
    const std::vector<Hit> hits = accel.intersect_all(ray, query);
    const bool stops = !std::all_of(hits.begin(), hits.end(), [&](const Hit& hit) {
        return is_clear(accel.scene(), clear, object_index(accel.scene(), hit.object),
                        hit.primitive);
    });
    ASSERT_EQ(blocked, stops) << to_text(ray);
    ASSERT_EQ(crossed.size(), stops ? 0 : hits.size()) << to_text(ray);
    for (std::size_t i = 0; i < crossed.size(); ++i)
        ASSERT_EQ(crossed[i], hits[i]) << to_text(ray);
}

// Also where the memory was used before.
Tally expect_as_single(const Accel& accel, const std::vector<Ray>& rays, const RayQuery& query = {},
                       const glm::vec3* end = nullptr) {
    const Clearness clear = clear_in(accel.scene());
    Crossings crossings;
    crossings.hits.resize(3);
    if (end != nullptr) {
        accel.cross_towards(*end, rays, clear, crossings, query);
    } else {
        accel.cross(rays, clear, crossings, query);
    }
    EXPECT_EQ(crossings.blocked.size(), rays.size());
    EXPECT_EQ(crossings.first.size(), rays.size() + 1);
    Tally tally;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool blocked = crossings.blocked[i] != 0;
        expect_as_single(accel, clear, rays[i], query, blocked, crossings.of(i));
        if (testing::Test::HasFatalFailure()) return tally;
        ++(blocked ? tally.blocked : crossings.of(i).empty() ? tally.free : tally.crossing);
    }
    return tally;
}

// From what eye rays see, off it and right on it, to lights beside, among and far from it all.
void expect_shadows_as_single(const Accel& accel, const std::vector<Ray>& eyes,
                              const RayQuery& query = {}) {
    const glm::vec3 extent = accel.bounds().extent();
    for (const glm::vec3& light :
         {accel.bounds().max + 0.3f * extent, accel.bounds().centre() + 0.1f * extent,
          accel.bounds().min - 15.0f * extent}) {
        std::vector<Ray> rays = shadow_rays(accel, eyes, light);
        for (std::size_t i = 0; i < rays.size(); i += 2) {
            const auto hit = accel.intersect(rays[i]);
            if (hit) rays[i].origin = rays[i].at(hit->t);
            rays[i].t_max = glm::distance(rays[i].origin, light) * (1.0f - 1e-6f);
        }
        expect_as_single(accel, rays, query);
        expect_as_single(accel, rays, query, &light);
        const glm::vec3 beside = light + 0.01f * extent;
        expect_as_single(accel, rays, query, &beside);
        if (testing::Test::HasFatalFailure()) return;
    }
}

void expect_all_as_single(const Scene& scene, std::uint64_t seed, const RayQuery& query = {}) {
    const Accel accel = accel_of(scene);
    std::vector<Ray> rays = coherent_rays(accel.bounds(), {24, 48}, Projection::perspective, seed);
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const std::vector<Ray> some = coherent_rays(accel.bounds(), {16, 32}, projection, seed + 1);
        rays.insert(rays.end(), some.begin(), some.end());
    }
    const std::vector<Ray> stray = rays_through(accel.bounds(), seed, 300);
    rays.insert(rays.end(), stray.begin(), stray.end());
    const Tally tally = expect_as_single(accel, rays, query);
    EXPECT_GT(tally.blocked, 0u);
    EXPECT_GT(tally.crossing, 0u);
    EXPECT_GT(tally.free, 0u);
    expect_shadows_as_single(accel, rays, query);
}

std::vector<glm::vec4> small_balls(std::uint64_t seed, int count, float radius) {
    Random random(seed);
    std::vector<glm::vec4> balls;
    for (int i = 0; i < count; ++i)
        balls.emplace_back(glm::vec3(random.point(glm::dvec3(-1.0), glm::dvec3(1.0))), radius);
    return balls;
}

std::vector<glm::vec4> twigs(std::uint64_t seed, int count) {
    Random random(seed);
    std::vector<glm::vec4> ends;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 base = random.point(glm::dvec3(-1.0), glm::dvec3(1.0));
        ends.emplace_back(glm::vec3(base), 0.1f);
        ends.emplace_back(glm::vec3(base + 0.4 * random.direction()), i % 3 == 0 ? 0.1f : 0.02f);
    }
    return ends;
}

// The same set three times: clear, in the way of light, and in an object of its own space.
void place_thrice(Scene& scene, const Shape& shape) {
    place(scene, shape, kGlass, translate({0.3, 0.0, 0.0}));
    place(scene, shape, kGlass, rotate(40.0, {1, 2, 3}) * scale({1.2, -0.8, 0.7}));
    place(scene, shape, kStone, translate({0.0, 2.0, 0.3}) * scale(glm::dvec3(0.4)));
    place(scene, shape, kGlass);
}

TEST_P(AccelCrossings, OfSpheres) {
    Scene scene = scene_of_materials();
    place_thrice(scene, SphereSetInstance{add_sphere_set(
                            scene, make_sphere_set("balls", small_balls(1, 60, 0.2f)))});
    expect_all_as_single(scene, 1);
}

TEST_P(AccelCrossings, OfCones) {
    for (const bool capped : {true, false}) {
        Scene scene = scene_of_materials();
        place_thrice(scene, ConeSetInstance{
                                add_cone_set(scene, make_cone_set("twigs", twigs(2, 40), capped))});
        expect_all_as_single(scene, 2);
    }
}

TEST_P(AccelCrossings, OfMeshes) {
    Scene scene = scene_of_materials();
    place_mesh(scene, soup_data(3, 200, 0.5), kGlass);
    place_thrice(scene, MeshInstance{0});
    place_mesh(scene, ball_data(3), kGlass);
    expect_all_as_single(scene, 3);
}

// Their corners lie in one line to the last bit, and so do the rays' origins: rounding alone says
// on which side of the edges such a ray passes.
TEST_P(AccelCrossings, OfTrianglesWithoutArea) {
    Random random(5);
    MeshData flat;
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < 64; ++i) {
        const auto on_grid = [&] {
            return glm::dvec3(random.below(1000), random.below(1000), random.below(1000)) / 64.0;
        };
        const glm::dvec3 a = on_grid();
        const glm::dvec3 step = on_grid() - a;
        const glm::dvec3 ahead = random.direction();
        for (const double at : {0.0, 1.0, 2.0})
            flat.positions.emplace_back(a + at * step);
        flat.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
        for (int k = 0; k < 64; ++k) {
            const glm::dvec3 from = a + 0.125 * (1 + k % 15) * step;
            rays.push_back(ray_towards(glm::vec3(from), from + ahead + 0.1 * random.direction()));
        }
    }
    Scene scene = scene_of_materials();
    place_mesh(scene, flat, kGlass);
    EXPECT_EQ(expect_as_single(accel_of(scene), rays).free, rays.size());
}

TEST_P(AccelCrossings, OfJoinedMeshes) {
    Scene scene = scene_of_materials();
    for (std::uint64_t i = 0; i < 12; ++i)
        place_mesh(scene, soup_data(i, 60, 0.4), i % 4 == 3 ? kStone : kGlass);
    expect_all_as_single(scene, 4);
}

TEST_P(AccelCrossings, OfJoinedSets) {
    Scene scene = scene_of_materials();
    for (std::uint64_t i = 0; i < 5; ++i) {
        const MaterialId material = std::array{kGlass, kStone, kGlass, kCurtain, kLace}[i];
        place(scene,
              SphereSetInstance{
                  add_sphere_set(scene, make_sphere_set("balls", small_balls(i, 25, 0.15f)))},
              material);
        place(scene,
              ConeSetInstance{add_cone_set(scene, make_cone_set("twigs", twigs(i, 20), true))},
              material);
    }
    scene.objects[4].sides = Sides::front_only;
    expect_all_as_single(scene, 6);
    // Where rays of a group go one by one in the end.
    place_mesh(scene, soup_data(3, 500, 0.2), kGlass);
    expect_all_as_single(scene, 7);
}

TEST_P(AccelCrossings, OfOtherShapes) {
    Scene scene = scene_of_materials();
    int i = 0;
    for (const Shape& shape :
         {Shape{Sphere{{0, 0, 0}, 0.7}}, Shape{Box{{-1, -0.5, -1}, {0.2, 0.4, 0.3}}},
          Shape{Disk{{0, 0, 0}, {0.3, 0.2, 1}, 1.0, 0.2}}, Shape{Torus{{0, 0, 0}, {0, 1, 0.2}}},
          Shape{Cone{{-1, 0, -1}, {0, 1.5, 0}, 0.5, 0.1}},
          Shape{Rectangle{{-1, -1, 0.2}, {2, 0, 0.3}, {0, 2, 0.1}}}}) {
        place(scene, shape, kGlass);
        place(scene, shape, kGlass, rotate(10.0 * ++i, {1, 1, 0}) * scale(glm::dvec3(1.3)));
        place(scene, shape, kStone, translate({2.0, 0.1 * i, 0.4 * i}) * scale(glm::dvec3(0.2)));
    }
    place(scene, Plane{{0.0, 1.0, 0.1}, 1.5}, kGlass);
    place(scene, Plane{{0.0, 1.0, 0.1}, 2.5}, kStone);
    place_mesh(scene, ball_data(2), kGlass, translate({0.5, 0.5, 0.5}));
    const Accel accel = accel_of(scene);
    std::vector<Ray> rays = coherent_rays(accel.bounds(), {32, 48}, Projection::perspective, 5);
    expect_as_single(accel, rays);
    expect_shadows_as_single(accel, rays);
}

// Of one object, some let light through.
TEST_P(AccelCrossings, OfObjectsOfSeveralMaterials) {
    Scene scene = scene_of_materials();
    const std::vector<Part> parts{{0, 30, kGlass}, {30, 2, kStone}, {32, 28, kGlass}};
    place(scene, MeshInstance{add_mesh(scene, make_mesh("soup", soup_data(6, 60, 0.6), parts))});
    place(scene,
          SphereSetInstance{
              add_sphere_set(scene, make_sphere_set("balls", small_balls(7, 60, 0.1f), parts))},
          kNoMaterial, translate({0.2, 0.1, 0.0}));
    place(scene,
          ConeSetInstance{add_cone_set(scene, make_cone_set("twigs", twigs(8, 60), true, parts))});
    expect_all_as_single(scene, 6);
    const Clearness clear = clear_in(scene);
    EXPECT_TRUE(is_clear(scene, clear, 0, 29));
    EXPECT_FALSE(is_clear(scene, clear, 1, 31));
    EXPECT_TRUE(is_clear(scene, clear, 2, 32));
}

TEST_P(AccelCrossings, OfThingsWithHoles) {
    Scene scene = scene_of_materials();
    const SetId balls = add_sphere_set(scene, make_sphere_set("balls", small_balls(9, 40, 0.2f)));
    const SetId cones = add_cone_set(scene, make_cone_set("twigs", twigs(10, 30), true));
    MeshData soup = soup_data(11, 100, 0.6);
    for (std::size_t i = 0; i < soup.positions.size(); ++i)
        soup.uvs.emplace_back(i % 3 == 1 ? 1.0f : 0.0f, i % 3 == 2 ? 1.0f : 0.0f);
    const MeshId mesh = add_mesh(scene, make_mesh("soup", soup));
    for (const MaterialId material : {kLace, kCurtain, kGlass}) {
        const double size = material == kLace ? 0.3 : 1.0;
        const Transform where = translate({0.3 * material, 0.0, 0.0}) * scale(glm::dvec3(size));
        place(scene, SphereSetInstance{balls}, material, where);
        place(scene, ConeSetInstance{cones}, material, where);
        place(scene, MeshInstance{mesh}, material, where);
        place(scene, Rectangle{{-1, -1, 0.2}, {2, 0, 0.3}, {0, 2, 0.1}}, material, where);
    }
    expect_all_as_single(scene, 7);
}

Scene of_everything() {
    Scene scene = scene_of_materials();
    place_mesh(scene, soup_data(12, 150, 0.5), kGlass);
    place_thrice(scene, MeshInstance{0});
    place_thrice(scene, SphereSetInstance{add_sphere_set(
                            scene, make_sphere_set("balls", small_balls(13, 30, 0.2f)))});
    place_thrice(scene,
                 ConeSetInstance{add_cone_set(scene, make_cone_set("twigs", twigs(14, 20), true))});
    place_thrice(scene, Rectangle{{-1, -1, 0.2}, {2, 0, 0.3}, {0, 2, 0.1}});
    return scene;
}

TEST_P(AccelCrossings, OfSidesMasksAndFilters) {
    Scene scene = of_everything();
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        scene.objects[i].mask = i % 4 == 1 ? 2u : 3u;
        if (i % 3 != 0) scene.objects[i].sides = i % 3 == 1 ? Sides::front_only : Sides::back_only;
    }
    expect_all_as_single(scene, 8);
    for (const Sides sides : {Sides::front_only, Sides::back_only}) {
        RayQuery query;
        query.sides = sides;
        query.mask = 1;
        query.uv = false;
        expect_all_as_single(scene, 9, query);
    }
    const std::vector<ClipPlane> planes{{{1.0f, 0.0f, 0.0f}, 0.1f}};
    RayQuery clipped;
    clipped.clip_planes = planes;
    expect_all_as_single(scene, 10, clipped);
    const auto odd = [](const Hit& hit) { return hit.primitive % 2 == 1; };
    RayQuery filtered;
    filtered.accept = odd;
    expect_all_as_single(scene, 11, filtered);
}

// One in the other, face on face, and so many sheets that no short list holds them.
TEST_P(AccelCrossings, OfCoincidentSurfacesAndManySheets) {
    Scene scene = scene_of_materials();
    const SetId balls = add_sphere_set(scene, make_sphere_set("balls", small_balls(15, 20, 0.3f)));
    const MeshId ball = add_mesh(scene, make_mesh("ball", ball_data(2)));
    for (int i = 0; i < 3; ++i) {
        place(scene, SphereSetInstance{balls}, kGlass);
        place(scene, MeshInstance{ball}, kGlass);
        place(scene, Box{{-1, -1, -1}, {0, 0, 0}}, kGlass);
    }
    for (int i = 0; i < 70; ++i) {
        const double z = 0.01 * (i / 2);  // two in each place
        place(scene, Rectangle{{-1, -1, z}, {2, 0, 0}, {0, 2, 0}}, kGlass);
    }
    place(scene, MeshInstance{ball}, kStone, translate({0.5, 0.5, -0.5}) * scale(glm::dvec3(0.2)));
    expect_all_as_single(scene, 12);
    const Accel accel = accel_of(scene);
    std::vector<Ray> through(64, Ray{{0.1f, 0.1f, 5.0f}, {0.0f, 0.0f, -1.0f}});
    Crossings crossings;
    accel.cross(through, clear_in(scene), crossings);
    EXPECT_GT(crossings.of(63).size(), 70u);
}

TEST_P(AccelCrossings, OfRaysOfAllKinds) {
    const Accel accel = accel_of(of_everything());
    const std::vector<Ray> rays =
        coherent_rays(accel.bounds(), {16, 32}, Projection::perspective, 13);
    const auto expect_changed = [&](const auto& change) {
        std::vector<Ray> changed = rays;
        for (std::size_t i = 0; i < changed.size(); i += 3)
            change(changed[i]);
        expect_as_single(accel, changed);
    };
    expect_changed([](Ray& ray) { ray.t_max = 2.0f; });
    expect_changed([](Ray& ray) { ray.t_min = 2.0f; });
    expect_changed([](Ray& ray) { ray.t_min = -1.0f; });
    expect_changed([](Ray& ray) { ray.t_min = -kInfinity; });
    expect_changed([](Ray& ray) { ray.t_max = 0.0f; });
    expect_changed([](Ray& ray) { ray.t_max = kNaN; });
    expect_changed([](Ray& ray) { ray.direction = -ray.direction; });
    expect_changed([](Ray& ray) { ray.direction *= 1e-3f; });
    expect_changed([](Ray& ray) { ray.direction.y = kNaN; });
    expect_changed([](Ray& ray) { ray.direction = glm::vec3(0.0f); });
    expect_changed([](Ray& ray) { ray.origin.x = kInfinity; });
    expect_changed([](Ray& ray) { ray.origin.z = 1e20f; });
    expect_as_single(accel, {});
    for (const int count : {1, 3, 13, 63, 65})
        expect_as_single(accel, {rays.begin(), rays.begin() + count});
    for (const glm::vec3& nowhere : {glm::vec3(kNaN), glm::vec3(kInfinity), glm::vec3(0.0f)})
        expect_as_single(accel, rays, {}, &nowhere);
}

TEST_P(AccelCrossings, OfEmptyAndOfHugeScenes) {
    const Scene nothing = scene_of_materials();
    const std::vector<Ray> rays(70);
    EXPECT_EQ(expect_as_single(accel_of(nothing), rays).free, 70u);
    Scene plane = nothing;
    place(plane, Plane{{0.0, 0.0, 1.0}, 2.0}, kGlass);
    EXPECT_EQ(expect_as_single(accel_of(plane), rays).crossing, 70u);
    Scene huge = nothing;
    place(huge, Sphere{{0, 0, -3e12}, 1e12}, kGlass);
    place(huge, Sphere{{0, 0, -6e12}, 1e12}, kStone);
    EXPECT_EQ(expect_as_single(accel_of(huge), rays).blocked, 70u);
}

// Groups that begin where their neighbours went on.
TEST_P(AccelCrossings, RunsThroughADeepMesh) {
    Scene scene = scene_of_materials();
    place_mesh(scene, soup_data(3, 20000, 0.03), kGlass);
    const Accel accel = accel_of(scene);
    const std::vector<Ray> rays = rays_of_one_octant(accel, {32, 64}, {0.6, -0.4, 0.5});
    EXPECT_GT(expect_as_single(accel, rays).crossing, 500u);
    const glm::vec3 light = accel.bounds().max + 0.3f * accel.bounds().extent();
    expect_as_single(accel, shadow_rays(accel, rays, light), {}, &light);
}

RAYPICK_ON_EACH_INSTRUCTION_SET(AccelCrossings);

TEST(Clearness, IsThatOfTheMaterials) {
    using Of = Clearness::Of;
    Scene scene = scene_of_materials();
    const auto place_soup = [&](const std::vector<Part>& parts, MaterialId material) {
        const MeshId mesh = add_mesh(scene, make_mesh("soup", soup_data(1, 10, 0.5), parts));
        place(scene, MeshInstance{mesh}, material);
    };
    place_soup({}, kNoMaterial);
    place_soup({}, kGlass);
    place_soup({}, kLace);
    place_soup({{0, 4, kGlass}, {4, 6, kCurtain}}, kNoMaterial);
    place_soup({{0, 4, kGlass}, {4, 6, kCurtain}}, kStone);
    place_soup({{0, 4, kStone}, {4, 6, kLace}}, kNoMaterial);
    place_soup({{0, 9, kStone}, {9, 1, kNoMaterial}}, kNoMaterial);
    EXPECT_THAT(clear_in(scene).objects, ElementsAre(Of::nothing, Of::all, Of::nothing, Of::all,
                                                     Of::nothing, Of::nothing, Of::nothing));
    const Clearness rest = clearness(scene, {0, 0, 0, 0, 1});
    EXPECT_THAT(rest.objects, ElementsAre(Of::all, Of::nothing, Of::nothing, Of::nothing,
                                          Of::nothing, Of::nothing, Of::some));
    EXPECT_FALSE(is_clear(scene, rest, 6, 8));
    EXPECT_TRUE(is_clear(scene, rest, 6, 9));
}

// As they are offered, if one primitive is hit twice at one distance.
TEST(SortAlongRay, KeepsTheOrderOfOnePrimitivesHits) {
    for (const std::uint32_t count : {2u, 30u, 200u}) {
        std::vector<Hit> hits;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t shuffled = i * 7 % count;
            const Hit hit{shuffled % 3, shuffled % 2, static_cast<float>(shuffled / 6), {}, true};
            hits.push_back(hit);
            hits.push_back(hit);
            hits.back().front_face = false;
        }
        sort_along_ray(hits);
        for (std::size_t i = 0; i + 1 < hits.size(); ++i) {
            const auto key = [](const Hit& hit) {
                return std::tuple(hit.t, hit.object, hit.primitive, !hit.front_face);
            };
            ASSERT_LE(key(hits[i]), key(hits[i + 1])) << i;
        }
    }
}

}  // namespace
}  // namespace raypick
