// Meshes that stand where they are and nowhere else share a tree, and whose its triangles are is
// known whatever happens to their objects later.
#include "tracer/accel/joined_tree.h"
#include "tests/each_instruction_set.h"
#include "tests/ray_batches.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/accel.h"
#include "tracer/accel/trees.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <utility>
#include <vector>

namespace raypick {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::IsNull;
using ::testing::Not;
using ::testing::NotNull;

// Meshes 0 to 11 through one another, one object each.
Scene soups() {
    Scene scene;
    for (std::uint64_t seed = 0; seed < 12; ++seed)
        place_mesh(scene, soup_data(seed, 120 + 40 * static_cast<std::uint32_t>(seed), 0.4));
    return scene;
}

Accel with_trees_of(const Accel& before, const Scene& scene) {
    return Accel(std::make_shared<const Scene>(scene), {}, &before);
}

std::vector<MeshId> joined_in(const Scene& scene) {
    std::vector<MeshId> ids;
    for (const JoinableMesh& joinable : joinable_meshes(scene, {}))
        ids.push_back(static_cast<MeshId>(joinable.mesh - scene.meshes.data()));
    return ids;
}

// Of small ones among large ones, and of just one.
TEST(JoinedMeshes, KnowWhoseEachTriangleIs) {
    for (const std::vector<std::size_t>& sizes :
         {std::vector<std::size_t>{7}, {1, 1, 1}, {1, 900, 2, 1, 1, 1, 5000, 3}}) {
        std::vector<Mesh> meshes(sizes.size());
        std::vector<const Mesh*> pointers;
        std::vector<std::size_t> expected;
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            meshes[i].triangles = std::vector<glm::uvec3>(sizes[i]);
            pointers.push_back(&meshes[i]);
            expected.insert(expected.end(), sizes[i], i);
        }
        const JoinedMeshes joined(pointers);
        ASSERT_EQ(joined.triangles(), expected.size());
        for (std::size_t triangle = 0; triangle < expected.size(); ++triangle)
            EXPECT_EQ(joined.member_of(triangle), expected[triangle]) << "triangle " << triangle;
    }
}

TEST(JoinableMeshes, StandWhereTheyAreAndNowhereElse) {
    Scene scene = soups();
    scene.objects[1].world_from_object = translate({0.0, 1e-9, 0.0});
    place(scene, MeshInstance{3});
    place_mesh(scene, MeshData{});
    add_mesh(scene, make_mesh("nobody's", ball_data(1)));
    EXPECT_THAT(joined_in(scene), ElementsAre(0u, 2u, 4u, 5u, 6u, 7u, 8u, 9u, 10u, 11u));
}

TEST(JoinableMeshes, AreInEachOthersWay) {
    Scene scene;
    for (int i = 0; i < 4; ++i)
        place_mesh(scene, ball_data(1));
    EXPECT_THAT(joined_in(scene), IsEmpty());
    for (int i = 0; i < 2; ++i)
        place_mesh(scene, ball_data(1));
    EXPECT_THAT(joined_in(scene), ElementsAre(0u, 1u, 2u, 3u, 4u, 5u));
    MeshData far_away = ball_data(1);
    for (glm::vec3& position : far_away.positions)
        position.x += 10.0f;
    place_mesh(scene, far_away);
    EXPECT_THAT(joined_in(scene), IsEmpty());
}

TEST(JoinedTree, StandsForTheTreesOfItsMeshes) {
    Scene scene = soups();
    place(scene, MeshInstance{2}, kNoMaterial, translate({0.5, 0.0, 0.0}));
    const SceneTrees trees = build_trees(scene, {}, nullptr);
    ASSERT_THAT(trees.joined_meshes.tree, NotNull());
    EXPECT_EQ(trees.joined_meshes.tree->members.size(), 11u);
    for (MeshId mesh = 0; mesh < 12; ++mesh)
        EXPECT_EQ(trees.meshes[mesh] != nullptr, mesh == 2) << mesh;
    const BuildOptions first{.quality = TreeQuality::first};
    EXPECT_THAT(build_trees(scene, first, nullptr).joined_meshes.tree, IsNull());
}

TEST(JoinedTree, StaysWhenAnObjectIsMoved) {
    Scene scene = soups();
    const SceneTrees before = build_trees(scene, {}, nullptr);
    scene.objects[4].world_from_object = translate({0.2, 0.0, 0.0});
    const SceneTrees after = build_trees(scene, {}, &before);
    EXPECT_EQ(after.joined_meshes.tree, before.joined_meshes.tree);
    EXPECT_THAT(after.joined_meshes.objects,
                ElementsAre(0u, 1u, 2u, 3u, kNobody, 5u, 6u, 7u, 8u, 9u, 10u, 11u));
    EXPECT_THAT(after.meshes[4], NotNull());
    EXPECT_THAT(after.meshes[3], IsNull());
    scene.objects[4].world_from_object = {};
    const SceneTrees back = build_trees(scene, {}, &after);
    EXPECT_EQ(back.joined_meshes.tree, before.joined_meshes.tree);
    EXPECT_THAT(back.joined_meshes.objects, Not(Contains(kNobody)));
    EXPECT_THAT(back.meshes[4], IsNull());
}

TEST(JoinedTree, IsBuiltAnewWhenMostOfItIsGone) {
    Scene scene = soups();
    const SceneTrees before = build_trees(scene, {}, nullptr);
    for (std::size_t i = 6; i < 12; ++i)
        scene.objects[i].world_from_object = translate({0.2, 0.0, 0.0});
    const SceneTrees after = build_trees(scene, {}, &before);
    ASSERT_THAT(after.joined_meshes.tree, NotNull());
    EXPECT_NE(after.joined_meshes.tree, before.joined_meshes.tree);
    EXPECT_THAT(after.joined_meshes.objects, ElementsAre(0u, 1u, 2u, 3u, 4u, 5u));
    for (std::size_t i = 2; i < 6; ++i)
        scene.objects[i].world_from_object = translate({0.2, 0.0, 0.0});
    EXPECT_THAT(build_trees(scene, {}, &after).joined_meshes.tree, IsNull());
}

TEST(JoinedTree, IsNotBuiltForWhatHasTrees) {
    Scene scene;
    for (int i = 0; i < 4; ++i)
        place_mesh(scene, ball_data(1));
    const SceneTrees before = build_trees(scene, {}, nullptr);
    for (int i = 0; i < 4; ++i)
        place_mesh(scene, ball_data(1));
    const SceneTrees after = build_trees(scene, {}, &before);
    EXPECT_THAT(after.joined_meshes.tree, IsNull());
    EXPECT_EQ(after.meshes[3], before.meshes[3]);
    EXPECT_THAT(build_trees(scene, {}, nullptr).joined_meshes.tree, NotNull());
    const SceneTrees first = build_trees(scene, {.quality = TreeQuality::first}, nullptr);
    EXPECT_THAT(build_trees(scene, {}, &first).joined_meshes.tree, NotNull());
}

TEST(JoinedTree, IsTheSameForAnyNumberOfThreads) {
    const Scene scene = soups();
    const SceneTrees one = build_trees(scene, {.threads = 1}, nullptr);
    const SceneTrees three = build_trees(scene, {.threads = 3}, nullptr);
    const auto& a = one.joined_meshes.tree->tree;
    const auto& b = three.joined_meshes.tree->tree;
    ASSERT_EQ(a.patches.bytes(), b.patches.bytes());
    EXPECT_EQ(std::memcmp(a.patches.blocks.data(), b.patches.blocks.data(), a.patches.bytes()), 0);
}

class JoinedRays : public OnInstructionSet {};

TEST_P(JoinedRays, MeetTheMeshes) {
    Scene scene = soups();
    scene.objects[3].sides = Sides::front_only;
    scene.objects[5].sides = Sides::back_only;
    place(scene, MeshInstance{2}, kNoMaterial, rotate(30.0, {0, 1, 0}));
    expect_all_ways(scene, 3);
}

TEST_P(JoinedRays, TellWhoseTrianglesInOnePlaceAre) {
    Scene scene;
    for (const std::uint32_t mask : {1u, 2u, 3u, 1u, 2u, 3u}) {
        place_mesh(scene, ball_data(2));
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
        const auto hit = accel.intersect({{0.1f, 0.2f, 5.0f}, {0, 0, -1}}, query);
        ASSERT_EQ(hit.has_value(), mask != 4);
        if (hit) {
            EXPECT_EQ(hit->object, scene.objects[mask - 1].id);
        }
    }
}

TEST_P(JoinedRays, MeetNothingWhereAnObjectWas) {
    Scene scene = soups();
    const Accel before = accel_of(scene);
    scene.objects[4].world_from_object = translate({0.7, 0.0, 0.0});
    scene.objects.erase(scene.objects.begin() + 1);
    const Accel after = with_trees_of(before, scene);
    const Accel anew = accel_of(scene);
    EXPECT_GT(after.stats().nodes, anew.stats().nodes);  // there still is what was joined
    EXPECT_EQ(after.bounds().min, anew.bounds().min);
    EXPECT_EQ(after.bounds().max, anew.bounds().max);
    expect_all_ways(after, 5);
}

RAYPICK_ON_EACH_INSTRUCTION_SET(JoinedRays);

}  // namespace
}  // namespace raypick
