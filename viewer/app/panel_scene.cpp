#include "viewer/app/panels.h"
#include "viewer/app/widgets.h"

#include <fmt/format.h>
#include <imgui.h>

namespace raypick {

namespace {

std::string counted(double count, const char* one, const char* many) {
    return fmt::format("{} {}", short_count(count), count == 1.0 ? one : many);
}

std::string counts(const Scene& scene, const AccelStats& stats) {
    const auto size = [](const auto& list) { return static_cast<double>(list.size()); };
    const std::string lights =
        scene.lights.empty() ? "headlight" : counted(size(scene.lights), "light", "lights");
    return fmt::format(
        "{}, {}, {}, {}", counted(size(scene.objects), "object", "objects"),
        counted(static_cast<double>(stats.triangles), "stored triangle", "stored triangles"),
        counted(size(scene.materials), "material", "materials"), lights);
}

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
    draw_dim_text(counts(scene, document->accel->stats()));
    draw_dim_text(fmt::format("read in {}, tree in {}", short_time(document->load_seconds),
                              short_time(document->build_seconds)));
    if (!document->warnings.empty()) draw_warnings(document->warnings);
}

}  // namespace raypick
