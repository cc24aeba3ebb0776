#include "picking/click_detector.h"

#include <gtest/gtest.h>

#include <limits>

namespace raypick {
namespace {

constexpr MouseButton kLeft = MouseButton::left;
constexpr MouseButton kRight = MouseButton::right;

TEST(ClickDetector, PressAndReleaseInPlaceIsAClick) {
    ClickDetector clicks;
    clicks.press(kLeft, {10, 20}, true);
    EXPECT_EQ(clicks.held(), kLeft);
    EXPECT_FALSE(clicks.dragging());
    EXPECT_EQ(clicks.release(kLeft, {10, 20}), (Cursor{10, 20}));
    EXPECT_FALSE(clicks.held());
}

TEST(ClickDetector, ATremblingHandStillClicksWhereItPressed) {
    ClickDetector clicks;
    clicks.press(kLeft, {10, 20}, true);
    clicks.move({12, 22});
    clicks.move({10, 24});
    EXPECT_FALSE(clicks.dragging());
    EXPECT_EQ(clicks.release(kLeft, {7, 20}), (Cursor{10, 20}));
}

TEST(ClickDetector, ExactlyTheSlopIsAClickAndMoreIsNot) {
    ClickDetector clicks;
    clicks.press(kLeft, {0, 0}, true);
    EXPECT_TRUE(clicks.release(kLeft, {ClickDetector::kSlop, 0}));
    clicks.press(kLeft, {0, 0}, true);
    EXPECT_FALSE(clicks.release(kLeft, {ClickDetector::kSlop + 1e-9, 0}));
    clicks.press(kLeft, {0, 0}, true);
    EXPECT_FALSE(clicks.release(kLeft, {3, 3})) << "the slop is a circle";
}

TEST(ClickDetector, ADragThatReturnsToItsStartIsADrag) {
    ClickDetector clicks;
    clicks.press(kLeft, {100, 100}, true);
    clicks.move({150, 100});
    EXPECT_TRUE(clicks.dragging());
    clicks.move({100, 100});
    EXPECT_TRUE(clicks.dragging());
    EXPECT_FALSE(clicks.release(kLeft, {100, 100}));
    EXPECT_FALSE(clicks.dragging());
}

TEST(ClickDetector, AReleaseElsewhereIsADragEvenWithoutAMoveEvent) {
    ClickDetector clicks;
    clicks.press(kLeft, {100, 100}, true);
    EXPECT_FALSE(clicks.release(kLeft, {300, 100}));
}

TEST(ClickDetector, APressOnAPanelNeverClicks) {
    ClickDetector clicks;
    clicks.press(kLeft, {10, 10}, false);
    EXPECT_FALSE(clicks.held());
    clicks.move({300, 300});
    EXPECT_FALSE(clicks.dragging());
    EXPECT_FALSE(clicks.release(kLeft, {10, 10}));
}

TEST(ClickDetector, AReleaseWithoutAPressIsNothing) {
    ClickDetector clicks;
    clicks.move({5, 5});
    EXPECT_FALSE(clicks.release(kLeft, {5, 5}));
}

TEST(ClickDetector, AnotherButtonMeanwhileSpoilsTheClick) {
    ClickDetector clicks;
    clicks.press(kLeft, {10, 10}, true);
    clicks.press(kRight, {10, 10}, true);
    EXPECT_EQ(clicks.held(), kLeft);
    EXPECT_FALSE(clicks.release(kRight, {10, 10})) << "its press did not begin a gesture";
    EXPECT_EQ(clicks.held(), kLeft);
    EXPECT_FALSE(clicks.release(kLeft, {10, 10}));
    clicks.press(kLeft, {10, 10}, true);
    EXPECT_TRUE(clicks.release(kLeft, {10, 10})) << "the next one counts again";
}

TEST(ClickDetector, TheReleaseOfAnotherButtonEndsNothing) {
    ClickDetector clicks;
    clicks.press(kLeft, {10, 10}, true);
    EXPECT_FALSE(clicks.release(kRight, {10, 10}));
    EXPECT_TRUE(clicks.release(kLeft, {10, 10}));
}

TEST(ClickDetector, CancelForgetsThePress) {
    ClickDetector clicks;
    clicks.press(kLeft, {10, 10}, true);
    clicks.cancel();
    EXPECT_FALSE(clicks.held());
    EXPECT_FALSE(clicks.release(kLeft, {10, 10}));
}

TEST(ClickDetector, APressWhoseReleaseGotLostStartsAnew) {
    ClickDetector clicks;
    clicks.press(kLeft, {10, 10}, true);
    clicks.move({200, 200});
    clicks.press(kLeft, {50, 50}, true);
    EXPECT_FALSE(clicks.dragging());
    EXPECT_EQ(clicks.release(kLeft, {51, 50}), (Cursor{50, 50}));
    clicks.press(kLeft, {10, 10}, true);
    clicks.press(kLeft, {10, 10}, false);
    EXPECT_FALSE(clicks.release(kLeft, {10, 10})) << "the second press was on a panel";
}

TEST(ClickDetector, ANaNIsNoClick) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    ClickDetector clicks;
    clicks.press(kLeft, {nan, 10}, true);
    EXPECT_FALSE(clicks.release(kLeft, {nan, 10}));
}

}  // namespace
}  // namespace raypick
