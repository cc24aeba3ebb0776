// The same picture and the same picks wherever a scene stands and however large it is.
#include "picking/pick.h"
#include "tests/model_files.h"
#include "tests/moved_scene.h"
#include "tests/needs.h"
#include "tests/tracer_scenes.h"
#include "tracer/io/load.h"
#include "tracer/render/image.h"
#include "tracer/render/render_job.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

namespace raypick {
namespace {

constexpr ImageSize kSize{150, 200};

struct View {
    std::shared_ptr<const Accel> accel;
    Camera camera;
    Image image;
};

View view_of(Scene scene, const Camera& camera, const RenderSettings& settings = {}) {
    View view;
    view.camera = camera;
    view.accel = std::make_shared<const Accel>(std::make_shared<const Scene>(std::move(scene)));
    RenderedFrame frame = render(view.accel, camera, kSize, settings);
    EXPECT_EQ(frame.nan_pixels, 0u);
    view.image = std::move(frame.image);
    return view;
}

int differing(const Image& a, const Image& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.colour.size(); ++i) {
        bool same = true;
        for (int k = 0; k < 3; ++k) {
            const float gap = srgb_from_linear(glm::clamp(a.colour[i][k], 0.0f, 1.0f)) -
                              srgb_from_linear(glm::clamp(b.colour[i][k], 0.0f, 1.0f));
            same = same && std::abs(gap) <= 1.0f / 255;
        }
        count += same ? 0 : 1;
    }
    return count;
}

int differing_ids(const Image& a, const Image& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.object.size(); ++i)
        count += a.object[i] != b.object[i] || a.primitive[i] != b.primitive[i] ? 1 : 0;
    return count;
}

// Points in file coordinates, held against each other in lengths of the first scene.
void expect_same_picks(const View& before, const View& after, const Similarity& by) {
    const glm::dvec3 old_origin = before.accel->scene().origin;
    int differ = 0;
    int compared = 0;
    for (int row = 2; row < kSize.rows; row += 7) {
        for (int col = 3; col < kSize.cols; col += 7) {
            const auto a = pick_pixel(*before.accel, before.camera, kSize, {row, col});
            const auto b = pick_pixel(*after.accel, after.camera, kSize, {row, col});
            ++compared;
            if (a.has_value() != b.has_value() || (a && a->path != b->path) ||
                (a && a->hit.primitive != b->hit.primitive)) {
                ++differ;
                continue;
            }
            if (!a) continue;
            const glm::dvec3 wanted = by.point(a->point - old_origin) + old_origin;
            const double distance = static_cast<double>(a->hit.t) * by.scale;
            // Rays have directions in float: what they meet at a flat angle slides along it.
            const glm::dvec3 along = glm::normalize(a->point - old_origin - before.camera.eye);
            const double cosine = std::abs(glm::dot(along, glm::dvec3(a->normal)));
            // A file coordinate of 1e6 has a last place of 1.2e-10 in double.
            EXPECT_LT(glm::distance(b->point, wanted), 1e-6 * distance / cosine + 1e-9)
                << row << ' ' << col;
            EXPECT_LT(glm::distance(glm::dvec3(b->normal), by.direction(glm::dvec3(a->normal))),
                      2e-3);
        }
    }
    EXPECT_LE(differ, compared / 1000);
}

struct Case {
    std::string name;
    Similarity by;
};

std::vector<Case> cases() {
    std::vector<Case> cases{{"scale 1e-4", {1e-4, {}, glm::dvec3(0.0)}},
                            {"scale 1e4", {1e4, {}, glm::dvec3(0.0)}},
                            {"turn", {1.0, rotate(73.0, {1, -2, 0.7}), glm::dvec3(0.0)}}};
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 offset(0.0);
        offset[axis] = axis == 1 ? -1e6 : 1e6;
        cases.push_back({fmt::format("move along axis {}", axis), {1.0, {}, offset}});
    }
    cases.push_back({"all", {1e2, rotate(-20.0, {0.3, 1, 0.1}), {1e6, 1e6, -1e6}}});
    return cases;
}

// The near plane too belongs to the bounds, which turning loosens: it is taken from the scene as it
// was.
void expect_invariant(const Scene& scene, const RenderSettings& settings = {}) {
    const Camera camera = default_camera(scene, kSize);
    const View before = view_of(scene, camera, settings);
    const auto pixels = static_cast<int>(kSize.pixel_count());
    for (const Case& one : cases()) {
        SCOPED_TRACE(one.name);
        Scene other = moved(scene, one.by);
        Camera other_camera = moved(camera, one.by);
        const glm::dvec3 shift = other.origin - scene.origin;
        other_camera.eye -= shift;
        other_camera.at -= shift;
        const View after = view_of(std::move(other), other_camera, settings);
        EXPECT_LE(differing(before.image, after.image), pixels / 1000);
        EXPECT_LE(differing_ids(before.image, after.image), pixels / 1000);
        expect_same_picks(before, after, one.by);
    }
}

class Invariance : public testing::TestWithParam<const char*> {};

TEST_P(Invariance, OurScenes) {
    expect_invariant(load_scene(asset(GetParam())).scene);
}

INSTANTIATE_TEST_SUITE_P(Assets, Invariance,
                         testing::Values("default.json", "glass.json", "shapes.json", "mirror.json",
                                         "spheres.json"),
                         [](const auto& scene) {
                             const std::string name = scene.param;
                             return name.substr(0, name.find('.'));
                         });

// Every shape, light and kind of glass in one scene, with what our files hold none of. Area lights
// of one sample: their random points turn with nothing.
TEST(InvarianceTest, AllShapesAndLights) {
    Scene scene;
    Material glass = black_material();
    glass.transmit = glm::vec3(0.95f);
    glass.reflect = glm::vec3(1.0f);
    glass.reflectance = Reflectance::dielectric;
    glass.absorption = {0.8f, 0.1f, 0.4f};
    Material metal = black_material();
    metal.reflect = {0.9f, 0.6f, 0.3f};
    metal.reflectance = Reflectance::conductor;
    metal.specular = glm::vec3(0.5f);
    const MaterialId clear = add_material(scene, glass);
    const MaterialId gold = add_material(scene, metal);
    place(scene, Plane{{0.1, 1, 0.05}, 1.0});
    place(scene, Sphere{{-2.2, 0.1, 0}, 0.9}, clear);
    place(scene, Torus{{0, 0, 0}, {0.2, 1, 0.4}, 0.7, 0.25}, gold);
    place(scene, Cone{{2, -0.8, 0}, {2.2, 0.9, 0.1}, 0.7, 0.2}, clear);
    place(scene, Disk{{-1, 1.4, -1}, {0.3, -0.2, 1}, 0.7, 0.2}, gold);
    place(scene, Rectangle{{0.4, 0.7, -1}, {1, 0.2, 0}, {0, 0.8, 0.3}});
    place(scene, Box{{-0.6, -0.9, 1.0}, {0.1, -0.4, 1.6}}, clear);
    place_mesh(scene, ball_data(3), gold, translate({1.2, -0.5, 1.2}) * scale(glm::dvec3(0.4)));
    const SetId drops = add_sphere_set(
        scene,
        make_sphere_set("drops", {{-3, 1.5f, -1, 0.3f}, {3, 1.5f, -1, 0.4f}, {0, 2, -2, 0.5f}}));
    place(scene, SphereSetInstance{drops}, gold);
    scene.environment = GradientSky{};
    scene.lights = {
        PointLight{"lamp", {3, 5, 4}, glm::vec3(9.0f), {1.0, 0.1, 0.1}},
        DirectionalLight{"sun", {1, -2, -1}, glm::vec3(0.2f)},
        SpotLight{"spot", {-4, 5, 3}, {4, -5, -3}, glm::vec3(20.0f), {0, 0, 1}, 10.0, 20.0},
        SphereLight{"bulb", {0, 4, -3}, 0.5, glm::vec3(0.2f), {}, 1},
        RectangleLight{"panel", {-2, 4, 2}, {1, 0, 0}, {0, 0, 1}, glm::vec3(0.1f), {}, 1}};
    Camera camera;
    camera.eye = {0.6, 1.6, 7.0};
    camera.at = {0, 0.2, 0};
    camera.near = 0.05;
    scene.cameras.push_back({"front", camera});
    RenderSettings tinted;
    tinted.glass_shadows = GlassShadows::tinted;
    expect_invariant(scene, tinted);
}

// The numbers in the file are scaled and moved, not the object that is made of them.
using InvarianceOfFiles = ModelFiles;

TEST_F(InvarianceOfFiles, ARealModelWhoseFileIsScaledAndMoved) {
    RAYPICK_REQUIRE_MODEL("common-3d-test-models/teapot.obj");
    std::ifstream file(model("common-3d-test-models/teapot.obj"));
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto rewritten = [&](const Similarity& by) {
        std::istringstream lines(text);
        std::string moved_text;
        for (std::string line; std::getline(lines, line);) {
            std::istringstream words(line);
            std::string key;
            glm::dvec3 p(0.0);
            words >> key;
            if (key == "v" && words >> p.x >> p.y >> p.z) {
                const glm::dvec3 q = by.point(p);
                line = fmt::format("v {} {} {}", q.x, q.y, q.z);
            }
            moved_text += line + '\n';
        }
        return load("teapot.obj", moved_text).scene;
    };
    const Scene scene = rewritten({});
    const Camera camera = default_camera(scene, kSize);
    const View before = view_of(scene, camera);
    for (const Case& one : cases()) {
        SCOPED_TRACE(one.name);
        Scene other = rewritten(one.by);
        Camera other_camera = moved(camera, one.by);
        other_camera.eye -= other.origin;
        other_camera.at -= other.origin;
        const View after = view_of(std::move(other), other_camera);
        EXPECT_LE(differing(before.image, after.image),
                  static_cast<int>(kSize.pixel_count() / 1000));
        EXPECT_LE(differing_ids(before.image, after.image),
                  static_cast<int>(kSize.pixel_count() / 1000));
        expect_same_picks(before, after, one.by);
    }
}

}  // namespace
}  // namespace raypick
