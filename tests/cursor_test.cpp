#include "picking/cursor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace raypick {
namespace {

// A window of 801 x 603 units on a screen with these scales.
WindowMetrics window_at(double scale_x, double scale_y) {
    return {801.0, 603.0, static_cast<int>(std::lround(801 * scale_x)),
            static_cast<int>(std::lround(603 * scale_y))};
}

ViewRect whole(const WindowMetrics& window) {
    return {{0, 0}, {window.framebuffer_rows, window.framebuffer_cols}};
}

struct CursorCase {
    double scale_x, scale_y;
    Cursor cursor;
    Pixel expected;
};

void PrintTo(const CursorCase& c, std::ostream* out) {
    *out << "scale " << c.scale_x << " x " << c.scale_y << ", cursor (" << c.cursor.x << ", "
         << c.cursor.y << ")";
}

class CursorTable : public testing::TestWithParam<CursorCase> {};

TEST_P(CursorTable, GivesThePixelWorkedOutByHand) {
    const CursorCase& c = GetParam();
    const WindowMetrics window = window_at(c.scale_x, c.scale_y);
    EXPECT_EQ(pixel_under(c.cursor, window, whole(window)), c.expected);
}

INSTANTIATE_TEST_SUITE_P(
    Scales, CursorTable,
    testing::Values(CursorCase{1, 1, {0, 0}, {0, 0}},              //
                    CursorCase{1, 1, {0.99, 0.99}, {0, 0}},        //
                    CursorCase{1, 1, {1.0, 2.0}, {2, 1}},          //
                    CursorCase{1, 1, {400.5, 301.5}, {301, 400}},  //
                    CursorCase{2, 2, {0.5, 0.49}, {0, 1}},         //
                    CursorCase{2, 2, {10.25, 20.75}, {41, 20}},    //
                    CursorCase{2, 2, {800.9, 602.9}, {1205, 1601}},
                    // 801 * 1.25 = 1001.25 is 1001 columns, 603 * 1.25 = 753.75 is 754 rows.
                    CursorCase{1.25, 1.25, {100.0, 100.0}, {125, 124}},
                    CursorCase{1.25, 1.25, {800.999, 602.999}, {753, 1000}},
                    // 1201.5 rounds to 1202 columns, 904.5 to 905 rows.
                    CursorCase{1.5, 1.5, {100.0, 100.0}, {150, 150}},
                    CursorCase{1.5, 1.5, {0.66, 0.67}, {1, 0}},
                    CursorCase{2, 1, {300.5, 300.5}, {300, 601}},
                    CursorCase{1, 2, {300.5, 300.5}, {601, 300}},
                    CursorCase{1.25, 2, {100.0, 100.0}, {200, 124}}));

TEST(Cursor, FourCornersAtEveryScale) {
    for (const double scale_x : {1.0, 1.25, 1.5, 2.0}) {
        for (const double scale_y : {1.0, 1.25, 1.5, 2.0}) {
            SCOPED_TRACE(testing::Message() << scale_x << " x " << scale_y);
            const WindowMetrics w = window_at(scale_x, scale_y);
            const int last_row = w.framebuffer_rows - 1;
            const int last_col = w.framebuffer_cols - 1;
            const double right = std::nextafter(w.window_width, 0.0);
            const double bottom = std::nextafter(w.window_height, 0.0);
            EXPECT_EQ(pixel_under({0, 0}, w, whole(w)), (Pixel{0, 0}));
            EXPECT_EQ(pixel_under({right, 0}, w, whole(w)), (Pixel{0, last_col}));
            EXPECT_EQ(pixel_under({0, bottom}, w, whole(w)), (Pixel{last_row, 0}));
            EXPECT_EQ(pixel_under({right, bottom}, w, whole(w)), (Pixel{last_row, last_col}));
        }
    }
}

TEST(Cursor, EveryPixelCentreComesBack) {
    for (const double scale : {1.0, 1.25, 1.5, 2.0}) {
        const WindowMetrics w = window_at(scale, 3.0 - scale);
        for (int i = 0; i < std::min(w.framebuffer_rows, w.framebuffer_cols); ++i) {
            const Cursor centre{(i + 0.5) * w.window_width / w.framebuffer_cols,
                                (i + 0.5) * w.window_height / w.framebuffer_rows};
            ASSERT_EQ(pixel_under(centre, w, whole(w)), (Pixel{i, i})) << "scale " << scale;
        }
    }
}

TEST(Cursor, JustOutsideEachSideIsNothing) {
    for (const double scale : {1.0, 1.25, 1.5, 2.0}) {
        const WindowMetrics w = window_at(scale, scale);
        EXPECT_FALSE(pixel_under({-1e-9, 300}, w, whole(w)));
        EXPECT_FALSE(pixel_under({400, -1e-9}, w, whole(w)));
        EXPECT_FALSE(pixel_under({w.window_width, 300}, w, whole(w)));
        EXPECT_FALSE(pixel_under({400, w.window_height}, w, whole(w)));
    }
}

TEST(Cursor, NegativeFractionsAreNotPixelZero) {
    const WindowMetrics w = window_at(1, 1);
    EXPECT_FALSE(pixel_under({-0.3, 10}, w, whole(w)));
    EXPECT_FALSE(pixel_under({10, -0.3}, w, whole(w)));
    EXPECT_FALSE(pixel_under({-0.3, -0.3}, w, whole(w)));
}

// Panels on the left (100 px) and on top (30 px), at scale 2.
TEST(Cursor, ViewThatDoesNotStartAtTheOrigin) {
    const WindowMetrics w{400, 300, 800, 600};
    const ViewRect view{{30, 100}, {500, 650}};
    EXPECT_EQ(pixel_under({50, 15}, w, view), (Pixel{0, 0}));
    EXPECT_EQ(pixel_under({50.5, 16.0}, w, view), (Pixel{2, 1}));
    EXPECT_EQ(pixel_under({374.9, 264.9}, w, view), (Pixel{499, 649}));
    EXPECT_FALSE(pixel_under({49.9, 100}, w, view)) << "on the left panel";
    EXPECT_FALSE(pixel_under({100, 14.9}, w, view)) << "on the top panel";
    EXPECT_FALSE(pixel_under({375.0, 100}, w, view)) << "right of the view";
    EXPECT_FALSE(pixel_under({100, 265.0}, w, view)) << "below the view";
}

TEST(Cursor, NonsenseIsNothing) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const WindowMetrics w = window_at(1, 1);
    EXPECT_FALSE(pixel_under({nan, 1}, w, whole(w)));
    EXPECT_FALSE(pixel_under({1, nan}, w, whole(w)));
    EXPECT_FALSE(pixel_under({infinity, 1}, w, whole(w)));
    EXPECT_FALSE(pixel_under({1, -infinity}, w, whole(w)));
    EXPECT_FALSE(pixel_under({1e300, 1e300}, w, whole(w)));
    EXPECT_FALSE(pixel_under({1, 1}, {}, whole(w))) << "an iconified window has size 0";
    EXPECT_FALSE(pixel_under({1, 1}, {nan, nan, 800, 600}, whole(w)));
    EXPECT_FALSE(pixel_under({1, 1}, {800, 600, 0, 0}, whole(w)));
    EXPECT_FALSE(pixel_under({1, 1}, w, {{0, 0}, {0, 0}}));
}

}  // namespace
}  // namespace raypick
