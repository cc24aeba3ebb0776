// The trees over boxes: what every tree must be, and what the builders promise about theirs.
#include "tracer/bvh/bvh.h"
#include "tests/boxes.h"
#include "tests/random.h"
#include "tracer/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <new>
#include <ostream>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace raypick {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

bool usable(const Bounds& box) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis])) return false;
    }
    return !box.empty();
}

Boxes same(std::size_t count, const Bounds& box) {
    Boxes boxes;
    boxes.assign(count, box);
    return boxes;
}

Bounds point_box(float x, float y, float z) {
    Bounds box;
    box.extend(glm::vec3(x, y, z));
    return box;
}

// What is wrong with a tree over these boxes; empty if nothing is.
class TreeCheck {
public:
    TreeCheck(Bvh bvh, const Boxes& boxes) : bvh_(std::move(bvh)), boxes_(boxes) {}

    std::string complaint() {
        seen_.assign(boxes_.size(), 0);
        visited_ = 0;
        depth_ = 0;
        if (!bvh_.nodes.empty()) visit(0, 1);
        if (visited_ != bvh_.nodes.size()) say("nodes that nothing leads to");
        for (std::size_t i = 0; i < boxes_.size(); ++i) {
            const int wanted = usable(boxes_[i]) ? 1 : 0;
            if (seen_[i] != wanted) {
                say("box " + std::to_string(i) + " stands in " + std::to_string(seen_[i]) +
                    " leaves");
            }
        }
        if (depth_ > Bvh::kMaxDepth) say("depth " + std::to_string(depth_));
        return complaint_;
    }

    [[nodiscard]] int depth() const { return depth_; }
    [[nodiscard]] std::uint32_t largest_leaf() const { return largest_leaf_; }

private:
    Bounds visit(std::uint32_t index, int depth) {
        ++visited_;
        depth_ = std::max(depth_, depth);
        if (visited_ > bvh_.nodes.size()) {
            say("a circle");
            return {};
        }
        const BvhNode& node = bvh_.nodes.at(index);
        Bounds inside;
        if (node.is_leaf()) {
            largest_leaf_ = std::max(largest_leaf_, node.count);
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                const std::uint32_t box = bvh_.indices.at(i);
                ++seen_.at(box);
                inside.extend(boxes_[box]);
            }
        } else {
            if (node.first <= index) say("children before their parent");
            inside = visit(node.first, depth + 1);
            inside.extend(visit(node.first + 1, depth + 1));
        }
        if (inside.min != node.bounds.min || inside.max != node.bounds.max) {
            say("node " + std::to_string(index) + " doesn't bound exactly what is in it");
        }
        return node.bounds;
    }

    void say(const std::string& what) {
        if (complaint_.size() < 300) complaint_ += what + "; ";
    }

    Bvh bvh_;
    const Boxes& boxes_;
    std::vector<int> seen_;
    std::size_t visited_ = 0;
    int depth_ = 0;
    std::uint32_t largest_leaf_ = 0;
    std::string complaint_;
};

std::string complaint(const Bvh& bvh, const Boxes& boxes) {
    return TreeCheck(bvh, boxes).complaint();
}

bool same_tree(const Bvh& a, const Bvh& b) {
    return a.indices == b.indices &&
           std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(),
                      [](const BvhNode& m, const BvhNode& n) {
                          return m.bounds.min == n.bounds.min && m.bounds.max == n.bounds.max &&
                                 m.first == n.first && m.count == n.count;
                      });
}

struct Builder {
    std::string name;
    Bvh (*build)(std::size_t count, const BoxSource& boxes, const BvhOptions& options);

    [[nodiscard]] Bvh operator()(const Boxes& boxes, const BvhOptions& options = {}) const {
        return build(boxes.size(), source_of(boxes), options);
    }
};

void PrintTo(const Builder& builder, std::ostream* out) {
    *out << builder.name;
}

class BvhBuilder : public testing::TestWithParam<Builder> {};
INSTANTIATE_TEST_SUITE_P(All, BvhBuilder,
                         testing::Values(Builder{"quality", build_bvh},
                                         Builder{"fast", build_first}),
                         [](const auto& test) { return test.param.name; });

TEST_P(BvhBuilder, EveryBoxIsInOneLeaf) {
    for (const std::size_t count : {1u, 2u, 3u, 4u, 5u, 7u, 9u, 33u, 1000u, 20000u, 60000u}) {
        SCOPED_TRACE(count);
        for (const Boxes& boxes : {scattered(count, count, 0.1), clustered(count, count)}) {
            for (const LeafCosts& costs : {LeafCosts{}, kWideLeaves, kWideSurfaceLeaves}) {
                TreeCheck check(GetParam()(boxes, {.costs = costs, .threads = 0, .stop = {}}),
                                boxes);
                EXPECT_EQ(check.complaint(), "");
                EXPECT_LE(check.largest_leaf(), costs.max_leaf);
            }
        }
    }
}

TEST_P(BvhBuilder, TheTreeIsTheSameForAnyNumberOfThreads) {
    const Boxes boxes = clustered(3, 150000);
    const Bvh one = GetParam()(boxes, {.costs = kWideLeaves, .threads = 1, .stop = {}});
    for (int threads = 2; threads <= 8; ++threads) {
        SCOPED_TRACE(threads);
        EXPECT_TRUE(same_tree(
            GetParam()(boxes, {.costs = kWideLeaves, .threads = threads, .stop = {}}), one));
    }
}

TEST_P(BvhBuilder, NoBoxesMakeNoTree) {
    for (const Boxes& boxes : {Boxes{}, same(3, Bounds{}), same(2, point_box(kNan, 0.0f, 0.0f))}) {
        const Bvh bvh = GetParam()(boxes);
        EXPECT_TRUE(bvh.nodes.empty());
        EXPECT_TRUE(bvh.indices.empty());
        EXPECT_EQ(sah_cost(bvh, {}), 0.0);
    }
}

TEST_P(BvhBuilder, BadBoxesAreLeftOut) {
    Boxes boxes = scattered(4, 40000, 0.05);
    for (std::size_t i = 0; i < boxes.size(); i += 7) {
        const int axis = static_cast<int>(i / 7 % 3);
        switch (i / 21 % 5) {
            case 0:
                boxes[i].min[axis] = kNan;
                break;
            case 1:
                boxes[i].max[axis] = kNan;
                break;
            case 2:
                boxes[i].max[axis] = kInfinity;
                break;
            case 3:
                boxes[i].min[axis] = -kInfinity;
                break;
            default:
                boxes[i] = {};
        }
    }
    const Bvh bvh = GetParam()(boxes);
    EXPECT_EQ(complaint(bvh, boxes), "");
    EXPECT_EQ(bvh.indices.size(), boxes.size() - (boxes.size() + 6) / 7);
}

TEST_P(BvhBuilder, TakesBoxesThatNothingTellsApart) {
    for (const std::size_t count : {5u, 100u, 20000u}) {
        SCOPED_TRACE(count);
        Bounds cube;
        cube.extend(glm::vec3(1.0f));
        cube.extend(glm::vec3(2.0f));
        for (const Bounds& box :
             {cube, point_box(0.0f, 0.0f, 0.0f), point_box(1e30f, 0.0f, -5.0f)}) {
            const Boxes boxes = same(count, box);
            EXPECT_EQ(complaint(GetParam()(boxes), boxes), "");
        }
    }
}

TEST_P(BvhBuilder, TakesBoxesOnALineAndInAPlane) {
    Boxes line;
    Boxes plane;
    for (int i = 0; i < 30000; ++i) {
        line.push_back(point_box(0.0f, static_cast<float>(i * 7919 % 30000), 3.0f));
        const int row = i / 173;
        plane.push_back(point_box(static_cast<float>(i % 173), -1.0f, static_cast<float>(row)));
    }
    for (const Boxes& boxes : {line, plane}) {
        TreeCheck check(GetParam()(boxes), boxes);
        EXPECT_EQ(check.complaint(), "");
        EXPECT_LE(check.depth(), 40);
    }
}

TEST_P(BvhBuilder, TakesHugeAndTinyBoxes) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    constexpr float kSmallest = std::numeric_limits<float>::denorm_min();
    for (const double scale : {1e-44, 1e-30, 1e-20, 1e15, 1e25, 1.5e38, 3.3e38}) {
        SCOPED_TRACE(scale);
        Boxes boxes = scattered(5, 10000, 0.01);
        for (Bounds& box : boxes) {
            for (int axis = 0; axis < 3; ++axis) {
                box.min[axis] = static_cast<float>(scale * static_cast<double>(box.min[axis]));
                box.max[axis] = static_cast<float>(scale * static_cast<double>(box.max[axis]));
            }
        }
        TreeCheck check(GetParam()(boxes), boxes);
        EXPECT_EQ(check.complaint(), "");
        EXPECT_LE(check.depth(), 40);
    }
    Boxes all_sizes = scattered(6, 3000, 0.1);
    all_sizes.push_back({glm::vec3(-kLargest), glm::vec3(kLargest)});
    all_sizes.push_back({glm::vec3(kLargest), glm::vec3(kLargest)});
    all_sizes.push_back({glm::vec3(0.0f), glm::vec3(kSmallest)});
    all_sizes.push_back({glm::vec3(kLargest, 0.0f, 0.0f), glm::vec3(kLargest, 1.0f, 1.0f)});
    EXPECT_EQ(complaint(GetParam()(all_sizes), all_sizes), "");
}

// Each box half as large and half as far away as the one before: no bin holds more than one box
// but the last.
TEST_P(BvhBuilder, NoTreeIsTooDeep) {
    Boxes boxes;
    for (int repeat = 0; repeat < 200; ++repeat) {
        for (int power = 60; power > -120; --power) {
            const float x = std::ldexp(1.0f, power);
            boxes.push_back({glm::vec3(0.5f * x, 0.0f, 0.0f), glm::vec3(x)});
        }
    }
    TreeCheck check(GetParam()(boxes), boxes);
    EXPECT_EQ(check.complaint(), "");
    EXPECT_GT(check.depth(), 20) << "it does not test much";
}

TEST_P(BvhBuilder, ALeafIsNoLargerThanAsked) {
    const Boxes boxes = clustered(7, 5000);
    for (const std::uint32_t most : {1u, 2u, 8u}) {
        SCOPED_TRACE(most);
        TreeCheck check(
            GetParam()(boxes, {.costs = {.block_size = std::min(most, 4u), .max_leaf = most},
                               .threads = 1,
                               .stop = {}}),
            boxes);
        EXPECT_EQ(check.complaint(), "");
        EXPECT_LE(check.largest_leaf(), most);
    }
}

TEST_P(BvhBuilder, StopsWhenAskedBefore) {
    std::stop_source stop;
    stop.request_stop();
    const Boxes boxes = scattered(8, 1000, 0.1);
    EXPECT_THROW(GetParam()(boxes, {.costs = {}, .threads = 1, .stop = stop.get_token()}),
                 Cancelled);
}

TEST_P(BvhBuilder, StopsWhenAskedOnTheWay) {
    for (const int threads : {1, 2, 5}) {
        std::stop_source stop;
        const Boxes boxes = scattered(9, 200000, 0.01);
        std::atomic<std::size_t> asked{0};
        const BoxSource source = [&](std::size_t first, std::span<Bounds> wanted) {
            source_of(boxes)(first, wanted);
            if ((asked += wanted.size()) > boxes.size() / 2) stop.request_stop();
        };
        EXPECT_THROW(GetParam().build(boxes.size(), source,
                                      {.costs = {}, .threads = threads, .stop = stop.get_token()}),
                     Cancelled);
        EXPECT_LT(asked, boxes.size());
    }
}

TEST_P(BvhBuilder, RunningOutOfMemoryIsAnException) {
    const BoxSource source = [](std::size_t first, std::span<Bounds> wanted) {
        if (first > 50000) throw std::bad_alloc();
        std::fill(wanted.begin(), wanted.end(), point_box(0.0f, 0.0f, 0.0f));
    };
    for (const int threads : {1, 2}) {
        EXPECT_THROW(
            GetParam().build(100000, source, {.costs = {}, .threads = threads, .stop = {}}),
            std::bad_alloc);
    }
}

TEST(BvhRefit, BoxesThatStayChangeNothing) {
    for (const std::size_t count : {0u, 1u, 2u, 300u, 50000u}) {
        const Boxes boxes = clustered(10, count);
        const Bvh before = build_bvh(boxes, 1, {});
        Bvh after = before;
        refit(after, source_of(boxes), 0, {});
        EXPECT_TRUE(same_tree(after, before));
    }
}

TEST(BvhRefit, BoundsMovedBoxesExactly) {
    const Boxes before = clustered(11, 40000);
    Boxes after = before;
    Random random(12);
    for (Bounds& box : after) {
        const glm::vec3 step(random.point(glm::dvec3(-0.5), glm::dvec3(0.5)));
        box = {box.min + step, box.max + step};
    }
    const Bvh built = build_bvh(before, 1, {});
    Bvh one = built;
    refit(one, source_of(after), 1, {});
    EXPECT_EQ(complaint(one, after), "");
    EXPECT_NE(complaint(built, after), "");
    for (int threads = 2; threads <= 8; ++threads) {
        Bvh many = built;
        refit(many, source_of(after), threads, {});
        EXPECT_TRUE(same_tree(many, one));
    }
}

TEST(BvhRefit, FollowsATreeThatIsNothingButDeep) {
    Bvh chain;  // inner nodes at even places, each with a leaf and the next
    Boxes boxes;
    constexpr std::uint32_t kLeaves = 60;
    constexpr std::size_t kNodes = 2 * std::size_t{kLeaves} - 1;
    for (std::uint32_t i = 0; i < kLeaves; ++i) {
        boxes.push_back(point_box(static_cast<float>(i), 0.0f, 0.0f));
        chain.indices.push_back(i);
    }
    chain.nodes.resize(kNodes);
    for (std::uint32_t i = 0; i + 1 < kLeaves; ++i) {
        const std::uint32_t child = 2 * i + 1;
        chain.nodes[child - 1].first = child;
        chain.nodes[child].first = i;
        chain.nodes[child].count = 1;
    }
    chain.nodes.back().first = kLeaves - 1;
    chain.nodes.back().count = 1;
    refit(chain, source_of(boxes), 2, {});
    EXPECT_EQ(complaint(chain, boxes), "");
}

TEST(BvhRefit, BadBoxesCountForNothing) {
    const Boxes before = scattered(13, 1000, 0.1);
    Bvh bvh = build_bvh(before, 1, {});
    Boxes after = before;
    Bounds rest;
    for (std::size_t i = 0; i < after.size(); ++i) {
        if (i % 3 == 0) after[i] = point_box(kNan, 0.0f, 0.0f);
        if (i % 3 == 1) after[i] = point_box(kInfinity, 0.0f, 0.0f);
        if (i % 3 == 2) rest.extend(after[i]);
    }
    refit(bvh, source_of(after), 1, {});
    EXPECT_EQ(bvh.nodes[0].bounds.min, rest.min);
    EXPECT_EQ(bvh.nodes[0].bounds.max, rest.max);
}

TEST(BvhRefit, CanBeStopped) {
    const Boxes boxes = scattered(14, 10000, 0.1);
    Bvh bvh = build_bvh(boxes, 1, {});
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(refit(bvh, source_of(boxes), 2, stop.get_token()), Cancelled);
}

}  // namespace
}  // namespace raypick
