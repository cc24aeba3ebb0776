// NFF: every entity, in the orders and spellings that programs write, and what is wrong with a file
// is said with its line.
#include "model_files.h"
#include "needs.h"
#include "tracer/accel/accel.h"

#include <gmock/gmock.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>

namespace raypick {
namespace {

using testing::HasSubstr;

class Nff : public ModelFiles {
protected:
    Scene scene_of(std::string_view text) { return load("a.nff", text).scene; }
    std::string complaint_of(std::string_view text) { return complaint("a.nff", text); }
};

const SphereSet& spheres_of(const Scene& scene, std::size_t object = 0) {
    return scene.sphere_sets[std::get<SphereSetInstance>(scene.objects[object].shape).set];
}

const ConeSet& cones_of(const Scene& scene, std::size_t object = 0) {
    return scene.cone_sets[std::get<ConeSetInstance>(scene.objects[object].shape).set];
}

TEST_F(Nff, ReadsEveryEntity) {
    const Scene scene = scene_of(R"(b 0.078 0.361 0.753
v
from 1 2 3
at 4 5 6
up 0 0 1
angle 45
hither 0.01
resolution 512 512
l 1 2 3
l 4 5 6 0.25 0.5 1
f 1 0.5 0.25 0.5 0.4 3.0827 0 0
s 1 2 3 0.5
s 4 5 6 0.25
c
0 0 0 2
0 0 5 1
c
1 0 0 2
1 0 5 2
p 4
0 0 0
1 0 0
1 1 0
0 1 0
pp 3
0 0 0 0 0 2
1 0 0 1 0 1
0 1 0 0 0 1
)");
    EXPECT_EQ(scene.background, glm::vec3(0.078f, 0.361f, 0.753f));
    ASSERT_EQ(scene.cameras.size(), 1u);
    const Camera& camera = scene.cameras[0].camera;
    EXPECT_EQ(camera.eye, glm::dvec3(1, 2, 3));
    EXPECT_EQ(camera.at, glm::dvec3(4, 5, 6));
    EXPECT_EQ(camera.up, glm::dvec3(0, 0, 1));
    EXPECT_EQ(camera.fovy, 45.0);
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(std::get<PointLight>(scene.lights[0]).position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(std::get<PointLight>(scene.lights[0]).colour,
              glm::vec3(static_cast<float>(std::sqrt(2.0) / 4.0)));
    EXPECT_EQ(std::get<PointLight>(scene.lights[1]).colour, glm::vec3(0.25f, 0.5f, 1.0f));

    EXPECT_EQ(object_names(scene),
              (std::vector<std::string>{"spheres", "cones", "polygons", "patches"}));
    EXPECT_EQ(spheres_of(scene).spheres[1], glm::vec4(4, 5, 6, 0.25f));
    const ConeSet& cones = cones_of(scene, 1);
    EXPECT_EQ(cones.size(), 2u);
    EXPECT_FALSE(cones.capped);
    EXPECT_EQ(cones.ends[0], glm::vec4(0, 0, 0, 2));
    EXPECT_EQ(cones.ends[1], glm::vec4(0, 0, 5, 1));
    EXPECT_EQ(mesh_of(scene, 2).triangles.size(), 2u);
    EXPECT_TRUE(mesh_of(scene, 2).normals.empty()) << "polygons are flat";
    const Mesh& patches = mesh_of(scene, 3);
    ASSERT_EQ(patches.normals.size(), 3u);
    EXPECT_EQ(patches.normals[0], glm::vec3(0, 0, 1));
    EXPECT_NEAR(glm::length(patches.normals[1] - glm::vec3(std::sqrt(0.5f), 0, std::sqrt(0.5f))),
                0.0f, 1e-6f);
    EXPECT_EQ(scene.objects[2].sides, Sides::front_only);
    EXPECT_EQ(scene.objects[3].sides, Sides::both);
}

TEST_F(Nff, MapsFillsToMaterials) {
    const Scene scene = scene_of(
        "f 1 0.5 0.25 0.5 0.4 3.0827 0 0\ns 0 0 0 1\n"
        "f 1 1 1 0.1 0.2 101 0.9 1.5\ns 0 0 0 1\n");
    ASSERT_EQ(scene.materials.size(), 2u);
    const Material& matt = scene.materials[0];
    EXPECT_EQ(matt.name, "f1");
    EXPECT_EQ(matt.diffuse, glm::vec3(0.5f, 0.25f, 0.125f));
    EXPECT_EQ(matt.ambient, glm::vec3(1.0f, 0.5f, 0.25f));
    EXPECT_EQ(scene.ambient, glm::vec3(0.1f));
    EXPECT_EQ(matt.specular, glm::vec3(0.4f));
    EXPECT_EQ(matt.reflect, glm::vec3(0.4f));
    EXPECT_EQ(matt.shininess, 3.0827f);
    EXPECT_FALSE(matt.transmits());
    EXPECT_EQ(matt.ior, 1.0f) << "0 means nothing on opaque surfaces";
    const Material& glass = scene.materials[1];
    EXPECT_EQ(glass.transmit, glm::vec3(0.9f));
    EXPECT_EQ(glass.ior, 1.5f);
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(scene.objects[0].sides, Sides::front_only);
    EXPECT_EQ(scene.objects[0].material, 0u);
    EXPECT_EQ(scene.objects[1].sides, Sides::both) << "transmitting: two sides";
    EXPECT_EQ(scene.objects[1].material, 1u);
}

TEST_F(Nff, EqualFillsAreOneMaterialAndRunsAreParts) {
    const Scene scene = scene_of(
        "s 0 0 0 1\n"
        "f 1 0 0 1 0 1 0 1\ns 1 0 0 1\ns 2 0 0 1\n"
        "f 0 1 0 1 0 1 0 1\np 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
        "f 1 0 0 1 0 1 0 1\ns 3 0 0 1\n"
        "f 0 1 0 1 0 1 0 1\ns 4 0 0 1\n");
    EXPECT_EQ(scene.materials.size(), 2u);
    const std::vector<Part>& parts = spheres_of(scene).parts;
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_EQ(parts[0].count, 1u);
    EXPECT_EQ(parts[0].material, kNoMaterial) << "before the first f";
    EXPECT_EQ(parts[1].first, 1u);
    EXPECT_EQ(parts[1].count, 3u) << "the polygon is no sphere: the run goes on";
    EXPECT_EQ(parts[1].material, 0u);
    EXPECT_EQ(parts[2].first, 4u);
    EXPECT_EQ(parts[2].material, 1u);
    EXPECT_EQ(mesh_of(scene, 1).parts.size(), 1u);
}

TEST_F(Nff, NegativeRadiiShowTheInside) {
    const Scene scene = scene_of(
        "s 0 0 0 -2\ns 9 0 0 1\nc 0 0 0 -1 0 0 5 -0.5\n"
        "c 0 0 0 -1 0 0 5 0\n");
    EXPECT_EQ(object_names(scene), (std::vector<std::string>{"sphere", "sphere#2", "cones"}));
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).radius, 1.0);
    EXPECT_EQ(scene.objects[0].sides, Sides::front_only);
    EXPECT_EQ(std::get<Sphere>(scene.objects[1].shape).radius, 2.0);
    EXPECT_EQ(scene.objects[1].sides, Sides::back_only);
    EXPECT_EQ(scene.objects[2].sides, Sides::back_only);
    EXPECT_EQ(cones_of(scene, 2).ends[0].w, 1.0f);
    EXPECT_EQ(cones_of(scene, 2).ends[3].w, 0.0f);
}

TEST_F(Nff, TakesCommentsBlankLinesAndAnyLineBreaks) {
    const Scene scene = scene_of(
        "# a comment with s 1 2 3 4\r\n"
        "\r\n"
        "s 1 # x\r\n 2\r\n\r\n# between\r\n3 4#radius\r\n"
        "l 1 2 3 # no colour: 1 1 1\r\n"
        "p 3 0 0 0 1 0 0 0 1 0\r\n"
        "l 1 2\r\n3 4\r\n5 6\r\n"
        "f 1 1 1\r\n1 0\r\n7\r\n"
        "b 0.5 0.5 0.5\r\n");
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).centre, glm::dvec3(1, 2, 3));
    EXPECT_EQ(std::get<Sphere>(scene.objects[0].shape).radius, 4.0);
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(std::get<PointLight>(scene.lights[0]).colour,
              glm::vec3(static_cast<float>(std::sqrt(2.0) / 4.0)));
    EXPECT_EQ(std::get<PointLight>(scene.lights[1]).colour, glm::vec3(4, 5, 6));
    EXPECT_EQ(scene.materials[0].shininess, 7.0f);
    EXPECT_EQ(scene.background, glm::vec3(0.5f));
}

TEST_F(Nff, WithoutAViewTheSceneIsFramed) {
    const Scene scene = scene_of("s 100 0 0 1\n");
    EXPECT_TRUE(scene.cameras.empty());
    const Camera camera = default_camera(scene, {100, 100});
    const auto centre = project(camera, {100, 100}, glm::dvec3(100, 0, 0) - scene.origin);
    ASSERT_TRUE(centre);
    EXPECT_NEAR(centre->r, 50.0, 1.0);
    EXPECT_NEAR(centre->c, 50.0, 1.0);
    EXPECT_EQ(scene.background, glm::vec3(0)) << "NFF's default";
}

TEST_F(Nff, CoordinatesFarFromZeroKeepTheirDigits) {
    const Scene scene = scene_of(
        "s 5000000.123 0 0 0.001\ns 5000000.125 0 0 0.001\n"
        "p 3\n5000000.123 0 0\n5000000.125 0 0\n5000000.123 0.25 0\n");
    const SphereSet& set = spheres_of(scene);
    const glm::dvec3 centre =
        scene.origin + scene.objects[0].world_from_object.point(glm::dvec3(set.spheres[0]));
    EXPECT_NEAR(centre.x, 5000000.123, 1e-8);
    EXPECT_NEAR(corner(scene, 1, 0, 0).x, 5000000.123, 1e-8);
}

// Area of a mesh object, signed by the side of its triangles towards +z.
double area(const Mesh& mesh) {
    double sum = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t.x];
        sum +=
            0.5 *
            glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a).z;
    }
    return sum;
}

// Area within an outline, by the shoelace formula.
double outline_area(const std::vector<glm::dvec2>& corners) {
    double sum = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec2 a = corners[i];
        const glm::dvec2 b = corners[(i + 1) % corners.size()];
        sum += 0.5 * (a.x * b.y - b.x * a.y);
    }
    return sum;
}

// As a polygon on the plane z = 3.
std::string polygon_text(const std::vector<glm::dvec2>& corners) {
    std::string text = fmt::format("p {}\n", corners.size());
    for (const glm::dvec2& corner : corners)
        text += fmt::format("{:.17g} {:.17g} 3\n", corner.x, corner.y);
    return text;
}

TEST_F(Nff, GearOf144CornersIsTriangulatedWithinItsOutline) {
    // 36 teeth of four corners each, the tooth's flanks radial: as concave as SPD's gears.
    std::vector<glm::dvec2> corners;
    for (int i = 0; i < 144; ++i) {
        const int flank = i / 2;
        const double angle = 2.0 * std::numbers::pi * flank / 72.0;
        const double radius = ((i + 1) / 2) % 2 == 0 ? 1.0 : 0.8;
        corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    const double expected = outline_area(corners);
    const Scene scene = scene_of(polygon_text(corners));
    const Mesh& mesh = mesh_of(scene);
    EXPECT_EQ(mesh.triangles.size(), 142u);
    EXPECT_NEAR(area(mesh), expected, 1e-5);
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t.x];
        const glm::dvec3 u = glm::dvec3(mesh.positions[t.y]) - a;
        const glm::dvec3 v = glm::dvec3(mesh.positions[t.z]) - a;
        EXPECT_GE(glm::cross(u, v).z, -1e-7) << "all turn as the polygon does";
    }
}

TEST_F(Nff, AHoleMayHangOnABridge) {
    const std::vector<glm::dvec2> square_in_square{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0},
                                                   {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
    const Scene scene = scene_of(polygon_text(square_in_square));
    EXPECT_NEAR(area(mesh_of(scene)), 16.0 - 4.0, 1e-6);
    const Accel accel(std::make_shared<const Scene>(scene));
    const auto is_hit = [&](float x, float y) {
        Ray ray;
        ray.origin = {x, y, 9};
        ray.direction = {0, 0, -1};
        return accel.occluded(ray);
    };
    EXPECT_FALSE(is_hit(2.0f, 2.0f));
    EXPECT_TRUE(is_hit(0.5f, 2.0f));
    EXPECT_TRUE(is_hit(2.0f, 3.5f));
}

TEST_F(Nff, SpiralsAndPolygonsTheOtherWayRoundKeepTheirArea) {
    std::vector<glm::dvec2> spiral;
    const auto wind = [&spiral](int i, double inwards) {
        const double angle = 6.0 * std::numbers::pi * i / 200.0;
        const double radius = 0.2 + 0.8 * i / 200.0 - inwards;
        spiral.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    };
    for (int i = 0; i < 200; ++i)
        wind(i, 0.0);
    for (int i = 199; i >= 0; --i)
        wind(i, 0.1);
    EXPECT_NEAR(area(mesh_of(scene_of(polygon_text(spiral)))), outline_area(spiral), 1e-5);
    std::reverse(spiral.begin(), spiral.end());
    ASSERT_LT(outline_area(spiral), 0.0);
    EXPECT_NEAR(area(mesh_of(scene_of(polygon_text(spiral)))), outline_area(spiral), 1e-5);
}

TEST_F(Nff, ConcavePatchesKeepTheirNormals) {
    const Scene scene = scene_of(
        "pp 6\n0 0 0 0 0 1\n2 0 0 1 0 1\n2 1 0 1 0 1\n1 1 0 0 0 1\n1 2 0 0 1 1\n"
        "0 2 0 0 1 1\n");
    const Mesh& mesh = mesh_of(scene);
    EXPECT_EQ(mesh.triangles.size(), 4u);
    EXPECT_NEAR(area(mesh), 3.0, 1e-6);
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    const float half = std::sqrt(0.5f);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 p = mesh.positions[i];
        const glm::vec3 expected(p.x > 1.5f ? half : 0.0f, p.y > 1.5f ? half : 0.0f,
                                 p.x > 1.5f || p.y > 1.5f ? half : 1.0f);
        EXPECT_LT(glm::length(mesh.normals[i] - expected), 1e-6f) << i;
    }
}

TEST_F(Nff, TheLastBackgroundAndViewCountAndAllLights) {
    const Scene scene = scene_of(
        "l 1 1 1 1 0 0\nb 1 0 0\nv\nfrom 1 2 3\nat 0 0 0\nup 0 0 1\nangle 30\n"
        "s 0 0 0 1\nl 2 2 2 0 1 0\nb 0 1 0\nv\nresolution 9 9\nhither 1\nangle 40\n"
        "up 0 1 0\nat 0 0 0\nfrom 3 2 1\nl 3 3 3 0 0 1");
    EXPECT_EQ(scene.background, glm::vec3(0, 1, 0));
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].camera.eye, glm::dvec3(3, 2, 1));
    EXPECT_EQ(scene.cameras[0].camera.fovy, 40.0);
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(std::get<PointLight>(scene.lights[2]).colour, glm::vec3(0, 0, 1))
        << "read without a line break at the end";
}

TEST_F(Nff, PlaneThroughThreePoints) {
    const Scene scene = scene_of("pl 12 12 -0.5 -12 12 -0.5 -12 -12 -0.5\n");
    const auto& plane = std::get<Plane>(scene.objects[0].shape);
    EXPECT_EQ(plane.normal, glm::dvec3(0, 0, 1));
    EXPECT_EQ(plane.d, 0.5);
}

TEST_F(Nff, WarnsOfWhatIsLeftOut) {
    const LoadedScene loaded = load("a.nff",
                                    "f 1 1 1 0.5 0.5 45 0 1 earth.jpg\n"
                                    "tess 4\ns 1 -4 2 4 2 2\n");
    ASSERT_EQ(loaded.warnings.size(), 2u);
    EXPECT_THAT(loaded.warnings[0], HasSubstr("line 1: \"earth.jpg\" behind f is left out"));
    EXPECT_THAT(loaded.warnings[1], HasSubstr("line 3: \"2 2\" behind s is left out"));
}

TEST_F(Nff, SaysWhatIsWrongAndWhere) {
    EXPECT_EQ(complaint_of("s 0 0 0 1\nx 1 2\n"),
              "line 2: unknown keyword \"x\": v, b, l, f, c, s, p or pp should stand here");
    EXPECT_EQ(complaint_of("c 0 0 0 1 0 0 1 1 5\n"), "line 1: \"5\" where a keyword should stand");
    EXPECT_EQ(complaint_of("p 2\n0 0 0\n1 0 0\n"),
              "line 1: a polygon needs at least three corners, not 2");
    EXPECT_EQ(complaint_of("\npp -3\n0 0 0\n1 0 0\n"),
              "line 2: a polygon needs at least three corners, not -3");
    EXPECT_EQ(complaint_of("p 3.5\n0 0 0\n1 0 0\n0 1 0\n"),
              "line 1: the number of corners must be a whole number, not 3.5");
    EXPECT_EQ(complaint_of("p 1e9\n0 0 0\n1 0 0\n"),
              "line 1: promises 1000000000 corners, but the file ends before that");
    EXPECT_EQ(complaint_of("p 3\n0 0 0\n1 0 0\n 0 x 0\n"), "line 4: a corner: \"x\" is no number");
    EXPECT_EQ(complaint_of("p 3\n0 0 0\n1 0 0\n0.25 1"), "line 4: a corner is missing");
    EXPECT_EQ(complaint_of("s 0 0 0 0\n"),
              "line 1: a sphere's radius must be a number other than 0, not 0");
    EXPECT_EQ(complaint_of("s 0 0 0 nan\n"),
              "line 1: a sphere's radius must be a number other than 0, not nan");
    EXPECT_EQ(complaint_of("# one\n# two\ns 0 nan 0 1\n"),
              "line 3: a sphere's centre: y is not a number");
    EXPECT_EQ(complaint_of("s 0 inf 0 1\n"), "line 1: a sphere's centre: y is inf: beyond 1e+18");
    EXPECT_EQ(complaint_of("s 0 0 0\n"), "line 2: a sphere's radius is missing");
    EXPECT_EQ(complaint_of("c 0 0 0 1\n0 0 0 2\n"),
              "line 2: a cone's base and apex are the same point");
    EXPECT_EQ(complaint_of("s 0 0 0 1e-44\n"),
              "line 1: a sphere's radius must be a number other than 0, not 1e-44");
    EXPECT_EQ(
        complaint_of("f 1 1 1 1 0 1 0.5 1e-44\n"),
        "line 1: the index of refraction of what transmits light must be positive, not 1e-44");
    EXPECT_EQ(complaint_of("f 1e9 1 1 1 0 1 0 1\n"),
              "line 1: a colour must be no more than 1000000, not 1000000000");
    EXPECT_EQ(complaint_of("c 0 0 0 0\n0 0 1 0\n"), "line 2: both radii of a cone are 0");
    EXPECT_EQ(complaint_of("c 0 0 0 nan\n0 0 1 0\n"), "line 2: a cone's radii must be numbers");
    EXPECT_EQ(complaint_of("c 0 0 0 -1\n0 0 1 2\n"),
              "line 2: a cone's radii -1 and 2 have different signs");
    EXPECT_EQ(complaint_of("f 1 1 -1 1 0 1 0 1\n"), "line 1: a colour must be 0 or more, not -1");
    EXPECT_EQ(complaint_of("f 1 1 1 nan 0 1 0 1\n"), "line 1: Kd must be 0 or more, not nan");
    EXPECT_EQ(complaint_of("f 1 1 1 1 0 -5 0 1\n"), "line 1: Shine must be 0 or more, not -5");
    EXPECT_EQ(complaint_of("f 1 1 1 1 0 1 0.5 0\n"),
              "line 1: the index of refraction of what transmits light must be positive, not 0");
    EXPECT_EQ(complaint_of("f 1 1 1\ns 0 0 0 1\n"), "line 2: Kd: \"s\" is no number");
    EXPECT_EQ(complaint_of("l 0 0 nan\n"), "line 1: a light's position: z is not a number");
    EXPECT_EQ(complaint_of("l 0 0 1 -1 0 0\n"), "line 1: a light's red must be 0 or more, not -1");
    EXPECT_EQ(complaint_of("b 1 1\n"), "line 2: the background's colour is missing");
    EXPECT_EQ(complaint_of("pl 0 0 0 1 0 0 2 0 0\n"),
              "line 1: the three points of a plane lie on one line");
    EXPECT_EQ(complaint_of("\nv\nfrom 1 2 3\nup 0 0 1\ns 0 0 0 1\n"),
              "line 2: the view has no \"at\"");
    EXPECT_THAT(complaint_of("\nv\nfrom 1 2 3\nat 1 2 3\n"), HasSubstr("line 2: the view: "));
    EXPECT_THAT(complaint_of("v\nfrom 1 2 3\nat 0 0 0\nangle 180\n"),
                HasSubstr("line 1: the view"));
    EXPECT_EQ(complaint_of("b 1 1 1\n"), "has no objects: nothing to show");
}

// A set keeps floats, as which both ends are the same; a cone of its own keeps doubles.
TEST_F(Nff, AConeFlatterThanFloatsTellIsReadAloneAndAmongOthers) {
    const std::string flat = "c\n1000 0 0 1\n1000.00001 0 0 2\n";
    const Scene alone = scene_of(flat);
    const Scene among = scene_of("f 1 0 0 1 0 1 0 1\nc\n0 0 0 1\n0 1 0 1\nf 0 1 0 1 0 1 0 1\n" +
                                 flat + "c\n0 2 0 1\n0 3 0 1\n");
    ASSERT_EQ(among.objects.size(), 2u);
    const Cone& a = std::get<Cone>(alone.objects.at(0).shape);
    const Cone& b = std::get<Cone>(among.objects.at(0).shape);
    EXPECT_EQ(b.base, a.base);
    EXPECT_EQ(b.apex, glm::dvec3(1000.00001, 0, 0));
    EXPECT_EQ(b.apex_radius, 2.0);
    EXPECT_EQ(among.materials.at(among.objects[0].material).diffuse, glm::vec3(0, 1, 0));
    EXPECT_EQ(among.cone_sets.at(0).ends.size(), 4u);
    EXPECT_EQ(among.cone_sets.at(0).parts.size(), 2u);
}

TEST_F(Nff, DamagedFilesAreRefusedOrLoad) {
    expect_no_crash("a.nff",
                    "b 0 0 1\nv\nfrom 1 2 3\nat 0 0 0\nup 0 0 1\nangle 45\n"
                    "l 1 2 3\nf 1 0.5 0 1 0 1 0 1\ns 0 0 0 1\nc 0 0 0 1 0 0 1 1\n"
                    "p 3\n0 0 0\n1 0 0\n0 1 0\npp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n"
                    "0 1 0 0 0 1\n");
}

TEST_F(Nff, IsKnownByItsContent) {
    EXPECT_EQ(load("noending", "# SPD\nb 0 0 1\ns 0 0 0 1\n").scene.objects.size(), 1u);
    EXPECT_EQ(load("other.txt", "v\nfrom 1 2 3\nat 0 0 0\ns 0 0 0 1\n").scene.cameras.size(), 1u);
    EXPECT_THAT(readable_extensions(), testing::Contains(".nff"));
}

TEST_F(Nff, AMillionSpheresAreOneObject) {
    constexpr int kCount = 1'000'000;
    std::string text = "f 1 0.9 0.7 0.5 0.5 3 0 1\n";
    for (int i = 0; i < kCount; ++i)
        text += fmt::format("s {}.5 {} 0.25 0.125\n", i % 1000, i / 1000);
    const auto start = std::chrono::steady_clock::now();
    const Scene scene = scene_of(text);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    RecordProperty("seconds", fmt::format("{:.3f}", seconds.count()));
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(primitive_count(scene, scene.objects[0]), static_cast<std::uint32_t>(kCount));
    EXPECT_EQ(spheres_of(scene).spheres[kCount - 1], glm::vec4(999.5f, 999, 0.25f, 0.125f));
}

TEST_F(Nff, StopsWhenAsked) {
    std::stop_source source;
    source.request_stop();
    LoadOptions options;
    options.stop = source.get_token();
    EXPECT_THROW(load("a.nff", "s 0 0 0 1\n", options), Cancelled);
}

struct Counts {
    std::uint32_t spheres = 0;
    std::uint32_t cones = 0;
    std::uint32_t triangles = 0;
};

Counts counts_of(const Scene& scene) {
    Counts counts;
    for (const Object& object : scene.objects) {
        const std::uint32_t count = primitive_count(scene, object);
        const Shape& shape = object.shape;
        if (std::holds_alternative<MeshInstance>(shape)) counts.triangles += count;
        if (std::holds_alternative<Sphere>(shape)) ++counts.spheres;
        if (std::holds_alternative<SphereSetInstance>(shape)) counts.spheres += count;
        if (std::holds_alternative<Cone>(shape)) ++counts.cones;
        if (std::holds_alternative<ConeSetInstance>(shape)) counts.cones += count;
    }
    return counts;
}

// The counts are those of MODELS.md.
TEST(NffModels, AllLoadWithWhatTheyHold) {
    const std::map<std::string, Counts> expected = {
        {"spd/balls.nff", {7381, 0, 2}},          {"spd/mount.nff", {4, 0, 8192}},
        {"spd/rings.nff", {4200, 4200, 2}},       {"spd/tetra.nff", {0, 0, 4096}},
        {"nff/refract.nff", {0, 0, 570}},         {"nff/mount_high.nff", {4, 0, 2048}},
        {"nff/mount_low.nff", {4, 0, 8}},         {"nff/balls_low.nff", {10, 0, 0}},
        {"nff/balls_medium.nff", {91, 0, 0}},     {"assimp/NFF/spheres.nff", {4, 0, 0}},
        {"assimp/NFF/cone.nff", {2, 2, 0}},       {"assimp/NFF/cylinder.nff", {0, 1, 0}},
        {"assimp/NFF/WithCamera.nff", {3, 0, 2}}, {"assimp/NFF/positionTest.nff", {14, 1, 0}},
    };
    for (const auto& [file, counts] : expected) {
        SCOPED_TRACE(file);
        RAYPICK_REQUIRE_MODEL(file);
        const Scene scene = load_scene(model(file)).scene;
        const Counts found = counts_of(scene);
        EXPECT_EQ(found.spheres, counts.spheres);
        EXPECT_EQ(found.cones, counts.cones);
        EXPECT_EQ(found.triangles, counts.triangles);
    }
}

}  // namespace
}  // namespace raypick
