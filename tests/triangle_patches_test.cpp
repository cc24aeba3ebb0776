// The triangles of a mesh's leaves: each exactly once, its corners bit for bit the mesh's.
#include "tracer/accel/triangle_patches.h"
#include "tests/one_leaf.h"
#include "tests/random.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/trace_rays.h"
#include "tracer/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace raypick {
namespace {

WideBvh tree_over(const Mesh& mesh) {
    const BoxSource boxes = [&mesh](std::size_t first, std::span<Bounds> wanted) {
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const glm::uvec3 t = mesh.triangles[first + i];
            wanted[i] = {};
            for (int k = 0; k < 3; ++k)
                wanted[i].extend(mesh.positions[t[k]]);
        }
    };
    return widen(build_bvh(mesh.triangles.size(), boxes,
                           {.costs = kWideSurfaceLeaves, .threads = 1, .stop = {}}));
}

std::vector<WideRef> leaves_of(const WideBvh& bvh) {
    if (bvh.root.is_leaf()) return {bvh.root};
    std::vector<WideRef> leaves;
    for (const WideNode& node : bvh.nodes) {
        for (std::uint32_t i = 0; i < kWidth; ++i) {
            if (node.child[i] != WideRef::kNothing && node.ref(i).is_leaf()) {
                leaves.push_back(node.ref(i));
            }
        }
    }
    return leaves;
}

// Primitives leaf by leaf, sorted there.
std::vector<std::vector<std::uint32_t>> primitives_by_leaf(const WideBvh& bvh) {
    std::vector<std::vector<std::uint32_t>> result;
    for (const WideRef& leaf : leaves_of(bvh)) {
        result.emplace_back();
        each_index(bvh, leaf, [&](std::uint32_t index) {
            result.back().push_back(index);
            return false;
        });
        std::sort(result.back().begin(), result.back().end());
    }
    return result;
}

bool same_bits(const glm::vec3& a, const glm::vec3& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

void expect_well_formed(const TrianglePatch& patch, const Mesh& mesh) {
    ASSERT_GE(patch.triangles, 1u);
    ASSERT_LE(patch.triangles, TrianglePatch::kMostTriangles);
    ASSERT_GE(patch.corners, 1u);
    ASSERT_LE(patch.corners, TrianglePatch::kMostCorners);
    for (std::uint32_t i = 0; i < TrianglePatch::kMostTriangles; ++i) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t number = (patch.corner[k] >> (4 * i)) & 15u;
            ASSERT_LT(number, i < patch.triangles ? patch.corners : 1u);
            if (i >= patch.triangles) continue;
            const std::uint32_t corner = mesh.triangles[patch.primitives()[i]][k];
            ASSERT_TRUE(same_bits(patch.position(i, k), mesh.positions[corner]));
        }
    }
}

// Corners that share a position share a number; so no two of a patch's are the same.
void expect_no_corner_twice(const TrianglePatch& patch) {
    for (std::uint32_t i = 0; i < patch.corners; ++i) {
        for (std::uint32_t k = 0; k < i; ++k) {
            const auto at = [&patch](std::uint32_t n) {
                return glm::vec3(patch.along(0)[n], patch.along(1)[n], patch.along(2)[n]);
            };
            ASSERT_FALSE(same_bits(at(i), at(k)));
        }
    }
}

// Reading the corners as rays do, sixteen numbers from each axis' first on, stays within.
void expect_readable(const TrianglePatches& patches, const TrianglePatch& patch) {
    const auto* end = reinterpret_cast<const float*>(patches.blocks.data() + patches.blocks.size());
    for (int axis = 0; axis < 3; ++axis)
        ASSERT_LE(patch.along(axis) + TrianglePatch::kMostCorners, end);
}

// How many patches each leaf has.
std::vector<int> expect_takes_all(const Mesh& mesh, WideBvh bvh, int threads) {
    const auto before = primitives_by_leaf(bvh);
    const TrianglePatches patches = take_triangles(bvh, mesh, threads, {});
    EXPECT_EQ(bvh.indices.capacity(), 0u);
    const std::vector<WideRef> leaves = leaves_of(bvh);
    EXPECT_EQ(leaves.size(), before.size());
    std::vector<int> chains(leaves.size());
    std::vector<std::uint32_t> all;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        std::vector<std::uint32_t> primitives;
        each_patch(patches, leaves[i], [&](const TrianglePatch& patch) {
            ++chains[i];
            expect_well_formed(patch, mesh);
            expect_no_corner_twice(patch);
            expect_readable(patches, patch);
            const std::uint32_t* first = patch.primitives();
            primitives.insert(primitives.end(), first, first + patch.triangles);
            return testing::Test::HasFatalFailure();
        });
        std::sort(primitives.begin(), primitives.end());
        EXPECT_EQ(primitives, before[i]);
        all.insert(all.end(), primitives.begin(), primitives.end());
    }
    std::sort(all.begin(), all.end());
    EXPECT_EQ(all.size(), mesh.triangles.size());
    EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
    return chains;
}

Mesh mesh_of(MeshData data) {
    return make_mesh("mesh", std::move(data));
}

// `count` triangles in one place.
Mesh coincident(std::size_t count) {
    MeshData data;
    data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.triangles.assign(count, {0, 1, 2});
    return mesh_of(data);
}

TEST(TrianglePatches, HoldEachTriangleOnce) {
    const std::vector<Mesh> meshes = {mesh_of(ball_data(0)), mesh_of(ball_data(5)),
                                      mesh_of(soup_data(1, 2000, 0.1)), mesh_of(soup_data(2, 1, 1)),
                                      mesh_of(soup_data(3, 9, 0.5))};
    for (const Mesh& mesh : meshes) {
        SCOPED_TRACE(mesh.triangles.size());
        expect_takes_all(mesh, tree_over(mesh), 2);
    }
}

TEST(TrianglePatches, ShareCorners) {
    const Mesh mesh = mesh_of(ball_data(5));
    const Mesh soup = mesh_of(soup_data(1, 8192, 0.01));
    WideBvh bvh = tree_over(mesh);
    WideBvh other = tree_over(soup);
    const auto a_triangle = [](const TrianglePatches& patches, const Mesh& of) {
        return static_cast<double>(patches.bytes()) / static_cast<double>(of.triangles.size());
    };
    EXPECT_LT(a_triangle(take_triangles(bvh, mesh, 1, {}), mesh), 24.0);
    EXPECT_GT(a_triangle(take_triangles(other, soup, 1, {}), soup), 40.0);
}

// Of eight triangles without shared corners five fit into one patch.
TEST(TrianglePatches, BeginAnotherWhereCornersDoNotFit) {
    const Mesh mesh = mesh_of(soup_data(4, 8, 0.5));
    EXPECT_THAT(expect_takes_all(mesh, one_leaf(mesh), 1), testing::ElementsAre(2));
}

TEST(TrianglePatches, MakeChainsOfCoincidentTriangles) {
    for (const std::size_t count : {1u, 8u, 9u, 16u, 17u, 255u, 256u, 300u, 1000u}) {
        SCOPED_TRACE(count);
        const Mesh mesh = coincident(count);
        EXPECT_THAT(expect_takes_all(mesh, one_leaf(mesh), 1),
                    testing::ElementsAre(static_cast<int>((count + 7) / 8)));
        expect_takes_all(mesh, tree_over(mesh), 1);
    }
}

TEST(TrianglePatches, WalksStopWhereTheirBodiesSay) {
    const Mesh mesh = coincident(50);
    WideBvh bvh = one_leaf(mesh);
    const TrianglePatches patches = take_triangles(bvh, mesh, 1, {});
    int calls = 0;
    EXPECT_TRUE(each_patch(patches, bvh.root, [&](const TrianglePatch&) { return ++calls == 3; }));
    EXPECT_EQ(calls, 3);
}

// All corners of a triangle in one point: one corner, and the smallest patch that there is.
TEST(TrianglePatches, KeepTrianglesWithoutArea) {
    MeshData data;
    data.positions = {{1, 2, 3}, {4, 5, 6}};
    data.triangles = {{0, 0, 0}, {0, 1, 1}, {1, 1, 0}};
    const Mesh mesh = mesh_of(data);
    expect_takes_all(mesh, one_leaf(mesh), 1);
    data.triangles = {{0, 0, 0}};
    const Mesh point = mesh_of(data);
    expect_takes_all(point, one_leaf(point), 1);
}

TEST(TrianglePatches, TellZerosApart) {
    MeshData data;
    data.positions = {{0.0f, 0, 0}, {-0.0f, 0, 0}, {0, 1, 0}, {1, 0, 0}};
    data.triangles = {{0, 2, 3}, {1, 2, 3}};
    const Mesh mesh = mesh_of(data);
    expect_takes_all(mesh, one_leaf(mesh), 1);
}

TEST(TrianglePatches, AreTheSameForAnyNumberOfThreads) {
    MeshData data = soup_data(5, 40000, 0.02);
    const MeshData ball = ball_data(6);
    const auto offset = static_cast<std::uint32_t>(data.positions.size());
    data.positions.insert(data.positions.end(), ball.positions.begin(), ball.positions.end());
    for (const glm::uvec3& t : ball.triangles)
        data.triangles.push_back(t + offset);
    const Mesh mesh = mesh_of(data);
    const WideBvh bvh = tree_over(mesh);
    ASSERT_GT(bvh.nodes.size(), 1024u);  // several portions
    WideBvh first = bvh;
    const TrianglePatches one = take_triangles(first, mesh, 1, {});
    for (const int threads : {2, 3, 8}) {
        SCOPED_TRACE(threads);
        WideBvh again = bvh;
        const TrianglePatches same = take_triangles(again, mesh, threads, {});
        ASSERT_EQ(same.blocks.size(), one.blocks.size());
        EXPECT_EQ(std::memcmp(same.blocks.data(), one.blocks.data(), one.bytes()), 0);
        EXPECT_EQ(leaves_of(again), leaves_of(first));
    }
    expect_takes_all(mesh, bvh, 3);
}

TEST(TrianglePatches, AreTheSameForAnyInstructionSet) {
    const Mesh mesh = mesh_of(ball_data(5));
    const WideBvh bvh = tree_over(mesh);
    WideBvh chosen = bvh;
    const TrianglePatches patches = take_triangles(chosen, mesh, 1, {});
    for (const std::string& name : instruction_sets()) {
        SCOPED_TRACE(name);
        use_instruction_set(name);
        WideBvh again = bvh;
        const TrianglePatches same = take_triangles(again, mesh, 1, {});
        use_instruction_set("");
        ASSERT_EQ(same.blocks.size(), patches.blocks.size());
        EXPECT_EQ(std::memcmp(same.blocks.data(), patches.blocks.data(), patches.bytes()), 0);
    }
}

TEST(TrianglePatches, OfNoTrianglesAreNone) {
    const Mesh mesh;
    WideBvh bvh = tree_over(mesh);
    EXPECT_TRUE(take_triangles(bvh, mesh, 2, {}).blocks.empty());
}

TEST(TrianglePatches, CanBeCancelled) {
    const Mesh mesh = mesh_of(ball_data(4));
    WideBvh bvh = tree_over(mesh);
    std::stop_source source;
    source.request_stop();
    EXPECT_THROW(take_triangles(bvh, mesh, 2, source.get_token()), Cancelled);
}

}  // namespace
}  // namespace raypick
