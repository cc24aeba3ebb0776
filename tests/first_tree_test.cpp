// What first trees are made of: the order of boxes, wide nodes with few visits, and patches stored
// as the leaves are made.
#include "tests/random.h"
#include "tests/tracer_scenes.h"
#include "tracer/accel/joined_meshes.h"
#include "tracer/accel/trace_rays.h"
#include "tracer/accel/triangle_box.h"
#include "tracer/accel/triangle_patches.h"
#include "tracer/bvh/best_children.h"
#include "tracer/bvh/bvh_fast.h"
#include "tracer/bvh/morton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace raypick {
namespace {

Bounds random_box(Random& random) {
    Bounds box;
    const glm::dvec3 at = random.point(glm::dvec3(-1.0), glm::dvec3(1.0));
    box.extend(glm::vec3(at));
    box.extend(glm::vec3(at + 0.1 * random.point(glm::dvec3(0.0), glm::dvec3(1.0))));
    return box;
}

std::vector<Bounds> random_boxes(std::uint64_t seed, std::size_t count) {
    Random random(seed);
    std::vector<Bounds> boxes;
    while (boxes.size() < count)
        boxes.push_back(random_box(random));
    return boxes;
}

LargeArray<MortonKey> order_of(const std::vector<Bounds>& boxes, const Box4& around, int threads) {
    const Box4Source source = [&boxes](std::size_t first, std::span<Box4> wanted) {
        for (std::size_t i = 0; i < wanted.size(); ++i)
            wanted[i] = box4(boxes[first + i]);
    };
    return morton_order(boxes.size(), source, around,
                        {.costs = {}, .threads = threads, .stop = {}});
}

std::size_t cells(const LargeArray<MortonKey>& keys) {
    std::set<std::uint32_t> codes;
    for (const MortonKey& key : keys)
        codes.insert(key.code);
    return codes.size();
}

bool same_keys(const LargeArray<MortonKey>& a, const LargeArray<MortonKey>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const MortonKey& m, const MortonKey& n) {
                          return m.code == n.code && m.index == n.index;
                      });
}

TEST(MortonOrder, IsByCodeThenByIndexForAnyNumberOfThreads) {
    std::vector<Bounds> boxes = random_boxes(1, 60000);
    for (std::size_t i = 0; i < boxes.size(); i += 11)
        boxes[i] = {};
    for (std::size_t i = 5; i + 1 < boxes.size(); i += 7)
        boxes[i] = boxes[i + 1];
    const LargeArray<MortonKey> keys = order_of(boxes, {}, 1);
    EXPECT_EQ(keys.size(), boxes.size() - static_cast<std::size_t>(std::count_if(
                                              boxes.begin(), boxes.end(),
                                              [](const Bounds& box) { return box.empty(); })));
    EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end(), [](const auto& a, const auto& b) {
        return std::pair(a.code, a.index) < std::pair(b.code, b.index);
    }));
    for (int threads = 2; threads <= 5; ++threads) {
        SCOPED_TRACE(threads);
        EXPECT_TRUE(same_keys(order_of(boxes, {}, threads), keys));
    }
}

// A box that is far too large would put all into a few cells.
TEST(MortonOrder, TakesAHintForWhatItIs) {
    const std::vector<Bounds> boxes = random_boxes(2, 20000);
    const std::size_t most = cells(order_of(boxes, {}, 2));
    EXPECT_GT(most, boxes.size() / 2);
    Bounds tight;
    for (const Bounds& box : boxes)
        tight.extend(box);
    for (const float times : {1.0f, 1.5f, 3.0f, 1e4f, 1e30f}) {
        SCOPED_TRACE(times);
        const Box4 around = box4({times * tight.min, times * tight.max});
        EXPECT_GT(cells(order_of(boxes, around, 2)), most / 2);
    }
}

// A binary tree over boxes, halved where they come.
void halve(std::vector<BvhNode>& nodes, std::size_t node, std::span<const Bounds> boxes,
           std::uint32_t first) {
    for (const Bounds& box : boxes)
        nodes[node].bounds.extend(box);
    if (boxes.size() == 1) {
        nodes[node].first = first;
        nodes[node].count = 1;
        return;
    }
    const auto child = static_cast<std::uint32_t>(nodes.size());
    nodes[node].first = child;
    nodes.resize(nodes.size() + 2);
    const std::size_t middle = 1 + (boxes.size() - 1) / 3;
    halve(nodes, child, boxes.first(middle), first);
    halve(nodes, child + std::size_t{1}, boxes.subspan(middle),
          first + static_cast<std::uint32_t>(middle));
}

std::vector<BvhNode> binary_over(std::span<const Bounds> boxes) {
    std::vector<BvhNode> nodes(1);
    halve(nodes, 0, boxes, 0);
    return nodes;
}

// The visits that a wide tree costs, in areas of its nodes.
template <typename Children>
double visits(const std::vector<BvhNode>& nodes, std::uint32_t root, const Children& children) {
    if (nodes[root].is_leaf()) return 0.0;
    double sum = static_cast<double>(nodes[root].bounds.half_area());
    const WideChildren below = children(root);
    for (std::uint32_t i = 0; i < below.count; ++i)
        sum += visits(nodes, below.node[i], children);
    return sum;
}

std::uint32_t leaves_below(const std::vector<BvhNode>& nodes, std::uint32_t root,
                           const BestChildren& best) {
    if (nodes[root].is_leaf()) return 1;
    const WideChildren below = best.of(root);
    EXPECT_GE(below.count, 2u);
    EXPECT_LE(below.count, kWidth);
    std::uint32_t sum = 0;
    for (std::uint32_t i = 0; i < below.count; ++i)
        sum += leaves_below(nodes, below.node[i], best);
    return sum;
}

TEST(BestChildren, LeadToEachLeaf) {
    for (std::size_t count = 1; count < 70; ++count) {
        SCOPED_TRACE(count);
        const std::vector<BvhNode> nodes = binary_over(random_boxes(count, count));
        BestChildren best;
        best.find(nodes, 0.02f);
        EXPECT_EQ(leaves_below(nodes, 0, best), count);
    }
}

TEST(BestChildren, AreVisitedLessThanThoseOfTheLargestSurfaces) {
    double best_sum = 0.0;
    double other_sum = 0.0;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        SCOPED_TRACE(seed);
        const std::vector<BvhNode> nodes = binary_over(random_boxes(seed, 64));
        BestChildren best;
        best.find(nodes, 1e-6f);
        const double least = visits(nodes, 0, [&](std::uint32_t node) { return best.of(node); });
        const double other =
            visits(nodes, 0, [&](std::uint32_t node) { return open_node(nodes, node); });
        EXPECT_LE(least, 1.0001 * other);
        best_sum += least;
        other_sum += other;
    }
    EXPECT_LT(best_sum, 0.95 * other_sum);
}

// Eight leaves fit into one node; nine need two, whatever their areas are.
TEST(BestChildren, AreAsManyAsFitWhereAreasTellNothing) {
    for (const float size : {0.0f, 1e30f, std::numeric_limits<float>::max()}) {
        SCOPED_TRACE(size);
        std::vector<Bounds> boxes(8);
        for (Bounds& box : boxes) {
            box.extend(glm::vec3(-size));
            box.extend(glm::vec3(size));
        }
        BestChildren best;
        const std::vector<BvhNode> eight = binary_over(boxes);
        best.find(eight, 0.02f);
        EXPECT_EQ(best.of(0).count, 8u);
        boxes.push_back(boxes.front());
        const std::vector<BvhNode> nine = binary_over(boxes);
        best.find(nine, 0.02f);
        EXPECT_EQ(leaves_below(nine, 0, best), 9u);
    }
}

struct FirstTree {
    WideBvh bvh;
    TrianglePatches patches;
};

FirstTree first_tree(const Mesh& mesh, int threads) {
    const BvhOptions how{.costs = kWideSurfaceLeaves, .threads = threads, .stop = {}};
    const Box4Source boxes = [&mesh](std::size_t first, std::span<Box4> wanted) {
        for (std::size_t i = 0; i < wanted.size(); ++i)
            wanted[i] = triangle_box4(mesh, first + i);
    };
    LargeArray<MortonKey> keys = morton_order(mesh.triangles.size(), boxes, {}, how);
    const JoinedMeshes meshes({&mesh});
    PatchStore store(meshes, keys.size());
    WideBvh bvh = build_over_keys(std::move(keys), store.leaves(), how);
    return {std::move(bvh), store.take()};
}

// Fills in the triangles below a place, and expects its box to be just around them.
void expect_holds(const FirstTree& tree, const Mesh& mesh, const WideRef& ref, const Bounds& box,
                  std::vector<std::uint32_t>& found) {
    Bounds inside;
    if (ref.is_leaf()) {
        each_patch(tree.patches, ref, [&](const TrianglePatch& patch) {
            for (std::uint32_t i = 0; i < patch.triangles; ++i) {
                found.push_back(patch.primitives()[i]);
                inside.extend(triangle_box(mesh, found.back()));
            }
            return false;
        });
    } else {
        const WideNode& node = tree.bvh.nodes.at(ref.index());
        for (std::uint32_t i = 0; i < kWidth; ++i) {
            if (node.child[i] == WideRef::kNothing) continue;
            inside.extend(node.box(i));
            expect_holds(tree, mesh, node.ref(i), node.box(i), found);
        }
    }
    EXPECT_EQ(inside.min, box.min);
    EXPECT_EQ(inside.max, box.max);
}

// Surfaces whose leaves take a patch each, triangles apart, whose leaves take two, and a second
// chunk of one leaf.
std::vector<Mesh> meshes() {
    return {make_mesh("ball", ball_data(6)), make_mesh("soup", soup_data(1, 30000, 0.05)),
            make_mesh("and a leaf", soup_data(4, kKeysInChunk + 3, 0.1)),
            make_mesh("few", soup_data(2, 3, 0.5)), make_mesh("one", soup_data(3, 1, 0.5))};
}

TEST(FirstTree, HoldsEachTriangleOnce) {
    for (const Mesh& mesh : meshes()) {
        SCOPED_TRACE(mesh.name);
        const FirstTree tree = first_tree(mesh, 2);
        std::vector<std::uint32_t> found;
        expect_holds(tree, mesh, tree.bvh.root, tree.bvh.bounds, found);
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found.size(), mesh.triangles.size());
        EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    }
}

template <typename Array>
bool same_bytes(const Array& a, const Array& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

bool same_trees(const FirstTree& a, const FirstTree& b) {
    return a.bvh.root == b.bvh.root && same_bytes(a.bvh.nodes, b.bvh.nodes) &&
           same_bytes(a.patches.blocks, b.patches.blocks);
}

TEST(FirstTree, IsTheSameForAnyNumberOfThreads) {
    for (const Mesh& mesh : meshes()) {
        SCOPED_TRACE(mesh.name);
        const FirstTree one = first_tree(mesh, 1);
        for (int threads = 2; threads <= 5; ++threads)
            EXPECT_TRUE(same_trees(first_tree(mesh, threads), one)) << threads;
    }
}

TEST(FirstTree, IsTheSameForEachInstructionSet) {
    for (const Mesh& mesh : meshes()) {
        SCOPED_TRACE(mesh.name);
        const FirstTree best = first_tree(mesh, 1);
        for (const std::string& set : instruction_sets()) {
            use_instruction_set(set);
            EXPECT_TRUE(same_trees(first_tree(mesh, 1), best)) << set;
        }
        use_instruction_set("");
    }
}

TEST(FirstTree, LeavesOutTrianglesWithoutAPlace) {
    MeshData data = soup_data(4, 5000, 0.05);
    data.positions[7].y = std::numeric_limits<float>::quiet_NaN();
    data.positions[300].x = std::numeric_limits<float>::infinity();
    const Mesh mesh = make_mesh("mesh", data);
    const FirstTree tree = first_tree(mesh, 2);
    std::vector<std::uint32_t> found;
    expect_holds(tree, mesh, tree.bvh.root, tree.bvh.bounds, found);
    EXPECT_EQ(found.size(), mesh.triangles.size() - 2);
}

TEST(FirstTree, OfNothingIsEmpty) {
    const FirstTree tree = first_tree(make_mesh("none", {}), 2);
    EXPECT_TRUE(tree.bvh.empty());
    EXPECT_TRUE(tree.bvh.nodes.empty());
}

}  // namespace
}  // namespace raypick
