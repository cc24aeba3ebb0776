// The scene's core: ids, names, materials, bounds, origin, views and checks.
#include "tracer/scene/scene.h"

#include "tracer/error.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <glm/geometric.hpp>

#include <chrono>
#include <limits>

namespace raypick {
namespace {

using testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr ImageSize kSize{101, 173};

Object object(std::string name, Shape shape, const Transform& transform = {}) {
    Object result;
    result.name = std::move(name);
    result.shape = shape;
    result.world_from_object = transform;
    return result;
}

// A right triangle in each of two parts, and a stray vertex that no triangle uses.
Mesh two_part_mesh() {
    MeshData data;
    data.positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {2, 3, 1}, {900, 900, 900}};
    data.triangles = {{0, 1, 2}, {1, 3, 2}};
    return make_mesh("quad", std::move(data), {{0, 1, 0}, {1, 1, 1}});
}

std::string message_of(const Scene& scene) {
    try {
        check_scene(scene);
    } catch (const Error& error) {
        return error.what();
    }
    return "no complaint";
}

std::string message_of(const Mesh& mesh) {
    try {
        check_mesh(mesh);
    } catch (const Error& error) {
        return error.what();
    }
    return "no complaint";
}

void expect_near(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance) {
    EXPECT_LE(glm::length(actual - expected), tolerance)
        << fmt::format("({}, {}, {}) is not ({}, {}, {})", actual.x, actual.y, actual.z, expected.x,
                       expected.y, expected.z);
}

TEST(Mesh, OwnsItsArraysAndSharesThemWithItsCopies) {
    const Mesh mesh = two_part_mesh();
    const Mesh copy = mesh;
    EXPECT_EQ(copy.positions.data(), mesh.positions.data());
    EXPECT_EQ(copy.positions.size(), 5u);
    EXPECT_EQ(copy.positions[3], glm::vec3(2, 3, 1));
}

TEST(Mesh, BorrowsWithoutCopying) {
    const std::vector<glm::vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<glm::uvec3> triangles{{0, 1, 2}};
    const Mesh mesh = borrow_mesh("mine", positions, triangles);
    EXPECT_EQ(mesh.positions.data(), positions.data());
    EXPECT_EQ(mesh.triangles.data(), triangles.data());
    EXPECT_EQ(mesh.storage, nullptr);
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_NO_THROW(check_mesh(mesh));
}

TEST(Mesh, ChecksNameTheFirstOffender) {
    MeshData data;
    data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.triangles = {{0, 1, 2}, {0, 3, 1}, {7, 0, 0}};
    EXPECT_EQ(message_of(make_mesh("m", data)),
              "mesh \"m\": triangle 1 uses position 3, but there are 3");
    data.triangles = {{0, 1, 2}};
    data.normals = {{0, 0, 1}};
    EXPECT_EQ(message_of(make_mesh("m", data)),
              "mesh \"m\": 1 normals for 3 positions: give one a position or none");
    data.normals.clear();
    data.uvs.resize(4);
    EXPECT_EQ(message_of(make_mesh("m", data)),
              "mesh \"m\": 4 uvs for 3 positions: give one a position or none");
    data.uvs.clear();
    EXPECT_EQ(message_of(make_mesh("m", data, {{1, 1, 0}})),
              "mesh \"m\": part 0 begins at triangle 1, but should at 0");
    EXPECT_EQ(message_of(make_mesh("m", data, {{0, 2, 0}})),
              "mesh \"m\": the parts hold 2 triangles, the mesh has 1");
    EXPECT_EQ(message_of(make_mesh("m", data, {{0, 1, 0}})), "no complaint");
    EXPECT_EQ(message_of(Mesh{}), "no complaint");
}

TEST(Mesh, FindsThePartOfATriangle) {
    MeshData data;
    data.positions.resize(3);
    data.triangles.resize(10, {0, 1, 2});
    const Mesh mesh = make_mesh("m", data, {{0, 3, 5}, {3, 0, 6}, {3, 6, 7}, {9, 1, 8}});
    check_mesh(mesh);
    EXPECT_EQ(part_of(mesh, 0)->material, 5u);
    EXPECT_EQ(part_of(mesh, 2)->material, 5u);
    EXPECT_EQ(part_of(mesh, 3)->material, 7u);
    EXPECT_EQ(part_of(mesh, 8)->material, 7u);
    EXPECT_EQ(part_of(mesh, 9)->material, 8u);
    EXPECT_EQ(part_of(mesh, 10), nullptr);
    EXPECT_EQ(part_of(make_mesh("m", data), 0), nullptr);
}

TEST(Scene, GivesIdsAndUniqueNames) {
    Scene scene;
    scene.next_object_id = 40;
    EXPECT_EQ(add_object(scene, object("wheel", Sphere{})), 40u);
    add_object(scene, object("wheel", Sphere{}));
    add_object(scene, object("wheel#3", Sphere{}));
    add_object(scene, object("wheel", Sphere{}));
    add_object(scene, object("", Sphere{}));
    add_object(scene, object("", Sphere{}));
    Object in_tree = object("wheel#2", Sphere{});
    in_tree.path = "/car/wheel";
    EXPECT_EQ(add_object(scene, in_tree), 46u);
    std::vector<std::string> names;
    for (const Object& o : scene.objects)
        names.push_back(o.name);
    EXPECT_THAT(names, testing::ElementsAre("wheel", "wheel#2", "wheel#3", "wheel#4", "object",
                                            "object#2", "wheel#2#2"));
    EXPECT_EQ(scene.objects[1].path, "/wheel#2");
    EXPECT_EQ(scene.objects[6].path, "/car/wheel");
    EXPECT_EQ(scene.next_object_id, 47u);
}

TEST(Scene, NamesAHundredThousandObjectsAtOnce) {
    Scene scene;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 100'000; ++i)
        add_object(scene, object("wheel", Sphere{}));
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_EQ(scene.objects.back().name, "wheel#100000");
    EXPECT_LT(seconds.count(), 5.0);  // takes 0.05; a search through all names takes minutes
}

TEST(Scene, FindsObjectsAlsoWhereSomeWereRemoved) {
    Scene scene;
    scene.next_object_id = 10;
    for (int i = 0; i < 8; ++i)
        add_object(scene, object(fmt::format("o{}", i), Sphere{}));
    EXPECT_EQ(object_index(scene, 17), 7u);
    scene.objects.erase(scene.objects.begin() + 2, scene.objects.begin() + 4);  // ids 12, 13
    EXPECT_EQ(find_object(scene, 12), nullptr);
    EXPECT_EQ(find_object(scene, 9), nullptr);
    EXPECT_EQ(find_object(scene, 18), nullptr);
    EXPECT_EQ(find_object(scene, kNoObject), nullptr);
    EXPECT_EQ(find_object(scene, 14)->name, "o4");
    EXPECT_EQ(object_index(scene, 11), 1u);
    EXPECT_EQ(object_index(scene, 14), 2u);
    EXPECT_EQ(object_index(scene, 17), 5u);
    scene.objects.clear();
    EXPECT_EQ(find_object(scene, 10), nullptr);
}

TEST(Scene, TakesTheMaterialOfTheObjectElseOfThePartElseGrey) {
    Scene scene;
    Material red;
    red.name = "red";
    add_material(scene, red);
    add_material(scene, Material{});
    const MeshId mesh = add_mesh(scene, two_part_mesh());
    Object in_parts = object("parts", MeshInstance{mesh});
    EXPECT_EQ(material_id(scene, in_parts, 0), 0u);
    EXPECT_EQ(material_id(scene, in_parts, 1), 1u);
    in_parts.material = 0;
    EXPECT_EQ(material_id(scene, in_parts, 1), 0u);
    const Object sphere = object("ball", Sphere{});
    EXPECT_EQ(material_id(scene, sphere, 0), kNoMaterial);
    EXPECT_EQ(material(scene, 0).name, "red");
    EXPECT_EQ(material(scene, kNoMaterial).name, "");
    EXPECT_EQ(material(scene, kNoMaterial).diffuse, Material{}.diffuse);
}

TEST(Scene, CountsPrimitives) {
    Scene scene;
    const MeshId mesh = add_mesh(scene, two_part_mesh());
    EXPECT_EQ(primitive_count(scene, object("m", MeshInstance{mesh})), 2u);
    EXPECT_EQ(primitive_count(scene, object("b", Box{})), 6u);
    EXPECT_EQ(primitive_count(scene, object("s", Sphere{})), 1u);
    EXPECT_EQ(primitive_count(scene, object("p", Plane{})), 1u);
    EXPECT_EQ(primitive_count(scene, object("t", Triangle{})), 1u);
}

TEST(SceneBounds, OfEachShape) {
    Scene scene;
    const MeshId mesh = add_mesh(scene, two_part_mesh());
    const MeshId empty = add_mesh(scene, Mesh{});
    const auto extent_of = [&scene](const Shape& shape) { return object_extent(scene, shape); };
    const auto sphere = extent_of(Sphere{{1, 2, 3}, 2});
    expect_near(sphere->min, {-1, 0, 1}, 0);
    expect_near(sphere->max, {3, 4, 5}, 0);
    const auto triangle = extent_of(Triangle{{1, 5, 0}, {-2, 4, 1}, {0, 7, -3}});
    expect_near(triangle->min, {-2, 4, -3}, 0);
    expect_near(triangle->max, {1, 7, 1}, 0);
    const auto of_mesh = extent_of(MeshInstance{mesh});
    expect_near(of_mesh->min, {0, 0, 0}, 0);
    expect_near(of_mesh->max, {2, 3, 1}, 0);  // without the stray vertex
    EXPECT_FALSE(extent_of(Plane{}).has_value());
    EXPECT_FALSE(extent_of(MeshInstance{empty}).has_value());
    EXPECT_TRUE(object_bounds(scene, object("plane", Plane{})).empty());
}

TEST(SceneBounds, IgnoresVerticesThatAreNotFinite) {
    Scene scene;
    MeshData data;
    data.positions = {
        {0, 0, 0}, {1, kNan, 0}, {0, 1, std::numeric_limits<float>::infinity()}, {1, 1, 1}};
    data.triangles = {{0, 1, 2}, {0, 2, 3}};
    const MeshId mesh = add_mesh(scene, make_mesh("m", data));
    const auto extent = object_extent(scene, MeshInstance{mesh});
    expect_near(extent->min, {0, 0, 0}, 0);
    expect_near(extent->max, {1, 1, 1}, 0);
}

TEST(SceneBounds, CountWhatIsFiniteAndVisible) {
    Scene scene;
    EXPECT_TRUE(scene_bounds(scene).empty());
    add_object(scene, object("floor", Plane{}));
    EXPECT_TRUE(scene_bounds(scene).empty());
    const MeshId mesh = add_mesh(scene, two_part_mesh());
    add_object(scene, object("quad", MeshInstance{mesh}, translate({10, 0, 0})));
    add_object(scene, object("quad", MeshInstance{mesh}, scale({-1, 1, 1})));
    Object hidden = object("hidden", Sphere{{0, 50, 0}, 1});
    hidden.mask = 0;
    add_object(scene, hidden);
    const Bounds bounds = scene_bounds(scene);
    expect_near(bounds.min, {-2, 0, 0}, 1e-5);
    expect_near(bounds.max, {12, 3, 1}, 1e-5);
    EXPECT_LE(bounds.min.x, -2.0f);  // rounded outwards
    EXPECT_GE(bounds.max.x, 12.0f);
}

// A 1 km site at projected coordinates.
Scene far_scene() {
    Scene scene;
    const glm::dvec3 corner{4'500'000.25, 120.5, 5'400'000.75};
    add_object(scene, object("box", Box{{0, 0, 0}, {1000, 50, 1000}}, translate(corner)));
    add_object(scene, object("ball", Sphere{corner + glm::dvec3(100, 60, 100), 5}));
    add_object(scene, object("ground", Plane{{0, 1, 0}, -120.5}));
    scene.lights = {PointLight{"lamp", corner + glm::dvec3(0, 100, 0), glm::vec3(1)},
                    DirectionalLight{"sun", {0, -1, 0}, glm::vec3(1)}};
    Camera camera;
    camera.eye = corner + glm::dvec3(0, 200, 0);
    camera.at = corner + glm::dvec3(500, 0, 500);
    scene.cameras = {{"view", camera}};
    return scene;
}

TEST(Origin, StaysZeroNearTheOrigin) {
    Scene scene;
    add_object(scene, object("box", Box{{3, 4, 5}, {4, 5, 6}}));
    choose_origin(scene);
    EXPECT_EQ(scene.origin, glm::dvec3(0));
    Scene planes_only;
    add_object(planes_only, object("plane", Plane{}, translate({1e7, 0, 0})));
    choose_origin(planes_only);
    EXPECT_EQ(planes_only.origin, glm::dvec3(0));
}

TEST(Origin, MovesEverythingAndKeepsFileCoordinates) {
    const Scene before = far_scene();
    Scene scene = before;
    choose_origin(scene);
    EXPECT_EQ(scene.origin, glm::round(scene.origin));
    expect_near(scene.origin, {4'500'500.25, 153, 5'400'500.75}, 20);

    const Bounds bounds = scene_bounds(scene);
    expect_near(glm::dvec3(bounds.min) + scene.origin, {4'500'000.25, 120.5, 5'400'000.75}, 1e-3);
    expect_near(glm::dvec3(bounds.max) + scene.origin, {4'501'000.25, 185.5, 5'401'000.75}, 1e-3);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const glm::dvec3 p{1, 2, 3};
        expect_near(scene.objects[i].world_from_object.point(p) + scene.origin,
                    before.objects[i].world_from_object.point(p), 1e-8);
    }
    expect_near(std::get<PointLight>(scene.lights[0]).position + scene.origin,
                std::get<PointLight>(before.lights[0]).position, 1e-8);
    EXPECT_EQ(std::get<DirectionalLight>(scene.lights[1]).direction, glm::dvec3(0, -1, 0));
    expect_near(scene.cameras[0].camera.eye + scene.origin, before.cameras[0].camera.eye, 1e-8);
    expect_near(scene.cameras[0].camera.at + scene.origin, before.cameras[0].camera.at, 1e-8);
    EXPECT_NO_THROW(check_scene(scene));

    const glm::dvec3 origin = scene.origin;
    choose_origin(scene);
    EXPECT_EQ(scene.origin, origin);
}

TEST(Origin, IsExactForTinyScenesToo) {
    Scene scene;
    const glm::dvec3 centre{5'000'000.123, 0, 0};
    add_object(scene, object("grain", Sphere{centre, 0.001}));
    choose_origin(scene);
    // The ball's middle must lie within its size of the origin, where floats are dense.
    EXPECT_LT(std::abs(centre.x - scene.origin.x), 0.001);
    const glm::dvec3 grains = scene.origin * 8192.0;  // a power of two below 1 / extent
    EXPECT_EQ(grains, glm::round(grains));
    Scene point;
    add_object(point, object("point", Box{{7e6, 1, 2}, {7e6, 1, 2}}));
    choose_origin(point);
    EXPECT_EQ(point.origin, glm::dvec3(7e6, 1, 2));
}

TEST(DefaultCamera, IsTheFilesFirst) {
    Scene scene = far_scene();
    Camera second;
    scene.cameras.push_back({"second", second});
    const Camera camera = default_camera(scene, kSize, {0, 0, 1});
    EXPECT_EQ(camera.eye, scene.cameras[0].camera.eye);
    EXPECT_EQ(camera.at, scene.cameras[0].camera.at);
    EXPECT_EQ(camera.up, glm::dvec3(0, 1, 0));
    EXPECT_EQ(camera.near, near_for_bounds(camera, scene_bounds(scene)));
}

// The corners of the bounds, projected.
void expect_framed(const Camera& camera, const Bounds& bounds) {
    double largest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1) != 0 ? bounds.max.x : bounds.min.x,
                           (corner & 2) != 0 ? bounds.max.y : bounds.min.y,
                           (corner & 4) != 0 ? bounds.max.z : bounds.min.z);
        const auto image_point = project(camera, kSize, p);
        ASSERT_TRUE(image_point.has_value());
        largest = std::max({largest, std::abs(2 * image_point->r / kSize.rows - 1),
                            std::abs(2 * image_point->c / kSize.cols - 1)});
    }
    EXPECT_LE(largest, 1.0);
    EXPECT_GE(largest, 0.7);
}

TEST(DefaultCamera, LooksFromTheFrontRightAndAbove) {
    Scene scene;
    add_object(scene, object("box", Box{{5, 0, 0}, {9, 2, 3}}));
    add_object(scene, object("floor", Plane{}));
    const Camera camera = default_camera(scene, kSize);
    expect_framed(camera, scene_bounds(scene));
    const glm::dvec3 side = glm::normalize(camera.eye - camera.at);
    expect_near(side, glm::normalize(glm::dvec3(0.6, 0.45, 1)), 1e-6);
    EXPECT_EQ(camera.fovy, 45.0);
    EXPECT_EQ(camera.near, near_for_bounds(camera, scene_bounds(scene)));
}

TEST(DefaultCamera, TurnsWithTheUpDirection) {
    Scene scene;
    add_object(scene, object("box", Box{{5, 0, 0}, {9, 2, 3}}));
    // With z up, the front is -y and the right is still x.
    const Camera z_up = default_camera(scene, kSize, {0, 0, 2});
    expect_near(glm::normalize(z_up.eye - z_up.at), glm::normalize(glm::dvec3(0.6, -1, 0.45)),
                1e-6);
    expect_framed(z_up, scene_bounds(scene));
    for (const glm::dvec3& up : {glm::dvec3(0, -1, 0), glm::dvec3(1, 1, 0), glm::dvec3(-3, 0, 0)}) {
        const Camera camera = default_camera(scene, kSize, up);
        expect_framed(camera, scene_bounds(scene));
        EXPECT_GT(glm::dot(camera.eye - camera.at, up), 0.0);
        EXPECT_GT(glm::dot(camera_frame(camera).vy, up), 0.0);
    }
}

TEST(DefaultCamera, SeesAnInfinitePlaneFromOutside) {
    for (const glm::dvec3& normal :
         {glm::dvec3(0, 1, 0), glm::dvec3(0, -3, 0), glm::dvec3(0, 0, -1), glm::dvec3(1, 0, -1),
          glm::dvec3(-1, 0, 0)}) {
        SCOPED_TRACE(fmt::format("normal ({}, {}, {})", normal.x, normal.y, normal.z));
        Scene scene;
        add_object(scene, object("plane", Plane{normal, 5.0}, translate({0, 2, 0})));
        const Camera camera = default_camera(scene, kSize);
        EXPECT_NO_THROW(check_camera(camera));
        const auto height = [&normal](const glm::dvec3& p) {
            return glm::dot(normal, p - glm::dvec3(0, 2, 0)) + 5.0;
        };
        EXPECT_GT(height(camera.eye), 0.0);
        EXPECT_NEAR(height(camera.at), 0.0, 1e-6);
    }
    EXPECT_NO_THROW(check_camera(default_camera(Scene{}, kSize)));
}

TEST(ChooseCamera, TakesFileCoordinates) {
    Scene scene = far_scene();
    const Scene before = scene;
    choose_origin(scene);
    CameraOverride wanted;
    wanted.eye = glm::dvec3(4'500'001, 300, 5'400'002);
    Camera camera = choose_camera(scene, kSize, wanted);
    expect_near(camera.eye + scene.origin, *wanted.eye, 1e-8);
    expect_near(camera.at + scene.origin, before.cameras[0].camera.at, 1e-8);
    wanted = {};
    wanted.at = glm::dvec3(4'500'001, 300, 5'400'002);
    wanted.up = glm::dvec3(0, 0, 1);
    wanted.fovy = 20.0;
    camera = choose_camera(scene, kSize, wanted);
    expect_near(camera.eye + scene.origin, before.cameras[0].camera.eye, 1e-8);
    expect_near(camera.at + scene.origin, *wanted.at, 1e-8);
    EXPECT_EQ(camera.up, glm::dvec3(0, 0, 1));
    EXPECT_EQ(camera.fovy, 20.0);
    EXPECT_EQ(camera.near, near_for_bounds(camera, scene_bounds(scene)));
}

TEST(ChooseCamera, WithNothingWantedIsTheDefaultCamera) {
    Scene scene;
    add_object(scene, object("box", Box{}));
    EXPECT_EQ(choose_camera(scene, kSize, {}), default_camera(scene, kSize));
    const Scene with_camera = far_scene();
    EXPECT_EQ(choose_camera(with_camera, kSize, {}), default_camera(with_camera, kSize));
}

TEST(ChooseCamera, FramesWithTheWantedAngleAndUp) {
    Scene scene;
    add_object(scene, object("box", Box{{5, 0, 0}, {9, 2, 3}}));
    CameraOverride wanted;
    wanted.fovy = 15.0;
    wanted.up = glm::dvec3(0, 0, 1);
    const Camera camera = choose_camera(scene, kSize, wanted);
    EXPECT_EQ(camera.fovy, 15.0);
    expect_framed(camera, scene_bounds(scene));
    EXPECT_GT(camera.eye.z, camera.at.z);
}

TEST(ChooseCamera, RefusesWhatMakesNoView) {
    Scene scene;
    add_object(scene, object("box", Box{}));
    CameraOverride same_point;
    same_point.eye = same_point.at = glm::dvec3(1, 2, 3);
    EXPECT_THROW(choose_camera(scene, kSize, same_point), Error);
    CameraOverride flat;
    flat.fovy = 0.0;
    EXPECT_THROW(choose_camera(scene, kSize, flat), Error);
    CameraOverride not_a_number;
    not_a_number.up = glm::dvec3(kNan, 0, 1);
    EXPECT_THROW(choose_camera(scene, kSize, not_a_number), Error);
}

TEST(Lights, AHeadlightOnlyIfTheSceneHasNone) {
    Scene scene;
    Camera camera;
    camera.eye = {1, 2, 3};
    const std::vector<Light> lights = effective_lights(scene, camera);
    ASSERT_EQ(lights.size(), 1u);
    EXPECT_EQ(std::get<PointLight>(lights[0]).position, camera.eye);
    EXPECT_EQ(std::get<PointLight>(lights[0]).colour, glm::vec3(1));
    scene.lights = {DirectionalLight{"sun", {0, -1, 0}, glm::vec3(0.5f)}};
    ASSERT_EQ(effective_lights(scene, camera).size(), 1u);
    EXPECT_EQ(std::get<DirectionalLight>(effective_lights(scene, camera)[0]).name, "sun");
}

Scene one_object(Shape shape, const Transform& transform = {}) {
    Scene scene;
    add_object(scene, object("thing", shape, transform));
    return scene;
}

TEST(CheckScene, AcceptsWhatIsRight) {
    EXPECT_EQ(message_of(Scene{}), "no complaint");
    EXPECT_EQ(message_of(far_scene()), "no complaint");
    EXPECT_EQ(message_of(one_object(Box{{1, 1, 1}, {1, 2, 2}})), "no complaint");
}

TEST(CheckScene, NamesObjectKeyAndValue) {
    EXPECT_EQ(message_of(one_object(Sphere{{0, 0, 0}, -2.5})),
              "object \"thing\": radius must be positive, not -2.5");
    EXPECT_EQ(message_of(one_object(Sphere{{0, kNan, 0}, 1})),
              "object \"thing\": centre must be a finite number, not nan");
    EXPECT_EQ(message_of(one_object(Plane{{0, 0, 0}, 1})),
              "object \"thing\": normal must not be zero: it gives a direction");
    EXPECT_EQ(message_of(one_object(Box{{0, 3, 0}, {1, 2, 1}})),
              "object \"thing\": min must not exceed max, but 3 > 2 on the y axis");
    EXPECT_EQ(message_of(one_object(Triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, INFINITY}})),
              "object \"thing\": c must be a finite number, not inf");
    EXPECT_EQ(message_of(one_object(MeshInstance{3})),
              "object \"thing\": mesh 3 does not exist: the scene has 0");
    EXPECT_EQ(message_of(one_object(Sphere{}, scale({1, 0, 1}))),
              "object \"thing\": transform is singular: it flattens the object");
    EXPECT_EQ(message_of(one_object(Sphere{}, translate({1, kNan, 1}))),
              "object \"thing\": transform must be a finite number, not nan");
}

TEST(CheckScene, FindsDanglingIds) {
    Scene scene = one_object(Sphere{});
    scene.objects[0].material = 2;
    EXPECT_EQ(message_of(scene), "object \"thing\": material 2 does not exist: the scene has 0");
    scene = Scene{};
    add_mesh(scene, two_part_mesh());
    add_material(scene, Material{});
    EXPECT_EQ(message_of(scene), "mesh \"quad\": material 1 does not exist: the scene has 1");
    scene = one_object(Sphere{});
    scene.objects[0].id = 5;
    EXPECT_EQ(message_of(scene), "object \"thing\": id 5 is out of order: use add_object");
}

TEST(CheckScene, ChecksMaterialsLightsAndCameras) {
    Scene scene;
    Material glass;
    glass.name = "glass";
    glass.ior = 0.0f;
    add_material(scene, glass);
    EXPECT_EQ(message_of(scene), "material \"glass\": ior must be positive, not 0");
    scene.materials[0] = Material{};
    scene.materials[0].reflect.y = kNan;
    EXPECT_EQ(message_of(scene), "material \"\": reflect must be a finite number, not nan");
    scene = Scene{};
    scene.lights = {DirectionalLight{"sun", {0, 0, 0}, glm::vec3(1)}};
    EXPECT_EQ(message_of(scene), "light \"sun\": direction must not be zero: it gives a direction");
    scene.lights = {PointLight{"lamp", {0, kNan, 0}, glm::vec3(1)}};
    EXPECT_EQ(message_of(scene), "light \"lamp\": position must be a finite number, not nan");
    scene = Scene{};
    Camera camera;
    camera.eye = camera.at;
    scene.cameras = {{"side", camera}};
    EXPECT_THAT(message_of(scene), HasSubstr("camera \"side\": "));
    scene = Scene{};
    scene.background.x = INFINITY;
    EXPECT_EQ(message_of(scene), "the scene: background must be a finite number, not inf");
}

}  // namespace
}  // namespace raypick
