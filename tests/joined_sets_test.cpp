// Sets of spheres and cones that stand where they are and nowhere else share a tree, and whose its
// elements are is known whatever happens to their objects later.
#include "tracer/accel/joined_sets.h"
#include "tests/each_instruction_set.h"
#include "tests/ray_batches.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/accel/joined_tree.h"
#include "tracer/accel/trees.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <variant>
#include <vector>

namespace raypick {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::IsNull;
using ::testing::Not;
using ::testing::NotNull;

std::vector<glm::vec4> points(std::uint64_t seed, std::size_t count, float radius) {
    Random random(seed);
    std::vector<glm::vec4> at;
    for (std::size_t i = 0; i < count; ++i)
        at.emplace_back(glm::vec3(random.point(glm::dvec3(-1.0), glm::dvec3(1.0))), radius);
    return at;
}

SetId add_spheres(Scene& scene, std::uint64_t seed, std::size_t count = 90) {
    return add_sphere_set(scene, make_sphere_set("atoms", points(seed, count, 0.12f)));
}

SetId add_cones(Scene& scene, std::uint64_t seed, bool capped, std::size_t count = 90) {
    Random random(seed);
    std::vector<glm::vec4> ends;
    for (const glm::vec4& base : points(seed + 100, count, 0.06f)) {
        ends.push_back(base);
        ends.emplace_back(glm::vec3(base) + glm::vec3(0.3 * random.direction()), 0.03f);
    }
    return add_cone_set(scene, make_cone_set("bonds", std::move(ends), capped));
}

// Objects 0 to 5 through one another: three sets of spheres, three of capped cones.
Scene molecule(std::size_t elements_of_each = 90) {
    Scene scene;
    for (std::uint64_t seed = 0; seed < 3; ++seed)
        place(scene, SphereSetInstance{add_spheres(scene, seed, elements_of_each)});
    for (std::uint64_t seed = 3; seed < 6; ++seed)
        place(scene, ConeSetInstance{add_cones(scene, seed, true, elements_of_each)});
    return scene;
}

// Of each set: threads take them in portions of 16384.
constexpr std::size_t kForSeveralThreads = 9000;

std::vector<std::size_t> sizes_joined_in(const Scene& scene) {
    std::vector<std::size_t> sizes;
    for (const JoinableSet& joinable : joinable_sets(scene, {}))
        sizes.push_back(joinable.size());
    return sizes;
}

TEST(JoinableSets, StandWhereTheyAreAndNowhereElse) {
    Scene scene;
    place(scene, ConeSetInstance{add_cones(scene, 1, true, 50)});
    for (const std::size_t count : {60u, 70u, 80u})
        place(scene, SphereSetInstance{add_spheres(scene, count, count)});
    place(scene, ConeSetInstance{add_cones(scene, 2, true, 55)});
    EXPECT_THAT(sizes_joined_in(scene), ElementsAre(60u, 70u, 80u, 50u, 55u));
    scene.objects[1].world_from_object = translate({0.0, 1e-9, 0.0});
    place(scene, SphereSetInstance{1});
    EXPECT_THAT(sizes_joined_in(scene), ElementsAre(80u, 50u, 55u));
}

TEST(JoinableSets, OfConesAreOfTheKindThatThereIsMoreOf) {
    Scene scene;
    for (const bool capped : {true, false, true, false})
        place(scene, ConeSetInstance{add_cones(scene, 1, capped, capped ? 50 : 60)});
    EXPECT_THAT(sizes_joined_in(scene), ElementsAre(60u, 60u));
    place(scene, ConeSetInstance{add_cones(scene, 1, true, 50)});
    EXPECT_THAT(sizes_joined_in(scene), ElementsAre(50u, 50u, 50u));
}

TEST(JoinableSets, AreInEachOthersWay) {
    Scene scene;
    place(scene, SphereSetInstance{add_spheres(scene, 1)});
    EXPECT_THAT(sizes_joined_in(scene), IsEmpty());
    std::vector<glm::vec4> far_away = points(2, 90, 0.1f);
    for (glm::vec4& sphere : far_away)
        sphere.x += 4.0f;
    place(scene, SphereSetInstance{add_sphere_set(scene, make_sphere_set("", far_away))});
    EXPECT_THAT(sizes_joined_in(scene), IsEmpty());
    Scene together;
    for (std::uint64_t seed = 1; seed < 3; ++seed)
        place(together, SphereSetInstance{add_spheres(together, seed)});
    EXPECT_THAT(sizes_joined_in(together), ElementsAre(90u, 90u));
}

TEST(JoinedSets, StandForTheTreesOfEach) {
    Scene scene = molecule();
    place(scene, SphereSetInstance{1}, kNoMaterial, translate({0.5, 0.0, 0.0}));
    const SceneTrees trees = build_trees(scene, {}, nullptr);
    ASSERT_THAT(trees.joined_sets.tree, NotNull());
    EXPECT_THAT(trees.joined_sets.objects, ElementsAre(0u, 2u, 3u, 4u, 5u));
    EXPECT_THAT(trees.sphere_sets, ElementsAre(IsNull(), NotNull(), IsNull()));
    EXPECT_THAT(trees.cone_sets, ElementsAre(IsNull(), IsNull(), IsNull()));
    const BuildOptions first{.quality = TreeQuality::first};
    EXPECT_THAT(build_trees(scene, first, nullptr).joined_sets.tree, IsNull());
}

// A leaf's elements are what its indices say, the spheres first.
TEST(JoinedSets, LeavesHoldWhatTheSetsHave) {
    const Scene scene = molecule(kForSeveralThreads);
    const SceneTrees trees = build_trees(scene, {}, nullptr);
    const PrimitiveTree& tree = trees.joined_sets.tree->tree;
    std::vector<int> seen(6 * kForSeveralThreads);
    for (std::size_t first = 0; first < tree.bvh.indices.size();) {
        const WideRef ref = WideRef::leaf(static_cast<std::uint32_t>(first));
        const JoinedLeaf leaf = joined_leaf(tree.bvh, tree.elements, ref);
        for (std::size_t i = 0; i < leaf.spheres + leaf.cones; ++i) {
            const auto [member, primitive] = leaf.elements[i];
            ++seen[kForSeveralThreads * member + primitive];
            ASSERT_EQ(i < leaf.spheres, member < 3);
            const glm::vec4* row = leaf.rows + tree.elements.stride * i;
            if (member < 3) {
                ASSERT_EQ(row[0], scene.sphere_sets[member].spheres[primitive]);
            } else {
                const auto& ends = scene.cone_sets[member - 3].ends;
                ASSERT_EQ(row[0], ends[std::size_t{2} * primitive]);
                ASSERT_EQ(row[1], ends[std::size_t{2} * primitive + 1]);
            }
        }
        first += indices_of(tree.bvh, ref).size();
    }
    EXPECT_THAT(seen, Each(1));
    EXPECT_TRUE(tree.elements.capped);
}

TEST(JoinedSets, StayWhenAnObjectIsMoved) {
    Scene scene = molecule();
    const SceneTrees before = build_trees(scene, {}, nullptr);
    scene.objects[4].world_from_object = translate({0.2, 0.0, 0.0});
    const SceneTrees after = build_trees(scene, {}, &before);
    EXPECT_EQ(after.joined_sets.tree, before.joined_sets.tree);
    EXPECT_THAT(after.joined_sets.objects, ElementsAre(0u, 1u, 2u, 3u, kNobody, 5u));
    EXPECT_THAT(after.cone_sets, ElementsAre(IsNull(), NotNull(), IsNull()));
    scene.objects[4].world_from_object = {};
    const SceneTrees back = build_trees(scene, {}, &after);
    EXPECT_EQ(back.joined_sets.tree, before.joined_sets.tree);
    EXPECT_THAT(back.joined_sets.objects, Not(Contains(kNobody)));
    for (std::size_t i = 0; i < 3; ++i)
        scene.objects[i].world_from_object = translate({0.2, 0.0, 0.0});
    const SceneTrees half = build_trees(scene, {}, &before);
    EXPECT_NE(half.joined_sets.tree, before.joined_sets.tree);
    EXPECT_THAT(half.joined_sets.objects, ElementsAre(3u, 4u, 5u));
}

TEST(JoinedSets, AreNotJoinedWhereTheyHaveTrees) {
    Scene scene;
    place(scene, SphereSetInstance{add_spheres(scene, 1)});
    const SceneTrees before = build_trees(scene, {}, nullptr);
    place(scene, ConeSetInstance{add_cones(scene, 2, false)});
    const SceneTrees after = build_trees(scene, {}, &before);
    EXPECT_THAT(after.joined_sets.tree, IsNull());
    EXPECT_EQ(after.sphere_sets[0], before.sphere_sets[0]);
    EXPECT_THAT(build_trees(scene, {}, nullptr).joined_sets.tree, NotNull());
    const SceneTrees first = build_trees(scene, {.quality = TreeQuality::first}, nullptr);
    EXPECT_THAT(build_trees(scene, {}, &first).joined_sets.tree, NotNull());
}

TEST(JoinedSets, AreTheSameForAnyNumberOfThreads) {
    const Scene scene = molecule(kForSeveralThreads);
    const SceneTrees one = build_trees(scene, {.threads = 1}, nullptr);
    const SceneTrees three = build_trees(scene, {.threads = 3}, nullptr);
    const JoinedElements& a = one.joined_sets.tree->tree.elements;
    const JoinedElements& b = three.joined_sets.tree->tree.elements;
    ASSERT_EQ(a.bytes(), b.bytes());
    EXPECT_EQ(std::memcmp(a.rows.data(), b.rows.data(), a.rows.size() * sizeof(a.rows[0])), 0);
    EXPECT_EQ(std::memcmp(a.elements.data(), b.elements.data(),
                          a.elements.size() * sizeof(a.elements[0])),
              0);
}

class JoinedSetRays : public OnInstructionSet {};

TEST_P(JoinedSetRays, MeetSpheresAndCones) {
    Scene scene = molecule();
    scene.objects[1].sides = Sides::front_only;
    scene.objects[2].sides = Sides::back_only;
    scene.objects[4].sides = Sides::back_only;
    place(scene, ConeSetInstance{add_cones(scene, 9, false)});
    place(scene, SphereSetInstance{1}, kNoMaterial, rotate(30.0, {0, 1, 0}));
    place_mesh(scene, soup_data(4, 50, 0.4));
    expect_all_ways(scene, 3);
}

TEST_P(JoinedSetRays, MeetSpheresOnly) {
    Scene scene;
    for (std::uint64_t seed = 0; seed < 4; ++seed)
        place(scene, SphereSetInstance{add_spheres(scene, seed)});
    expect_all_ways(scene, 4);
}

TEST_P(JoinedSetRays, MeetOpenConesOnly) {
    Scene scene;
    for (std::uint64_t seed = 0; seed < 3; ++seed)
        place(scene, ConeSetInstance{add_cones(scene, seed, false)});
    expect_all_ways(scene, 5);
}

// Rays come in through the caps, or through open ends, and out of the side.
TEST_P(JoinedSetRays, TellOpenConesFromCappedOnes) {
    Scene scene;
    for (const bool capped : {true, false, true, false, true}) {
        std::vector<glm::vec4> ends = points(scene.objects.size(), 80, 0.12f);
        for (std::size_t i = 1; i < ends.size(); i += 2)
            ends[i] = ends[i - 1] + glm::vec4(0.0f, 0.1f, 0.03f, 0.02f);
        place(scene, ConeSetInstance{add_cone_set(scene, make_cone_set("", ends, capped))});
    }
    expect_all_ways(scene, 6);
    const Accel accel = accel_of(scene);
    const Accel apart(std::make_shared<const Scene>(scene), {.quality = TreeQuality::first});
    const std::vector<Ray> rays = rays_through(accel.bounds(), 7, 3000);
    expect_as_one_by_one(accel, rays);
    for (const Ray& ray : rays)
        ASSERT_EQ(accel.intersect(ray), apart.intersect(ray)) << to_text(ray);
}

// Where there are more triangles, shadow rays go from the light to what it shines on.
TEST_P(JoinedSetRays, AreFollowedBackwards) {
    Scene scene = molecule();
    place_mesh(scene, soup_data(5, 1500, 0.05));
    for (const Sides sides : {Sides::both, Sides::front_only, Sides::back_only}) {
        for (Object& object : scene.objects)
            object.sides = sides;
        const Accel accel = accel_of(scene);
        expect_shadows_as_one_by_one(
            accel, coherent_rays(accel.bounds(), {24, 32}, Projection::perspective, 4));
    }
}

TEST_P(JoinedSetRays, SeeOneSideIfAskedTo) {
    const Accel accel = accel_of(molecule());
    const std::vector<Ray> rays =
        coherent_rays(accel.bounds(), {16, 16}, Projection::perspective, 4);
    const std::vector<Ray> scattered = rays_through(accel.bounds(), 5, 500);
    for (const Sides sides : {Sides::front_only, Sides::back_only}) {
        RayQuery query;
        query.sides = sides;
        expect_as_one_by_one(accel, rays, query);
        expect_as_one_by_one(accel, scattered, query);
        const auto hit = accel.intersect(rays[70], query);
        if (hit) {
            EXPECT_EQ(hit->front_face, sides == Sides::front_only);
        }
    }
}

TEST_P(JoinedSetRays, TellWhoseElementsInOnePlaceAre) {
    Scene scene;
    for (const std::uint32_t mask : {1u, 2u, 3u, 1u, 2u, 3u}) {
        place(scene, SphereSetInstance{add_spheres(scene, 7)});
        scene.objects.back().mask = mask;
        place(scene, ConeSetInstance{add_cones(scene, 8, true)});
        scene.objects.back().mask = mask;
    }
    const Accel accel = accel_of(scene);
    const std::vector<Ray> rays =
        coherent_rays(accel.bounds(), {16, 16}, Projection::perspective, 4);
    for (const std::uint32_t mask : {1u, 2u, 4u}) {
        RayQuery query;
        query.mask = mask;
        expect_as_one_by_one(accel, rays, query, mask == 4 ? Hits::perhaps : Hits::some);
        expect_shadows_as_one_by_one(accel, rays, query);
        std::vector<Hit> hits(rays.size());
        accel.intersect(rays, hits, query);
        for (const Hit& hit : hits) {
            if (!hit.valid()) continue;
            const std::size_t first = mask == 1 ? 0 : 2;
            ASSERT_THAT(hit.object,
                        ::testing::AnyOf(scene.objects[first].id, scene.objects[first + 1].id));
        }
    }
}

TEST_P(JoinedSetRays, GoThroughHoles) {
    Scene scene = molecule();
    const MaterialId sieve = add_sieve(scene);
    for (const std::size_t object : {0u, 2u, 4u})
        scene.objects[object].material = sieve;
    const Accel accel = accel_of(scene);
    const Accel apart(std::make_shared<const Scene>(scene), {.quality = TreeQuality::first});
    std::vector<Ray> rays = coherent_rays(accel.bounds(), {16, 16}, Projection::perspective, 6);
    for (const Ray& ray : rays_through(accel.bounds(), 6, 500))
        rays.push_back(ray);
    expect_as_one_by_one(accel, rays);
    for (const Ray& ray : rays)
        ASSERT_EQ(accel.intersect(ray), apart.intersect(ray)) << to_text(ray);
}

TEST_P(JoinedSetRays, MeetNothingWhereAnObjectWas) {
    Scene edited = molecule();
    auto before = std::make_unique<const Accel>(std::make_shared<const Scene>(edited));
    edited.objects[4].world_from_object = translate({0.7, 0.0, 0.0});
    // The first set is gone with its array.
    edited.objects.erase(edited.objects.begin());
    edited.sphere_sets.erase(edited.sphere_sets.begin());
    for (Object& object : edited.objects) {
        if (auto* spheres = std::get_if<SphereSetInstance>(&object.shape)) --spheres->set;
    }
    const Accel after(std::make_shared<const Scene>(edited), {}, before.get());
    before.reset();
    const Accel anew = accel_of(edited);
    EXPECT_GT(after.stats().bytes, anew.stats().bytes);  // there still is what was joined
    EXPECT_EQ(after.bounds().min, anew.bounds().min);
    EXPECT_EQ(after.bounds().max, anew.bounds().max);
    expect_all_ways(after, 5);
}

// One array as spheres and as cones, and as cones of both kinds.
TEST_P(JoinedSetRays, TellSetsOfOneArrayApart) {
    std::vector<glm::vec4> rows = points(1, 60, 0.1f);
    for (std::size_t i = 1; i < rows.size(); i += 2)
        rows[i] = rows[i - 1] + glm::vec4(0.3f, 0.1f, 0.2f, -0.05f);
    const auto shared = std::make_shared<const std::vector<glm::vec4>>(rows);
    const auto placed = [&](std::initializer_list<int> kinds) {
        Scene scene;
        for (const int kind : kinds) {
            if (kind == 0) {
                place(scene, SphereSetInstance{add_sphere_set(scene, {"", *shared, {}, shared})});
            } else {
                place(scene,
                      ConeSetInstance{add_cone_set(scene, {"", *shared, kind == 2, {}, shared})});
            }
        }
        return scene;
    };
    for (const auto& kinds : {std::initializer_list<int>{1, 0}, {0, 2}, {2, 1, 0}, {2, 1, 1}})
        expect_all_ways(placed(kinds), 6);
    // An edit makes open cones of capped ones, and the set of spheres shorter.
    const Scene before = placed({2, 0, 2, 0, 2});
    const Accel accel = accel_of(before);
    Scene edited = before;
    edited.cone_sets[0].capped = false;
    edited.sphere_sets[1].spheres = edited.sphere_sets[1].spheres.first(40);
    expect_all_ways(Accel(std::make_shared<const Scene>(edited), {}, &accel), 7);
}

// What came to stand in the memory of a set that is gone is another set.
TEST_P(JoinedSetRays, ForgetWhatIsGone) {
    std::vector<glm::vec4> borrowed = points(1, 90, 0.1f);
    Scene scene = molecule();
    place(scene, SphereSetInstance{add_sphere_set(scene, {"", borrowed, {}, nullptr})});
    const Accel with = accel_of(scene);
    Scene without = scene;
    without.objects.pop_back();
    without.sphere_sets.pop_back();
    const Accel gone(std::make_shared<const Scene>(without), {}, &with);
    const std::vector<glm::vec4> others = points(2, 90, 0.2f);
    std::copy(others.begin(), others.end(), borrowed.begin());
    const Accel back(std::make_shared<const Scene>(scene), {}, &gone);
    EXPECT_GT(back.stats().nodes, gone.stats().nodes);
    expect_all_ways(back, 8);
}

TEST_P(JoinedSetRays, MeetWhatIsBesideHugeThings) {
    Scene scene = molecule();
    const glm::vec4 huge(3e38f, 0.0f, 0.0f, 3e38f);
    place(scene, SphereSetInstance{
                     add_sphere_set(scene, make_sphere_set("", {huge, {0.0f, 0.0f, 0.0f, 0.2f}}))});
    const Accel accel = accel_of(scene);
    EXPECT_LT(accel.bounds().max.x, 10.0f);
    expect_as_one_by_one(accel,
                         coherent_rays(accel.bounds(), {16, 16}, Projection::perspective, 1));
    const Scene far = [] {
        Scene made = molecule();
        for (const float at : {1e6f, 1e13f})
            place(made, SphereSetInstance{add_sphere_set(
                            made, make_sphere_set("", {{at, 0, 0, at / 4}, {0, 0, 0, 0.2f}}))});
        return made;
    }();
    std::vector<Ray> rays = rays_through({glm::vec3(-1.0f), glm::vec3(1.0f)}, 2, 500);
    expect_as_one_by_one(accel_of(far), rays);
}

TEST_P(JoinedSetRays, MeetWhatQueriesAdmit) {
    const Accel accel = accel_of(molecule());
    const std::vector<Ray> rays =
        coherent_rays(accel.bounds(), {16, 16}, Projection::perspective, 9);
    const ClipPlane plane{{1, 0, 0}, 0.1f};
    RayQuery query;
    query.clip_planes = {&plane, 1};
    expect_as_one_by_one(accel, rays, query);
    const auto odd = [](const Hit& hit) { return hit.primitive % 2 == 1; };
    query.accept = odd;
    expect_as_one_by_one(accel, rays, query);
}

// More than a group can keep in mind.
TEST_P(JoinedSetRays, MeetTheFirstOfManyInOnePlace) {
    Scene scene;
    for (int i = 0; i < 150; ++i) {
        place(scene, SphereSetInstance{add_spheres(scene, 7, 20)});
        place(scene, ConeSetInstance{add_cones(scene, 8, true, 20)});
    }
    const Accel accel = accel_of(scene);
    expect_as_one_by_one(accel,
                         coherent_rays(accel.bounds(), {16, 16}, Projection::perspective, 2));
    expect_as_one_by_one(accel, rays_through(accel.bounds(), 3, 300));
}

RAYPICK_ON_EACH_INSTRUCTION_SET(JoinedSetRays);

}  // namespace
}  // namespace raypick
