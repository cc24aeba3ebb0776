// What is wrong with a file is said with its place, or seen in the picture; never a NaN.
#include "tests/model_files.h"
#include "tests/tracer_scenes.h"
#include "tracer/render/render_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace raypick {
namespace {

using testing::HasSubstr;

using BadInput = ModelFiles;

RenderedFrame picture(Scene scene, const Camera& camera, ImageSize size = {24, 32},
                      const RenderSettings& settings = {}) {
    return render(std::make_shared<const Accel>(accel_of(std::move(scene))), camera, size,
                  settings);
}

// --- textures -----------------------------------------------------------------------------------

// A wall that fills the view and glows by a texture.
constexpr const char* kWall = R"({"raypick": 1, "background": 0, "ambient": 0,
    "camera": {"eye": [0, 0, 1], "at": [0, 0, 0]},
    "textures": {"paper": {"type": "image", "file": "paper.png"}},
    "materials": {"wall": {"ambient": 0, "diffuse": 0, "emissive": 1,
                           "maps": {"emissive": "paper"}}},
    "objects": [{"type": "rectangle", "corner": [-2, -2, 0], "edge_u": [4, 0, 0],
                 "edge_v": [0, 4, 0], "material": "wall"}]})";

TEST_F(BadInput, AMissingOrBrokenTextureIsAWarningAndMagentaSquares) {
    for (const std::string content : {"", "no picture", "\x89PNG\r\n\x1a\nhalf of one"}) {
        SCOPED_TRACE(content);
        if (!content.empty()) write("paper.png", content);
        const LoadedScene loaded = load("wall.json", kWall);
        ASSERT_EQ(loaded.warnings.size(), 1u);
        EXPECT_THAT(loaded.warnings[0], HasSubstr("wall.json: line 3: /textures/paper/file: "));
        EXPECT_THAT(loaded.warnings[0], HasSubstr("paper.png"));
        const Image image =
            picture(loaded.scene, default_camera(loaded.scene, {96, 96}), {96, 96}).image;
        int magenta = 0;
        int black = 0;
        for (const glm::vec3& c : image.colour) {
            magenta += c == glm::vec3(1, 0, 1) ? 1 : 0;
            black += c == glm::vec3(0.0f) ? 1 : 0;
        }
        EXPECT_GT(magenta, 1000);
        EXPECT_GT(black, 1000);
    }
}

// --- materials of other formats -----------------------------------------------------------------

TEST_F(BadInput, MaterialsOfObjFilesNameTheirLibraryAndLine) {
    write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    for (const std::string line : {"Kd nan 0 0", "Kd inf 0 0", "Ks -1 0 0", "Ke 0 -2 0", "Ns nan",
                                   "Ni nan", "d nan", "Tr -inf", "Tf -1 0 0"}) {
        const std::filesystem::path library = write("a.mtl", "newmtl red\n\n" + line + "\n");
        try {
            load_scene(folder_ / "a.obj");
            ADD_FAILURE() << line << " passed";
        } catch (const FileError& error) {
            EXPECT_EQ(error.file(), library.string());
            EXPECT_THAT(error.what(), HasSubstr("line 3: material \"red\": " + line.substr(0, 2)))
                << line;
        }
    }
}

// --- numbers that are allowed -------------------------------------------------------------------

// As far as check_scene lets them go, and in places where a formula divides or takes a root.
TEST(AwkwardInput, GivesNumbersInEveryPixel) {
    for (const float shininess : {0.0f, 1e-30f, 1e18f}) {
        for (const float ior : {1e-6f, 1.0000001f, 1e6f}) {
            for (const auto reflectance :
                 {Reflectance::constant, Reflectance::dielectric, Reflectance::conductor}) {
                for (const bool thin : {false, true}) {
                    SCOPED_TRACE(testing::Message() << shininess << ' ' << ior << ' '
                                                    << static_cast<int>(reflectance) << thin);
                    Material glass;
                    glass.specular = glass.reflect = glass.transmit = glm::vec3(0.5f);
                    glass.shininess = shininess;
                    glass.ior = ior;
                    glass.reflectance = reflectance;
                    glass.thin_walled = thin;
                    glass.absorption = {1e18f, 1e-30f, 0.0f};
                    glass.model = thin ? LocalModel::phong : LocalModel::blinn_phong;
                    Scene scene;
                    const MaterialId id = add_material(scene, glass);
                    place(scene, Sphere{{0, 0, 0}, 1.0}, id);
                    place(scene, Box{{1, -1, -1}, {1, 1, 1}}, id);  // flat, and touches the ball
                    place(scene, Plane{{0, 1, 0}, 1.0}, id);        // touches both
                    // Lights within, on and at the surfaces.
                    scene.lights = {PointLight{"a", {0, 0, 0}, glm::vec3(1.0f), {0, 0, 1}},
                                    PointLight{"b", {0, -1, 0}, glm::vec3(1.0f), {0, 1, 0}},
                                    SpotLight{"c", {0, 1, 0}, {0, -1, 0}, glm::vec3(1), {}, 0, 0},
                                    SphereLight{"d", {0, -1, 0}, 2.0, glm::vec3(1), {}, 1}};
                    for (const GlassShadows shadows :
                         {GlassShadows::opaque, GlassShadows::tinted}) {
                        RenderSettings settings;
                        settings.glass_shadows = shadows;
                        settings.cutoff = 0.01f;
                        settings.threads = 1;
                        settings.depth = 4;
                        // From outside, from within and from a surface.
                        for (const double z : {5.0, 0.0, 1.0}) {
                            Camera camera;
                            camera.eye = {0, 0, z};
                            camera.at = {0.3, -0.2, -9};
                            EXPECT_EQ(picture(scene, camera, {8, 11}, settings).nan_pixels, 0u);
                        }
                    }
                }
            }
        }
    }
}

// A room that makes light, as far as it may and as often as rays may bounce.
TEST(AwkwardInput, TheStrongestMirrorsGiveNumbersInEveryPixel) {
    Scene scene;
    Material mirror;
    mirror.reflect = {2.0f, 0.5f, 0.0f};
    mirror.diffuse = mirror.ambient = {0.5f, 0.0f, 0.3f};
    place(scene, Sphere{{0, 0, 0}, 1.0}, add_material(scene, mirror));
    scene.lights = {PointLight{"lamp", {0.2, 0.1, 0}, glm::vec3(1e9f), {0, 0, 1}}};
    Camera camera;
    camera.eye = {0, 0, 0.5};
    camera.at = {0.3, 0.2, -1};
    RenderSettings settings;
    settings.depth = 64;
    EXPECT_EQ(picture(scene, camera, {8, 11}, settings).nan_pixels, 0u);
}

// Triangles without area, normals of no length, texture coordinates all the same.
TEST(AwkwardInput, DegenerateMeshesGiveNumbersInEveryPixel) {
    MeshData data = ball_data(1);
    const auto count = static_cast<std::uint32_t>(data.positions.size());
    data.triangles.insert(data.triangles.end(), {{0, 0, 0}, {0, 0, 1}, {0, 2, 0}});
    data.normals.assign(count, glm::vec3(0.0f));
    data.uvs.assign(count, glm::vec2(0.5f));
    Scene scene;
    Texture squares;
    squares.source = Checker{};
    Material material;
    material.map(MapSlot::diffuse).texture = add_texture(scene, squares);
    material.map(MapSlot::normal) = material.map(MapSlot::diffuse);
    material.reflect = glm::vec3(0.5f);
    place_mesh(scene, std::move(data), add_material(scene, material));
    scene.lights = {PointLight{"lamp", {3, 3, 3}, glm::vec3(1.0f)}};
    const RenderedFrame frame = picture(scene, Camera{});
    EXPECT_EQ(frame.nan_pixels, 0u);
    EXPECT_GT(frame.rays.eye_hits, 50u);
}

}  // namespace
}  // namespace raypick
