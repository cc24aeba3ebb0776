// Saved scenes: everything comes back, the same image bit for bit, and saving again gives the same
// file.
#include "tracer/io/save_scene.h"
#include "tracer/accel/accel.h"
#include "tracer/io/base64.h"
#include "tracer/io/load.h"
#include "tracer/render/render_job.h"

#include "model_files.h"
#include "needs.h"
#include "tracer_scenes.h"

#include <gmock/gmock.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

namespace raypick {
namespace {

using testing::HasSubstr;

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

constexpr ImageSize kSize{27, 41};

Image traced(Scene scene) {
    auto shared = std::make_shared<const Scene>(std::move(scene));
    const Camera camera = default_camera(*shared, kSize);
    RenderSettings settings;
    settings.threads = 2;
    return render(std::make_shared<const Accel>(shared), camera, kSize, settings).image;
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_same_bits(const Image& a, const Image& b) {
    EXPECT_TRUE(same_bits(a.colour, b.colour));
    EXPECT_TRUE(same_bits(a.depth, b.depth));
    EXPECT_TRUE(same_bits(a.normal, b.normal));
    EXPECT_TRUE(same_bits(a.object, b.object));
    EXPECT_TRUE(same_bits(a.primitive, b.primitive));
}

class SaveScene : public ModelFiles {
protected:
    // Saves, loads, saves again: the same file, scene and image.
    Scene expect_round_trip(const Scene& scene) {
        const std::filesystem::path first = folder_ / "first.json";
        const std::filesystem::path second = folder_ / "second.json";
        save_scene(scene, first);
        LoadedScene loaded = load_scene(first);
        EXPECT_THAT(loaded.warnings, testing::IsEmpty());
        save_scene(loaded.scene, second);
        EXPECT_EQ(bytes_of(first) == bytes_of(second), true) << "saved twice, the files differ";
        expect_same_bits(traced(scene), traced(loaded.scene));
        EXPECT_EQ(loaded.scene.origin, scene.origin);
        EXPECT_EQ(object_names(loaded.scene), object_names(scene));
        EXPECT_EQ(placed_triangles(loaded.scene), placed_triangles(scene));
        return std::move(loaded.scene);
    }
};

// A number that has all its digits.
double awkward(int seed) {
    return std::sin(static_cast<double>(seed)) / 3.0;
}

glm::dvec3 awkward_point(int seed) {
    return {awkward(seed), awkward(seed + 1), awkward(seed + 2)};
}

glm::vec3 awkward_colour(int seed) {
    return glm::abs(glm::vec3(awkward_point(seed)));
}

Material awkward_material(int seed) {
    Material material;
    material.name = seed % 3 == 0 ? "" : "same name";
    material.ambient = awkward_colour(seed);
    material.diffuse = awkward_colour(seed + 3);
    material.specular = awkward_colour(seed + 6);
    material.shininess = 10.0f / 3.0f;
    material.emissive = awkward_colour(seed + 9);
    material.ior = 4.0f / 3.0f;
    return material;
}

Scene scene_of_everything() {
    Scene scene;
    scene.background = awkward_colour(1);
    scene.ambient = awkward_colour(2);
    scene.environment = GradientSky{awkward_colour(3), awkward_colour(4), awkward_colour(5),
                                    glm::dvec3(0.1, 1.0, -0.0)};
    std::vector<glm::u8vec4> texels;
    for (int i = 0; i < 15; ++i)
        texels.emplace_back(17 * i, 255 - 16 * i, 3 * i, 255 - i);
    add_texture(scene, {"image", ImageTexture{make_texture_pixels(3, 5, texels, TexelCoding::srgb),
                                              "folder/wood \"x\".png"}});
    add_texture(scene,
                {"", ImageTexture{make_texture_pixels(5, 3, texels, TexelCoding::linear), ""}});
    add_texture(scene, {"squares", Checker{{0.1f, 0.2f, 0.3f, 0.7f}, {1.0f, 0.5f, 0.25f, 1.0f}}});
    for (int i = 0; i < 6; ++i)
        add_material(scene, awkward_material(i));
    Material& rich = scene.materials[1];
    rich.model = LocalModel::blinn_phong;
    rich.reflectance = Reflectance::dielectric;
    rich.reflect = glm::vec3(1.0f);
    rich.transmit = glm::vec3(0.9f);
    rich.absorption = awkward_colour(20);
    rich.priority = -3;
    Material& sheet = scene.materials[2];
    sheet.thin_walled = true;
    sheet.opacity = 1.0f / 3.0f;
    sheet.alpha_mode = AlphaMode::blend;
    sheet.alpha_cutoff = 0.1f;
    TextureMap map;
    map.texture = 0;
    map.u_row = glm::vec3(awkward_point(30));
    map.v_row = glm::vec3(awkward_point(31));
    map.wrap_u = Wrap::clamp;
    map.wrap_v = Wrap::mirror;
    map.filter = TextureFilter::nearest;
    map.channel = 2;
    map.base = 0.1f;
    map.gain = -0.7f;
    sheet.map(MapSlot::emissive) = map;
    scene.materials[3].map(MapSlot::diffuse).texture = 2;
    scene.materials[4].map(MapSlot::normal).texture = 1;

    MeshData data = octahedron_data();
    data.uvs.assign(data.positions.size(), glm::vec2(awkward_point(40)));
    const auto count = static_cast<std::uint32_t>(data.triangles.size());
    const MeshId flat =
        add_mesh(scene, make_mesh("flat", data, {{0, 2, 3}, {2, count - 2, kNoMaterial}}));
    data.normals.assign(data.positions.size(), glm::vec3(0, 1, 0));
    const MeshId smooth = add_mesh(scene, make_mesh("", data));
    add_mesh(scene, make_mesh("unused", {}));
    const SetId drops = add_sphere_set(
        scene,
        make_sphere_set("drops", {{0, 0, 0, 0.1f}, {0.3f, 0, 0, 0.2f}}, {{0, 1, 4}, {1, 1, 5}}));
    const SetId twigs = add_cone_set(
        scene, make_cone_set("twigs", {{0, 0, 0, 0.1f}, {0, 1.0f / 3.0f, 0, 0.05f}}, true));

    const std::vector<Shape> shapes = {
        Sphere{awkward_point(1), 1.0 / 3.0},
        Plane{awkward_point(2), 5.0 / 3.0},
        Triangle{awkward_point(3), awkward_point(4), awkward_point(5)},
        Box{glm::dvec3(-0.1), glm::dvec3(1.0 / 7.0)},
        MeshInstance{flat},
        MeshInstance{smooth},
        Disk{awkward_point(6), awkward_point(7), 0.3, 0.1},
        Rectangle{awkward_point(8), awkward_point(9), awkward_point(17)},
        Cone{awkward_point(10), awkward_point(11), 0.2, 0.1, false},
        Torus{awkward_point(12), awkward_point(13), 0.4, 0.1},
        SphereSetInstance{drops},
        ConeSetInstance{twigs},
    };
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const int seed = static_cast<int>(i);
        Object object;
        object.name = seed % 2 == 0 ? "thing" : "ding \u00fc";
        object.path = seed % 3 == 0 ? "/tree/branch" : "";
        object.shape = shapes[i];
        object.material = i % 4 == 3 ? kNoMaterial : static_cast<MaterialId>(i % 6);
        object.sides = static_cast<Sides>(i % 3);
        object.mask = i == 5 ? 0x80000001u : 0xffffffffu;
        if (i != 3) {
            object.world_from_object = translate(2.0 * awkward_point(3 * seed)) *
                                       rotate(100.0 / 7.0 * seed, {1, 2, 3}) *
                                       scale({1.1, seed % 2 == 0 ? -0.9 : 1.3, 0.7});
        }
        if (i == 6) scene.next_object_id += 5;
        add_object(scene, object);
    }
    scene.lights = {
        PointLight{"", 5.0 * awkward_point(50), awkward_colour(51), {0.5, 1.0 / 3.0, 0.01}},
        DirectionalLight{"sun", awkward_point(52), awkward_colour(53)},
        SpotLight{
            "spot", 5.0 * awkward_point(54), awkward_point(55), awkward_colour(56), {}, 10.5, 33.3},
        SphereLight{"ball", 5.0 * awkward_point(57), 0.7, awkward_colour(58), {0, 0, 1}, 2},
        RectangleLight{"window",
                       5.0 * awkward_point(59),
                       {1, 0, 0},
                       {0, 0, 1.0 / 3.0},
                       awkward_colour(60),
                       {},
                       3}};
    Camera view;
    view.eye = glm::dvec3(1.0 / 3.0, 2.0, 4.0);
    scene.cameras.push_back({"", view});
    view.projection = Projection::orthographic;
    view.height = 10.0 / 3.0;
    view.near = 0.1;
    scene.cameras.push_back({"top", view});
    return scene;
}

TEST_F(SaveScene, EverythingComesBack) {
    const Scene scene = scene_of_everything();
    const Scene loaded = expect_round_trip(scene);
    ASSERT_EQ(loaded.objects.size(), scene.objects.size());
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        SCOPED_TRACE(scene.objects[i].name);
        const Object& before = scene.objects[i];
        const Object& after = loaded.objects[i];
        EXPECT_EQ(after.id, before.id);
        EXPECT_EQ(after.path, before.path);
        EXPECT_EQ(after.shape.index(), before.shape.index());
        EXPECT_EQ(after.world_from_object, before.world_from_object);
        EXPECT_EQ(after.material, before.material);
        EXPECT_EQ(after.mask, before.mask);
        EXPECT_EQ(after.sides, before.sides);
    }
    ASSERT_EQ(loaded.materials.size(), scene.materials.size());
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& before = scene.materials[i];
        const Material& after = loaded.materials[i];
        EXPECT_EQ(after.name, before.name);
        EXPECT_EQ(after.diffuse, before.diffuse);
        EXPECT_EQ(after.ambient, before.ambient);
        EXPECT_EQ(after.absorption, before.absorption);
        EXPECT_EQ(after.priority, before.priority);
        EXPECT_EQ(after.opacity, before.opacity);
        EXPECT_EQ(after.maps, before.maps);
        EXPECT_EQ(after.model, before.model);
        EXPECT_EQ(after.reflectance, before.reflectance);
        EXPECT_EQ(after.thin_walled, before.thin_walled);
    }
    ASSERT_EQ(loaded.textures.size(), scene.textures.size());
    for (std::size_t i = 0; i < 2; ++i) {
        const auto& before = std::get<ImageTexture>(scene.textures[i].source);
        const auto& after = std::get<ImageTexture>(loaded.textures[i].source);
        EXPECT_EQ(after.file, before.file);
        EXPECT_EQ(after.pixels->coding, before.pixels->coding);
        EXPECT_EQ(after.pixels->texels, before.pixels->texels);
    }
    ASSERT_EQ(loaded.cameras.size(), 2u);
    EXPECT_EQ(loaded.cameras[0].camera, scene.cameras[0].camera);
    EXPECT_EQ(loaded.cameras[1].camera, scene.cameras[1].camera);
    EXPECT_EQ(loaded.meshes.size(), 3u) << "also those that nothing shows";
    EXPECT_EQ(loaded.lights.size(), scene.lights.size());
}

TEST_F(SaveScene, AnImageAllAround) {
    Scene scene = scene_of_everything();
    std::vector<glm::vec3> texels;
    for (int i = 0; i < 32; ++i)
        texels.push_back(awkward_colour(i) * 3.0f);
    ImageSky sky;
    sky.pixels = make_sky_pixels(4, 8, texels);
    sky.file = "skies/sunset.hdr";
    sky.forward = {1.0 / 3.0, 0.0, 1.0};
    sky.scale = 0.7f;
    scene.environment = sky;
    const Scene loaded = expect_round_trip(scene);
    const auto& after = std::get<ImageSky>(loaded.environment);
    EXPECT_EQ(after.pixels->texels, texels);
    EXPECT_EQ(after.file, sky.file);
}

TEST_F(SaveScene, FarFromZeroTheOriginIsKept) {
    Scene scene;
    place(scene, Sphere{{5000000.123, 4.8e6, 1.0 / 3.0}, 0.25});
    place(scene, Sphere{{5000001.25, 4.8e6, 0.0}, 0.5});
    choose_origin(scene);
    ASSERT_NE(scene.origin, glm::dvec3(0.0));
    const Scene loaded = expect_round_trip(scene);
    EXPECT_EQ(std::get<Sphere>(loaded.objects[0].shape).centre,
              std::get<Sphere>(scene.objects[0].shape).centre);
    EXPECT_EQ(loaded.objects[0].world_from_object, scene.objects[0].world_from_object);
}

TEST_F(SaveScene, SignsOfZeroAndExtremeNumbersSurvive) {
    Scene scene;
    constexpr double kTiny = std::numeric_limits<double>::denorm_min();
    place(scene, Sphere{{-0.0, kTiny, -1e17}, 1.0 + std::numeric_limits<double>::epsilon()});
    scene.objects[0].world_from_object.translation = {-0.0, 9007199254740993.0,
                                                      123456789012345680.0};
    scene.materials.push_back(Material{});
    scene.materials[0].emissive = {std::numeric_limits<float>::min(), std::nextafter(0.1f, 1.0f),
                                   16777216.0f};
    save_scene(scene, folder_ / "a.json");
    const Scene loaded = load_scene(folder_ / "a.json").scene;
    const auto& before = std::get<Sphere>(scene.objects[0].shape);
    const auto& after = std::get<Sphere>(loaded.objects[0].shape);
    EXPECT_EQ(std::memcmp(&after, &before, sizeof before), 0);
    EXPECT_EQ(std::memcmp(&loaded.objects[0].world_from_object, &scene.objects[0].world_from_object,
                          sizeof(Transform)),
              0);
    EXPECT_EQ(loaded.materials[0].emissive, scene.materials[0].emissive);
}

// The ends of what check_scene allows are what the reader allows.
TEST_F(SaveScene, TheLargestNumbersComeBack) {
    Scene scene;
    Material m;
    m.diffuse = m.ambient = m.specular = glm::vec3(1e6f);
    m.reflect = m.transmit = glm::vec3(2.0f);
    m.emissive = m.absorption = glm::vec3(1e18f);
    m.shininess = m.ior = m.alpha_cutoff = 1e18f;
    place(scene, Sphere{{0, 0, 0}, 1.0}, add_material(scene, m), scale(glm::dvec3(1e18)));
    PointLight lamp;
    lamp.colour = glm::vec3(1e18f);
    lamp.attenuation = {1e-18, 0.0, 1e18};
    scene.lights.emplace_back(lamp);
    add_texture(scene, {"squares", Checker{glm::vec4(1.0f), glm::vec4(0.0f)}});
    save_scene(scene, folder_ / "a.json");
    const Scene loaded = load_scene(folder_ / "a.json").scene;
    EXPECT_EQ(loaded.materials.at(0).absorption, m.absorption);
    EXPECT_EQ(loaded.materials.at(0).alpha_cutoff, m.alpha_cutoff);
    EXPECT_EQ(std::get<PointLight>(loaded.lights.at(0)).attenuation, lamp.attenuation);
}

TEST_F(SaveScene, EveryFloatIsReadBack) {
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        std::mt19937_64 random(seed);
        const auto bits = static_cast<std::uint32_t>(random());
        float value = 0.0f;
        std::memcpy(&value, &bits, sizeof value);
        value = std::abs(value);
        if (!(value >= std::numeric_limits<float>::min() && value <= 1e18f)) continue;
        Scene scene;
        scene.background = glm::vec3(value);
        save_scene(scene, folder_ / "a.json");
        ASSERT_EQ(load_scene(folder_ / "a.json").scene.background, scene.background)
            << "seed " << seed;
    }
}

TEST_F(SaveScene, AFailureLeavesTheOldFile) {
    const std::filesystem::path file = write("scene.json", "precious");
    Scene bad;
    place(bad, Sphere{{0, 0, 0}, -1.0});
    EXPECT_THROW(save_scene(bad, file), Error);
    std::stop_source source;
    source.request_stop();
    SaveOptions options;
    options.stop = source.get_token();
    EXPECT_THROW(save_scene(scene_of_everything(), file, options), Cancelled);
    EXPECT_EQ(bytes_of(file), "precious");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1)
        << "a temporary file is left";
    try {
        save_scene(Scene{}, folder_ / "no folder" / "a.json");
        ADD_FAILURE() << "no complaint";
    } catch (const FileError& error) {
        EXPECT_THAT(error.what(), HasSubstr("can't be written: No such file"));
    }
}

TEST_F(SaveScene, ReportsProgress) {
    std::atomic<float> progress = 0.0f;
    SaveOptions options;
    options.progress = &progress;
    save_scene(scene_of_everything(), folder_ / "a.json", options);
    EXPECT_EQ(progress.load(), 1.0f);
}

class SaveAssets : public SaveScene {};

TEST_F(SaveAssets, AllOurScenesComeBack) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(asset(""))) {
        const std::filesystem::path& file = entry.path();
        if (file.extension() != ".json" || file.filename() == "scene.schema.json") continue;
        SCOPED_TRACE(file.string());
        expect_round_trip(load_scene(file).scene);
    }
}

class SaveModels : public SaveScene, public testing::WithParamInterface<const char*> {};

TEST_P(SaveModels, ComeBackBitForBit) {
    RAYPICK_REQUIRE_MODEL(GetParam());
    expect_round_trip(load_scene(model(GetParam())).scene);
}

INSTANTIATE_TEST_SUITE_P(Real, SaveModels,
                         testing::Values("gltf/CesiumMilkTruck.glb", "gltf/statue.glb",
                                         "bitterli/coffee.glb", "openfoam/motorBike.obj",
                                         "spd/balls.nff", "spd/rings.nff", "nff/refract.nff"),
                         [](const auto& test) {
                             std::string name = std::filesystem::path(test.param).stem().string();
                             return name;
                         });

TEST(Base64Writing, GivesWhatIsRead) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        std::string bytes(seed, '\0');
        for (char& c : bytes)
            c = static_cast<char>(random());
        std::string text;
        append_base64(text, bytes);
        EXPECT_EQ(text.size() % 4, 0u);
        EXPECT_EQ(decode_base64(text), bytes) << "seed " << seed;
    }
    std::string text;
    append_base64(text, "Man");
    append_base64(text, "M");
    EXPECT_EQ(text, "TWFuTQ==");
}

}  // namespace
}  // namespace raypick
