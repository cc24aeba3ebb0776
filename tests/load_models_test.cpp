// The real models: what is in them by MODELS.md, under which names.
#include "model_files.h"
#include "needs.h"

#include <gmock/gmock.h>
#include <glm/geometric.hpp>

#include <ostream>

namespace raypick {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

struct Known {
    const char* file;
    std::size_t triangles;

    friend std::ostream& operator<<(std::ostream& out, const Known& known) {
        return out << known.file;
    }
};

class Models : public testing::TestWithParam<Known> {};

// Triangle counts of MODELS.md, instances counted as placed.
TEST_P(Models, HaveTheirTriangles) {
    RAYPICK_REQUIRE_MODEL(GetParam().file);
    const LoadedScene loaded = load_scene(model(GetParam().file));
    const Scene& scene = loaded.scene;
    EXPECT_EQ(placed_triangles(scene), GetParam().triangles);
    EXPECT_FALSE(scene_bounds(scene).empty());
    for (const Mesh& mesh : scene.meshes) {
        for (const glm::vec3& n : mesh.normals)
            ASSERT_NEAR(glm::length(n), 1.0f, 1e-5f) << mesh.name;
    }
    for (const Object& object : scene.objects) {
        EXPECT_FALSE(object.name.empty());
        EXPECT_EQ(object.path.front(), '/');
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, Models,
    testing::Values(
        Known{"assimp/OBJ/box.obj", 12}, Known{"assimp/OBJ/cube_usemtl.obj", 12},
        Known{"assimp/OBJ/cube_with_vertexcolors.obj", 12},
        Known{"assimp/OBJ/concave_polygon.obj", 64}, Known{"assimp/OBJ/number_formats.obj", 1},
        Known{"assimp/OBJ/multiple_spaces.obj", 1}, Known{"assimp/OBJ/spider.obj", 1368},
        Known{"assimp/OBJ/WusonOBJ.obj", 3732}, Known{"assimp/PLY/cube.ply", 12},
        Known{"assimp/PLY/cube_binary.ply", 12}, Known{"assimp/PLY/cube_uv.ply", 12},
        Known{"assimp/PLY/float-color.ply", 1}, Known{"assimp/PLY/Wuson.ply", 3732},
        Known{"assimp/STL/triangle.stl", 1}, Known{"assimp/STL/triangle_with_two_solids.stl", 2},
        Known{"assimp/STL/Spider_ascii.stl", 1368}, Known{"assimp/STL/Spider_binary.stl", 1368},
        Known{"assimp/STL/sphereWithHole.stl", 285},
        Known{"assimp/glTF2/BoxTextured-glTF/BoxTextured.gltf", 12},
        Known{"assimp/glTF2/BoxTextured-glTF-Embedded/BoxTextured.gltf", 12},
        Known{"assimp/glTF2/BoxTextured-glTF-Binary/BoxTextured.glb", 12},
        Known{"assimp/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb", 121496},
        Known{"assimp/glTF2/cameras/Cameras.gltf", 2},
        Known{"assimp/glTF2/textureTransform/TextureTransformTest.gltf", 24},
        Known{"tinyobjloader/cornell_box.obj", 36},
        Known{"tinyobjloader/cornell_box_multimaterial.obj", 36},
        Known{"tinyobjloader/cube.obj", 12}, Known{"common-3d-test-models/suzanne.obj", 968},
        Known{"common-3d-test-models/teapot.obj", 6320},
        Known{"common-3d-test-models/cow.obj", 5804},
        Known{"common-3d-test-models/fandisk.obj", 12946},
        Known{"common-3d-test-models/spot.obj", 5856},
        Known{"common-3d-test-models/homer.obj", 12000}, Known{"stanford/bun_zipper.ply", 69451},
        Known{"stanford/bunny.stl", 69451}, Known{"stanford/bunny_binary.ply", 69451},
        Known{"stanford/armadillo.obj", 86482}, Known{"stanford/chinesedragon.gltf", 100960},
        Known{"sponza/sponza.obj", 66454},
        Known{"sterngarten/Sterngarten_Wien_innerArea-optimized.obj", 71673},
        Known{"sweethome3d/peterbilt/peterbilt.obj", 116501},
        Known{"sweethome3d/kitchenaid/kitchenaid.obj", 50390},
        Known{"sweethome3d/poolTable/poolTable.obj", 57184},
        Known{"sweethome3d/teddyBear/teddyBear.obj", 27552},
        Known{"sweethome3d/bed1/bed1.obj", 45176},
        Known{"sweethome3d/hamburger/hamburger.obj", 27436},
        Known{"sweethome3d/wheelchair/wheelchair.obj", 38000},
        Known{"sweethome3d/thermometer/thermometer.obj", 28336},
        Known{"openfoam/motorBike.obj", 331653}, Known{"openfoam/flange.stl", 6468},
        Known{"cura/UltimakerRobot_support.stl", 187974}, Known{"bitterli/kitchen.glb", 1443517},
        Known{"bitterli/coffee.glb", 235271}, Known{"bitterli/kitchen_Mesh090.ply", 115328},
        Known{"gltf/CesiumMilkTruck.glb", 3624}, Known{"gltf/Lights.glb", 12},
        Known{"gltf/geometry-camera-light.glb", 14},
        Known{"gltf/TransmissionRoughnessTest.glb", 77792}, Known{"gltf/glass-table.glb", 592},
        Known{"gltf/TwoSidedPlane.glb", 2}, Known{"gltf/statue.glb", 16259},
        Known{"gltf/terrain.glb", 3868}));

TEST(ModelNames, MotorBikeHas67Groups) {
    RAYPICK_REQUIRE_MODEL("openfoam/motorBike.obj");
    const LoadedScene loaded = load_scene(model("openfoam/motorBike.obj"));
    EXPECT_THAT(loaded.warnings, IsEmpty());
    const Scene& scene = loaded.scene;
    ASSERT_EQ(scene.objects.size(), 67u);
    EXPECT_EQ(scene.objects[0].name, "frt-fairing:001%1");
    EXPECT_EQ(scene.objects[1].name, "windshield:002%2");
    EXPECT_EQ(primitive_count(scene, scene.objects[0]), 47725u);
}

TEST(ModelNames, GroupsOpenedTwiceAreOneObject) {
    RAYPICK_REQUIRE_MODEL("sponza/sponza.obj");
    EXPECT_EQ(load_scene(model("sponza/sponza.obj")).scene.objects.size(), 34u);  // 68 g lines
}

TEST(ModelNames, UnnamedNodesAreNamedByTheirMeshes) {
    const char* const file = "assimp/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb";
    RAYPICK_REQUIRE_MODEL(file);
    const LoadedScene loaded = load_scene(model(file));
    const Scene& scene = loaded.scene;
    EXPECT_EQ(scene.objects.size(), 67u);
    EXPECT_EQ(scene.meshes.size(), 29u);
    EXPECT_EQ(scene.materials.size(), 34u);
    EXPECT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.objects[0].name, "body");
    EXPECT_EQ(scene.objects[1].name, "body#2");
    EXPECT_EQ(scene.objects[11].path, "/node0/node13/body");
}

TEST(ModelNames, TheMilkTruckHasTwoWheelsOfOneMesh) {
    RAYPICK_REQUIRE_MODEL("gltf/CesiumMilkTruck.glb");
    const LoadedScene loaded = load_scene(model("gltf/CesiumMilkTruck.glb"));
    const Scene& scene = loaded.scene;
    EXPECT_THAT(object_names(scene), ElementsAre("Cesium_Milk_Truck", "Wheels", "Wheels#2"));
    EXPECT_EQ(scene.objects[2].path, "/Cesium_Milk_Truck/node1/Wheels");
    EXPECT_EQ(&mesh_of(scene, 1), &mesh_of(scene, 2));
    EXPECT_EQ(mesh_of(scene, 0).parts.size(), 3u);
    EXPECT_TRUE(any_contains(loaded.warnings, "rest pose"));
}

TEST(ModelNames, TheKitchenHasItsObjectsMaterialsAndCamera) {
    RAYPICK_REQUIRE_MODEL("bitterli/kitchen.glb");
    const LoadedScene loaded = load_scene(model("bitterli/kitchen.glb"));
    EXPECT_EQ(loaded.scene.objects.size(), 299u);
    EXPECT_EQ(loaded.scene.materials.size(), 90u);
    EXPECT_EQ(loaded.scene.cameras.size(), 1u);
}

TEST(ModelNames, LightsAndCamerasOfGltf) {
    RAYPICK_REQUIRE_MODEL("gltf/Lights.glb");
    const LoadedScene lights = load_scene(model("gltf/Lights.glb"));
    EXPECT_EQ(lights.scene.lights.size(), 4u);
    RAYPICK_REQUIRE_MODEL("gltf/geometry-camera-light.glb");
    EXPECT_EQ(load_scene(model("gltf/geometry-camera-light.glb")).scene.cameras.size(), 2u);
}

TEST(ModelGeometry, TheConcavePolygonIsCoveredOnce) {
    RAYPICK_REQUIRE_MODEL("assimp/OBJ/concave_polygon.obj");
    const LoadedScene loaded = load_scene(model("assimp/OBJ/concave_polygon.obj"));
    const Scene& scene = loaded.scene;
    double area = 0.0;
    glm::dvec3 vector_area(0.0);
    for (std::size_t t = 0; t < placed_triangles(scene); ++t) {
        const glm::dvec3 a = corner(scene, 0, t, 0);
        const glm::dvec3 n =
            0.5 * glm::cross(corner(scene, 0, t, 1) - a, corner(scene, 0, t, 2) - a);
        area += glm::length(n);
        vector_area += n;
    }
    // A fan overlaps itself: its triangles add up to more than the polygon.
    EXPECT_GT(area, 0.1);
    EXPECT_NEAR(area, glm::length(vector_area), 1e-6 * area);
}

TEST(ModelGeometry, TheSameSpiderInAsciiAndBinary) {
    RAYPICK_REQUIRE_MODEL("assimp/STL/Spider_ascii.stl");
    const LoadedScene ascii = load_scene(model("assimp/STL/Spider_ascii.stl"));
    const LoadedScene binary = load_scene(model("assimp/STL/Spider_binary.stl"));
    const Bounds a = scene_bounds(ascii.scene);
    const Bounds b = scene_bounds(binary.scene);
    EXPECT_LT(glm::distance(a.extent(), b.extent()), 1e-3f);
}

TEST(ModelGeometry, TheBunnyIsTheSameFromThreeFiles) {
    RAYPICK_REQUIRE_MODEL("stanford/bunny_binary.ply");
    const LoadedScene ascii = load_scene(model("stanford/bun_zipper.ply"));
    const LoadedScene binary = load_scene(model("stanford/bunny_binary.ply"));
    for (std::size_t t = 0; t < placed_triangles(ascii.scene); t += 997) {
        const double d = glm::distance(corner(ascii.scene, 0, t, 0), corner(binary.scene, 0, t, 0));
        EXPECT_LT(d, 1e-6) << t;
    }
}

}  // namespace
}  // namespace raypick
