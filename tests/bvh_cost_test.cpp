// What a ray is expected to pay for a tree.
#include "tests/boxes.h"
#include "tracer/bvh/bvh.h"

#include <gtest/gtest.h>

#include <vector>

namespace raypick {
namespace {

struct CostCase {
    Boxes boxes;
    double before;  // cost of the tree of the builder that this one replaced
};

std::vector<CostCase> cost_cases() {
    return {{scattered(100, 20000, 0.3), 530.708},  {scattered(101, 20000, 0.05), 93.538},
            {scattered(102, 20000, 0.005), 60.450}, {clustered(103, 3000), 14.672},
            {clustered(104, 20000), 69.199},        {clustered(105, 60000), 185.906}};
}

TEST(BvhCost, IsWhatFullBinningGives) {
    for (const CostCase& c : cost_cases()) {
        EXPECT_LT(sah_cost(build_bvh(c.boxes, 1, {}), {}), 1.025 * c.before);
    }
}

TEST(BvhCost, OfTheFirstTreeIsNotMuchMore) {
    for (const CostCase& c : cost_cases()) {
        const Bvh bvh = build_first(c.boxes.size(), source_of(c.boxes), {});
        EXPECT_LT(sah_cost(bvh, {}), 1.15 * c.before);
    }
}

TEST(BvhCost, IsLessWithALookAtEveryLeaf) {
    for (const CostCase& c : cost_cases()) {
        const auto cost = [&](const LeafCosts& costs) {
            const Bvh bvh = build_bvh(c.boxes.size(), source_of(c.boxes),
                                      {.costs = costs, .threads = 1, .stop = {}});
            return sah_cost(bvh, kWideLeaves);
        };
        EXPECT_LE(cost(kWideLeaves), cost(kWideSurfaceLeaves));
        EXPECT_LE(cost(kWideLeaves), 1.05 * cost({}));
    }
}

// Two unit cubes, two apart: half areas of 3 each, and of 9 for the root, which is 4 x 1 x 1.
TEST(BvhCost, IsTheSumOverNodes) {
    Bvh bvh;
    bvh.indices = {0, 1, 2, 3, 4, 5};
    bvh.nodes.resize(3);
    bvh.nodes[0] = {{glm::vec3(0.0f), glm::vec3(4.0f, 1.0f, 1.0f)}, 1, 0};
    bvh.nodes[1] = {{glm::vec3(0.0f), glm::vec3(1.0f)}, 0, 1};
    bvh.nodes[2] = {{glm::vec3(3.0f, 0.0f, 0.0f), glm::vec3(4.0f, 1.0f, 1.0f)}, 1, 5};
    EXPECT_NEAR(sah_cost(bvh, {.node = 2.0f, .block = 3.0f, .block_size = 1}),
                2.0 + 3.0 * (3.0 * 1.0 + 3.0 * 5.0) / 9.0, 1e-6);
    EXPECT_NEAR(sah_cost(bvh, {.node = 2.0f, .block = 3.0f, .block_size = 4}),
                2.0 + 3.0 * (3.0 * 1.0 + 3.0 * 2.0) / 9.0, 1e-6);
}

}  // namespace
}  // namespace raypick
