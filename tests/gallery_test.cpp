// The gallery's scenes: every file in it loads without a warning, shows something, and comes back
// from a saved file with the same image, bit for bit.
#include "tracer/accel/accel.h"
#include "tracer/io/load.h"
#include "tracer/io/save_scene.h"
#include "tracer/render/render_job.h"

#include "gallery_files.h"
#include "model_files.h"

#include <gmock/gmock.h>

#include <cstring>
#include <set>
#include <utility>

namespace raypick {
namespace {

constexpr ImageSize kSize{20, 32};

RenderedFrame traced(Scene scene) {
    auto shared = std::make_shared<const Scene>(std::move(scene));
    const Camera camera = default_camera(*shared, kSize);
    RenderSettings settings;
    settings.depth = 8;
    settings.glass_shadows = GlassShadows::tinted;
    settings.threads = 2;
    return render(std::make_shared<const Accel>(shared), camera, kSize, settings);
}

class Gallery : public ModelFiles, public testing::WithParamInterface<std::string> {};

TEST_P(Gallery, LoadsWithACameraLightsAndNoWarning) {
    const LoadedScene loaded = load_scene(asset("gallery") / GetParam());
    EXPECT_THAT(loaded.warnings, testing::IsEmpty());
    EXPECT_EQ(loaded.scene.cameras.size(), 1u);
    EXPECT_FALSE(loaded.scene.lights.empty());
}

TEST_P(Gallery, ShowsManyThingsInManyColours) {
    const RenderedFrame result = traced(load_scene(asset("gallery") / GetParam()).scene);
    EXPECT_EQ(result.nan_pixels, 0u);
    std::set<std::pair<std::uint32_t, std::uint32_t>> things;  // NFF's spheres are one object
    for (std::size_t i = 0; i < result.image.object.size(); ++i) {
        if (result.image.object[i] == kNoObject) continue;
        things.emplace(result.image.object[i], result.image.primitive[i]);
    }
    EXPECT_GE(things.size(), 3u);
    std::set<std::uint8_t> levels;
    for (const glm::vec3& colour : result.image.colour)
        levels.insert(srgb_byte(colour.y));
    EXPECT_GE(levels.size(), 30u);
}

TEST_P(Gallery, ComesBackFromASavedFile) {
    const std::filesystem::path saved = folder_ / "saved.json";
    const Scene scene = load_scene(asset("gallery") / GetParam()).scene;
    save_scene(scene, saved);
    const LoadedScene again = load_scene(saved);
    EXPECT_THAT(again.warnings, testing::IsEmpty());
    const std::vector<glm::vec3> before = traced(scene).image.colour;
    const std::vector<glm::vec3> after = traced(again.scene).image.colour;
    ASSERT_EQ(before.size(), after.size());
    EXPECT_EQ(std::memcmp(before.data(), after.data(), before.size() * sizeof(before[0])), 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Gallery, testing::ValuesIn(gallery_files()), gallery_test_name);

}  // namespace
}  // namespace raypick
