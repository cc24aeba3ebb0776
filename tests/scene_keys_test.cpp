// The scene file's keys for shapes, sets, lights, looks and embedded arrays: what they give, and
// that a wrong value is named with its line, its key and its object.
#include "model_files.h"
#include "needs.h"

#include <gmock/gmock.h>
#include <glm/geometric.hpp>

namespace raypick {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class SceneKeys : public ModelFiles {
protected:
    Scene scene_of(const std::string& members) {
        return load("a.json", fmt::format(R"({{"raypick": 1, {}}})", members)).scene;
    }
    Scene objects(const std::string& list) {
        return scene_of(fmt::format(R"("objects": [{}])", list));
    }
    // What is wrong with a value, without line and file.
    std::string complaint_of(const std::string& members) {
        const std::string text =
            complaint("a.json", fmt::format(R"({{"raypick": 1, {}}})", members));
        const std::string line = "line 1: ";
        return text.starts_with(line) ? text.substr(line.size()) : text;
    }
    std::string of_object(const std::string& object) {
        return complaint_of(fmt::format(R"("objects": [{}])", object));
    }
    std::string of_light(const std::string& light) {
        return complaint_of(fmt::format(R"("lights": [{}])", light));
    }
    std::string of_material(const std::string& members) {
        return complaint_of(fmt::format(R"("materials": {{"m": {{{}}}}})", members));
    }
};

template <typename T>
const T& shape_of(const Scene& scene, std::size_t object = 0) {
    return std::get<T>(scene.objects[object].shape);
}

TEST_F(SceneKeys, Shapes) {
    const Scene scene = objects(R"(
        {"type": "disk", "centre": [1, 2, 3], "normal": [0, 0, 2], "radius": 4, "inner_radius": 1},
        {"type": "rectangle", "corner": [1, 2, 3], "edge_u": [1, 0, 0], "edge_v": [0, 2, 0]},
        {"type": "cone", "base": [0, 0, 0], "apex": [0, 3, 0], "base_radius": 2},
        {"type": "cylinder", "base": [0, 0, 0], "apex": [0, 3, 0], "radius": 2, "capped": false},
        {"type": "torus", "centre": [1, 1, 1], "axis": [0, 0, 1], "major_radius": 3,
         "minor_radius": 0.5})");
    const auto& disk = shape_of<Disk>(scene, 0);
    EXPECT_EQ(disk.centre, glm::dvec3(1, 2, 3));
    EXPECT_EQ(disk.normal, glm::dvec3(0, 0, 2));
    EXPECT_EQ(disk.radius, 4.0);
    EXPECT_EQ(disk.inner_radius, 1.0);
    const auto& rectangle = shape_of<Rectangle>(scene, 1);
    EXPECT_EQ(rectangle.corner, glm::dvec3(1, 2, 3));
    EXPECT_EQ(rectangle.edge_u, glm::dvec3(1, 0, 0));
    EXPECT_EQ(rectangle.edge_v, glm::dvec3(0, 2, 0));
    const auto& cone = shape_of<Cone>(scene, 2);
    EXPECT_EQ(cone.base_radius, 2.0);
    EXPECT_EQ(cone.apex_radius, 0.0);
    EXPECT_TRUE(cone.capped);
    const auto& cylinder = shape_of<Cone>(scene, 3);
    EXPECT_EQ(cylinder.base_radius, 2.0);
    EXPECT_EQ(cylinder.apex_radius, 2.0);
    EXPECT_FALSE(cylinder.capped);
    const auto& torus = shape_of<Torus>(scene, 4);
    EXPECT_EQ(torus.axis, glm::dvec3(0, 0, 1));
    EXPECT_EQ(torus.major_radius, 3.0);
    EXPECT_EQ(torus.minor_radius, 0.5);
}

TEST_F(SceneKeys, ShapesThatAreWrong) {
    EXPECT_EQ(of_object(R"({"type": "disk", "normal": [0, 0, 0], "radius": 1})"),
              "/objects/0/normal: must not be [0, 0, 0]: it gives a direction");
    EXPECT_EQ(of_object(R"({"type": "disk", "normal": [0, 1, 0], "radius": 1, "inner_radius": 1})"),
              "/objects/0/inner_radius: must be less than radius, which is 1");
    EXPECT_EQ(of_object(R"({"type": "rectangle", "corner": [0, 0, 0], "edge_u": [1, 1, 0],
                            "edge_v": [-2, -2, 0]})")
                  .substr(0, 60),
              "line 2: /objects/0/edge_v: must not be parallel to edge_u");
    EXPECT_EQ(
        of_object(R"({"type": "cone", "base": [0, 0, 0], "apex": [0, 0, 0],"base_radius": 1})"),
        "/objects/0/apex: must not be the same point as base");
    EXPECT_EQ(
        of_object(R"({"type": "cone", "base": [0, 0, 0], "apex": [0, 1, 0],"base_radius": 0})"),
        "/objects/0/base_radius: must not be 0, since apex_radius is");
    EXPECT_EQ(
        of_object(R"({"type": "cone", "base": [0, 0, 0], "apex": [0, 1, 0],"base_radius":-1})"),
        "/objects/0/base_radius: must be a number from 0 to 1e18, not -1");
    EXPECT_EQ(
        of_object(R"({"type": "cylinder", "base": [0, 0, 0], "apex": [0, 1, 0], "radius": 0})"),
        "/objects/0/radius: must be a positive number, not 0");
    EXPECT_EQ(of_object(R"({"type": "cylinder", "base": [0, 0, 0], "apex": [0, 1, 0], "radius": 1,
                            "capped": 1})"),
              "line 2: /objects/0/capped: must be true or false, not 1");
    EXPECT_EQ(of_object(R"({"type": "torus", "major_radius": 1, "minor_radius": 1.5})"),
              "/objects/0/minor_radius: must not be more than major_radius, which is 1");
    EXPECT_EQ(of_object(R"({"type": "sphere", "radius": 1, "sides": "inside"})"),
              "/objects/0/sides: must be \"both\", \"front\" or \"back\", not \"inside\"");
    EXPECT_EQ(of_object(R"({"type": "sphere", "radius": 1, "mask": 0.5})"),
              "/objects/0/mask: must be a whole number from 0 to 4294967295, not 0.5");
}

TEST_F(SceneKeys, ComplaintsNameLineKeyAndObject) {
    const std::string text = R"({
    "raypick": 1, // the mark
    "objects": [
        {"type": "sphere", "radius": 1},
        /* several
           lines */
        {
            "type": "sphere", "name": "ball", "centre": [0,
                "x", 0], "radius": 0
        }
    ]
})";
    EXPECT_EQ(complaint("a.json", text),
              "line 9: /objects/1/centre/1 (of \"ball\"): must be a number between -1e18 and 1e18, "
              "not \"x\"");
    std::string fixed = text;
    fixed.replace(fixed.find("\"x\""), 3, "5");
    EXPECT_EQ(complaint("a.json", fixed),
              "line 9: /objects/1/radius (of \"ball\"): must be a positive number, not 0");
    EXPECT_EQ(complaint("a.json",
                        "{\"raypick\": 1,\n\"lights\": [{\n\"type\": \"point\",\n"
                        "\"name\": \"sun\"}]}"),
              "line 2: /lights/0 (of \"sun\"): \"position\" is missing");
    EXPECT_EQ(complaint("a.json",
                        "{\"raypick\": 1,\n\"materials\": {\n\"a/b\": {},\n\"gold\": "
                        "{\n\"ior\":\n0}}}"),
              "line 5: /materials/gold/ior: must be a positive number, not 0");
    EXPECT_EQ(complaint("a.json", "{\"raypick\": 1,\n\"ambient\": 1,\n\"ambi\\u0065nt\": 2}"),
              "line 3: /: the key \"ambient\" stands there twice");
}

TEST_F(SceneKeys, SidesMaskIdAndPath) {
    const Scene scene = objects(R"(
        {"type": "sphere", "name": "a", "radius": 1, "sides": "front", "mask": 5, "id": 7,
         "path": "/house/a"},
        {"type": "sphere", "name": "b", "radius": 1, "sides": "back"},
        {"type": "instance", "of": "a"},
        {"type": "instance", "of": "a", "sides": "both"})");
    EXPECT_EQ(scene.objects[0].sides, Sides::front_only);
    EXPECT_EQ(scene.objects[0].mask, 5u);
    EXPECT_EQ(scene.objects[0].id, 7u);
    EXPECT_EQ(scene.objects[0].path, "/house/a");
    EXPECT_EQ(scene.objects[1].sides, Sides::back_only);
    EXPECT_EQ(scene.objects[1].id, 8u);
    EXPECT_EQ(scene.objects[1].path, "/b");
    EXPECT_EQ(scene.objects[2].sides, Sides::front_only) << "as its original";
    EXPECT_EQ(scene.objects[3].sides, Sides::both);
    EXPECT_EQ(of_object(R"({"type": "sphere", "radius": 1, "id": 3},
                           {"type": "sphere", "radius": 1, "id": 3})"),
              "line 2: /objects/1/id: must be a whole number, at least 4: ids ascend, not 3");
}

TEST_F(SceneKeys, IdsGoOnWhereTheSessionStands) {
    LoadOptions options;
    options.first_object_id = 100;
    const Scene scene = load("a.json", R"({"raypick": 1, "objects": [
        {"type": "sphere", "radius": 1, "id": 3}, {"type": "sphere", "radius": 1}]})",
                             options)
                            .scene;
    EXPECT_EQ(scene.objects[0].id, 103u);
    EXPECT_EQ(scene.objects[1].id, 104u);
}

TEST_F(SceneKeys, Sets) {
    const Scene scene = scene_of(R"(
        "materials": [{"name": "red"}, {}],
        "sphere_sets": {"drops": {"spheres": [[0, 0, 0, 1], [3, 0, 0, 0.5], [6, 0, 0, 2]],
            "parts": [{"first": 0, "count": 1, "material": "red"},
                      {"first": 1, "count": 2, "material": 1}]}},
        "objects": [
            {"type": "spheres", "set": "drops"},
            {"type": "spheres", "set": "drops", "translate": [0, 9, 0], "material": "red"},
            {"type": "cones", "capped": true, "cones": [[0, 0, 0, 1, 0, 2, 0, 0.5]]}])");
    ASSERT_EQ(scene.sphere_sets.size(), 1u);
    const SphereSet& drops = scene.sphere_sets[0];
    EXPECT_EQ(drops.name, "drops");
    EXPECT_EQ(drops.spheres[2], glm::vec4(6, 0, 0, 2));
    ASSERT_EQ(drops.parts.size(), 2u);
    EXPECT_EQ(drops.parts[0].material, 0u);
    EXPECT_EQ(drops.parts[1].material, 1u);
    EXPECT_EQ(shape_of<SphereSetInstance>(scene, 1).set, 0u);
    EXPECT_EQ(scene.objects[1].material, 0u);
    const ConeSet& cones = scene.cone_sets.at(0);
    EXPECT_TRUE(cones.capped);
    EXPECT_EQ(cones.ends[1], glm::vec4(0, 2, 0, 0.5f));
}

TEST_F(SceneKeys, SetsFarFromZeroKeepTheirDigits) {
    const Scene scene = objects(R"({"type": "spheres", "spheres": [[5000000.123, 0, 0, 0.001],
                                                   [5000000.125, 0, 0, 0.001]]})");
    const glm::dvec3 centre = scene.origin + scene.objects[0].world_from_object.point(
                                                 glm::dvec3(scene.sphere_sets[0].spheres[0]));
    EXPECT_NEAR(centre.x, 5000000.123, 1e-8);
}

TEST_F(SceneKeys, SetsThatAreWrong) {
    EXPECT_EQ(
        of_object(R"({"type": "spheres", "name": "s", "spheres": [[0, 0, 0, 1], [0, 0, 0, 0]]})"),
        "/objects/0/spheres/1/3 (of \"s\"): must be a positive number, not 0");
    EXPECT_EQ(of_object(R"({"type": "spheres", "spheres": [[0, 0, 0]]})"),
              "/objects/0/spheres/0: must be a sphere [x, y, z, radius], not an array of 3");
    EXPECT_EQ(of_object(R"({"type": "spheres", "set": 0, "spheres": []})"),
              "/objects/0/spheres: what this is made of is said by \"set\"");
    EXPECT_EQ(of_object(R"({"type": "spheres", "set": "drops"})"),
              "/objects/0/set: there is no set of spheres \"drops\"");
    EXPECT_EQ(of_object(R"({"type": "cones", "cones": [[0, 0, 0, 1, 0, 0, 0, 2]]})"),
              "/objects/0/cones: cone 0 has no size: its ends must be two points, its radii not "
              "negative and not both 0");
    EXPECT_EQ(
        of_object(R"({"type": "spheres", "spheres": [[0, 0, 0, 1]],
                            "parts": [{"first": 1, "count": 1}]})"),
        "line 2: /objects/0/parts/0/first: must be 0, where the part before ends: parts cover "
        "all primitives, not 1");
    EXPECT_EQ(of_object(R"({"type": "spheres", "spheres": [[0, 0, 0, 1], [2, 0, 0, 1]],
                            "parts": [{"first": 0, "count": 1}]})"),
              "line 2: /objects/0/parts: cover 1 of 2 primitives");
    EXPECT_EQ(of_object(R"({"type": "spheres", "spheres": [[0, 0, 0, 1]],
                            "parts": [{"first": 0, "count": 2}]})"),
              "line 2: /objects/0/parts/0/count: must be a whole number from 1 to 1, not 2");
    // 16 bytes: 0 0 0 with radius -1.
    EXPECT_THAT(of_object(R"({"type": "spheres", "spheres": "AAAAAAAAAAAAAAAAAACAvw=="})"),
                StartsWith("/objects/0/spheres: sphere 0 is (0, 0, 0) with radius -1"));
    EXPECT_EQ(of_object(R"({"type": "spheres", "spheres": "AAAA"})"),
              "/objects/0/spheres: holds 3 bytes, which is no multiple of 16");
    EXPECT_EQ(of_object(R"({"type": "spheres", "spheres": "?"})"),
              "/objects/0/spheres: is no base64");
}

TEST_F(SceneKeys, MeshesWithTextureCoordinatesAndParts) {
    const std::string arrays = R"("positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
        "triangles": [[0, 1, 2], [2, 1, 0]], "uvs": [[0, 0], [1, 0], [0, 1.5]])";
    const Scene scene = scene_of(fmt::format(
        R"("materials": {{"red": {{}}}}, "meshes": {{"leaf": {{{0}}}}},
           "objects": [{{"type": "mesh", "mesh": "leaf"}}, {{"type": "mesh", {0},
                "parts": [{{"first": 0, "count": 2, "material": "red"}}]}}])",
        arrays));
    const Mesh& shared = mesh_of(scene, 0);
    EXPECT_EQ(shared.name, "leaf");
    EXPECT_TRUE(shared.normals.empty()) << "a shared mesh is as it is written: flat";
    EXPECT_EQ(shared.uvs[2], glm::vec2(0, 1.5f));
    const Mesh& own = mesh_of(scene, 1);
    EXPECT_FALSE(own.normals.empty()) << "a mesh of an object is smoothed";
    EXPECT_EQ(own.uvs.size(), own.positions.size());
    ASSERT_EQ(own.parts.size(), 1u);
    EXPECT_EQ(own.parts[0].material, 0u);
}

TEST_F(SceneKeys, MeshesThatAreWrong) {
    const auto of_mesh = [this](const std::string& more) {
        return complaint_of(R"("meshes": [{"positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], )" +
                            more + "}]");
    };
    EXPECT_EQ(of_mesh(R"("triangles": [[0, 1, 3]])"),
              "/meshes/0/triangles/0/2: must be the number of a position, 0 to 2, not 3");
    // 0 1 3 as three unsigned integers.
    EXPECT_EQ(of_mesh(R"("triangles": "AAAAAAEAAAADAAAA")"),
              "/meshes/0/triangles: triangle 0 has a corner beyond position 2");
    EXPECT_EQ(of_mesh(R"("triangles": [], "uvs": [[0, 0]])"),
              "/meshes/0/uvs: must be an array of 3 [u, v], one a position, not an array of 1");
    EXPECT_EQ(of_mesh(R"("triangles": [], "normals": "AAAAAAAAAAAAAIA/")"),
              "/meshes/0/normals: holds 1, but there are 3 positions");
    EXPECT_EQ(of_object(R"({"type": "mesh", "mesh": 0})"),
              "/objects/0/mesh: must be the name of a mesh, not 0");
    EXPECT_EQ(of_object(R"({"type": "mesh", "mesh": 0, "file": "x.ply"})"),
              "/objects/0/file: what this is made of is said by \"mesh\"");
}

TEST_F(SceneKeys, Lights) {
    const Scene scene = scene_of(R"("lights": [
        {"type": "point", "position": [1, 2, 3], "attenuation": [0, 0.5, 2]},
        {"type": "spot", "position": [1, 2, 3], "direction": [0, -1, 0], "inner_degrees": 10,
         "outer_degrees": 25, "attenuation": [1, 0, 1], "colour": 3},
        {"type": "spot", "position": [1, 2, 3], "direction": [0, -1, 0], "outer_degrees": 15},
        {"type": "sphere", "centre": [1, 2, 3], "radius": 0.5, "samples": 9},
        {"type": "rectangle", "corner": [1, 2, 3], "edge_u": [1, 0, 0], "edge_v": [0, 0, 2],
         "name": "lamp"}])");
    EXPECT_EQ(std::get<PointLight>(scene.lights[0]).attenuation, (Attenuation{0.0, 0.5, 2.0}));
    const auto& spot = std::get<SpotLight>(scene.lights[1]);
    EXPECT_EQ(spot.inner_degrees, 10.0);
    EXPECT_EQ(spot.outer_degrees, 25.0);
    EXPECT_EQ(spot.attenuation, (Attenuation{1.0, 0.0, 1.0}));
    EXPECT_EQ(spot.colour, glm::vec3(3));
    EXPECT_EQ(std::get<SpotLight>(scene.lights[2]).inner_degrees, 15.0)
        << "the default is not more than the outer angle";
    const auto& ball = std::get<SphereLight>(scene.lights[3]);
    EXPECT_EQ(ball.centre, glm::dvec3(1, 2, 3));
    EXPECT_EQ(ball.radius, 0.5);
    EXPECT_EQ(ball.samples, 9);
    const auto& window = std::get<RectangleLight>(scene.lights[4]);
    EXPECT_EQ(window.edge_v, glm::dvec3(0, 0, 2));
    EXPECT_EQ(window.name, "lamp");
}

TEST_F(SceneKeys, LightsThatAreWrong) {
    EXPECT_EQ(of_light(R"({"type": "point", "position": [0, 0, 0], "attenuation": [0, 0, 0]})"),
              "/lights/0/attenuation: must not be [0, 0, 0]: the light would be infinitely bright");
    EXPECT_EQ(of_light(R"({"type": "point", "position": [0, 0, 0], "attenuation": [1, -1, 0]})"),
              "/lights/0/attenuation/1: must be 0 or a number from 1e-18 to 1e18, not -1");
    EXPECT_EQ(of_light(R"({"type": "spot", "name": "s", "position": [0, 0, 0],
                           "direction": [0, 1, 0], "inner_degrees": 40, "outer_degrees": 30})"),
              "line 2: /lights/0/inner_degrees (of \"s\"): must not be more than outer_degrees, "
              "which is 30");
    EXPECT_EQ(of_light(R"({"type": "spot", "position": [0, 0, 0], "direction": [0, 1, 0],
                           "outer_degrees": 91})"),
              "line 2: /lights/0/outer_degrees: must be a number from 0 to 90 (degrees), not 91");
    EXPECT_EQ(of_light(R"({"type": "sphere", "centre": [0, 0, 0], "radius": 1, "samples": 65})"),
              "/lights/0/samples: must be a whole number from 1 to 64, not 65");
    EXPECT_EQ(of_light(R"({"type": "sphere", "centre": [0, 0, 0], "radius": 1, "samples": 1.5})"),
              "/lights/0/samples: must be a whole number from 1 to 64, not 1.5");
    EXPECT_EQ(of_light(R"({"type": "sphere", "centre": [0, 0, 0], "radius": -1})"),
              "/lights/0/radius: must be a positive number, not -1");
}

TEST_F(SceneKeys, Materials) {
    const Scene scene = scene_of(R"(
        "textures": {"wood": {"type": "checker"}},
        "materials": {"m": {"model": "blinn_phong", "reflectance": "dielectric",
            "thin_walled": true, "absorption": [0.1, 0.2, 0.3], "priority": -2, "opacity": 0.5,
            "alpha_mode": "blend", "alpha_cutoff": 0.25,
            "maps": {"diffuse": "wood",
                     "opacity": {"texture": "wood", "scale": [4, 2], "offset": 0.5,
                                 "wrap": ["clamp", "mirror"], "filter": "nearest", "channel": 3,
                                 "base": 1, "gain": -1},
                     "normal": {"texture": "wood", "u_row": [0, 1, 0], "v_row": [1, 0, 0.5],
                                "wrap": "clamp"}}}})");
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.model, LocalModel::blinn_phong);
    EXPECT_EQ(m.reflectance, Reflectance::dielectric);
    EXPECT_TRUE(m.thin_walled);
    EXPECT_EQ(m.absorption, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.priority, -2);
    EXPECT_EQ(m.opacity, 0.5f);
    EXPECT_EQ(m.alpha_mode, AlphaMode::blend);
    EXPECT_EQ(m.alpha_cutoff, 0.25f);
    TextureMap plain;
    plain.texture = 0;
    EXPECT_EQ(m.map(MapSlot::diffuse), plain);
    EXPECT_EQ(m.map(MapSlot::specular), TextureMap{});
    const TextureMap& opacity = m.map(MapSlot::opacity);
    EXPECT_EQ(opacity.u_row, glm::vec3(4, 0, 0.5f));
    EXPECT_EQ(opacity.v_row, glm::vec3(0, 2, 0.5f));
    EXPECT_EQ(opacity.wrap_u, Wrap::clamp);
    EXPECT_EQ(opacity.wrap_v, Wrap::mirror);
    EXPECT_EQ(opacity.filter, TextureFilter::nearest);
    EXPECT_EQ(opacity.channel, 3);
    EXPECT_EQ(opacity.base, 1.0f);
    EXPECT_EQ(opacity.gain, -1.0f);
    const TextureMap& normal = m.map(MapSlot::normal);
    EXPECT_EQ(normal.u_row, glm::vec3(0, 1, 0));
    EXPECT_EQ(normal.v_row, glm::vec3(1, 0, 0.5f));
    EXPECT_EQ(normal.wrap_v, Wrap::clamp);
}

TEST_F(SceneKeys, MaterialsThatAreWrong) {
    EXPECT_EQ(of_material(R"("model": "lambert")"),
              "/materials/m/model: must be \"phong\" or \"blinn_phong\", not \"lambert\"");
    EXPECT_EQ(of_material(R"("opacity": 1.5)"),
              "/materials/m/opacity: must be a number from 0 to 1, not 1.5");
    EXPECT_EQ(of_material(R"("absorption": -1)"),
              "/materials/m/absorption: must be a number from 0 to 1e18, not -1");
    EXPECT_EQ(of_material(R"("reflect": [1e18, 0.5, 0])"),
              "/materials/m/reflect/0: must be a number from 0 to 2, not 1e+18");
    EXPECT_EQ(of_material(R"("alpha_cutoff": 1.5)"), "");
    EXPECT_EQ(of_material(R"("priority": 0.5)"),
              "/materials/m/priority: must be a whole number between -1e9 and 1e9, not 0.5");
    EXPECT_EQ(of_material(R"("thin_walled": "yes")"),
              "/materials/m/thin_walled: must be true or false, not \"yes\"");
    EXPECT_EQ(of_material(R"("maps": {"difuse": 0})"),
              "/materials/m/maps/difuse: unknown key; did you mean \"diffuse\"?");
    EXPECT_EQ(of_material(R"("maps": {"diffuse": "wood"})"),
              "/materials/m/maps/diffuse: there is no texture \"wood\"");
    const auto of_map = [this](const std::string& members) {
        return complaint_of(R"("textures": [{"type": "checker", "name": "a"}],
            "materials": [{"name": "m", "maps": {"diffuse": {)" +
                            members + "}}}]");
    };
    EXPECT_EQ(of_map(R"("texture": 1)"),
              "line 2: /materials/0/maps/diffuse/texture (of \"m\"): must be the name of a texture "
              "or its number, 0 to 0, not 1");
    EXPECT_THAT(of_map(R"("texture": 0, "scale": 1, "u_row": [1, 0, 0])"),
                HasSubstr("diffuse/u_row (of \"m\"): give either u_row and v_row or scale"));
    EXPECT_THAT(of_map(R"("texture": 0, "channel": 4)"),
                HasSubstr("channel (of \"m\"): must be a channel: 0, 1, 2 or 3, not 4"));
    EXPECT_THAT(of_map(R"("texture": 0, "wrap": "tile")"), HasSubstr("must be \"repeat\""));
}

TEST_F(SceneKeys, TexturesFromTexelsAndFiles) {
    // Red and half transparent blue.
    const std::string embedded = R"({"type": "image", "rows": 1, "cols": 2, "texels":
        "/wAA/wAA/4A=", "coding": "linear", "source": "board.png"})";
    const LoadedScene loaded = load("a.json", fmt::format(R"({{"raypick": 1, "textures": {{
        "board": {}, "lost": {{"type": "image", "file": "lost.png"}},
        "squares": {{"type": "checker", "even": [1, 0, 0, 0.5], "odd": 0.25}}}}}})",
                                                          embedded));
    ASSERT_EQ(loaded.scene.textures.size(), 3u);
    const auto& board = std::get<ImageTexture>(loaded.scene.textures[0].source);
    EXPECT_EQ(board.pixels->coding, TexelCoding::linear);
    EXPECT_EQ(board.pixels->texels[1], glm::u8vec4(0, 0, 255, 128));
    EXPECT_EQ(board.file, "board.png");
    const auto& lost = std::get<ImageTexture>(loaded.scene.textures[1].source);
    EXPECT_FALSE(lost.pixels->texels.empty()) << "a placeholder";
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_THAT(loaded.warnings[0],
                testing::AllOf(HasSubstr("a.json: line 3: /textures/lost/file: "),
                               HasSubstr("lost.png"), HasSubstr("magenta")));
    const auto& squares = std::get<Checker>(loaded.scene.textures[2].source);
    EXPECT_EQ(squares.even, glm::vec4(1, 0, 0, 0.5f));
    EXPECT_EQ(squares.odd, glm::vec4(0.25f, 0.25f, 0.25f, 1.0f));
}

std::string bytes_of_ints(const std::vector<int>& bytes) {
    std::string text;
    for (const int byte : bytes)
        text += static_cast<char>(byte);
    return text;
}

// Images of 4 x 2 texels in formats that say their size and then just go on.
std::vector<std::pair<std::string, std::string>> plain_images() {
    const std::string texels(4 * 2 * 4, '\x60');
    return {
        {"a.tga", bytes_of_ints({0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 2, 0, 32, 0}) + texels},
        {"a.bmp", bytes_of_ints({'B', 'M', 86, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0,
                                 4,   0,   0,  0, 2, 0, 0, 0, 1, 0, 32, 0, 0, 0, 0,  0, 0, 0,
                                 0,   0,   0,  0, 0, 0, 0, 0, 0, 0, 0,  0, 0, 0, 0,  0, 0, 0}) +
                      texels},
        {"a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n" + texels}};
}

// What stb makes of the missing texels is whatever lies in its memory.
TEST_F(SceneKeys, ImagesThatAreCutShortAreTheChecker) {
    for (const auto& [name, bytes] : plain_images()) {
        SCOPED_TRACE(name);
        const std::string scene = fmt::format(R"({{"raypick": 1,
            "environment": {{"type": "image", "file": "{0}"}},
            "textures": {{"t": {{"type": "image", "file": "{0}"}}}}}})",
                                              name);
        write(name, bytes);
        EXPECT_THAT(load("a.json", scene).warnings, testing::IsEmpty());
        for (const std::size_t missing : {1, 5, 16, 31}) {
            SCOPED_TRACE(missing);
            write(name, bytes.substr(0, bytes.size() - missing));
            const LoadedScene loaded = load("a.json", scene);
            ASSERT_EQ(loaded.warnings.size(), 2u);
            for (const std::string& warning : loaded.warnings)
                EXPECT_THAT(warning, HasSubstr("is cut short"));
            const auto& image = std::get<ImageTexture>(loaded.scene.textures.at(0).source);
            EXPECT_EQ(image.pixels->texels.at(0), glm::u8vec4(255, 0, 255, 255));
            const auto& sky = std::get<ImageSky>(loaded.scene.environment);
            EXPECT_EQ(sky.pixels->texels.at(0), glm::vec3(1, 0, 1));
        }
    }
}

// Base64 of a triangle's numbers with one that is none.
TEST_F(SceneKeys, ArraysOfBase64HoldFiniteNumbers) {
    const auto of_mesh = [this](const std::string& members) {
        return complaint_of(
            fmt::format(R"("meshes": [{{"name": "m", "triangles": "", {}}}])", members));
    };
    EXPECT_EQ(of_mesh(R"("positions": "AAAAAAAAAAAAAAAAAAAAAAAAgH8AAAAA")"),
              "/meshes/0/positions (of \"m\"): element 1 holds inf, which is not finite");
    EXPECT_EQ(of_mesh(R"("positions": [[0, 0, 0]], "normals": "AADAfwAAAAAAAAAA")"),
              "/meshes/0/normals (of \"m\"): element 0 holds nan, which is not finite");
    EXPECT_EQ(of_mesh(R"("positions": [[0, 0, 0]], "uvs": "AAAAAAAAgP8=")"),
              "/meshes/0/uvs (of \"m\"): element 0 holds -inf, which is not finite");
}

TEST_F(SceneKeys, TexturesThatAreWrong) {
    const auto of_texture = [this](const std::string& members) {
        return complaint_of(fmt::format(R"("textures": [{{"name": "t", {}}}])", members));
    };
    EXPECT_EQ(of_texture(R"("type": "image")"),
              "/textures/0 (of \"t\"): give either file or rows, cols and texels");
    EXPECT_EQ(of_texture(R"("type": "image", "file": "a.png", "texels": "")"),
              "/textures/0/file (of \"t\"): give either file or rows, cols and texels");
    EXPECT_EQ(of_texture(R"("type": "image", "rows": 2, "cols": 2, "texels": "/wAA/wAA/4A=")"),
              "/textures/0/texels (of \"t\"): holds 2 texels, but 2 x 2 are 4");
    EXPECT_EQ(of_texture(R"("type": "image", "rows": 0, "cols": 2, "texels": "")"),
              "/textures/0/rows (of \"t\"): must be a whole number from 1 to 65536, not 0");
    EXPECT_EQ(of_texture(R"("type": "checker", "even": [1, 0, 0, 2])"),
              "/textures/0/even/3 (of \"t\"): must be a number from 0 to 1, not 2");
    EXPECT_EQ(of_texture(R"("type": "checker", "odd": 3)"),
              "/textures/0/odd (of \"t\"): must be a number from 0 to 1, not 3");
}

TEST_F(SceneKeys, Environments) {
    const Scene gradient = scene_of(R"("environment": {"type": "gradient", "zenith": [0, 0, 1],
        "horizon": 0.5, "ground": 0, "up": [0, 0, 1]})");
    const auto& sky = std::get<GradientSky>(gradient.environment);
    EXPECT_EQ(sky.zenith, glm::vec3(0, 0, 1));
    EXPECT_EQ(sky.horizon, glm::vec3(0.5f));
    EXPECT_EQ(sky.up, glm::dvec3(0, 0, 1));
    // One texel (1, 0.5, 0).
    const Scene image = scene_of(R"("environment": {"type": "image", "rows": 1, "cols": 1,
        "texels": "AACAPwAAAD8AAAAA", "forward": [1, 0, 0], "scale": 2})");
    EXPECT_EQ(std::get<ImageSky>(image.environment).forward, glm::dvec3(1, 0, 0));
    EXPECT_EQ(environment_colour(image, {0, 1, 0}), glm::vec3(2, 1, 0));
    EXPECT_EQ(complaint_of(R"("environment": {"type": "image", "file": "a.hdr",
                               "forward": [0, -3, 0]})"),
              "line 2: /environment/forward: forward must not be parallel to up");
    EXPECT_EQ(complaint_of(R"("environment": {"type": "sky"})"),
              "/environment/type: must be \"gradient\" or \"image\", not \"sky\"");
    // One texel (NaN, 0, 0).
    EXPECT_EQ(complaint_of(R"("environment": {"type": "image", "rows": 1, "cols": 1,
                               "texels": "AADAfwAAAAAAAAAA"})"),
              "line 2: /environment/texels: element 0 holds nan, which is not finite");
    const LoadedScene lost =
        load("b.json", R"({"raypick": 1, "environment": {"type": "image", "file": "lost.hdr"}})");
    ASSERT_EQ(lost.warnings.size(), 1u);
    EXPECT_THAT(lost.warnings[0], HasSubstr("/environment/file"));
}

TEST_F(SceneKeys, CamerasAndOrigin) {
    const Scene scene = scene_of(R"("origin": [1000, 0, 0],
        "camera": {"eye": [0, 0, 5], "at": [0, 0, 0], "projection": "orthographic", "height": 3},
        "objects": [{"type": "sphere", "centre": [1e6, 0, 0], "radius": 1}])");
    EXPECT_EQ(scene.origin, glm::dvec3(1000, 0, 0)) << "the file's own, wherever things lie";
    EXPECT_EQ(scene.cameras[0].camera.projection, Projection::orthographic);
    EXPECT_EQ(scene.cameras[0].camera.height, 3.0);
    EXPECT_EQ(shape_of<Sphere>(scene).centre, glm::dvec3(1e6, 0, 0));
    EXPECT_EQ(complaint_of(R"("camera": {"eye": [0, 0, 5], "at": [0, 0, 0], "height": 0})"),
              "/camera/height: must be a positive number, not 0");
}

TEST_F(SceneKeys, ModelsBringTheirSetsAndSides) {
    write("a.nff", "f 1 0 0 1 0 1 0 1\ns 0 0 0 1\ns 3 0 0 1\n");
    write("b.nff",
          "f 0 1 0 1 0 1 0 1\nc 0 0 0 1 0 1 0 1\nc 3 0 0 1 3 1 0 1\ns 0 0 0 1\n"
          "s 3 0 0 -1\ns 5 0 0 -1\n");
    const Scene scene =
        objects(R"({"type": "mesh", "file": "a.nff"}, {"type": "mesh", "file": "b.nff"})");
    ASSERT_EQ(scene.objects.size(), 4u);
    EXPECT_EQ(shape_of<SphereSetInstance>(scene, 0).set, 0u);
    std::size_t inside = 0;
    for (const Object& object : scene.objects) {
        if (object.sides != Sides::back_only) continue;
        ++inside;
        const SetId set = std::get<SphereSetInstance>(object.shape).set;
        EXPECT_EQ(set, 1u);
        EXPECT_EQ(scene.sphere_sets[set].parts.at(0).material, 1u) << "b's own material";
    }
    EXPECT_EQ(inside, 1u);
}

}  // namespace
}  // namespace raypick
