#include "viewer/app/panels.h"
#include "viewer/app/widgets.h"

#include <fmt/format.h>
#include <imgui.h>

namespace raypick {

namespace {

void draw_warnings(const std::vector<std::string>& warnings) {
    const std::string label = warnings.size() == 1 ? std::string("1 warning")
                                                   : fmt::format("{} warnings", warnings.size());
    if (!ImGui::TreeNode("warnings", "%s", label.c_str())) return;
    constexpr std::size_t kShown = 50;
    for (std::size_t i = 0; i < warnings.size() && i < kShown; ++i)
        draw_dim_text(warnings[i]);
    if (warnings.size() > kShown) {
        draw_dim_text(fmt::format("... and {} more", warnings.size() - kShown));
    }
    ImGui::TreePop();
}

}  // namespace

void draw_scene_panel(const Document* document) {
    draw_heading("Scene");
    if (document == nullptr) {
        draw_dim_text("Nothing is open.");
        return;
    }
    const Scene& scene = document->scene();
    draw_text(document->file.filename().string());
    if (begin_values("scene")) {
        draw_value("objects", fmt::format("{}", scene.objects.size()));
        draw_value("triangles",
                   short_count(static_cast<double>(document->accel->stats().triangles)));
        draw_value("materials", fmt::format("{}", scene.materials.size()));
        draw_value("lights", scene.lights.empty() ? std::string("headlight")
                                                  : fmt::format("{}", scene.lights.size()));
        draw_value("opened in", fmt::format("{} + {} build", short_time(document->load_seconds),
                                            short_time(document->build_seconds)));
        end_values();
    }
    if (!document->warnings.empty()) draw_warnings(document->warnings);
}

}  // namespace raypick
