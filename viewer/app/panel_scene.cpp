#include "viewer/app/panels.h"
#include "viewer/app/widgets.h"

#include <fmt/format.h>
#include <imgui.h>

namespace raypick {

namespace {

std::string counted(double count, const char* one, const char* many) {
    return fmt::format("{} {}", short_count(count), count == 1.0 ? one : many);
}

std::string counts(const Scene& scene) {
    std::size_t triangles = 0;
    for (const Mesh& mesh : scene.meshes)
        triangles += mesh.triangles.size();
    const auto size = [](const auto& list) { return static_cast<double>(list.size()); };
    const std::string lights =
        scene.lights.empty() ? "headlight" : counted(size(scene.lights), "light", "lights");
    return fmt::format(
        "{}, {}, {}, {}", counted(size(scene.objects), "object", "objects"),
        counted(static_cast<double>(triangles), "stored triangle", "stored triangles"),
        counted(size(scene.materials), "material", "materials"), lights);
}

// Which of its trees there are.
std::string tree_text(const BuildProgress& trees) {
    if (!trees.accel) {
        return trees.error.empty() ? "building the first tree" : "no tree: " + trees.error;
    }
    const std::string first = "first tree in " + short_time(trees.first_seconds);
    if (trees.quality == TreeQuality::many_rays) {
        return fmt::format("{}, the better one in {}", first, short_time(trees.many_rays_seconds));
    }
    return first + (trees.error.empty() ? ", building a better one" : "; " + trees.error);
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

void draw_scene_panel(const Document* document, const BuildProgress& trees) {
    draw_heading("Scene");
    if (document == nullptr) {
        draw_dim_text("Nothing is open.");
        return;
    }
    draw_text(document->file.filename().string());
    draw_dim_text(counts(*document->scene));
    draw_dim_text(fmt::format("read in {}", short_time(document->load_seconds)));
    draw_dim_text(tree_text(trees));
    if (!document->warnings.empty()) draw_warnings(document->warnings);
}

}  // namespace raypick
