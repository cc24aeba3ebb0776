// The form of a tree that rays run on: every box once, children in the order of each octant.
#include "tracer/bvh/wide_bvh.h"
#include "tests/random.h"
#include "tracer/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stop_token>
#include <utility>
#include <vector>

namespace raypick {
namespace {

using Boxes = std::vector<Bounds>;

Boxes scattered(std::uint64_t seed, std::size_t count, double size) {
    Random random(seed);
    Boxes boxes(count);
    for (Bounds& box : boxes) {
        const glm::dvec3 corner = random.point(glm::dvec3(-1.0), glm::dvec3(1.0));
        box.extend(glm::vec3(corner));
        box.extend(glm::vec3(corner + size * random.point(glm::dvec3(0.0), glm::dvec3(1.0))));
    }
    return boxes;
}

Bvh binary_over(const Boxes& boxes, const LeafCosts& costs = {}) {
    const BoxSource source = [&boxes](std::size_t first, std::span<Bounds> wanted) {
        std::copy_n(boxes.begin() + static_cast<std::ptrdiff_t>(first), wanted.size(),
                    wanted.begin());
    };
    return build_bvh(boxes.size(), source, {.costs = costs, .threads = 1, .stop = {}});
}

WideBvh wide_over(const Boxes& boxes, const LeafCosts& costs = {}) {
    return widen(binary_over(boxes, costs));
}

bool holds(const Bounds& outer, const Bounds& inner) {
    return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && outer.min.z <= inner.min.z &&
           outer.max.x >= inner.max.x && outer.max.y >= inner.max.y && outer.max.z >= inner.max.z;
}

// What can be reached from the root: how often each index, and whether boxes hold what they should.
struct Reached {
    explicit Reached(const WideBvh& bvh, const Boxes& boxes)
        : bvh_(bvh), boxes_(boxes), times(boxes.size()) {
        if (!bvh.empty()) visit(bvh.root, bvh.bounds);
    }

    void visit(const WideRef& ref, const Bounds& box) {
        if (ref.is_leaf()) {
            const auto indices = indices_of(bvh_, ref);
            std::size_t same = 0;
            each_index(bvh_, ref, [&](std::uint32_t index) {
                EXPECT_EQ(index, indices[same++] & ~WideBvh::kLast);
                EXPECT_TRUE(holds(box, boxes_[index])) << index;
                ++times[index];
                return false;
            });
            EXPECT_EQ(same, indices.size());
            return;
        }
        ++nodes;
        const WideNode& node = bvh_.nodes[ref.index()];
        for (std::uint32_t i = 0; i < kWidth; ++i) {
            if (node.child[i] == WideRef::kNothing) {
                EXPECT_EQ(node.box(i).min, Bounds{}.min);
                EXPECT_EQ(node.box(i).max, Bounds{}.max);
                continue;
            }
            EXPECT_TRUE(holds(box, node.box(i)));
            visit(node.ref(i), node.box(i));
        }
    }

    const WideBvh& bvh_;
    const Boxes& boxes_;
    std::vector<int> times;
    std::size_t nodes = 0;
};

std::array<std::uint32_t, kWidth> order_of(const WideNode& node, std::size_t octant) {
    std::array<std::uint32_t, kWidth> order{};
    for (std::size_t i = 0; i < kWidth; ++i)
        order[i] = (node.far_to_near(octant) >> (3 * i)) & 7u;
    return order;
}

void put(WideNode& node, std::size_t i, const Bounds& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.planes[axis][i] = box.min[static_cast<int>(axis)];
        node.planes[3 + axis][i] = box.max[static_cast<int>(axis)];
    }
}

WideNode node_of(const Boxes& boxes) {
    WideNode node;
    for (std::size_t i = 0; i < kWidth; ++i)
        put(node, i, i < boxes.size() ? boxes[i] : Bounds{});
    node.sort_children();
    return node;
}

TEST(WideBvh, ReachesEveryIndexOnceWithinItsBoxes) {
    for (const std::size_t count : {1u, 2u, 3u, 7u, 8u, 9u, 63u, 64u, 65u, 1000u, 5000u}) {
        for (const std::uint32_t max_leaf : {1u, 4u, 8u}) {
            SCOPED_TRACE(testing::Message() << count << " boxes, leaves of " << max_leaf);
            const Boxes boxes = scattered(count, count, 0.2);
            const WideBvh bvh = wide_over(boxes, {.max_leaf = max_leaf});
            const Reached reached(bvh, boxes);
            EXPECT_THAT(reached.times, testing::Each(1));
            EXPECT_EQ(reached.nodes, bvh.nodes.size());
        }
    }
}

TEST(WideBvh, OneBoxIsALeafWithoutNodes) {
    const Boxes boxes = scattered(1, 1, 0.5);
    const WideBvh bvh = wide_over(boxes);
    EXPECT_TRUE(bvh.root.is_leaf());
    EXPECT_TRUE(bvh.nodes.empty());
    EXPECT_EQ(bvh.bounds.min, boxes[0].min);
    EXPECT_EQ(bvh.bounds.max, boxes[0].max);
    EXPECT_THAT(indices_of(bvh, bvh.root), testing::ElementsAre(0u | WideBvh::kLast));
}

TEST(WideBvh, NothingIsEmpty) {
    for (const std::size_t count : {0u, 5u}) {  // of empty boxes
        const WideBvh bvh = wide_over(Boxes(count));
        EXPECT_TRUE(bvh.empty());
        EXPECT_TRUE(bvh.nodes.empty());
    }
}

// So many in one place can't be told apart.
TEST(WideBvh, ManyBoxesInOnePlaceAreAllReached) {
    const Boxes boxes(1000, scattered(3, 1, 0.5).front());
    const WideBvh bvh = wide_over(boxes, {.max_leaf = 1});
    EXPECT_THAT(Reached(bvh, boxes).times, testing::Each(1));
}

// A leaf of 300 and one of 1: counts of leaves fit whatever they are.
TEST(WideBvh, LeavesHaveAnySize) {
    Boxes boxes = scattered(4, 301, 0.5);
    Bvh binary;
    binary.nodes.resize(3);
    for (std::uint32_t i = 0; i < 301; ++i) {
        binary.indices.push_back(300 - i);
        binary.nodes[0].bounds.extend(boxes[i]);
        binary.nodes[i == 0 ? 2 : 1].bounds.extend(boxes[i]);
    }
    binary.nodes[0].first = 1;
    binary.nodes[1].first = 0;
    binary.nodes[1].count = 300;
    binary.nodes[2].first = 300;
    binary.nodes[2].count = 1;
    const WideBvh bvh = widen(std::move(binary));
    ASSERT_EQ(bvh.nodes.size(), 1u);
    EXPECT_EQ(indices_of(bvh, bvh.nodes[0].ref(0)).size(), 300u);
    EXPECT_EQ(indices_of(bvh, bvh.nodes[0].ref(1)).size(), 1u);
    EXPECT_THAT(Reached(bvh, boxes).times, testing::Each(1));
}

// Byte for byte: from trees with no subtrees below the nodes near the root to such with many nodes.
TEST(WideBvh, IsTheSameForAnyNumberOfThreads) {
    for (const std::size_t count : {2u, 9u, 300u, 3000u, 30000u}) {
        const Boxes boxes = scattered(count, count, 0.1);
        const WideBvh one = wide_over(boxes, {.max_leaf = 1});
        for (const int threads : {0, 2, 3, 8}) {
            SCOPED_TRACE(testing::Message() << count << " on " << threads);
            const WideBvh same = widen(binary_over(boxes, {.max_leaf = 1}), threads);
            EXPECT_EQ(same.root, one.root);
            EXPECT_EQ(same.indices, one.indices);
            ASSERT_EQ(same.nodes.size(), one.nodes.size());
            EXPECT_EQ(std::memcmp(same.nodes.data(), one.nodes.data(),
                                  one.nodes.size() * sizeof(WideNode)),
                      0);
        }
    }
}

TEST(WideBvh, CanBeCancelled) {
    std::stop_source source;
    source.request_stop();
    for (const int threads : {1, 2}) {
        Bvh binary = binary_over(scattered(1, 1000, 0.1));
        EXPECT_THROW(widen(std::move(binary), threads, source.get_token()), Cancelled);
    }
}

TEST(WideBvh, BodiesStopTheWalkOverIndices) {
    const Boxes boxes(3, scattered(3, 1, 0.5).front());
    const WideBvh bvh = wide_over(boxes, {.min_leaf = 3, .max_leaf = 4});
    ASSERT_TRUE(bvh.root.is_leaf());
    int calls = 0;
    EXPECT_TRUE(each_index(bvh, bvh.root, [&](std::uint32_t) { return ++calls == 2; }));
    EXPECT_EQ(calls, 2);
}

TEST(WideNode, OppositeOctantsHaveOppositeOrders) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        SCOPED_TRACE(seed);
        const WideNode node = node_of(scattered(seed, 2 + seed % 7, 0.3));
        for (std::size_t octant = 0; octant < 8; ++octant) {
            auto order = order_of(node, octant);
            auto opposite = order_of(node, 7 - octant);
            std::reverse(opposite.begin(), opposite.end());
            EXPECT_EQ(order, opposite);
            std::sort(order.begin(), order.end());
            EXPECT_THAT(order, testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
        }
    }
}

// Boxes of one size, of which each is beyond the one before on every axis of the octant.
TEST(WideNode, NearerBoxesComeLast) {
    for (std::size_t octant = 0; octant < 8; ++octant) {
        for (std::size_t count = 2; count <= kWidth; ++count) {
            SCOPED_TRACE(testing::Message() << octant << ": " << count);
            Boxes boxes(count);
            std::array<std::uint32_t, kWidth> shuffled{5, 2, 7, 0, 3, 6, 1, 4};
            for (std::size_t i = 0; i < count; ++i) {
                glm::vec3 at(2.0f * static_cast<float>(shuffled[i]));
                for (int axis = 0; axis < 3; ++axis) {
                    if (((octant >> axis) & 1) != 0) at[axis] = -at[axis];
                }
                boxes[i].extend(at - 0.5f);
                boxes[i].extend(at + 0.5f);
            }
            const WideNode node = node_of(boxes);
            std::uint32_t before = kWidth;  // larger than all
            for (const std::uint32_t i : order_of(node, octant)) {
                if (i >= count) continue;  // no child
                EXPECT_LT(shuffled[i], before);
                before = shuffled[i];
            }
        }
    }
}

// Sums of coordinates overflow, boxes are infinite or no boxes at all: an order is an order.
TEST(WideNode, OrdersAnything) {
    constexpr float kMost = std::numeric_limits<float>::max();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Boxes boxes = scattered(1, 8, 0.5);
    boxes[1] = {glm::vec3(0.9f * kMost), glm::vec3(kMost)};
    boxes[2] = {glm::vec3(-kMost, 0.9f * kMost, 0.0f), glm::vec3(-0.9f * kMost, kMost, 1.0f)};
    boxes[3] = {glm::vec3(-kInfinity), glm::vec3(kInfinity)};
    boxes[4] = Bounds{};
    const WideNode node = node_of(boxes);
    for (std::size_t octant = 0; octant < 8; ++octant) {
        auto order = order_of(node, octant);
        std::sort(order.begin(), order.end());
        EXPECT_THAT(order, testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
    }
}

TEST(WideRef, TellsLeavesFromNodes) {
    for (const std::uint32_t index : {0u, 1u, 0x7ffffffeu}) {
        EXPECT_FALSE(WideRef::node(index).is_leaf());
        EXPECT_TRUE(WideRef::leaf(index).is_leaf());
        EXPECT_EQ(WideRef::node(index).index(), index);
        EXPECT_EQ(WideRef::leaf(index).index(), index);
        EXPECT_NE(WideRef::leaf(index).bits, WideRef::kNothing);
    }
}

}  // namespace
}  // namespace raypick
