// The raster view's lights, materials and environments against the traced image without shadows and
// further rays.
#include "tests/look_fixture.h"

#include <glm/gtc/constants.hpp>

#include <cmath>

namespace raypick {
namespace {

Material shiny(const glm::vec3& colour, LocalModel model) {
    Material m;
    m.ambient = 0.5f * colour;
    m.diffuse = colour;
    m.specular = {0.6f, 0.5f, 0.4f};
    m.shininess = model == LocalModel::phong ? 12.0f : 40.0f;
    m.emissive = 0.03f * colour;
    m.model = model;
    return m;
}

// A ball and a box on a floor, seen from slightly above.
Scene still_life(LocalModel model) {
    Scene scene;
    const MaterialId red = add_material(scene, shiny({0.8f, 0.2f, 0.1f}, model));
    const MaterialId grey = add_material(scene, shiny({0.5f, 0.5f, 0.55f}, model));
    place(scene, Plane{{0.0, 1.0, 0.0}, 1.0}, grey);
    place(scene, Sphere{{-0.7, 0.0, 0.0}, 1.0}, red);
    place(scene, Box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}, red,
          translate({1.1, -0.4, 0.6}) * rotate(30, {0.1, 1, 0.2}));
    return scene;
}

const Camera kView = camera_at({0.4, 1.6, 5.0}, {0.1, -0.2, 0.0});

struct NamedLight {
    const char* name;
    Light light;
};

const NamedLight kLights[] = {
    {"point", PointLight{"", {1.5, 2.5, 2.0}, {0.9f, 0.8f, 0.7f}}},
    {"attenuated", PointLight{"", {1.5, 1.5, 2.0}, {3.0f, 2.0f, 2.5f}, {0.4, 0.3, 0.2}}},
    {"inverse_square", PointLight{"", {1.5, 1.5, 2.0}, {5.0f, 4.0f, 6.0f}, {0.0, 0.0, 1.0}}},
    {"directional", DirectionalLight{"", {-0.4, -2.0, -1.0}, {0.8f, 0.9f, 0.7f}}},
    {"spot", SpotLight{"",
                       {1.5, 2.5, 2.0},
                       {-2.0, -3.0, -2.2},
                       {1.2f, 1.1f, 0.9f},
                       {1.0, 0.05, 0.0},
                       12.0,
                       32.0}},
    {"sharp_spot",
     SpotLight{"", {1.5, 2.5, 2.0}, {-2.0, -3.0, -2.2}, glm::vec3(1.0f), {}, 20.0, 20.0}},
    {"half_space_spot",
     SpotLight{"", {0.0, 1.5, 1.0}, {0.5, -0.2, 0.1}, glm::vec3(1.0f), {}, 0.0, 90.0}},
    {"sphere_centre", SphereLight{"", {1.5, 2.5, 2.0}, 0.7, glm::vec3(0.8f), {}, 1}},
    {"rectangle_centre",
     RectangleLight{
         "", {0.5, 2.5, 2.0}, {1.2, 0, 0}, {0, 0.3, 0.9}, glm::vec3(0.8f), {0.5, 0.2, 0.0}, 1}},
};

class LightTest : public LookTest,
                  public ::testing::WithParamInterface<std::tuple<std::size_t, LocalModel>> {};

TEST_P(LightTest, ShadesAsTheTracer) {
    Scene scene = still_life(std::get<1>(GetParam()));
    scene.lights.push_back(kLights[std::get<0>(GetParam())].light);
    agree(std::move(scene), kView);
}

INSTANTIATE_TEST_SUITE_P(Lights, LightTest,
                         ::testing::Combine(::testing::Range(std::size_t{0}, std::size(kLights)),
                                            ::testing::Values(LocalModel::phong,
                                                              LocalModel::blinn_phong)),
                         [](const auto& test) {
                             const bool phong = std::get<1>(test.param) == LocalModel::phong;
                             return std::string(kLights[std::get<0>(test.param)].name) +
                                    (phong ? "_phong" : "_blinn_phong");
                         });

// The point lights at the centres of an area light's cells.
std::vector<Light> cell_centres(const RectangleLight& light) {
    std::vector<Light> points;
    for (int i = 0; i < light.samples; ++i) {
        for (int j = 0; j < light.samples; ++j) {
            const double u = (i + 0.5) / light.samples;
            const double v = (j + 0.5) / light.samples;
            points.emplace_back(
                PointLight{"", light.corner + u * light.edge_u + v * light.edge_v,
                           light.colour / static_cast<float>(light.samples * light.samples),
                           light.attenuation});
        }
    }
    return points;
}

TEST_F(LookTest, RectangleLightsAreTheCentresOfTheirCells) {
    const RectangleLight area{
        "", {0.5, 2.0, 1.5}, {1.5, 0.2, 0}, {0, 0.3, 1.2}, {0.9f, 0.8f, 0.7f}, {0.5, 0.2, 0.1}, 5};
    Scene scene = still_life(LocalModel::phong);
    scene.lights = {area};
    const Image one = both(scene, kView).raster;
    scene.lights = cell_centres(area);
    const ColourAgreement result =
        compare_colours(both(scene, kView).traced, one, kColourTolerance);
    EXPECT_EQ(result.share_beyond, 0.0) << result.summary();
    EXPECT_GT(result.contrast, 0.01) << result.summary();
}

// The tracer's samples lie anywhere in the cells: with many of them both are the same integral.
TEST_F(LookTest, AreaLightsShadeAsTheTracersMean) {
    const Light lights[] = {
        SphereLight{"", {1.5, 2.0, 2.0}, 0.9, {0.9f, 0.8f, 0.7f}, {0.5, 0.2, 0.1}, 16},
        RectangleLight{
            "", {0.5, 2.0, 1.5}, {1.5, 0.2, 0}, {0, 0.3, 1.2}, {0.9f, 0.8f, 0.7f}, {}, 16}};
    for (const Light& light : lights) {
        Scene scene = still_life(LocalModel::blinn_phong);
        scene.lights = {light};
        const Pictures pictures = both(std::move(scene), kView, {60, 81});
        const ColourAgreement result = compare_colours(pictures.traced, pictures.raster, 5e-3f);
        EXPECT_LE(result.share_beyond, 5e-3) << result.summary();
        EXPECT_LT(result.mean, 3e-4) << result.summary();
        EXPECT_GT(result.contrast, 0.01) << result.summary();
    }
}

TEST_F(LookTest, ManyLightsOfAllKindsAddUp) {
    Scene scene = still_life(LocalModel::phong);
    for (const NamedLight& named : kLights) {
        if (std::string(named.name) != "sharp_spot") scene.lights.push_back(named.light);
    }
    const Pictures pictures = both(std::move(scene), kView);
    const ColourAgreement result = compare_colours(pictures.traced, pictures.raster, 5e-3f);
    EXPECT_LE(result.share_beyond, 1e-3) << result.summary();
}

TEST_F(LookTest, LightsFarFromTheOriginKeepTheirPlaces) {
    const glm::dvec3 offset(3.0e5, -1.0e5, 2.0e5);
    Scene scene = still_life(LocalModel::phong);
    for (Object& object : scene.objects)
        object.world_from_object = translate(offset) * object.world_from_object;
    scene.lights.emplace_back(
        SpotLight{"", offset + glm::dvec3(1.5, 2.5, 2.0), {-2.0, -3.0, -2.2}, glm::vec3(1.0f)});
    // The tracer's own points are floats: 1/32 apart here.
    Camera camera = kView;
    camera.eye = glm::dvec3(glm::vec3(camera.eye + offset));
    camera.at += offset;
    const Pictures pictures = both(std::move(scene), camera);
    const ColourAgreement result = compare_colours(pictures.traced, pictures.raster, 0.05f);
    EXPECT_LE(result.share_beyond, 0.02) << result.summary();
}

TEST_F(LookTest, BlendedSurfacesGiveTheirShareAlone) {
    Scene scene = still_life(LocalModel::phong);
    scene.materials[0].alpha_mode = AlphaMode::blend;
    scene.materials[0].opacity = 0.35f;
    scene.materials[1].opacity = 0.8f;  // a cut-out above its cut-off is all there
    scene.lights.push_back(kLights[0].light);
    agree(std::move(scene), kView);
}

TEST_F(LookTest, ShininessZeroAndGrazingHighlightsAreNumbers) {
    for (const LocalModel model : {LocalModel::phong, LocalModel::blinn_phong}) {
        Scene scene = still_life(model);
        for (Material& m : scene.materials)
            m.shininess = 0.0f;
        // Behind the eye, and exactly opposite to it.
        scene.lights.emplace_back(PointLight{"", kView.eye, glm::vec3(0.5f)});
        scene.lights.emplace_back(PointLight{"", 2.0 * kView.at - kView.eye, glm::vec3(0.5f)});
        agree(std::move(scene), kView, 5e-3);
    }
}

// --- Environments -------------------------------------------------------------------------------

// Nothing but a small ball, so that nearly all is sky.
Scene sky_scene(Environment environment) {
    Scene scene;
    place(scene, Sphere{{0, 0, 0}, 0.1});
    scene.environment = std::move(environment);
    return scene;
}

std::shared_ptr<const SkyPixels> noisy_sky(int rows, int cols) {
    std::vector<glm::vec3> texels;
    Random random(17);
    for (int i = 0; i < rows * cols; ++i) {
        texels.emplace_back(random.point(glm::dvec3(0.0), glm::dvec3(1.0)));
    }
    return make_sky_pixels(rows, cols, std::move(texels));
}

std::vector<Camera> views_all_around() {
    std::vector<Camera> cameras;
    for (const glm::dvec3& direction :
         {glm::dvec3(0, 0, -1), glm::dvec3(1, 0.3, 0.2), glm::dvec3(-0.3, 0.9, 0.1),
          glm::dvec3(0.2, -1, 0.3), glm::dvec3(0.1, 0.05, 1)}) {
        Camera camera = camera_at(-3.0 * direction, glm::dvec3(0.0));
        camera.fovy = 70;
        cameras.push_back(camera);
    }
    return cameras;
}

TEST_F(LookTest, GradientSky) {
    GradientSky sky;
    sky.up = {0.2, 2.0, -0.3};
    for (const Camera& camera : views_all_around())
        agree(sky_scene(sky), camera);
}

TEST_F(LookTest, CoarseImageSkyIsInterpolatedAlsoAtSeamAndPoles) {
    ImageSky sky;
    sky.pixels = noisy_sky(7, 12);
    sky.up = {0.1, 1.0, 0.2};
    sky.forward = {0.3, 0.1, -1.0};
    sky.scale = 0.8f;
    for (const Camera& camera : views_all_around())
        agree(sky_scene(sky), camera);
}

TEST_F(LookTest, FineImageSkyIsAveraged) {
    ImageSky sky;
    sky.pixels = noisy_sky(1000, 1800);
    for (const Camera& camera : views_all_around())
        agree(sky_scene(sky), camera, 5e-3, {61, 83});
}

}  // namespace
}  // namespace raypick
