// Our pictures against those of POV-Ray 3.7, in linear colour, pixel by pixel: mean absolute
// difference below 1 % of full scale, 99 % of the pixels within 4 % of it in every channel.
//
// Left out, because the two differ by definition; in brackets the tests by closed form:
//   the soft edge of spot lights, a cubic there, glTF's square here (light_forms_test)
//   thin-walled sheets, priorities of overlapping glass, glass that blocks light: POV-Ray has none
//   (glass_forms_test)
//   total reflection in glass of constant coefficients: POV-Ray reflects all of the light, the
//   notes' rule what would have been transmitted (trace_test)
//   glass in glass by Fresnel: POV-Ray 3.7 takes the index of the glass that a ray leaves for that
//   of both sides, and so reflects nothing there; absorption of what is reflected inside: it leaves
//   that out (glass_in_glass_test)
//   one-sided surfaces, normal maps, filtered textures: POV-Ray has none
//
// With the environment variable RAYPICK_PICTURES=FOLDER both pictures are kept there.
#include "tests/looks.h"
#include "tests/model_files.h"
#include "tests/needs.h"
#include "tests/picture_difference.h"
#include "tests/pov_scene.h"
#include "tests/tracer_scenes.h"
#include "tracer/render/image.h"
#include "tracer/render/render_job.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <glm/gtc/constants.hpp>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

namespace raypick {
namespace {

constexpr double kMostMean = 0.01;
constexpr double kNear = 0.04;
constexpr double kLeastNear = 0.99;

// A scene with how it is looked at.
struct View {
    Scene scene;
    Camera camera;
    ImageSize size{120, 160};
    RenderSettings settings;
    int area_samples = 24;  // POV-Ray's, along each edge of a light
};

class PovrayOracle : public ModelFiles {
protected:
    // With `samples` x `samples` rays a pixel. Empty, with a test failure, if POV-Ray fails.
    Image by_povray(const View& view, int samples) {
        const ImageSize size{view.size.rows * samples, view.size.cols * samples};
        write_pov_scene(folder_, view.scene, view.camera, size, view.settings, view.area_samples);
        // 16 bits, linear, nothing smoothed, no window, everything computed.
        const std::string command = fmt::format(
            "cd '{}' && povray +Iscene.pov +Oscene.ppm +W{} +H{} +FP16 File_Gamma=1.0 "
            "-A -D +Q9 -GA >povray.log 2>&1",
            folder_.string(), size.cols, size.rows);
        const int status = std::system(command.c_str());
        std::ostringstream log;
        log << std::ifstream(folder_ / "povray.log").rdbuf();
        EXPECT_EQ(status, 0) << log.str();
        Image image = read_pov_picture(folder_ / "scene.ppm");
        EXPECT_EQ(image.size.cols, size.cols) << log.str();
        return image;
    }

    void compare(View view, int samples = 1) {
        RAYPICK_REQUIRE(std::system("command -v povray >/dev/null") == 0,
                        "POV-Ray (povray) is not installed: .ci/bootstrap --oracle");
        view.settings.cutoff = 0.0f;
        view.camera.near = 1e-3;
        if (samples > 1) {
            view.settings.sampling = Sampling::stratified;
            view.settings.samples = samples;
        }
        Image theirs = by_povray(view, samples);
        if (HasFailure()) return;
        if (samples > 1) theirs = shrunk(theirs, samples);
        const auto accel = std::make_shared<const Accel>(std::make_shared<const Scene>(view.scene));
        const RenderedFrame frame = render(accel, view.camera, view.size, view.settings);
        const Difference apart = difference(frame.image, theirs, kNear);
        const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
        keep(frame.image, name + "_ours.png");
        keep(theirs, name + "_povray.png");
        std::cout << fmt::format("| {} | {:.4f} % | {:.2f} % |\n", name, 100.0 * apart.mean,
                                 100.0 * apart.near);
        EXPECT_EQ(frame.nan_pixels, 0u);
        EXPECT_GT(contrast(theirs), 0.05) << "there is little to see";
        EXPECT_LT(apart.mean, kMostMean);
        EXPECT_GE(apart.near, kLeastNear);
    }

private:
    static void keep(const Image& image, const std::string& name) {
        if (const char* folder = std::getenv("RAYPICK_PICTURES"))
            write_image(image, std::filesystem::path(folder) / name);
    }
};

// --- Scenes -------------------------------------------------------------------------------------

// From the front, right and above.
Camera looking_down(double distance = 7.0) {
    Camera camera;
    camera.eye = distance * glm::normalize(glm::dvec3(0.35, 0.45, 1.0));
    camera.at = {0.0, 0.6, 0.0};
    camera.fovy = 40.0;
    return camera;
}

GradientSky evening_sky() {
    GradientSky sky;
    sky.zenith = {0.2f, 0.3f, 0.7f};
    sky.horizon = {0.9f, 0.7f, 0.4f};
    sky.ground = {0.3f, 0.15f, 0.1f};
    return sky;
}

View on_a_floor(const glm::vec3& floor = {0.7f, 0.7f, 0.6f}) {
    View view;
    view.camera = looking_down();
    view.scene.background = {0.1f, 0.2f, 0.4f};
    place(view.scene, Plane{}, add_material(view.scene, matt(floor)));
    view.scene.lights.emplace_back(PointLight{"key", {4.0, 7.0, 5.0}, glm::vec3(0.7f), {}});
    return view;
}

void add_squares(Scene& scene, ObjectId object, float side) {
    Texture squares;
    squares.source = Checker{glm::vec4(1.0f), glm::vec4(0.2f, 0.1f, 0.1f, 1.0f)};
    TextureMap map;
    map.texture = add_texture(scene, squares);
    map.u_row.x = 1.0f / side;
    map.v_row.y = 1.0f / side;
    scene.materials[find_object(scene, object)->material].map(MapSlot::diffuse) = map;
}

// Of the SPD: around each ball nine of a third of its size.
void add_flake(std::vector<glm::vec4>& balls, const glm::dvec3& centre, double radius,
               const glm::dvec3& outwards, int levels) {
    balls.emplace_back(glm::vec3(centre), radius);
    if (levels == 0) return;
    const glm::dvec3 aside = std::abs(outwards.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(outwards, aside));
    const glm::dvec3 v = glm::cross(outwards, u);
    for (int i = 0; i < 9; ++i) {
        const double around = glm::radians(i < 6 ? 60.0 * i : 120.0 * i + 30.0);
        const double up = glm::radians(i < 6 ? 0.0 : 55.0);
        const glm::dvec3 to =
            std::cos(up) * (std::cos(around) * u + std::sin(around) * v) + std::sin(up) * outwards;
        add_flake(balls, centre + radius * 4.0 / 3.0 * to, radius / 3.0, to, levels - 1);
    }
}

TEST_F(PovrayOracle, Sphereflake) {
    View view = on_a_floor();
    Scene& scene = view.scene;
    std::vector<glm::vec4> balls;
    add_flake(balls, {0.0, 1.2, 0.0}, 0.8, {0.0, 1.0, 0.0}, 2);
    Material material = shiny({0.5f, 0.45f, 0.35f}, 0.4f, 20.0f);
    material.reflect = glm::vec3(0.4f);
    place(scene, SphereSetInstance{add_sphere_set(scene, make_sphere_set("", std::move(balls)))},
          add_material(scene, material));
    scene.lights.emplace_back(PointLight{"fill", {-5.0, 4.0, 2.0}, {0.3f, 0.2f, 0.2f}, {}});
    compare(view);
}

TEST_F(PovrayOracle, SpdBalls) {
    RAYPICK_REQUIRE_MODEL("spd/balls.nff");
    View view;
    view.size = {150, 150};
    view.scene = load_scene(model("spd/balls.nff")).scene;
    view.camera = choose_camera(view.scene, view.size, {});
    for (Object& object : view.scene.objects)
        object.sides = Sides::both;
    compare(view);
}

TEST_F(PovrayOracle, Mirrors) {
    View view = on_a_floor({0.6f, 0.5f, 0.3f});
    Scene& scene = view.scene;
    scene.environment = evening_sky();
    const MaterialId silver =
        add_material(scene, mirror({0.8f, 0.85f, 0.9f}, Reflectance::constant));
    const MaterialId gold = add_material(scene, mirror({0.8f, 0.6f, 0.2f}, Reflectance::conductor));
    place(scene, Sphere{{-1.3, 1.0, 0.0}, 1.0}, silver);
    place(scene, Sphere{{1.4, 0.8, 0.8}, 0.8}, gold);
    place(scene, Box{{-3.0, 0.0, -3.2}, {3.0, 2.4, -3.0}}, silver);
    place(scene, Sphere{{0.2, 0.4, 1.9}, 0.4},
          add_material(scene, shiny({0.7f, 0.1f, 0.1f}, 0.5f, 30.0f)));
    view.settings.depth = 8;
    compare(view);
}

TEST_F(PovrayOracle, Glass) {
    View view;
    Scene& scene = view.scene;
    view.camera = looking_down();
    scene.environment = evening_sky();
    place(scene, Sphere{{-1.2, 1.0, 0.0}, 1.0},
          add_material(scene, glass(1.5f, Reflectance::dielectric)));
    place(scene, Box{{-0.6, -0.4, -0.6}, {0.6, 0.4, 0.6}},
          add_material(scene, glass(1.7f, Reflectance::dielectric)),
          translate({1.4, 0.8, 0.6}) * rotate(35.0, {1.0, 2.0, 0.5}));
    Material pane = glass(1.3f, Reflectance::constant);
    pane.transmit = glm::vec3(0.6f);
    pane.reflect = glm::vec3(0.2f);
    place(scene, Sphere{{0.3, 2.2, -1.0}, 0.7}, add_material(scene, pane));
    place(scene, Sphere{{0.2, -0.2, -2.0}, 0.8},
          add_material(scene, shiny({0.2f, 0.6f, 0.2f}, 0.4f, 40.0f)));
    place(scene, Sphere{{-2.0, 0.5, -3.0}, 0.9},
          add_material(scene, shiny({0.7f, 0.3f, 0.1f}, 0.4f, 40.0f)));
    scene.lights.emplace_back(PointLight{"key", {4.0, 7.0, 5.0}, glm::vec3(0.8f), {}});
    view.settings.depth = 12;
    view.settings.shadows = false;
    compare(view);
}

// Glass in glass, in glass: each inside the next.
TEST_F(PovrayOracle, NestedGlass) {
    View view;
    Scene& scene = view.scene;
    view.camera = looking_down(5.5);
    scene.environment = evening_sky();
    place(scene, Sphere{{-0.8, 0.7, 0.0}, 1.3},
          add_material(scene, glass(1.33f, Reflectance::dielectric)));
    place(scene, Sphere{{-0.7, 0.8, 0.1}, 0.8},
          add_material(scene, glass(1.6f, Reflectance::constant)));
    place(scene, Sphere{{-0.6, 0.8, 0.2}, 0.3},
          add_material(scene, glass(1.1f, Reflectance::constant)));
    place(scene, Box{{0.9, -0.4, -0.5}, {2.3, 1.0, 0.9}},
          add_material(scene, glass(1.4f, Reflectance::dielectric)));
    place(scene, Sphere{{1.6, 0.3, 0.2}, 0.5},
          add_material(scene, glass(1.8f, Reflectance::constant)));
    view.settings.depth = 16;
    compare(view);
}

TEST_F(PovrayOracle, Absorption) {
    View view = on_a_floor({0.8f, 0.8f, 0.8f});
    Scene& scene = view.scene;
    view.camera.at.y = 0.3;
    Material ruby = glass(1.4f, Reflectance::constant);
    ruby.absorption = {0.1f, 1.2f, 0.9f};
    Material sea = glass(1.0f, Reflectance::constant);
    sea.absorption = {0.9f, 0.4f, 0.05f};
    Material amber = glass(1.6f, Reflectance::constant);
    amber.absorption = {0.05f, 0.3f, 1.5f};
    place(scene, Sphere{{-1.8, 0.9, 0.0}, 0.9}, add_material(scene, ruby));
    place(scene, Box{{-0.6, 0.1, -0.6}, {0.6, 1.3, 0.6}}, add_material(scene, sea),
          rotate(25.0, {0.0, 1.0, 0.0}));
    place(scene, Sphere{{1.8, 0.8, 0.4}, 0.8}, add_material(scene, amber));
    view.settings.depth = 12;
    view.settings.shadows = false;
    compare(view);
}

// Light through coloured glass: each surface lets its share through, the inside what absorption
// leaves.
TEST_F(PovrayOracle, TintedShadows) {
    View view = on_a_floor({0.9f, 0.9f, 0.9f});
    Scene& scene = view.scene;
    Material red = glass(1.0f, Reflectance::constant);
    red.transmit = {0.9f, 0.3f, 0.2f};
    Material grey = glass(1.0f, Reflectance::constant);
    grey.transmit = glm::vec3(0.7f);
    Material blue = glass(1.2f, Reflectance::constant);
    blue.absorption = {1.0f, 0.6f, 0.05f};
    place(scene, Sphere{{-1.5, 0.9, 0.0}, 0.8}, add_material(scene, red));
    place(scene, Box{{-0.5, 0.2, -0.5}, {0.5, 1.2, 0.5}}, add_material(scene, grey));
    place(scene, Sphere{{1.6, 0.8, 0.3}, 0.7}, add_material(scene, blue));
    view.settings.depth = 8;
    view.settings.glass_shadows = GlassShadows::tinted;
    compare(view);
}

TEST_F(PovrayOracle, AreaLight) {
    View view = on_a_floor();
    Scene& scene = view.scene;
    view.size = {75, 100};
    RectangleLight lamp;
    lamp.corner = {1.0, 4.0, 1.5};
    lamp.edge_u = {1.6, 0.0, 0.0};
    lamp.edge_v = {0.0, 0.4, -1.2};
    lamp.colour = {0.9f, 0.85f, 0.7f};
    lamp.samples = 16;
    scene.lights = {lamp};
    place(scene, Sphere{{-0.9, 1.0, 0.0}, 0.8},
          add_material(scene, shiny({0.2f, 0.4f, 0.7f}, 0.3f, 15.0f)));
    place(scene, Box{{0.6, 0.0, 0.2}, {1.4, 1.0, 1.0}},
          add_material(scene, matt({0.8f, 0.4f, 0.2f})), rotate(20.0, {0.0, 1.0, 0.0}));
    compare(view);
}

TEST_F(PovrayOracle, SphereLight) {
    View view = on_a_floor();
    Scene& scene = view.scene;
    view.size = {75, 100};
    SphereLight lamp;
    lamp.centre = {2.0, 4.0, 1.5};
    lamp.radius = 0.9;
    lamp.colour = {0.7f, 0.85f, 0.9f};
    lamp.samples = 16;
    scene.lights = {lamp};
    place(scene, Sphere{{-0.9, 1.0, 0.0}, 0.8},
          add_material(scene, shiny({0.7f, 0.4f, 0.2f}, 0.3f, 15.0f)));
    place(scene, Box{{0.6, 0.0, 0.2}, {1.4, 1.0, 1.0}},
          add_material(scene, matt({0.2f, 0.4f, 0.8f})), rotate(20.0, {0.0, 1.0, 0.0}));
    compare(view);
}

TEST_F(PovrayOracle, Lens) {
    View view = on_a_floor({0.5f, 0.6f, 0.5f});
    Scene& scene = view.scene;
    view.size = {60, 80};
    view.camera.fovy = 25.0;
    place(scene, Sphere{{-0.8, 0.6, 1.6}, 0.6}, add_material(scene, matt({0.8f, 0.3f, 0.2f})));
    place(scene, Sphere{{0.3, 0.7, -0.2}, 0.7}, add_material(scene, matt({0.3f, 0.7f, 0.3f})));
    place(scene, Sphere{{1.2, 0.8, -2.8}, 0.8}, add_material(scene, matt({0.2f, 0.3f, 0.8f})));
    view.settings.aperture = 1.2;
    view.settings.focus_distance = 7.0;
    view.settings.sampling = Sampling::stratified;
    view.settings.samples = 16;
    compare(view);
}

// Anti-aliased: a pixel of ours averages its squares, and so must POV-Ray's.
TEST_F(PovrayOracle, Checker) {
    View view = on_a_floor({0.9f, 0.8f, 0.7f});
    add_squares(view.scene, view.scene.objects[0].id, 0.7f);
    Material ball = mirror(glm::vec3(0.5f), Reflectance::constant);
    ball.diffuse = {0.3f, 0.1f, 0.1f};
    ball.ambient = ball.diffuse;
    place(view.scene, Sphere{{0.3, 1.0, 0.0}, 1.0}, add_material(view.scene, ball));
    compare(view, 8);
}

TEST_F(PovrayOracle, SpotAttenuatedAndDirectionalLights) {
    View view = on_a_floor({0.8f, 0.8f, 0.8f});
    Scene& scene = view.scene;
    place(scene, Sphere{{-1.0, 0.8, 0.5}, 0.8},
          add_material(scene, shiny({0.6f, 0.6f, 0.3f}, 0.5f, 60.0f)));
    place(scene, Box{{0.8, 0.0, -0.6}, {2.0, 1.6, 0.6}},
          add_material(scene, matt({0.5f, 0.7f, 0.5f})));
    SpotLight spot;
    spot.position = {-3.0, 4.0, 3.0};
    spot.direction = {2.2, -4.0, -2.4};
    spot.colour = {0.9f, 0.3f, 0.3f};
    spot.inner_degrees = 20.0;
    spot.outer_degrees = 20.0;
    SpotLight faded = spot;
    faded.position = {3.5, 3.0, 2.0};
    faded.direction = {-1.0, -1.2, -0.7};
    faded.colour = {0.3f, 0.9f, 0.5f};
    faded.attenuation = {0.5, 0.2, 0.0};
    const PointLight near{"near", {0.2, 1.0, 2.0}, {0.5f, 0.5f, 0.9f}, {0.4, 0.0, 0.6}};
    const DirectionalLight sun{"sun", {-1.0, -1.0, -0.3}, glm::vec3(0.2f)};
    scene.lights = {spot, faded, near, sun};
    compare(view);
}

// Each kind of shape, placed by transforms that also squeeze and mirror.
View all_shapes() {
    View view = on_a_floor();
    Scene& scene = view.scene;
    view.camera.eye = {1.5, 5.5, 8.0};
    const auto colour = [&scene](float r, float g, float b) {
        return add_material(scene, shiny({r, g, b}, 0.4f, 25.0f));
    };
    place(scene, Torus{{-2.4, 0.9, 0.0}, {0.3, 0.4, 1.0}, 0.7, 0.22}, colour(0.7f, 0.2f, 0.2f));
    place(scene, Cone{{-0.9, 0.0, 0.8}, {-0.9, 1.3, 0.8}, 0.6, 0.0, true},
          colour(0.2f, 0.6f, 0.2f));
    place(scene, Cone{{0.6, 0.4, 1.0}, {1.4, 1.0, 1.6}, 0.5, 0.25, false},
          colour(0.2f, 0.3f, 0.7f));
    place(scene, Cone{{0.3, 0.0, -1.0}, {0.3, 1.7, -1.0}, 0.4, 0.4, true},
          colour(0.6f, 0.6f, 0.2f));
    place(scene, Disk{{2.0, 1.3, -0.8}, {-0.2, 0.5, 1.0}, 0.8, 0.3}, colour(0.6f, 0.3f, 0.6f));
    place(scene, Box{{-0.5, -0.3, -0.4}, {0.5, 0.3, 0.4}}, colour(0.3f, 0.6f, 0.6f),
          translate({2.6, 0.5, 1.0}) * rotate(40.0, {1.0, 1.0, 0.2}));
    place_mesh(scene, ball_data(2), colour(0.8f, 0.5f, 0.3f),
               translate({-2.2, 0.6, 1.9}) * scale({0.6, 0.6, 0.6}));
    MeshData smooth = ball_data(4);
    smooth.normals = smooth.positions;
    place_mesh(
        scene, smooth, colour(0.4f, 0.4f, 0.8f),
        translate({-1.1, 0.5, 2.6}) * rotate(30.0, {0.0, 0.0, 1.0}) * scale({-0.7, 0.4, 0.5}));
    place(scene, Rectangle{{-1.5, 0.2, -1.8}, {1.2, 0.3, 0.2}, {-0.1, 1.5, -0.3}},
          colour(0.7f, 0.7f, 0.7f));
    place(scene, Triangle{{0.9, 0.1, -2.2}, {2.0, 0.2, -2.4}, {1.3, 1.9, -2.6}},
          colour(0.9f, 0.4f, 0.5f));
    place(scene, Sphere{{0.0, 0.0, 0.0}, 1.0}, colour(0.3f, 0.7f, 0.3f),
          translate({1.1, 0.35, 2.9}) * rotate(50.0, {0.0, 1.0, 0.0}) * scale({0.8, 0.3, 0.4}));
    std::vector<glm::vec4> ends;
    for (int i = 0; i < 5; ++i) {
        const auto x = static_cast<float>(i);
        ends.emplace_back(2.3f + 0.25f * x, 0.0f, 2.5f, 0.12f);
        ends.emplace_back(2.3f + 0.25f * x, 0.5f + 0.1f * x, 2.4f, 0.02f * x);
    }
    place(scene, ConeSetInstance{add_cone_set(scene, make_cone_set("", std::move(ends), false))},
          colour(0.8f, 0.6f, 0.2f));
    return view;
}

TEST_F(PovrayOracle, AllShapes) {
    compare(all_shapes());
}

TEST_F(PovrayOracle, OrthographicView) {
    View view = all_shapes();
    view.camera.projection = Projection::orthographic;
    view.camera.height = 6.0;
    compare(view);
}

// Blinn's highlight, light that a surface gives off itself, surfaces that are half there.
TEST_F(PovrayOracle, BlinnGlowAndOpacity) {
    View view = on_a_floor();
    Scene& scene = view.scene;
    scene.ambient = {0.3f, 0.25f, 0.2f};
    Material blinn = shiny({0.3f, 0.3f, 0.6f}, 0.6f, 40.0f);
    blinn.model = LocalModel::blinn_phong;
    Material lamp = matt({0.4f, 0.4f, 0.4f});
    lamp.emissive = {0.5f, 0.3f, 0.1f};
    Material veil = matt({0.2f, 0.7f, 0.3f});
    veil.opacity = 0.4f;
    veil.alpha_mode = AlphaMode::blend;
    place(scene, Sphere{{-1.5, 0.9, 0.0}, 0.9}, add_material(scene, blinn));
    place(scene, Sphere{{0.9, 0.7, -1.0}, 0.7}, add_material(scene, lamp));
    place(scene, Rectangle{{-0.2, 0.0, 1.0}, {2.4, 0.0, 0.4}, {0.0, 1.4, -0.2}},
          add_material(scene, veil));
    view.settings.glass_shadows = GlassShadows::tinted;
    compare(view);
}

// Squares of random colours; seen as sRGB.
TextureId add_patchwork(Scene& scene, int rows, int cols) {
    Random random(3);
    std::vector<glm::u8vec4> texels(ImageSize{rows, cols}.pixel_count());
    for (glm::u8vec4& texel : texels)
        texel = glm::u8vec4(random.below(256), random.below(256), random.below(256), 255);
    Texture texture;
    texture.source =
        ImageTexture{make_texture_pixels(rows, cols, std::move(texels), TexelCoding::srgb), {}};
    return add_texture(scene, std::move(texture));
}

// Waves of colour in all directions.
ImageSky coloured_sky() {
    constexpr int kRows = 64;
    std::vector<glm::vec3> texels;
    for (int row = 0; row < kRows; ++row) {
        for (int col = 0; col < 2 * kRows; ++col) {
            const float up = (static_cast<float>(row) + 0.5f) / kRows;
            const float around = glm::two_pi<float>() * (static_cast<float>(col) + 0.5f) / kRows;
            texels.emplace_back(0.5f + 0.4f * std::sin(0.5f * around), 1.0f - up,
                                0.5f + 0.4f * std::cos(around) * std::sin(3.0f * up));
        }
    }
    ImageSky sky;
    sky.pixels = make_sky_pixels(kRows, 2 * kRows, std::move(texels));
    sky.forward = {-1.0, 0.0, 0.0};
    return sky;
}

TEST_F(PovrayOracle, Images) {
    View view;
    Scene& scene = view.scene;
    view.camera = looking_down(6.0);
    scene.environment = coloured_sky();
    scene.lights.emplace_back(PointLight{"key", {4.0, 7.0, 5.0}, glm::vec3(0.9f), {}});
    Material patched = matt(glm::vec3(1.0f));
    patched.map(MapSlot::diffuse).texture = add_patchwork(scene, 7, 5);
    patched.map(MapSlot::diffuse).filter = TextureFilter::nearest;
    MeshData sheet;
    sheet.positions = {{-3, 0, 2}, {3, 0, 2}, {3, 0, -2}, {-3, 0, -2}};
    sheet.uvs = {{-0.3f, 0.1f}, {1.6f, 0.0f}, {1.7f, 1.2f}, {0.0f, 0.9f}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
    place_mesh(scene, sheet, add_material(scene, patched));
    place(scene, Sphere{{0.0, 1.0, 0.0}, 0.9},
          add_material(scene, mirror(glm::vec3(0.9f), Reflectance::constant)));
    compare(view);
}

}  // namespace
}  // namespace raypick
