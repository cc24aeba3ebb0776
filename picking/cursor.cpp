#include "picking/cursor.h"

#include <cmath>

namespace raypick {
namespace {

// Index of the cell under `cursor` on one axis, counted from `begin`; nothing outside its `count`
// cells. Comparisons are arranged so that a NaN is outside.
std::optional<int> cell_under(double cursor, double window, int framebuffer, int begin, int count) {
    if (!(window > 0.0) || framebuffer <= 0) return std::nullopt;
    const double cell = std::floor(cursor * framebuffer / window) - begin;
    if (!(cell >= 0.0 && cell < count)) return std::nullopt;
    return static_cast<int>(cell);
}

}  // namespace

std::optional<Pixel> pixel_under(Cursor cursor, const WindowMetrics& window, const ViewRect& view) {
    const auto row = cell_under(cursor.y, window.window_height, window.framebuffer_rows,
                                view.top_left.row, view.size.rows);
    const auto col = cell_under(cursor.x, window.window_width, window.framebuffer_cols,
                                view.top_left.col, view.size.cols);
    if (!row || !col) return std::nullopt;
    return Pixel{*row, *col};
}

}  // namespace raypick
