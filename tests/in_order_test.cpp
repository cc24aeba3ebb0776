// What a parallel loop's results are taken with: in order, one at a time, whoever brings them.
#include "tracer/parallel/in_order.h"
#include "tests/random.h"
#include "tracer/parallel/parallel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

namespace raypick {
namespace {

std::vector<std::size_t> numbers(std::size_t count) {
    std::vector<std::size_t> all(count);
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
}

TEST(InOrder, WaitsForThoseBefore) {
    std::vector<std::size_t> taken;
    InOrder in_order(5, [&](std::size_t i) { taken.push_back(i); });
    in_order.ready(1);
    in_order.ready(3);
    EXPECT_TRUE(taken.empty());
    in_order.ready(0);
    EXPECT_THAT(taken, testing::ElementsAre(0u, 1u));
    in_order.ready(2);
    EXPECT_THAT(taken, testing::ElementsAre(0u, 1u, 2u, 3u));
    in_order.ready(4);
    EXPECT_EQ(taken, numbers(5));
}

TEST(InOrder, TakesAllInAnyOrder) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        std::vector<std::size_t> order = numbers(100);
        for (std::size_t i = order.size(); i > 1; --i)
            std::swap(order[i - 1], order[random.below(i)]);
        std::vector<std::size_t> taken;
        InOrder in_order(order.size(), [&](std::size_t i) { taken.push_back(i); });
        for (const std::size_t i : order)
            in_order.ready(i);
        EXPECT_EQ(taken, numbers(order.size()));
    }
}

TEST(InOrder, TakesOneAtATimeFromManyThreads) {
    constexpr std::size_t kCount = 5000;
    std::vector<std::size_t> results(kCount);
    std::vector<std::size_t> taken;
    std::atomic<int> inside{0};
    InOrder in_order(kCount, [&](std::size_t i) {
        EXPECT_EQ(++inside, 1);
        taken.push_back(results[i]);
        --inside;
    });
    parallel_for(kCount, 4, {}, [&](std::size_t i) {
        results[i] = i;
        in_order.ready(i);
    });
    EXPECT_EQ(taken, numbers(kCount));
}

TEST(InOrder, TakesNothingMoreAfterAFailure) {
    std::vector<std::size_t> taken;
    InOrder in_order(4, [&](std::size_t i) {
        if (i == 1) throw std::runtime_error("no");
        taken.push_back(i);
    });
    in_order.ready(0);
    in_order.ready(2);
    EXPECT_THROW(in_order.ready(1), std::runtime_error);
    in_order.ready(3);
    EXPECT_THAT(taken, testing::ElementsAre(0u));
}

}  // namespace
}  // namespace raypick
