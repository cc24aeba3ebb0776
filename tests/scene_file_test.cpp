// The JSON scene file: what it says is what the scene holds, and what is wrong is said where it is.
#include "tracer/error.h"
#include "tracer/io/load.h"
#include "tracer/scene/scene.h"

#include "needs.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <set>

namespace raypick {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Json = nlohmann::json;

// A folder of its own for each test, gone afterwards.
class SceneFile : public testing::Test {
protected:
    void SetUp() override {
        const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  fmt::format("raypick-{}-{}", test->name(), ::getpid());
        std::filesystem::create_directories(folder_ / "models");
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }

    [[nodiscard]] LoadedScene load(const std::string& text, const LoadOptions& options = {}) const {
        write("scene.json", text);
        return load_scene(folder_ / "scene.json", options);
    }
    // A scene with these objects, written as JSON.
    [[nodiscard]] Scene load_objects(const std::string& objects) const {
        return load(fmt::format(R"({{"raypick": 1, "objects": [{}]}})", objects)).scene;
    }
    // The complaint without the line that it begins with where it isn't a syntax error.
    [[nodiscard]] std::string complaint(const std::string& text) const {
        const std::string whole = complaint_with_line(text);
        const std::size_t digits = whole.find_first_not_of("0123456789", 5);
        const bool has_line = whole.starts_with("line ") && whole.find(": ", 5) == digits;
        return has_line ? whole.substr(digits + 2) : whole;
    }
    // The complaint without the file's name, which it must begin with.
    [[nodiscard]] std::string complaint_with_line(const std::string& text) const {
        try {
            (void)load(text);
        } catch (const FileError& error) {
            const std::string file = (folder_ / "scene.json").string();
            EXPECT_EQ(error.file(), file);
            const std::string what = error.what();
            EXPECT_EQ(what.substr(0, file.size() + 2), file + ": ");
            return what.substr(file.size() + 2);
        }
        return "no complaint";
    }
    [[nodiscard]] std::string complaint_of_root(const std::string& members) const {
        return complaint(fmt::format(R"({{"raypick": 1, {}}})", members));
    }
    [[nodiscard]] std::string complaint_of_objects(const std::string& objects) const {
        return complaint_of_root(fmt::format(R"("objects": [{}])", objects));
    }
    [[nodiscard]] std::string complaint_of_material(const std::string& members) const {
        return complaint_of_root(fmt::format(R"("materials": {{"gold": {{{}}}}})", members));
    }
    [[nodiscard]] std::filesystem::path folder() const { return folder_; }

private:
    std::filesystem::path folder_;
};

void expect_point(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance = 1e-12) {
    EXPECT_LE(glm::length(actual - expected), tolerance)
        << fmt::format("({}, {}, {}) is not ({}, {}, {})", actual.x, actual.y, actual.z, expected.x,
                       expected.y, expected.z);
}

std::vector<std::string> names_of(const Scene& scene) {
    std::vector<std::string> names;
    for (const Object& object : scene.objects)
        names.push_back(object.name);
    return names;
}

TEST_F(SceneFile, ReadsSettingsCamerasAndLights) {
    const Scene scene = load(R"(
        // a comment
        {
            "$schema": "somewhere.json", "raypick": 1, /* another */
            "background": [0.1, 0.2, 0.3], "ambient": 0.25,
            "camera": {"eye": [1, 2, 3], "at": [4, 5, 6], "up": [0, 0, 1], "fovy": 30},
            "cameras": [{"eye": [0, 0, 9], "at": [0, 0, 0]},
                        {"name": "top", "eye": [0, 9, 0], "at": [0, 0, 0]}],
            "lights": [{"type": "point", "position": [7, 8, 9], "colour": [2, 1, 0.5]},
                       {"type": "directional", "name": "sun", "direction": [0, -2, 0]}]
        })")
                            .scene;
    EXPECT_EQ(scene.background, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(scene.ambient, glm::vec3(0.25f));
    ASSERT_EQ(scene.cameras.size(), 3u);
    const Camera& camera = scene.cameras[0].camera;
    EXPECT_EQ(camera.eye, glm::dvec3(1, 2, 3));
    EXPECT_EQ(camera.at, glm::dvec3(4, 5, 6));
    EXPECT_EQ(camera.up, glm::dvec3(0, 0, 1));
    EXPECT_EQ(camera.fovy, 30.0);
    EXPECT_EQ(scene.cameras[0].name, "camera");
    EXPECT_EQ(scene.cameras[1].name, "camera 2");
    EXPECT_EQ(scene.cameras[2].name, "top");
    EXPECT_EQ(scene.cameras[1].camera.up, glm::dvec3(0, 1, 0));
    EXPECT_EQ(scene.cameras[1].camera.fovy, 45.0);
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(std::get<PointLight>(scene.lights[0]).position, glm::dvec3(7, 8, 9));
    EXPECT_EQ(std::get<PointLight>(scene.lights[0]).colour, glm::vec3(2, 1, 0.5f));
    EXPECT_EQ(std::get<DirectionalLight>(scene.lights[1]).direction, glm::dvec3(0, -2, 0));
    EXPECT_EQ(std::get<DirectionalLight>(scene.lights[1]).colour, glm::vec3(1));
    EXPECT_EQ(std::get<DirectionalLight>(scene.lights[1]).name, "sun");
}

TEST_F(SceneFile, ReadsTheSmallestScene) {
    const Scene scene = load(R"({"raypick": 1})").scene;
    EXPECT_TRUE(scene.objects.empty());
    EXPECT_TRUE(scene.cameras.empty());
    EXPECT_EQ(scene.background, Scene{}.background);
    EXPECT_EQ(scene.ambient, Scene{}.ambient);
}

TEST_F(SceneFile, ReadsMaterials) {
    const Scene scene = load(R"({"raypick": 1, "materials": {
        "all": {"ambient": 0.1, "diffuse": [0.2, 0.3, 0.4], "specular": 0.5, "shininess": 60,
                "emissive": [0, 0, 7], "reflect": 0.8, "transmit": [0.9, 0, 0], "ior": 1.33},
        "bare": {"diffuse": [0.5, 0.6, 0.7]}, "empty": {}},
        "objects": [{"type": "sphere", "radius": 1, "material": "all"},
                    {"type": "sphere", "radius": 1, "material": "bare"},
                    {"type": "sphere", "radius": 1, "material": "empty"},
                    {"type": "sphere", "radius": 1},
                    {"type": "sphere", "name": "egg", "radius": 1, "material": {"ior": 2}}]})")
                            .scene;
    const auto material_of = [&scene](std::size_t object) -> const Material& {
        return material(scene, scene.objects[object].material);
    };
    const Material& all = material_of(0);
    EXPECT_EQ(all.name, "all");
    EXPECT_EQ(all.ambient, glm::vec3(0.1f));
    EXPECT_EQ(all.diffuse, glm::vec3(0.2f, 0.3f, 0.4f));
    EXPECT_EQ(all.specular, glm::vec3(0.5f));
    EXPECT_EQ(all.shininess, 60.0f);
    EXPECT_EQ(all.emissive, glm::vec3(0, 0, 7));
    EXPECT_EQ(all.reflect, glm::vec3(0.8f));
    EXPECT_EQ(all.transmit, glm::vec3(0.9f, 0, 0));
    EXPECT_EQ(all.ior, 1.33f);
    EXPECT_EQ(material_of(1).ambient, material_of(1).diffuse);
    EXPECT_EQ(material_of(1).ior, 1.5f);
    EXPECT_EQ(material_of(1).shininess, 32.0f);
    EXPECT_EQ(material_of(2).diffuse, glm::vec3(0.8f));
    EXPECT_EQ(scene.objects[3].material, kNoMaterial);
    EXPECT_EQ(material_of(4).ior, 2.0f);
    EXPECT_EQ(material_of(4).name, "egg");
}

TEST_F(SceneFile, ReadsEveryShape) {
    const Scene scene = load_objects(R"(
        {"type": "sphere", "name": "ball", "centre": [1, 2, 3], "radius": 0.5},
        {"type": "sphere", "radius": 2},
        {"type": "plane", "normal": [0, 2, 0], "d": -3},
        {"type": "triangle", "a": [0, 0, 0], "b": [1, 0, 0], "c": [0, 0, 1]},
        {"type": "box", "min": [0, 0, 0], "max": [1, 2, 3]},
        {"type": "mesh", "name": "patch", "positions": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.5]],
         "triangles": [[0, 1, 2], [0, 2, 3]]})");
    EXPECT_THAT(names_of(scene),
                ElementsAre("ball", "sphere", "plane", "triangle", "box", "patch"));
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).centre, glm::dvec3(1, 2, 3));
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).radius, 0.5);
    EXPECT_EQ(std::get<Sphere>(scene.objects[1].shape).centre, glm::dvec3(0));
    EXPECT_EQ(std::get<Plane>(scene.objects[2].shape).normal, glm::dvec3(0, 2, 0));
    EXPECT_EQ(std::get<Plane>(scene.objects[2].shape).d, -3.0);
    EXPECT_EQ(std::get<Triangle>(scene.objects[3].shape).c, glm::dvec3(0, 0, 1));
    EXPECT_EQ(std::get<Box>(scene.objects[4].shape).max, glm::dvec3(1, 2, 3));
    const Mesh& mesh = scene.meshes[std::get<MeshInstance>(scene.objects[5].shape).mesh];
    ASSERT_EQ(mesh.triangles.size(), 2u);
    const glm::uvec3 second = mesh.triangles[1];
    EXPECT_EQ(mesh.positions[second.z], glm::vec3(0, 1, 0.5f));
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());  // smooth: 27 degrees
    for (const Object& object : scene.objects)
        EXPECT_EQ(object.path, "/" + object.name);
}

TEST_F(SceneFile, TakesNormalsAndTheCreaseAngle) {
    const std::string mesh = R"("type": "mesh", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                                "triangles": [[0, 1, 2]])";
    const Scene given =
        load_objects(fmt::format(R"({{{}, "normals": [[0, 0, 2], [0, 3, 4], [1, 0, 0]]}})", mesh));
    expect_point(given.meshes[0].normals[1], {0, 0.6, 0.8}, 1e-6);
    LoadOptions flat;
    flat.crease_degrees = 0.0;
    const Scene without =
        load(fmt::format(R"({{"raypick": 1, "objects": [{{{}}}]}})", mesh), flat).scene;
    EXPECT_TRUE(without.meshes[0].normals.empty());
}

TEST_F(SceneFile, PlacesByTranslateRotateScale) {
    const Scene scene = load_objects(R"(
        {"type": "sphere", "radius": 1, "translate": [10, 20, 30],
         "rotate": {"axis": [0, 0, 5], "degrees": 90}, "scale": [2, 3, -4]},
        {"type": "sphere", "radius": 1, "scale": 5},
        {"type": "sphere", "radius": 1,
         "matrix": [[0, -3, 0, 10], [2, 0, 0, 20], [0, 0, -4, 30]]},
        {"type": "sphere", "radius": 1,
         "matrix": [[0, -3, 0, 10], [2, 0, 0, 20], [0, 0, -4, 30], [0, 0, 0, 1]]})");
    // (1, 1, 1) scaled is (2, 3, -4), turned (-3, 2, -4), moved (7, 22, 26).
    expect_point(scene.objects[0].world_from_object.point({1, 1, 1}), {7, 22, 26});
    expect_point(scene.objects[1].world_from_object.point({1, 2, 3}), {5, 10, 15});
    expect_point(scene.objects[2].world_from_object.point({1, 1, 1}), {7, 22, 26});
    EXPECT_EQ(scene.objects[3].world_from_object, scene.objects[2].world_from_object);
    EXPECT_TRUE(scene.objects[0].world_from_object.mirrors());
}

TEST_F(SceneFile, NumbersAreReadInDouble) {
    const Scene scene = load(R"({"raypick": 1,
        "camera": {"eye": [4500000.123456, 0, 9], "at": [4500000.25, 0, 0]},
        "objects": [{"type": "sphere", "centre": [4500000.123456, 0, 0], "radius": 0.001}]})")
                            .scene;
    expect_point(scene.cameras[0].camera.eye + scene.origin, {4500000.123456, 0, 9}, 1e-8);
    expect_point(scene.objects[0].world_from_object.point({4500000.123456, 0, 0}) + scene.origin,
                 {4500000.123456, 0, 0}, 1e-8);
}

TEST_F(SceneFile, InlineMeshesFarFromTheOriginKeepTheirPrecision) {
    const Scene scene = load_objects(R"(
        {"type": "mesh", "positions": [[5000000.125, 1, 0], [5000000.375, 1, 0], [5000000.125, 2, 0]],
         "triangles": [[0, 1, 2]]})");
    const Object& object = scene.objects[0];
    const Mesh& mesh = scene.meshes[0];
    const glm::uvec3 t = mesh.triangles[0];
    const auto in_file = [&](std::uint32_t vertex) {
        return object.world_from_object.point(mesh.positions[vertex]) + scene.origin;
    };
    expect_point(in_file(t.x), {5000000.125, 1, 0}, 1e-8);
    expect_point(in_file(t.y), {5000000.375, 1, 0}, 1e-8);
    expect_point(in_file(t.z), {5000000.125, 2, 0}, 1e-8);
}

TEST_F(SceneFile, IdsGoOnFromTheSession) {
    LoadOptions options;
    options.first_object_id = 70;
    const Scene scene = load(R"({"raypick": 1, "objects": [{"type": "sphere", "radius": 1},
        {"type": "sphere", "radius": 1}]})",
                             options)
                            .scene;
    EXPECT_EQ(scene.objects[0].id, 70u);
    EXPECT_EQ(scene.objects[1].id, 71u);
    EXPECT_EQ(scene.next_object_id, 72u);
}

TEST_F(SceneFile, AnInstanceRepeatsShapeAndMaterialAtAPlaceOfItsOwn) {
    const Scene scene = load_objects(R"(
        {"type": "instance", "of": "patch", "translate": [0, 0, 7]},
        {"type": "mesh", "name": "patch", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
         "triangles": [[0, 1, 2]], "translate": [5, 0, 0], "material": {"diffuse": 0.1}},
        {"type": "instance", "name": "other", "of": "patch", "material": {"diffuse": 0.2}},
        {"type": "box", "name": "box", "min": [0, 0, 0], "max": [1, 1, 1]},
        {"type": "instance", "of": "box", "scale": -2})");
    EXPECT_THAT(names_of(scene), ElementsAre("patch", "patch#2", "other", "box", "box#2"));
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(std::get<MeshInstance>(scene.objects[0].shape).mesh, 0u);
    EXPECT_EQ(std::get<MeshInstance>(scene.objects[2].shape).mesh, 0u);
    expect_point(scene.objects[0].world_from_object.point({0, 0, 0}), {0, 0, 7});
    expect_point(scene.objects[1].world_from_object.point({0, 0, 0}), {5, 0, 0});
    EXPECT_EQ(scene.objects[0].material, scene.objects[1].material);
    EXPECT_EQ(material(scene, scene.objects[2].material).diffuse, glm::vec3(0.2f));
    EXPECT_EQ(std::get<Box>(scene.objects[4].shape).max, glm::dvec3(1));
}

// Two objects in a file, the second in two materials.
constexpr const char* kCarObj = R"(mtllib car.mtl
o body
v 0 0 0
v 1 0 0
v 0 1 0
usemtl red
f 1 2 3
o wheel
v 0 0 1
v 1 0 1
v 0 1 1
v 1 1 1
usemtl red
f 4 5 6
usemtl black
f 5 7 6
)";

constexpr const char* kCarMtl = "newmtl red\nKd 0.9 0 0\nnewmtl black\nKd 0 0 0\n";

constexpr const char* kLeafPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST_F(SceneFile, AModelFileWithOneObjectKeepsTheEntrysName) {
    write("models/leaf.ply", kLeafPly);
    const Scene scene = load_objects(R"(
        {"type": "mesh", "name": "oak", "file": "models/leaf.ply", "translate": [1, 2, 3]},
        {"type": "mesh", "file": "models/leaf.ply"})");
    EXPECT_THAT(names_of(scene), ElementsAre("oak", "leaf"));
    EXPECT_EQ(scene.objects[0].path, "/oak");
    EXPECT_EQ(primitive_count(scene, scene.objects[0]), 1u);
    const Bounds bounds = object_bounds(scene, scene.objects[0]);
    expect_point(bounds.min, {1, 2, 3}, 1e-5);
    expect_point(bounds.max, {2, 3, 3}, 1e-5);
}

TEST_F(SceneFile, AModelFileWithSeveralObjectsGivesSeveral) {
    write("models/car.obj", kCarObj);
    write("models/car.mtl", kCarMtl);
    const Scene scene = load(R"({"raypick": 1, "materials": {"chalk": {"diffuse": 1}}, "objects": [
        {"type": "mesh", "name": "car", "file": "models/car.obj", "translate": [10, 0, 0]},
        {"type": "instance", "name": "second", "of": "car", "material": "chalk"},
        {"type": "instance", "name": "third", "of": "car", "translate": [0, 5, 0]}]})")
                            .scene;
    EXPECT_THAT(names_of(scene), ElementsAre("car/body", "car/wheel", "second/body", "second/wheel",
                                             "third/body", "third/wheel"));
    EXPECT_EQ(scene.objects[1].path, "/car/wheel");
    EXPECT_EQ(scene.objects[3].path, "/second/wheel");
    const auto colour = [&scene](std::size_t object, std::uint32_t primitive) {
        const MaterialId id = material_id(scene, scene.objects[object], primitive);
        return material(scene, id).diffuse;
    };
    EXPECT_EQ(colour(1, 0), glm::vec3(0.9f, 0, 0));
    EXPECT_EQ(colour(1, 1), glm::vec3(0));
    EXPECT_EQ(colour(3, 0), glm::vec3(1));
    EXPECT_EQ(colour(3, 1), glm::vec3(1));
    EXPECT_EQ(colour(5, 0), glm::vec3(0.9f, 0, 0));
    EXPECT_EQ(std::get<MeshInstance>(scene.objects[5].shape).mesh,
              std::get<MeshInstance>(scene.objects[1].shape).mesh);
    expect_point(object_bounds(scene, scene.objects[1]).min, {10, 0, 1}, 1e-5);
    expect_point(object_bounds(scene, scene.objects[5]).min, {0, 5, 1}, 1e-5);
}

TEST_F(SceneFile, ReadsAModelFileOnceAndReportsItsProgress) {
    write("models/leaf.ply", kLeafPly);
    write("models/car.obj", kCarObj);  // without its car.mtl, which is a warning
    std::atomic<float> progress{0};
    LoadOptions options;
    options.progress = &progress;
    const LoadedScene loaded = load(R"({"raypick": 1, "objects": [
        {"type": "mesh", "file": "models/car.obj"},
        {"type": "mesh", "file": "models/../models/car.obj"},
        {"type": "mesh", "file": "models/leaf.ply"}]})",
                                    options);
    EXPECT_EQ(loaded.scene.objects.size(), 5u);
    EXPECT_EQ(loaded.scene.meshes.size(), 3u);
    EXPECT_EQ(progress, 1.0f);
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_THAT(loaded.warnings[0], HasSubstr("car.mtl"));
}

TEST_F(SceneFile, StopsWhenAsked) {
    std::stop_source source;
    source.request_stop();
    LoadOptions options;
    options.stop = source.get_token();
    EXPECT_THROW(
        (void)load(R"({"raypick": 1, "objects": [{"type": "sphere", "radius": 1}]})", options),
        Cancelled);
}

TEST_F(SceneFile, SyntaxErrorsHaveLineAndColumn) {
    EXPECT_EQ(complaint("{\n  \"raypick\": 1,\n  \"ambient\": oops\n}"),
              "line 3, column 14: unexpected 'o'; in /ambient");
    EXPECT_EQ(complaint("{\"raypick\": 1, }"),
              "line 1, column 16: unexpected '}'; expected text in quotes");
    EXPECT_EQ(complaint("{\"raypick\": 1,\n"),
              "line 2, column 1: unexpected end of the file; expected text in quotes");
    EXPECT_EQ(complaint("{\"raypick\": 1} x"),
              "line 1, column 16: unexpected 'x'; expected end of the file");
    EXPECT_EQ(complaint("{\"ä\": 1,, \"raypick\": 1}"),
              "line 1, column 9: unexpected ','; expected text in quotes");
    EXPECT_EQ(complaint("{\"raypick\": NaN}"), "line 1, column 13: unexpected 'N'; in /raypick");
    EXPECT_EQ(complaint("{\"raypick\": ,}"),
              "line 1, column 13: unexpected ','; expected '[', '{', a text, a number, true, false "
              "or null; in /raypick");
    EXPECT_EQ(complaint("{\"raypick\": 1.}"),
              "line 1, column 15: invalid number; expected digit after '.'; in /raypick");
    EXPECT_EQ(complaint("{\"raypick\": 1,\n \"ambient\": 1e999}"),
              "line 2, column 17: number overflow parsing '1e999'; in /ambient");
    EXPECT_EQ(complaint("{\"objects\": [{\"name\": \"a\"}, {\"min\": [0, NaN, 1]}]}"),
              "line 1, column 41: unexpected 'N'; in /objects/1/min/1");
    EXPECT_EQ(complaint("{\"raypick\": 1, \"\xff\": 1}"),
              "line 1, column 17: invalid string: ill-formed UTF-8 byte; expected text in quotes");
    EXPECT_EQ(complaint("{\"raypick\": 1, \"a\nb\": 1}"),
              "line 1, column 18: invalid string: control character U+000A (LF) must be escaped to "
              "\\u000A or \\n; expected text in quotes");
}

TEST_F(SceneFile, AFileThatIsNoScene) {
    EXPECT_THAT(complaint(""), HasSubstr("empty"));
    EXPECT_EQ(complaint("{}"),
              "/: \"raypick\": 1 is missing: the mark and version of a raypick scene");
    EXPECT_EQ(complaint("{\"raypick\": 2}"),
              "/raypick: must be 1, the version that this program reads, not 2");
    EXPECT_EQ(complaint("{\"raypick\": \"1\"}"),
              "/raypick: must be 1, the version that this program reads, not \"1\"");
    try {
        (void)load_scene(folder() / "missing.json");
        FAIL() << "a missing file was read";
    } catch (const FileError& error) {
        EXPECT_EQ(error.file(), (folder() / "missing.json").string());
        EXPECT_THAT(error.what(), HasSubstr("o such file"));
    }
}

TEST_F(SceneFile, UnknownKeys) {
    EXPECT_EQ(complaint_of_root(R"("ambiant": 1)"),
              "/ambiant: unknown key; did you mean \"ambient\"?");
    EXPECT_EQ(complaint_of_objects(R"({"type": "sphere", "radus": 1})"),
              "/objects/0/radus: unknown key; did you mean \"radius\"?");
    EXPECT_THAT(complaint_of_material(R"("color": 1)"),
                testing::StartsWith(
                    "/materials/gold/color: unknown key; a material has \"name\", \"ambient\", "));
    EXPECT_EQ(complaint_of_root(R"("camera": {"eye": [0, 0, 1], "at": [0, 0, 0], "fov": 3})"),
              "/camera/fov: unknown key; did you mean \"fovy\"?");
    EXPECT_EQ(
        complaint_of_root(R"("lights": [{"type": "point", "position": [0, 0, 0], "a/b~c": 3}])"),
        "/lights/0/a~1b~0c: unknown key; a point light has \"type\", \"name\", \"colour\", "
        "\"position\" and \"attenuation\"");
    EXPECT_EQ(complaint_of_objects(
                  R"({"type": "sphere", "radius": 1, "rotate": {"axis": [1, 0, 0], "degree": 3}})"),
              "/objects/0/rotate/degree: unknown key; did you mean \"degrees\"?");
}

TEST_F(SceneFile, TheSameKeyTwice) {
    EXPECT_EQ(complaint(R"({"raypick": 1, "ambient": 1, "ambient": 2})"),
              "/: the key \"ambient\" stands there twice");
    EXPECT_EQ(complaint_of_objects(R"({}, {"type": "sphere", "radius": 1, "radius": 1})"),
              "/objects/1: the key \"radius\" stands there twice");
    EXPECT_EQ(complaint_of_root(R"("materials": {"a": {}, "b/c": {"ior": 1, "ior": 2}})"),
              "/materials/b~1c: the key \"ior\" stands there twice");
}

TEST_F(SceneFile, NestedTooDeeply) {
    EXPECT_THAT(complaint(std::string(100'000, '[')), HasSubstr("nested deeper than 64 levels"));
}

TEST_F(SceneFile, MissingKeys) {
    EXPECT_EQ(complaint_of_objects(R"({"type": "sphere"})"), "/objects/0: \"radius\" is missing");
    EXPECT_EQ(complaint_of_objects(R"({"radius": 1})"), "/objects/0: \"type\" is missing");
    EXPECT_EQ(complaint_of_objects(R"({"type": "mesh"})"),
              "/objects/0: give either file or positions and triangles");
    EXPECT_EQ(complaint_of_objects(R"({"type": "mesh", "positions": []})"),
              "/objects/0: \"triangles\" is missing");
    EXPECT_EQ(complaint_of_root(R"("camera": {"eye": [0, 0, 0]})"), "/camera: \"at\" is missing");
    EXPECT_EQ(complaint_of_root(R"("lights": [{"type": "directional"}])"),
              "/lights/0: \"direction\" is missing");
}

TEST_F(SceneFile, WrongTypes) {
    EXPECT_EQ(complaint("[1]"), "/: must be a scene (an object), not an array of 1");
    EXPECT_EQ(complaint_of_root(R"("objects": {})"), "/objects: must be an array, not an object");
    EXPECT_EQ(complaint_of_objects("7"), "/objects/0: must be an object with a type, not 7");
    EXPECT_EQ(complaint_of_root(R"("materials": 1)"), "/materials: must be an object, not 1");
    EXPECT_EQ(complaint_of_root(R"("materials": [1])"), "/materials/0: must be an object, not 1");
    EXPECT_EQ(complaint_of_material(R"("ior": "glass")"),
              "/materials/gold/ior: must be a positive number, not \"glass\"");
    EXPECT_EQ(
        complaint_of_objects(R"({}, {"type": "sphere", "radius": 1, "material": {"ior": "glass"}})")
            .substr(0, 11),
        "/objects/0:");
    EXPECT_EQ(
        complaint_of_objects(R"({"type": "sphere", "radius": 1, "material": {"ior": "glass"}})"),
        "/objects/0/material/ior: must be a positive number, not \"glass\"");
    EXPECT_EQ(complaint_of_material(R"("diffuse": "red")"),
              "/materials/gold/diffuse: must be a colour: [red, green, blue] or one number, not "
              "\"red\"");
    EXPECT_EQ(complaint_of_material(R"("diffuse": [1, 2])"),
              "/materials/gold/diffuse: must be a colour: [red, green, blue] or one number, not an "
              "array of 2");
    EXPECT_EQ(complaint_of_material(R"("diffuse": [1, null, 2])"),
              "/materials/gold/diffuse/1: must be a number from 0 to 1e6, not null");
    EXPECT_EQ(complaint_of_objects(R"({"type": "sphere", "radius": 1, "centre": 1})"),
              "/objects/0/centre: must be three numbers [x, y, z], not 1");
    EXPECT_EQ(complaint_of_objects(R"({"type": "sphere", "radius": 1, "name": 5})"),
              "/objects/0/name: must be a text, not 5");
    EXPECT_EQ(complaint_of_objects(R"({"type": "sphere", "radius": 1, "name": ""})"),
              "/objects/0/name: must not be empty");
    EXPECT_EQ(complaint_of_objects(R"({"type": "cube"})"),
              "/objects/0/type: must be \"sphere\", \"plane\", \"triangle\", \"box\", \"disk\", "
              "\"rectangle\", \"cone\", \"cylinder\", \"torus\", \"mesh\", \"spheres\", "
              "\"cones\" or \"instance\", not \"cube\"");
    EXPECT_EQ(complaint_of_objects(R"({"type": "spehre"})"),
              "/objects/0/type: must be \"sphere\", \"plane\", \"triangle\", \"box\", \"disk\", "
              "\"rectangle\", \"cone\", \"cylinder\", \"torus\", \"mesh\", \"spheres\", "
              "\"cones\" or \"instance\", not \"spehre\"; did you mean \"sphere\"?");
    EXPECT_EQ(complaint_of_root(R"("lights": [{"type": "lamp"}])"),
              "/lights/0/type: must be \"point\", \"directional\", \"spot\", \"sphere\" or "
              "\"rectangle\", not \"lamp\"");
}

TEST_F(SceneFile, NumbersThatMakeNoSense) {
    EXPECT_EQ(complaint_of_material(R"("ior": 0)"),
              "/materials/gold/ior: must be a positive number, not 0");
    EXPECT_EQ(complaint_of_material(R"("ior": -1.5)"),
              "/materials/gold/ior: must be a positive number, not -1.5");
    EXPECT_EQ(complaint_of_material(R"("reflect": [0, -0.5, 0])"),
              "/materials/gold/reflect/1: must be a number from 0 to 2, not -0.5");
    EXPECT_EQ(complaint_of_material(R"("shininess": -1)"),
              "/materials/gold/shininess: must be a number from 0 to 1e18, not -1");
    EXPECT_EQ(complaint_of_objects(R"({"type": "sphere", "radius": 0})"),
              "/objects/0/radius: must be a positive number, not 0");
    EXPECT_EQ(complaint_of_objects(R"({"type": "sphere", "radius": 1, "centre": [0, 0, 1e200]})"),
              "/objects/0/centre/2: must be a number between -1e18 and 1e18, not 1e+200");
    EXPECT_EQ(complaint_of_objects(R"({"type": "plane", "normal": [0, 0, 0]})"),
              "/objects/0/normal: must not be [0, 0, 0]: it gives a direction");
    EXPECT_EQ(complaint_of_objects(R"({"type": "box", "min": [0, 5, 0], "max": [1, 1, 1]})"),
              "/objects/0/max: must not be less than min, but is in y");
    EXPECT_EQ(complaint_of_root(R"("lights": [{"type": "directional", "direction": [0, 0, 0]}])"),
              "/lights/0/direction: must not be [0, 0, 0]: it gives a direction");
    EXPECT_EQ(
        complaint_of_root(R"("lights": [{"type": "point", "position": [0, 0, 0], "colour": -1}])"),
        "/lights/0/colour: must be a number from 0 to 1e18, not -1");
}

TEST_F(SceneFile, CamerasThatMakeNoView) {
    const auto with_camera = [this](const std::string& members) {
        return complaint_of_root(fmt::format(R"("camera": {{{}}})", members));
    };
    EXPECT_EQ(with_camera(R"("eye": [1, 2, 3], "at": [1, 2, 3])"),
              "/camera/at: must not be the same point as eye");
    EXPECT_EQ(with_camera(R"("eye": [0, 0, 1], "at": [0, 0, 0], "fovy": 180)"),
              "/camera/fovy: must be a number between 0 and 180 (degrees), not 180");
    EXPECT_EQ(with_camera(R"("eye": [0, 0, 1], "at": [0, 0, 0], "fovy": 0)"),
              "/camera/fovy: must be a number between 0 and 180 (degrees), not 0");
    EXPECT_EQ(with_camera(R"("eye": [0, 0, 1], "at": [0, 0, 0], "up": [0, 0, 0])"),
              "/camera/up: must not be [0, 0, 0]: it gives a direction");
    EXPECT_EQ(complaint_of_root(R"("cameras": [{"eye": [0, 0, 1], "at": [0, 0, 0]}, {"eye": 1}])"),
              "/cameras/1/eye: must be three numbers [x, y, z], not 1");
}

TEST_F(SceneFile, TransformsThatFlatten) {
    const auto with_transform = [this](const std::string& members) {
        return complaint_of_objects(
            fmt::format(R"({{"type": "sphere", "radius": 1, {}}})", members));
    };
    EXPECT_EQ(with_transform(R"("scale": 0)"),
              "/objects/0/scale: must not be 0: it would flatten the object");
    EXPECT_EQ(with_transform(R"("scale": [1, 0, 1])"),
              "/objects/0/scale: must not be 0: it would flatten the object");
    EXPECT_EQ(with_transform(R"("matrix": [[1, 0, 0, 0], [2, 0, 0, 0], [0, 0, 1, 0]])"),
              "/objects/0/matrix: is singular: it would flatten the object");
    EXPECT_EQ(with_transform(R"("matrix": [[1, 0, 0, 0], [0, 1, 0, 0]])"),
              "/objects/0/matrix: must be 3 or 4 rows of 4 numbers, not an array of 2");
    EXPECT_EQ(with_transform(R"("matrix": [[1, 0, 0, 0], [0, 1, 0], [0, 0, 1, 0]])"),
              "/objects/0/matrix/1: must be a row of 4 numbers, not an array of 3");
    EXPECT_EQ(with_transform(R"("matrix": [[1,0,0,0], [0,1,0,0], [0,0,1,0], [0,0,1,1]])"),
              "/objects/0/matrix/3: the last row must be [0, 0, 0, 1]: only affine maps place "
              "objects");
    EXPECT_EQ(with_transform(R"("scale": 2, "matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]])"),
              "/objects/0/matrix: give either matrix or translate, rotate and scale");
    EXPECT_EQ(with_transform(R"("rotate": {"axis": [0, 0, 0], "degrees": 1})"),
              "/objects/0/rotate/axis: must not be [0, 0, 0]: it gives a direction");
    EXPECT_EQ(with_transform(R"("rotate": [0, 90, 0])"),
              "/objects/0/rotate: must be a rotation (an object), not an array of 3");
}

TEST_F(SceneFile, NamesThatLeadNowhere) {
    EXPECT_EQ(complaint_of_root(R"("materials": {"gold": {}}, "objects": [
                  {"type": "sphere", "radius": 1, "material": "golt"}])"),
              "/objects/0/material: there is no material \"golt\"; did you mean \"gold\"?");
    EXPECT_EQ(complaint_of_objects(R"({"type": "sphere", "radius": 1, "material": "lead"})"),
              "/objects/0/material: there is no material \"lead\"");
    EXPECT_EQ(complaint_of_objects(R"({"type": "sphere", "radius": 1, "material": 3})"),
              "/objects/0/material: must be the name of a material, not 3");
    EXPECT_EQ(complaint_of_objects(R"({"type": "sphere", "radius": 1, "material": []})"),
              "/objects/0/material: must be the name of a material or a material, not an array of "
              "0");
    EXPECT_EQ(complaint_of_objects(R"({"type": "instance", "of": "bal"},
                  {"type": "sphere", "name": "ball", "radius": 1})"),
              "/objects/0/of: there is no object \"bal\"; did you mean \"ball\"?");
    EXPECT_EQ(
        complaint_of_objects(R"({"type": "instance", "name": "a", "of": "a"})"),
        "/objects/0/of (of \"a\"): \"a\" is an instance itself: name what it is an instance of");
    EXPECT_EQ(complaint_of_objects(R"({"type": "sphere", "name": "a", "radius": 1},
                  {"type": "sphere", "name": "a", "radius": 2}, {"type": "instance", "of": "a"})"),
              "/objects/2/of: /objects/0 and /objects/1 are both called \"a\"");
}

TEST_F(SceneFile, MeshesThatAreWrong) {
    const auto with_mesh = [this](const std::string& members) {
        return complaint_of_objects(fmt::format(R"({{"type": "mesh", {}}})", members));
    };
    const std::string three = R"("positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]])";
    EXPECT_EQ(with_mesh(three + R"(, "triangles": [[0, 1, 2], [0, 1, 3]])"),
              "/objects/0/triangles/1/2: must be the number of a position, 0 to 2, not 3");
    EXPECT_EQ(with_mesh(three + R"(, "triangles": [[0, 1.5, 2]])"),
              "/objects/0/triangles/0/1: must be the number of a position, 0 to 2, not 1.5");
    EXPECT_EQ(with_mesh(three + R"(, "triangles": [[0, 1]])"),
              "/objects/0/triangles/0: must be three numbers of positions, not an array of 2");
    EXPECT_EQ(with_mesh(three + R"(, "triangles": [[0, 1, 2]], "normals": [[0, 0, 1]])"),
              "/objects/0/normals: must be an array of 3 normals, one a position, not an array of "
              "1");
    EXPECT_EQ(with_mesh(R"("positions": [[0, "x", 0]], "triangles": [])"),
              "/objects/0/positions/0/1: must be a number between -1e18 and 1e18, not \"x\"");
    EXPECT_EQ(with_mesh(R"("file": "a.ply", "positions": [])"),
              "/objects/0/positions: the mesh comes from a file: give either file or positions and "
              "triangles");
}

TEST_F(SceneFile, ModelFilesThatAreWrong) {
    EXPECT_THAT(complaint_of_objects(R"({"type": "mesh", "file": "models/none.ply"})"),
                testing::AllOf(testing::StartsWith("/objects/0/file: "), HasSubstr("none.ply"),
                               HasSubstr("o such file")));
    write("models/broken.ply", "ply\nformat ascii 1.0\nelement vertex many\n");
    EXPECT_THAT(complaint_of_objects(R"({}, {"type": "mesh", "file": "models/broken.ply"})"),
                testing::StartsWith("/objects/0: "));
    EXPECT_THAT(complaint_of_objects(R"({"type": "mesh", "file": "models/broken.ply"})"),
                testing::AllOf(testing::StartsWith("/objects/0/file: "), HasSubstr("broken.ply")));
    EXPECT_EQ(complaint_of_objects(R"({"type": "mesh", "file": 3})"),
              "/objects/0/file: must be a text, not 3");
}

TEST_F(SceneFile, ComplaintsStayShort) {
    const std::string word(5000, 'x');
    EXPECT_LT(complaint_of_material(fmt::format(R"("ior": "{}")", word)).size(), 300u);
    EXPECT_LT(complaint_of_material("\"ior\": \"" + word).size(), 300u);
}

// The schema and the reader must agree on every key.
class Schema : public SceneFile {
protected:
    void SetUp() override {
        SceneFile::SetUp();
        std::ifstream(asset("scene.schema.json")) >> schema_;
    }

    [[nodiscard]] const Json& definition(const std::string& name) const {
        return schema_.at("$defs").at(name);
    }
    [[nodiscard]] const Json& root() const { return schema_; }

    // An example of a value: the schema's own, or that of what it refers to.
    [[nodiscard]] Json example(const Json& value) const {
        if (value.contains("examples")) return value.at("examples").at(0);
        if (value.contains("const")) return value.at("const");
        const std::string reference = value.at("$ref");
        return example(definition(reference.substr(reference.rfind('/') + 1)));
    }
    // An instance of an object type with just the required keys.
    [[nodiscard]] Json smallest(const Json& type) const {
        Json object = Json::object();
        for (const std::string key : type.value("required", Json::array())) {
            object[key] = example(type.at("properties").at(key));
        }
        return object;
    }
    // A whole file around a value of this type.
    static Json file_with(const std::string& type, const Json& value) {
        Json file{{"raypick", 1}};
        if (type == "camera") {
            file["camera"] = value;
        } else if (type == "material") {
            file["textures"]["board"]["type"] = "checker";
            file["materials"]["wood"] = value;
        } else if (type.ends_with("light")) {
            file["lights"] = {value};
        } else if (type == "map") {
            file["textures"]["board"]["type"] = "checker";
            file["materials"]["wood"]["maps"]["diffuse"] = value;
        } else if (type.ends_with("_texture")) {
            file["textures"]["board"] = value;
        } else if (type.ends_with("_sky")) {
            file["environment"] = value;
        } else if (type == "mesh_arrays") {
            file["meshes"] = {value};
        } else if (type == "sphere_set") {
            file["sphere_sets"] = {value};
        } else if (type == "cone_set") {
            file["cone_sets"] = {value};
        } else if (type == "part") {
            file["sphere_sets"] = {{{"spheres", {{0, 0, 0, 1}}}, {"parts", {value}}}};
        } else if (type == "rotation") {
            file["objects"] = {{{"type", "sphere"}, {"radius", 1}, {"rotate", value}}};
        } else {
            file["materials"]["wheel"] = Json::object();
            file["objects"] = {value, {{"type", "sphere"}, {"name", "original"}, {"radius", 1}}};
        }
        return file;
    }
    // What the reader says that this type has.
    [[nodiscard]] std::set<std::string> keys_of_reader(const std::string& type,
                                                       const Json& smallest) const {
        Json with_unknown = smallest;
        with_unknown["qqqqqqqqqq"] = 1;
        return quoted(complaint(file_with(type, with_unknown).dump()));
    }
    static std::set<std::string> quoted(std::string text) {
        std::set<std::string> words;
        text.erase(0, text.find(" has "));
        for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at)) {
            const std::size_t end = text.find('"', at + 1);
            words.insert(text.substr(at + 1, end - at - 1));
            at = end + 1;
        }
        return words;
    }
    static std::set<std::string> keys(const Json& object) {
        std::set<std::string> keys;
        for (const auto& member : object.items())
            keys.insert(member.key());
        return keys;
    }

private:
    Json schema_;
};

const char* const kTypes[] = {"camera",       "point_light",  "directional_light",
                              "spot_light",   "sphere_light", "rectangle_light",
                              "material",     "map",          "checker_texture",
                              "gradient_sky", "rotation",     "sphere",
                              "plane",        "triangle",     "box",
                              "disk",         "rectangle",    "cone",
                              "cylinder",     "torus",        "mesh_arrays",
                              "sphere_set",   "cone_set",     "part",
                              "instance"};

TEST_F(Schema, AndReaderKnowTheSameKeys) {
    for (const std::string type : kTypes) {
        SCOPED_TRACE(type);
        const Json& schema = definition(type);
        EXPECT_FALSE(schema.at("additionalProperties").get<bool>());
        EXPECT_EQ(keys_of_reader(type, smallest(schema)), keys(schema.at("properties")));
    }
    const Json& mesh = definition("mesh");
    EXPECT_EQ(keys_of_reader("mesh", {{"type", "mesh"}, {"file", "x.ply"}}),
              keys(mesh.at("properties")));
    EXPECT_EQ(quoted(complaint(R"({"raypick": 1, "qqqqqqqqqq": 1})")),
              keys(root().at("properties")));
}

TEST_F(Schema, EveryKeyIsReadWithItsExample) {
    for (const std::string type : kTypes) {
        const Json& schema = definition(type);
        for (const auto& property : schema.at("properties").items()) {
            SCOPED_TRACE(fmt::format("{}/{}", type, property.key()));
            Json value = smallest(schema);
            value[property.key()] = example(property.value());
            EXPECT_EQ(complaint(file_with(type, value).dump()), "no complaint");
        }
    }
}

TEST_F(Schema, EveryRequiredKeyIsMissed) {
    for (const std::string type : kTypes) {
        const Json& schema = definition(type);
        for (const std::string key : schema.value("required", Json::array())) {
            SCOPED_TRACE(fmt::format("{}/{}", type, key));
            Json value = smallest(schema);
            value.erase(key);
            EXPECT_THAT(complaint(file_with(type, value).dump()),
                        HasSubstr(fmt::format("\"{}\" is missing", key)));
        }
    }
}

TEST_F(Schema, MeshesAreReadInBothForms) {
    const Json& properties = definition("mesh").at("properties");
    write("knot.ply", kLeafPly);
    Json from_file{{"type", "mesh"}, {"file", example(properties.at("file"))}};
    EXPECT_EQ(complaint(file_with("mesh", from_file).dump()), "no complaint");
    Json here{{"type", "mesh"}};
    for (const char* key : {"positions", "triangles", "normals"}) {
        here[key] = example(properties.at(key));
    }
    EXPECT_EQ(complaint(file_with("mesh", here).dump()), "no complaint");
}

TEST_F(Schema, DefaultsAreTheReaders) {
    const Scene scene = load(R"({"raypick": 1, "materials": {"m": {}},
        "camera": {"eye": [0, 0, 1], "at": [0, 0, 0]}})")
                            .scene;
    const Material& made = scene.materials.at(0);
    const Json& properties = definition("material").at("properties");
    const auto number = [&properties](const char* key) {
        return properties.at(key).at("default").get<float>();
    };
    EXPECT_EQ(made.diffuse, glm::vec3(number("diffuse")));
    EXPECT_EQ(made.ambient, glm::vec3(number("diffuse")));
    EXPECT_EQ(made.specular, glm::vec3(number("specular")));
    EXPECT_EQ(made.emissive, glm::vec3(number("emissive")));
    EXPECT_EQ(made.reflect, glm::vec3(number("reflect")));
    EXPECT_EQ(made.transmit, glm::vec3(number("transmit")));
    EXPECT_EQ(made.shininess, number("shininess"));
    EXPECT_EQ(made.ior, number("ior"));
    EXPECT_EQ(scene.cameras[0].camera.fovy,
              definition("camera").at("properties").at("fovy").at("default").get<double>());
    EXPECT_EQ(scene.ambient, glm::vec3(root().at("properties").at("ambient").at("default")));
    const Json& background = root().at("properties").at("background").at("default");
    EXPECT_EQ(scene.background, glm::vec3(background[0], background[1], background[2]));
}

TEST(Assets, AllLoadWithoutAWarning) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(asset(""))) {
        const std::filesystem::path& file = entry.path();
        if (file.extension() != ".json" || file.filename() == "scene.schema.json") continue;
        SCOPED_TRACE(file.string());
        const LoadedScene loaded = load_scene(file);
        EXPECT_THAT(loaded.warnings, testing::IsEmpty());
        EXPECT_FALSE(loaded.scene.objects.empty());
        EXPECT_NO_THROW(check_camera(default_camera(loaded.scene, {100, 150})));
        ++count;
    }
    EXPECT_GE(count, 7);
}

TEST(Assets, TheDefaultSceneShowsWhatTheProgramIsFor) {
    const Scene scene = load_scene(asset("default.json")).scene;
    EXPECT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.cameras.size(), 1u);
    bool mirror_ball = false;
    bool glass_ball = false;
    bool plane = false;
    std::uint32_t triangles = 0;
    for (const Object& object : scene.objects) {
        const Material& look = material(scene, material_id(scene, object, 0));
        const bool sphere = std::holds_alternative<Sphere>(object.shape);
        mirror_ball = mirror_ball || (sphere && look.reflects() && !look.transmits());
        glass_ball = glass_ball || (sphere && look.transmits());
        plane = plane || std::holds_alternative<Plane>(object.shape);
        if (std::holds_alternative<MeshInstance>(object.shape)) {
            triangles = std::max(triangles, primitive_count(scene, object));
        }
    }
    EXPECT_TRUE(mirror_ball && glass_ball && plane);
    EXPECT_GE(triangles, 10'000u);
    for (const Material& look : scene.materials) {
        SCOPED_TRACE(look.name);
        const glm::vec3 sum = look.diffuse + look.reflect + look.transmit;
        EXPECT_LE(std::max({sum.x, sum.y, sum.z}), 1.0f);
    }
}

TEST(Assets, TheFarSiteIsFarAndKeepsAHandsWidth) {
    const Scene scene = load_scene(asset("far.json")).scene;
    EXPECT_GT(glm::length(scene.origin), 5e6);
    const auto centre = [&scene](const std::string& name) {
        for (const Object& object : scene.objects) {
            if (object.name != name) continue;
            const auto& sphere = std::get<Sphere>(object.shape);
            return object.world_from_object.point(sphere.centre);
        }
        throw Error("there is no " + name);
    };
    expect_point(centre("lamp 2") - centre("lamp 1"), {0.12, 0, 0}, 1e-8);
    EXPECT_LT(glm::length(centre("lamp 1")), 1000.0);
}

}  // namespace
}  // namespace raypick
