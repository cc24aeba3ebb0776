// The gallery's scenes drawn by OpenGL, held against the tracer without shadows and further rays.
#include "tests/gallery_files.h"
#include "tests/look_fixture.h"
#include "tracer/io/load.h"

namespace raypick {
namespace {

constexpr ImageSize kSize{100, 160};

class GalleryLook : public LookTest, public testing::WithParamInterface<std::string> {};

// The points of soft lights that the tracer tries are random; OpenGL's are not. So: their centres.
void take_centres(Scene& scene) {
    for (Light& light : scene.lights) {
        if (auto* ball = std::get_if<SphereLight>(&light)) ball->samples = 1;
        if (auto* window = std::get_if<RectangleLight>(&light)) window->samples = 1;
    }
}

TEST_P(GalleryLook, IsAsTraced) {
    Scene scene = load_scene(asset("gallery") / GetParam()).scene;
    take_centres(scene);
    const Camera camera = default_camera(scene, kSize);
    agree(std::move(scene), camera, 5e-3, kSize);
}

INSTANTIATE_TEST_SUITE_P(Scenes, GalleryLook, testing::ValuesIn(gallery_files()),
                         gallery_test_name);

}  // namespace
}  // namespace raypick
