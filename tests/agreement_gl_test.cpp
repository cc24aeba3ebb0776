// The id buffer that OpenGL draws equals the tracer's first hits, on our scenes and on real models.
#include "tests/agreement.h"

#include "tests/gl_fixture.h"
#include "tracer/io/load.h"
#include "tracer/render/render_job.h"
#include "viewer/raster/rasterizer.h"

#include <glm/geometric.hpp>

namespace raypick {
namespace {

constexpr ImageSize kSize{211, 317};  // odd and not square

// The camera moved around its target, towards it and up.
Camera moved(const Camera& camera, const Bounds& bounds, double degrees, double closer,
             double rise) {
    const glm::dvec3 offset = camera.eye - camera.at;
    Camera other = camera;
    other.eye = camera.at + rotate(degrees, camera.up).vector(offset) * closer +
                glm::normalize(camera.up) * (rise * glm::length(offset));
    other.near = near_for_bounds(other, bounds);
    return other;
}

struct View {
    std::shared_ptr<const Scene> scene;
    std::unique_ptr<Accel> accel;
    std::vector<Camera> cameras;
};

View open(const std::filesystem::path& file) {
    View view;
    view.scene = std::make_shared<const Scene>(load_scene(file).scene);
    view.accel = std::make_unique<Accel>(view.scene);
    const Bounds& bounds = view.accel->bounds();
    const Camera first = choose_camera(*view.scene, kSize, {});
    view.cameras = {first, moved(first, bounds, 73.0, 0.8, 0.15),
                    moved(first, bounds, -160.0, 0.45, 0.3)};
    return view;
}

class AgreementTest : public GlTest {
protected:
    // To the bit.
    static void expect_same(const Image& a, const Image& b) {
        EXPECT_TRUE(a.object == b.object);
        EXPECT_TRUE(a.primitive == b.primitive);
        EXPECT_TRUE(a.depth == b.depth);
        EXPECT_TRUE(a.normal == b.normal);
        EXPECT_TRUE(a.colour == b.colour);
    }

    static void agree(const std::filesystem::path& file) {
        const View view = open(file);
        Rasterizer rasterizer;
        rasterizer.set_scene(view.scene);
        Rasterizer drawing_all(Unseen::drawn);
        drawing_all.set_scene(view.scene);
        for (const Camera& camera : view.cameras) {
            rasterizer.draw(camera, kSize);
            const Image image = rasterizer.read_image();
            drawing_all.draw(camera, kSize);
            expect_same(image, drawing_all.read_image());
            const Agreement result = compare(*view.accel, camera, image);
            fmt::print("    {}: {}\n", file.filename().string(), result.summary());
            EXPECT_GT(result.objects, 0u);
            EXPECT_EQ(result.uniform_differ, 0u) << result.summary();
            EXPECT_LE(result.edge_share(), 0.005) << result.summary();
            EXPECT_LE(result.ties, result.pixels / 200) << result.summary();
            EXPECT_LT(result.t_error, 2e-5) << result.summary();
        }
    }
};

class AssetAgreementTest : public AgreementTest,
                           public ::testing::WithParamInterface<const char*> {};

TEST_P(AssetAgreementTest, GlShowsWhatTheRaysHit) {
    RAYPICK_REQUIRE(std::filesystem::exists(asset(GetParam())),
                    std::string(GetParam()) + " is not there");
    agree(asset(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Assets, AssetAgreementTest,
                         ::testing::Values("default.json", "shapes.json", "spheres.json",
                                           "glass.json", "mirror.json", "far.json",
                                           "triangle.json"),
                         [](const auto& test) {
                             return std::filesystem::path(test.param).stem().string();
                         });

class ModelAgreementTest : public AgreementTest,
                           public ::testing::WithParamInterface<const char*> {};

TEST_P(ModelAgreementTest, GlShowsWhatTheRaysHit) {
    RAYPICK_REQUIRE_MODEL(GetParam());
    agree(model(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Models, ModelAgreementTest,
                         ::testing::Values("stanford/bunny_binary.ply", "openfoam/motorBike.obj",
                                           "bitterli/kitchen.glb", "gltf/CesiumMilkTruck.glb",
                                           "spd/balls.nff"),
                         [](const auto& test) {
                             return std::filesystem::path(test.param).stem().string();
                         });

// A click, the traced frame and the raster frame: one answer.
TEST(TracedFrame, HasTheSameIdsAsThePicks) {
    RAYPICK_REQUIRE(std::filesystem::exists(asset("default.json")), "default.json is not there");
    View view = open(asset("default.json"));
    const std::shared_ptr<const Accel> accel = std::move(view.accel);
    const Camera camera = view.cameras.front();
    RenderSettings settings;
    settings.depth = 1;
    const RenderedFrame frame = render(accel, camera, kSize, settings);
    for (int row = 0; row < kSize.rows; ++row) {
        for (int col = 0; col < kSize.cols; ++col) {
            const auto hit = accel->intersect(camera_ray(camera, kSize, Pixel{row, col}));
            const std::size_t i = kSize.index({row, col});
            ASSERT_EQ(frame.image.object[i], hit ? hit->object : kNoObject) << row << " " << col;
            ASSERT_EQ(frame.image.primitive[i], hit ? hit->primitive : 0xffffffffu);
        }
    }
}

}  // namespace
}  // namespace raypick
