#include "viewer/app/panels.h"
#include "viewer/app/widgets.h"

#include <fmt/format.h>
#include <imgui.h>

namespace raypick {

namespace {

void draw_pick(const Pixel& pixel, const Pick& pick) {
    if (!begin_values("pick")) return;
    draw_value("object", pick.object);
    draw_value("path", pick.path);
    draw_value("material", pick.material.empty() ? "none" : pick.material);
    draw_value("primitive", fmt::format("{}", pick.hit.primitive));
    draw_value("row, col", fmt::format("{}, {}", pixel.row, pixel.col));
    draw_value("t", fmt::format("{:.7g}", pick.hit.t));
    draw_value("point",
               fmt::format("{:.7g}\n{:.7g}\n{:.7g}", pick.point.x, pick.point.y, pick.point.z));
    draw_value("normal",
               fmt::format("{:.4f}  {:.4f}  {:.4f}", pick.normal.x, pick.normal.y, pick.normal.z));
    draw_value("side", pick.hit.front_face ? "front" : "back");
    end_values();
}

void draw_others(const Selection& selection) {
    const auto& entries = selection.entries();
    if (entries.size() < 2) return;
    draw_dim_text(fmt::format("{} objects selected:", entries.size()));
    constexpr std::size_t kShown = 12;
    for (std::size_t i = 0; i < entries.size() && i < kShown; ++i) {
        if (entries[i].pick.pick) draw_text(entries[i].pick.pick->object);
    }
    if (entries.size() > kShown) draw_dim_text(fmt::format("and {} more", entries.size() - kShown));
}

}  // namespace

std::optional<Command> draw_selection_panel(const Selection& selection) {
    draw_heading("Selection");
    const Selection::Entry* entry = selection.primary();
    if (entry == nullptr || !entry->pick.pick) {
        draw_dim_text("Click an object to see what it is. Shift+click adds another one.");
        return std::nullopt;
    }
    draw_pick(entry->pick.pixel, *entry->pick.pick);
    draw_others(selection);
    if (draw_wide_button("Frame it  (F)")) return Command::frame_selected;
    return std::nullopt;
}

}  // namespace raypick
