// Breadth first against the recursive form: the same to the bit, whatever travels together.
#include "tracer/shade/batch_tracer.h"

#include "gallery_files.h"
#include "tests/looks.h"
#include "tests/trace_shots.h"
#include "tracer/io/load.h"
#include "tracer/render/render_job.h"

#include <algorithm>
#include <cstring>
#include <memory>

namespace raypick {
namespace {

constexpr ImageSize kSize{45, 60};

struct Traced {
    std::vector<TracedRay> rays;
    RayCounts counts;
};

template <typename T>
bool same_bits(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

void expect_same(const Traced& got, const Traced& wanted) {
    ASSERT_EQ(got.rays.size(), wanted.rays.size());
    EXPECT_EQ(got.counts, wanted.counts);
    for (std::size_t i = 0; i < wanted.rays.size(); ++i) {
        ASSERT_EQ(got.rays[i].hit.object, wanted.rays[i].hit.object) << i;
        ASSERT_EQ(got.rays[i].hit.primitive, wanted.rays[i].hit.primitive) << i;
        ASSERT_TRUE(same_bits(got.rays[i].hit.t, wanted.rays[i].hit.t)) << i;
        ASSERT_TRUE(same_bits(got.rays[i].normal, wanted.rays[i].normal)) << i;
        ASSERT_TRUE(same_bits(got.rays[i].colour, wanted.rays[i].colour))
            << i << ": " << got.rays[i].colour.x << " instead of " << wanted.rays[i].colour.x;
    }
}

EyeRayList list_of(std::span<const EyeRay> eyes) {
    EyeRayList list;
    for (const EyeRay& eye : eyes)
        list.add(eye);
    return list;
}

// In portions of `step`, one after the other in the same memory, as scenes before.
Traced breadth_first(const ShadeScene& scene, const std::vector<EyeRay>& eyes, std::size_t step) {
    Traced traced;
    static BatchTracer tracer;
    for (std::size_t first = 0; first < eyes.size(); first += step) {
        const std::size_t count = std::min(step, eyes.size() - first);
        TracedRays results(count, true);
        tracer.trace(scene, list_of(std::span(eyes).subspan(first, count)).all(), results,
                     traced.counts);
        for (std::size_t i = 0; i < count; ++i)
            traced.rays.push_back({results.colours[i], results.hits[i], results.normals[i]});
    }
    return traced;
}

Traced recursive(const ShadeScene& scene, const std::vector<EyeRay>& eyes) {
    Traced traced;
    for (const EyeRay& eye : eyes)
        traced.rays.push_back(trace(scene, eye, traced.counts));
    return traced;
}

// All pixels' rays, each with a seed of its own.
std::vector<EyeRay> eyes_of(const Camera& camera, ImageSize size) {
    const RayGenerator rays(camera, size);
    std::vector<EyeRay> eyes;
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            const auto seed = static_cast<std::uint64_t>(eyes.size());
            eyes.push_back({rays.ray(pixel_centre({row, col})), rays.cone(), seed});
        }
    }
    return eyes;
}

// All that settings can change about a ray's way.
std::vector<RenderSettings> all_settings() {
    std::vector<RenderSettings> all(6);
    all[0].depth = 8;
    all[1].depth = 5;
    all[1].cutoff = 0.0f;
    all[2].depth = 8;
    all[2].glass_shadows = GlassShadows::tinted;
    all[3].shadows = false;
    all[4].reflections = false;
    all[5].refractions = false;
    all[5].glass_shadows = GlassShadows::tinted;
    return all;
}

void compare(const Accel& accel, const Camera& camera, ImageSize size) {
    const std::vector<EyeRay> eyes = eyes_of(camera, size);
    const std::vector<Light> lights = effective_lights(accel.scene(), camera);
    const std::vector<RenderSettings> all = all_settings();
    for (std::size_t i = 0; i < all.size(); ++i) {
        SCOPED_TRACE(i);
        const ShadeScene scene = shade_scene(accel, lights, all[i]);
        const std::size_t step = i % 2 == 0 ? 1000 : eyes.size();
        expect_same(breadth_first(scene, eyes, step), recursive(scene, eyes));
    }
}

class BatchTracerOnGallery : public testing::TestWithParam<std::string> {};

TEST_P(BatchTracerOnGallery, IsTheRecursiveFormToTheBit) {
    const Scene scene = load_scene(asset("gallery") / GetParam()).scene;
    const Camera camera = default_camera(scene, kSize);
    compare(accel_of(scene), camera, kSize);
}

INSTANTIATE_TEST_SUITE_P(All, BatchTracerOnGallery, testing::ValuesIn(gallery_files()),
                         gallery_test_name);

// Glass in glass with priorities, absorption, a bubble, thin walls, half transparent things, soft
// and hard light: rays of all kinds that meet all kinds of surfaces, some of them hidden.
Scene glassy_scene() {
    Scene scene;
    scene.environment = GradientSky{};
    Material water = glass(1.33f, Reflectance::dielectric);
    water.absorption = {0.4f, 0.2f, 0.1f};
    water.priority = 1;
    Material crystal = glass(1.6f, Reflectance::dielectric);
    crystal.absorption = {0.1f, 0.3f, 0.2f};
    crystal.priority = 2;
    Material sheet = glass(1.5f, Reflectance::dielectric);
    sheet.thin_walled = true;
    Material veil = white_material();
    veil.alpha_mode = AlphaMode::blend;
    veil.opacity = 0.4f;
    Material shiny = white_material();
    shiny.diffuse = {0.3f, 0.5f, 0.4f};
    shiny.specular = glm::vec3(0.5f);
    shiny.reflect = glm::vec3(0.4f);
    place(scene, Box{{-2, -1, -2}, {2, 0.3, 2}}, add_material(scene, water));
    place(scene, Sphere{{-0.6, 0.1, 0}, 0.8}, add_material(scene, crystal));
    place(scene, Sphere{{-0.6, 0.1, 0}, 0.3}, add_material(scene, glass_material(1.0f)));
    place(scene, Sphere{{0.9, 0.2, 0.4}, 0.6}, add_material(scene, crystal),
          rotate(20.0, {1, 1, 0}) * scale({1.0, 1.4, 0.8}));
    place(scene, Rectangle{{-2, -1, 2.4}, {3, 0, 0}, {0, 3, 0}}, add_material(scene, sheet));
    place(scene, Disk{{1.5, 1, 1}, {0.3, 0.2, 1}, 0.7, 0.2}, add_material(scene, veil));
    place(scene, Cone{{-1.8, 0, -1}, {-1.5, 1.5, -1}, 0.5, 0.1}, add_material(scene, shiny));
    place(scene, Torus{{0.5, 1.3, -1}, {0.2, 1, 0.3}, 0.5, 0.15}, add_material(scene, shiny));
    place_mesh(scene, ball_data(2), add_material(scene, crystal),
               translate({0.2, -0.3, 1.1}) * scale(glm::dvec3(0.4)));
    place(scene, Plane{{0, 1, 0}, 1.1}, add_material(scene, shiny));
    scene.lights = {PointLight{"lamp", {3, 5, 4}, glm::vec3(0.5f)},
                    DirectionalLight{"sun", {1, -2, -1}, glm::vec3(0.2f)},
                    SpotLight{"spot", {-2, 4, 2}, {1, -2, -1}, glm::vec3(0.4f)},
                    SphereLight{"bulb", {2, 4, -3}, 0.8, glm::vec3(0.4f), {}, 2},
                    RectangleLight{"panel", {-3, 5, 1}, {2, 0, 0}, {0, 0, 2}, glm::vec3(0.4f)}};
    return scene;
}

Camera glassy_camera() {
    Camera camera;
    camera.eye = {0.7, 1.6, 6.0};
    camera.near = 0.01;
    return camera;
}

TEST(BatchTracer, IsTheRecursiveFormInGlassOfAllKinds) {
    compare(accel_of(glassy_scene()), glassy_camera(), kSize);
}

// Sets and meshes of several looks through one another, whose shadows are tinted by one, blocked by
// the next, full of holes, in patterns, and twice as dark where two are in one place.
Scene stained_scene() {
    Scene scene;
    const TextureId squares = add_texture(
        scene, {"squares", Checker{{0.9f, 0.3f, 0.2f, 1.0f}, {0.2f, 0.5f, 0.9f, 0.2f}}});
    Material amber = glass_material(1.3f);
    amber.transmit = {0.9f, 0.7f, 0.3f};
    amber.absorption = {0.1f, 0.3f, 0.9f};
    Material stained = glass_material(1.0f);
    stained.thin_walled = true;
    stained.maps[static_cast<std::size_t>(MapSlot::transmit)].texture = squares;
    Material veil = white_material();
    veil.alpha_mode = AlphaMode::blend;
    veil.opacity = 0.8f;
    veil.maps[static_cast<std::size_t>(MapSlot::opacity)].texture = squares;
    veil.maps[static_cast<std::size_t>(MapSlot::opacity)].channel = 3;
    Material lace = white_material();
    lace.alpha_mode = AlphaMode::cut_out;
    lace.maps[static_cast<std::size_t>(MapSlot::opacity)] = veil.map(MapSlot::opacity);
    for (Material* mapped : {&stained, &veil, &lace}) {
        for (TextureMap& map : mapped->maps)
            map.u_row *= 4.0f;
    }
    const MaterialId looks[] = {add_material(scene, amber), add_material(scene, stained),
                                add_material(scene, white_material()), add_material(scene, veil),
                                add_material(scene, lace)};
    Random random(3);
    std::vector<glm::vec4> balls;
    std::vector<glm::vec4> rods;
    std::vector<Part> parts;
    for (std::uint32_t i = 0; i < 45; ++i) {
        balls.emplace_back(glm::vec3(random.point(glm::dvec3(-2, -1, -2), glm::dvec3(2, 2, 2))),
                           0.3f);
        const glm::dvec3 end = random.point(glm::dvec3(-2, -1, -2), glm::dvec3(2, 2, 2));
        rods.emplace_back(glm::vec3(end), 0.1f);
        rods.emplace_back(glm::vec3(end + random.direction()), 0.05f);
        if (i % 9 == 0) parts.push_back({i, 9, looks[i / 9]});
    }
    const SetId set = add_sphere_set(scene, make_sphere_set("balls", balls, parts));
    place(scene, SphereSetInstance{set});
    place(scene, SphereSetInstance{set}, looks[0]);
    place(scene, ConeSetInstance{add_cone_set(scene, make_cone_set("rods", rods, true, parts))});
    for (std::uint64_t i = 0; i < 10; ++i) {
        MeshData soup = soup_data(i, 12, 0.9);
        soup.uvs.resize(soup.positions.size());
        for (std::size_t k = 1; k < soup.uvs.size(); k += 3)
            soup.uvs[k] = {1.0f, 1.0f};
        place_mesh(scene, soup, looks[i % 5]);
    }
    place(scene, MeshInstance{1}, looks[1], translate({1, 0, 0}) * scale({1.0, -2.0, 1.0}));
    place(scene, Rectangle{{-2, 2.5, -2}, {4, 0, 0}, {0, 0, 4}}, looks[1]);
    place(scene, Plane{{0, 1, 0}, 1.5}, looks[2]);
    scene.lights = glassy_scene().lights;
    return scene;
}

TEST(BatchTracer, TintsShadowsAsTheRecursiveForm) {
    compare(accel_of(stained_scene()), glassy_camera(), kSize);
}

TEST(BatchTracer, DoesNotMindWhatTravelsTogether) {
    const Accel accel = accel_of(glassy_scene());
    RenderSettings settings;
    settings.depth = 7;
    const ShadeScene scene = shade_scene(accel, accel.scene().lights, settings);
    std::vector<EyeRay> eyes = eyes_of(glassy_camera(), {24, 32});
    const Traced wanted = breadth_first(scene, eyes, eyes.size());
    for (const std::size_t step : {1u, 3u, 64u, 500u}) {
        SCOPED_TRACE(step);
        expect_same(breadth_first(scene, eyes, step), wanted);
    }
    std::reverse(eyes.begin(), eyes.end());
    Traced backwards = breadth_first(scene, eyes, 100);
    std::reverse(backwards.rays.begin(), backwards.rays.end());
    expect_same(backwards, wanted);
}

TEST(BatchTracer, GivesColoursAlone) {
    const Accel accel = accel_of(glassy_scene());
    const ShadeScene scene = shade_scene(accel, accel.scene().lights, {});
    const std::vector<EyeRay> eyes = eyes_of(glassy_camera(), kSize);
    const Traced wanted = breadth_first(scene, eyes, eyes.size());
    TracedRays results(eyes.size(), false);
    RayCounts counts;
    BatchTracer().trace(scene, list_of(eyes).all(), results, counts);
    EXPECT_FALSE(results.has_hits());
    EXPECT_TRUE(results.normals.empty());
    EXPECT_EQ(counts, wanted.counts);
    for (std::size_t i = 0; i < eyes.size(); ++i)
        ASSERT_TRUE(same_bits(results.colours[i], wanted.rays[i].colour)) << i;
}

// Flat things along the axes, whose normals have zeros with a sign.
TEST(BatchTracer, KeepsTheSignsOfZeros) {
    Scene scene;
    MeshData quads;
    quads.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, -0.0f, -1},
                       {-1, 1, 0}, {1, 1, 0}, {1, 2, 0},  {-1, 2, -0.0f}};
    quads.triangles = {{0, 1, 2}, {0, 3, 2}, {4, 5, 6}, {4, 7, 6}};
    place_mesh(scene, quads);
    place_mesh(scene, quads, kNoMaterial, translate({0, 0, -3}));
    Camera camera;
    camera.eye = {0.2, 1.5, 4.0};
    compare(accel_of(scene), camera, kSize);
}

// Several times more rays of one depth than are followed at the same time.
TEST(BatchTracer, GoesOnInPortions) {
    Scene scene = dark_scene();
    Material half = glass_material(1.0f);
    half.reflect = half.transmit = glm::vec3(0.5f);
    half.emissive = {0.1f, 0.2f, 0.3f};
    half.thin_walled = true;
    const MaterialId id = add_material(scene, half);
    for (const double radius : {3.0, 5.0, 7.0, 9.0})
        place(scene, Sphere{{0, 0, 0}, radius}, id);
    RenderSettings settings;
    settings.depth = 15;
    settings.cutoff = 0.0f;
    const Accel accel = accel_of(scene);
    const ShadeScene shade = shade_scene(accel, {}, settings);
    Camera camera;
    camera.eye = {0.0, 0.0, 2.0};
    const std::vector<EyeRay> eyes = eyes_of(camera, {1, 3});
    const Traced wanted = recursive(shade, eyes);
    EXPECT_GT(wanted.counts.reflection_at[15], 5000u);
    expect_same(breadth_first(shade, eyes, eyes.size()), wanted);
}

TEST(BatchTracer, NoRaysAreNothing) {
    const Accel accel = accel_of(glassy_scene());
    RayCounts counts;
    TracedRays results(0, true);
    BatchTracer().trace(shade_scene(accel, {}, {}), {}, results, counts);
    EXPECT_EQ(counts, RayCounts{});
}

TEST(BatchTracer, ShootsNothingOnceStopped) {
    const Accel accel = accel_of(glassy_scene());
    const std::vector<EyeRay> eyes = eyes_of(glassy_camera(), {8, 8});
    TracedRays results(eyes.size(), true);
    RayCounts counts;
    std::stop_source stop;
    stop.request_stop();
    BatchTracer().trace(shade_scene(accel, accel.scene().lights, {}), list_of(eyes).all(), results,
                        counts, stop.get_token());
    EXPECT_EQ(counts.eye_hits + counts.shadow + counts.reflection, 0u);
}

// Every channel of a frame is what trace() says of the pixel's ray, whatever the number of threads.
TEST(BatchTracer, FramesAreMadeOfIt) {
    const auto accel = std::make_shared<const Accel>(accel_of(glassy_scene()));
    RenderSettings settings;
    settings.depth = 6;
    settings.sampling = Sampling::adaptive;
    settings.samples = 2;
    settings.threads = 1;
    const RenderedFrame one = render(accel, glassy_camera(), kSize, settings);
    settings.threads = 3;
    const RenderedFrame three = render(accel, glassy_camera(), kSize, settings);
    EXPECT_EQ(one.rays, three.rays);
    EXPECT_TRUE(std::equal(one.image.colour.begin(), one.image.colour.end(),
                           three.image.colour.begin(), same_bits<glm::vec3>));
}

}  // namespace
}  // namespace raypick
