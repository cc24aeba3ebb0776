// How fine the coarse image gets. Times are numbers here: no clock runs.
#include "tracer/render/coarse_pace.h"

#include "tracer/render/coarse_image.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace raypick {
namespace {

constexpr double kBudget = 0.025;
constexpr ImageSize kView{690, 1000};

double blocks(int step, ImageSize size = kView) {
    return static_cast<double>(block_grid(size, step).pixel_count());
}

// A machine that takes so long for a block, and `overhead` for any image.
struct Machine {
    double seconds_per_block = 0.0;
    double overhead = 0.0;

    [[nodiscard]] double time(int step, ImageSize size = kView) const {
        return overhead + seconds_per_block * blocks(step, size);
    }
    // The steps of so many images in a row.
    std::vector<int> run(CoarsePace& pace, int images, ImageSize size = kView) const {
        std::vector<int> steps;
        for (int i = 0; i < images; ++i) {
            steps.push_back(pace.step_for(size));
            pace.learn(size, steps.back(), time(steps.back(), size));
        }
        return steps;
    }
};

TEST(CoarsePace, BeginsInTheMiddle) {
    EXPECT_EQ(CoarsePace(kBudget).step_for(kView), CoarsePace::kUnknown);
}

TEST(CoarsePace, TakesTheFinestThatFits) {
    for (int step = 1; step <= CoarsePace::kCoarsest; ++step) {
        SCOPED_TRACE(step);
        // This step leaves some of the quarter, the next finer one does not fit.
        const Machine machine{0.74 * kBudget / blocks(step)};
        CoarsePace pace(kBudget);
        const int steady = machine.run(pace, 5).back();
        EXPECT_LE(machine.time(steady), kBudget);
        EXPECT_LE(steady, step);
        if (steady > 1) {
            EXPECT_GT(machine.time(steady - 1), 0.75 * kBudget);
        }
    }
}

TEST(CoarsePace, KeepsWithinItsLimits) {
    CoarsePace slow(kBudget);
    EXPECT_EQ(Machine{1.0}.run(slow, 5).back(), CoarsePace::kCoarsest);
    CoarsePace fast(kBudget);
    EXPECT_EQ(Machine{1e-12}.run(fast, 5).back(), 1);
    CoarsePace none(kBudget);
    EXPECT_EQ(Machine{0.0}.run(none, 5).back(), 1);
}

TEST(CoarsePace, SettlesAndStays) {
    for (const double overhead : {0.0, 0.002, 0.01}) {
        SCOPED_TRACE(overhead);
        CoarsePace pace(kBudget);
        const std::vector<int> steps = Machine{1e-6, overhead}.run(pace, 40);
        for (std::size_t i = 20; i < steps.size(); ++i)
            EXPECT_EQ(steps[i], steps[19]);
    }
}

TEST(CoarsePace, SmallChangesChangeNothing) {
    CoarsePace pace(kBudget);
    const Machine machine{1e-6};
    const auto next = [&](int i) {
        const int step = pace.step_for(kView);
        pace.learn(kView, step, machine.time(step) * (i % 2 == 0 ? 0.95 : 1.05));
        return step;
    };
    for (int i = 0; i < 10; ++i)
        next(i);
    const int steady = pace.step_for(kView);
    for (int i = 0; i < 30; ++i)
        EXPECT_EQ(next(i), steady);
}

TEST(CoarsePace, OneHoldUpCountsForNothing) {
    CoarsePace pace(kBudget);
    const Machine machine{1e-6};
    const int steady = machine.run(pace, 10).back();
    pace.learn(kView, steady, 5.0);
    EXPECT_EQ(pace.step_for(kView), steady);
}

TEST(CoarsePace, GivesWayWhenRaysGetDearAndComesBack) {
    CoarsePace pace(kBudget);
    const int cheap = Machine{1e-6}.run(pace, 10).back();
    const std::vector<int> dear = Machine{8e-6}.run(pace, 6);
    EXPECT_GT(dear[3], cheap) << "after three images";
    EXPECT_LE(Machine{8e-6}.time(dear[5]), kBudget);
    EXPECT_EQ(Machine{1e-6}.run(pace, 10).back(), cheap);
}

TEST(CoarsePace, ASmallerViewMayBeFiner) {
    CoarsePace pace(kBudget);
    const Machine machine{1e-6};
    const int large = machine.run(pace, 10).back();
    const ImageSize small{200, 300};
    const int step = pace.step_for(small);
    EXPECT_LT(step, large);
    EXPECT_LE(machine.time(step, small), kBudget);
}

TEST(CoarsePace, TimesThatAreNoNumbersDoNoHarm) {
    CoarsePace pace(kBudget);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < 3; ++i)
        pace.learn(kView, 8, nan);
    EXPECT_EQ(pace.step_for(kView), CoarsePace::kCoarsest);
    EXPECT_GE(pace.step_for({1, 1}), 1);
}

TEST(CoarseImage, EachBlockHasAPixelOfItsOwn) {
    for (const ImageSize size :
         {ImageSize{1, 1}, ImageSize{7, 33}, ImageSize{16, 16}, ImageSize{23, 5}}) {
        for (int step = 1; step <= CoarsePace::kCoarsest; ++step) {
            const ImageSize grid = block_grid(size, step);
            for (int row = 0; row < grid.rows; ++row) {
                for (int col = 0; col < grid.cols; ++col) {
                    const Pixel sample = block_sample({row, col}, step, size);
                    EXPECT_TRUE(size.contains(sample));
                    EXPECT_EQ(block_of(sample, step), (Pixel{row, col}));
                }
            }
            const Pixel last = block_of({size.rows - 1, size.cols - 1}, step);
            EXPECT_EQ(last, (Pixel{grid.rows - 1, grid.cols - 1}));
        }
    }
}

}  // namespace
}  // namespace raypick
