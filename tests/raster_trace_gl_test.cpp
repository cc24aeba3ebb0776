// The raster view looks like the traced image with shadows, reflection and refraction off: on our
// scenes and on real models, as a person sees it (sRGB), away from the edges of objects.
#include "tests/colour_agreement.h"
#include "tests/gl_fixture.h"
#include "tracer/io/load.h"
#include "viewer/raster/rasterizer.h"

namespace raypick {
namespace {

constexpr ImageSize kSize{270, 480};

double srgb_difference(const glm::vec3& a, const glm::vec3& b) {
    double sum = 0.0;
    for (int channel = 0; channel < 3; ++channel) {
        sum += std::abs(static_cast<double>(srgb_byte(a[channel])) -
                        static_cast<double>(srgb_byte(b[channel]))) /
               255.0;
    }
    return sum / 3.0;
}

struct Likeness {
    std::size_t compared = 0;
    std::size_t objects = 0;
    double mean = 0.0;  // absolute difference of a channel, 1: black against white
    double worst = 0.0;
};

Likeness compare_pictures(const Image& traced, const Image& raster) {
    Likeness result;
    std::vector<ObjectId> ids;
    double sum = 0.0;
    for (int row = 0; row < kSize.rows; ++row) {
        for (int col = 0; col < kSize.cols; ++col) {
            const Pixel p{row, col};
            const std::size_t i = kSize.index(p);
            const auto around = [p](const Image& image) {
                return uniform_around(kSize, p,
                                      [&](Pixel q) { return image.object[kSize.index(q)]; });
            };
            if (!around(traced) || !around(raster)) continue;
            const double difference = srgb_difference(traced.colour[i], raster.colour[i]);
            ids.push_back(traced.object[i]);
            sum += difference;
            result.worst = std::max(result.worst, difference);
        }
    }
    result.compared = ids.size();
    result.mean = ids.empty() ? 1.0 : sum / static_cast<double>(ids.size());
    std::sort(ids.begin(), ids.end());
    result.objects = static_cast<std::size_t>(std::unique(ids.begin(), ids.end()) - ids.begin());
    return result;
}

class RasterTraceTest : public GlTest {
protected:
    static void expect_alike(const std::filesystem::path& file) {
        const auto scene = std::make_shared<const Scene>(load_scene(file).scene);
        const Camera camera = choose_camera(*scene, kSize, {});
        Rasterizer rasterizer;
        rasterizer.set_scene(scene);
        rasterizer.draw(camera, kSize);
        const Likeness result =
            compare_pictures(trace_local(Accel(scene), camera, kSize), rasterizer.read_image());
        fmt::print(
            "    {}: {} objects, {} textures, {} of {} pixels, mean {:.4f} %, worst {:.2f} %\n",
            file.filename().string(), result.objects, scene->textures.size(), result.compared,
            kSize.pixel_count(), 100.0 * result.mean, 100.0 * result.worst);
        EXPECT_LT(result.mean, 0.005);
        EXPECT_GT(result.compared, kSize.pixel_count() / 2);
        EXPECT_GT(result.objects, 0u);
    }
};

class AssetTest : public RasterTraceTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(AssetTest, LooksLikeTheTracedImage) {
    expect_alike(asset(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Assets, AssetTest,
                         ::testing::Values("default.json", "shapes.json", "glass.json"),
                         [](const auto& test) {
                             return std::filesystem::path(test.param).stem().string();
                         });

class ModelTest : public RasterTraceTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(ModelTest, LooksLikeTheTracedImage) {
    RAYPICK_REQUIRE_MODEL(GetParam());
    expect_alike(model(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Models, ModelTest,
                         ::testing::Values("bitterli/kitchen.glb",
                                           "sweethome3d/poolTable/poolTable.obj", "gltf/statue.glb",
                                           "spd/balls.nff", "spd/rings.nff",
                                           "assimp/glTF2/BoxTextured-glTF-Binary/BoxTextured.glb"),
                         [](const auto& test) {
                             return std::filesystem::path(test.param).stem().string();
                         });

}  // namespace
}  // namespace raypick
