// OBJ and MTL files: every rule of names, indices, polygons, materials and complaints.
#include "model_files.h"

#include <gmock/gmock.h>
#include <glm/geometric.hpp>

#include <ctime>

namespace raypick {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class Obj : public ModelFiles {};

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST_F(Obj, ReadsATriangle) {
    const LoadedScene loaded = load("one.obj", kTriangle + "f 1 2 3\n");
    EXPECT_THAT(loaded.warnings, IsEmpty());
    ASSERT_EQ(loaded.scene.objects.size(), 1u);
    EXPECT_EQ(loaded.scene.objects[0].name, "one");
    EXPECT_EQ(loaded.scene.objects[0].path, "/one");
    EXPECT_EQ(corner(loaded.scene, 0, 0, 1), glm::dvec3(1, 0, 0));
    EXPECT_EQ(corner(loaded.scene, 0, 0, 2), glm::dvec3(0, 1, 0));
}

TEST_F(Obj, ObjectsAreTheOLinesIfThereAreAny) {
    const LoadedScene loaded = load("a.obj", kTriangle +
                                                 "f 1 2 3\no wheel left\ng rim\nf 1 2 3\ng tyre\n"
                                                 "f 1 2 3\no empty\no wheel left\nf 3 2 1\n");
    EXPECT_THAT(object_names(loaded.scene), ElementsAre("a", "wheel left", "wheel left#2"));
    EXPECT_EQ(loaded.scene.objects[2].path, "/wheel left#2");
    EXPECT_EQ(primitive_count(loaded.scene, loaded.scene.objects[1]), 2u);
}

TEST_F(Obj, ElseObjectsAreTheGroupsAndOneOpenedAgainGoesOn) {
    const LoadedScene loaded =
        load("a.obj", kTriangle +
                          "v 0 0 7\nf 1 2 3\ng door   frame\nf 1 2 3\ng window\nf 1 2 3\n"
                          "g door frame\nf 1 2 4\ng\nf 1 2 3\n");
    EXPECT_THAT(object_names(loaded.scene), ElementsAre("a", "door frame", "window", "default"));
    ASSERT_EQ(primitive_count(loaded.scene, loaded.scene.objects[1]), 2u);
    EXPECT_EQ(corner(loaded.scene, 1, 1, 2), glm::dvec3(0, 0, 7));
}

TEST_F(Obj, PartsAreTheRunsOfUsemtl) {
    const LoadedScene loaded = load("a.obj", kTriangle +
                                                 "usemtl red\nf 1 2 3\nf 1 2 3\nusemtl blue\n"
                                                 "f 1 2 3\nusemtl blue\nf 1 2 3\nusemtl red\n"
                                                 "f 1 2 3\n");
    const Mesh& mesh = mesh_of(loaded.scene);
    ASSERT_EQ(mesh.parts.size(), 3u);
    EXPECT_EQ(mesh.parts[1].first, 2u);
    EXPECT_EQ(mesh.parts[1].count, 2u);
    EXPECT_EQ(mesh.parts[2].material, mesh.parts[0].material);
    ASSERT_EQ(loaded.scene.materials.size(), 2u);
    EXPECT_EQ(loaded.scene.materials[mesh.parts[1].material].name, "blue");
}

TEST_F(Obj, IndicesCountFromOneOrBackFromTheLatest) {
    const LoadedScene loaded =
        load("a.obj", "v 9 9 9\n" + kTriangle + "f -3 -2 -1\nf +2 +3 +4\nv 5 5 5\nf -1 -2 -4\n");
    const Scene& scene = loaded.scene;
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(corner(scene, 0, 0, i), corner(scene, 0, 1, i));
    EXPECT_EQ(corner(scene, 0, 2, 0), glm::dvec3(5, 5, 5));
    EXPECT_EQ(corner(scene, 0, 2, 2), glm::dvec3(0, 0, 0));
}

TEST_F(Obj, FacesMayStandBeforeTheirVertices) {
    const LoadedScene loaded = load("a.obj", "f 1 2 3\n" + kTriangle);
    EXPECT_EQ(corner(loaded.scene, 0, 0, 1), glm::dvec3(1, 0, 0));
}

TEST_F(Obj, ReadsAllSpellingsOfCornersAndNumbers) {
    const LoadedScene loaded = load("a.obj",
                                    "v +1 -2.5e0 .5 1.0 0.1 0.2 0.3 # weight, colours\r\n"
                                    "v\t1E1 1e+1 1.e-1\r\nv 0 0 0\r\nvt 0.25\r\nvt 0.5 0.75 0\r\n"
                                    "vn 0 0 2\r\nf 1/2/1 2//1 3/1 # a comment\r\n");
    const Scene& scene = loaded.scene;
    EXPECT_EQ(corner(scene, 0, 0, 0), glm::dvec3(1, -2.5, 0.5));
    EXPECT_NEAR(corner(scene, 0, 0, 1).z, 0.1, 1e-8);
    const Mesh& mesh = mesh_of(scene);
    EXPECT_EQ(mesh.uvs[mesh.triangles[0].x], glm::vec2(0.5f, 0.75f));
    EXPECT_EQ(mesh.uvs[mesh.triangles[0].z], glm::vec2(0.25f, 0.0f));
    EXPECT_EQ(mesh.normals[mesh.triangles[0].y], glm::vec3(0, 0, 1));
}

TEST_F(Obj, LinesGoOnAfterABackslashButNamesDoNot) {
    const LoadedScene loaded =
        load("a.obj",
             "# a path C:\\models\\\nv 0 \\\n 0 0\nv 1 0 0\nv 0 1 0\no back\\\nf 1 \\\r\n2 3\n");
    EXPECT_THAT(object_names(loaded.scene), ElementsAre("back\\"));
    EXPECT_EQ(placed_triangles(loaded.scene), 1u);
}

TEST_F(Obj, ReadsLineEndsOfOldMacsAndAByteOrderMark) {
    const LoadedScene loaded = load("a.obj", "\xef\xbb\xbfv 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r");
    EXPECT_EQ(placed_triangles(loaded.scene), 1u);
}

TEST_F(Obj, KeepsDegenerateTrianglesAndTheirNumbers) {
    const LoadedScene loaded = load("a.obj", kTriangle + "f 1 2 3\nf 1 1 2\nf 1 2 1 2\nf 2 3 1\n");
    ASSERT_EQ(placed_triangles(loaded.scene), 5u);
    EXPECT_EQ(corner(loaded.scene, 0, 4, 0), glm::dvec3(1, 0, 0));
}

TEST_F(Obj, LeavesOutLinesPointsAndTwoCornersWithAWarning) {
    const LoadedScene loaded =
        load("a.obj", kTriangle + "l 1 2\np 1\nf 1 2\nf 1 2 3\ncurv2 1\nfoo 1\nfoo 2\n");
    EXPECT_EQ(placed_triangles(loaded.scene), 1u);
    const std::string file = (folder_ / "a.obj").string();
    EXPECT_THAT(loaded.warnings,
                ElementsAre(StartsWith(file + ": line 4: lines and points"),
                            StartsWith(file + ": line 8: free-form"),
                            StartsWith(file + ": line 6: a face with fewer than 3 corners"),
                            StartsWith(file + ": line 9: \"foo\" is no OBJ keyword")));
}

TEST_F(Obj, KeepsNormalsAndRepairsBadOnes) {
    const LoadedScene loaded = load("a.obj", kTriangle +
                                                 "v 1 1 0\nvn 3 0 4\nvn 0 0 0\nvn nan 0 1\n"
                                                 "vn 1.#INF -1.#IND 0\n"
                                                 "f 1//1 2//2 3//3\nf 3//1 2//4 4\n");
    const Mesh& mesh = mesh_of(loaded.scene);
    const auto normal = [&](std::size_t t, int c) { return mesh.normals[mesh.triangles[t][c]]; };
    EXPECT_NEAR(normal(0, 0).x, 0.6f, 1e-6);
    EXPECT_NEAR(normal(0, 0).z, 0.8f, 1e-6);
    EXPECT_EQ(normal(0, 1), glm::vec3(0, 0, 1));
    EXPECT_EQ(normal(0, 2), glm::vec3(0, 0, 1));
    EXPECT_EQ(normal(1, 1), glm::vec3(0, 0, 1));
    EXPECT_EQ(normal(1, 2), glm::vec3(0, 0, 1));
    for (const glm::vec3& n : mesh.normals)
        EXPECT_NEAR(glm::length(n), 1.0f, 1e-6);
}

TEST_F(Obj, GivesCreaseNormalsWhereTheFileHasNone) {
    const std::string roof =
        "v 0 0 0\nv 1 0 0\nv 0 1 0.2\nv 1 1 0.2\nv 0 2 0\nv 1 2 0\n"
        "f 1 2 4 3\nf 3 4 6 5\n";
    LoadOptions options;
    const auto normals = [&](double crease) {
        options.crease_degrees = crease;
        return load("a.obj", roof, options).scene.meshes[0].positions.size();
    };
    EXPECT_EQ(normals(30.0), 6u);  // the faces meet at 22.6 degrees: smooth
    EXPECT_EQ(normals(20.0), 8u);
    options.crease_degrees = 0.0;
    EXPECT_TRUE(load("a.obj", roof, options).scene.meshes[0].normals.empty());
}

TEST_F(Obj, SubMillimetreDetailSurvivesFarFromTheOrigin) {
    // 1 km wide around (5e6, 5e6, 100); steps of 0.2 mm at the far corner.
    const LoadedScene loaded = load("far.obj",
                                    "v 4999500 4999500 100\nv 5000500 4999500.0001 100\n"
                                    "v 4999500.0003 5000500 100.00052\nf 1 2 3\n");
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 1).y, 4999500.0001, 5e-5);
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 2).x, 4999500.0003, 5e-5);
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 2).z, 100.00052, 5e-5);
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 0).x, 4999500.0, 5e-5);
}

TEST_F(Obj, UnusedVerticesDoNotMoveTheOrigin) {
    const LoadedScene loaded =
        load("far.obj",
             "v 0 0 0\nv 5000000.125 5000000 0\nv 5000001 5000000 0\nv 5000000 5000001 0\n"
             "f 2 3 4\n");
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 0).x, 5000000.125, 1e-6);
}

// --- Polygons -----------------------------------------------------------------------------------

double triangle_area(const Scene& scene, std::size_t t) {
    const glm::dvec3 a = corner(scene, 0, t, 0);
    return 0.5 * glm::cross(corner(scene, 0, t, 1) - a, corner(scene, 0, t, 2) - a).z;
}

// All triangles of a polygon in the plane z = 0 turn as it does and add up to its area.
void expect_covers(const Scene& scene, std::size_t triangles, double area) {
    ASSERT_EQ(placed_triangles(scene), triangles);
    double sum = 0.0;
    for (std::size_t t = 0; t < triangles; ++t) {
        EXPECT_GE(triangle_area(scene, t), 0.0) << "triangle " << t;
        sum += triangle_area(scene, t);
    }
    EXPECT_NEAR(sum, area, 1e-5 * area);
}

TEST_F(Obj, ConvexPolygonsAreFansFromTheFirstCorner) {
    const LoadedScene loaded = load("a.obj",
                                    "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\n"
                                    "f 1 2 3 4 5\n");
    expect_covers(loaded.scene, 3, 5.0);
    for (std::size_t t = 0; t < 3; ++t)
        EXPECT_EQ(corner(loaded.scene, 0, t, 0), glm::dvec3(0, 0, 0));
}

TEST_F(Obj, AnArrowheadIsSplitAtItsNotchWhereverItBegins) {
    const std::string points = "v 0 0 0\nv 2 -1 0\nv 1 0 0\nv 2 1 0\n";  // notch at 3
    for (const char* face : {"f 1 2 3 4\n", "f 2 3 4 1\n", "f 3 4 1 2\n", "f 4 1 2 3\n"}) {
        SCOPED_TRACE(face);
        expect_covers(load("a.obj", points + face).scene, 2, 1.0);
    }
}

TEST_F(Obj, ConcavePolygonsAreCutByEars) {
    // A comb with 5 teeth.
    std::string text;
    int corners = 0;
    const auto add = [&](double x, double y) {
        text += fmt::format("v {} {} 0\n", x, y);
        ++corners;
    };
    add(0, 0);
    add(9, 0);
    for (int tooth = 4; tooth >= 0; --tooth) {
        add(2 * tooth + 1, 3);
        add(2 * tooth, 3);
        if (tooth > 0) {
            add(2 * tooth, 1);
            add(2 * tooth - 1, 1);
        }
    }
    text += "f";
    for (int i = 1; i <= corners; ++i)
        text += fmt::format(" {}", i);
    // The base 9 x 1 and teeth of 1 x 2.
    expect_covers(load("a.obj", text + "\n").scene, static_cast<std::size_t>(corners) - 2, 19.0);
}

TEST_F(Obj, HolesMayBeBridged) {
    // A 4 x 4 square with a 2 x 2 hole, connected by the edge 1-5, which is walked twice.
    const LoadedScene loaded =
        load("a.obj",
             "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\n"
             "f 1 2 3 4 1 5 6 7 8 5\n");
    expect_covers(loaded.scene, 8, 12.0);
}

TEST_F(Obj, CornersOnAnEdgeMakeNoHoles) {
    // The first corner's fan would be flat on two sides.
    const LoadedScene loaded =
        load("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 2 0\nv 1 1 0\nv 0 2 0\nf 1 2 3 4 5 6\n");
    expect_covers(loaded.scene, 4, 3.0);
}

TEST_F(Obj, RandomStarsAreCovered) {
    for (unsigned seed = 0; seed < 50; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        const int corners = 5 + static_cast<int>(random() % 60);
        std::string text;
        std::vector<glm::dvec2> points;
        for (int i = 0; i < corners; ++i) {
            const double radius = 1.0 + static_cast<double>(random() % 1000) / 100.0;
            const double angle = 2.0 * 3.14159265358979 * i / corners;
            points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
            text += fmt::format("v {} {} 0\n", points.back().x, points.back().y);
        }
        double area = 0.0;
        text += "f";
        for (int i = 0; i < corners; ++i) {
            const glm::dvec2 a = points[static_cast<std::size_t>(i)];
            const glm::dvec2 b = points[static_cast<std::size_t>((i + 1) % corners)];
            area += 0.5 * (a.x * b.y - a.y * b.x);
            text += fmt::format(" {}", i + 1);
        }
        expect_covers(load("a.obj", text + "\n").scene, static_cast<std::size_t>(corners) - 2,
                      area);
    }
}

TEST_F(Obj, AnyPolygonGivesTwoTrianglesFewerThanCorners) {
    const std::string points = kTriangle + "v 1 1 0\nv 0.5 0.5 0\n";
    // Crossing itself, all in one point, all on one line, the same corner again and again.
    EXPECT_EQ(placed_triangles(load("a.obj", points + "f 1 4 2 3 5\n").scene), 3u);
    EXPECT_EQ(placed_triangles(load("a.obj", points + "f 1 1 1 1 1 1\n").scene), 4u);
    EXPECT_EQ(placed_triangles(load("a.obj", points + "f 1 5 4 5 1\n").scene), 3u);
    EXPECT_EQ(placed_triangles(load("a.obj", points + "f 1 2 1 2 1 3 2 4 5\n").scene), 7u);
}

TEST_F(Obj, LargePolygonsTakeNoQuadraticTime) {
    // A gear of 200,000 corners; and one that crosses itself everywhere.
    std::string text;
    constexpr int kCorners = 200000;
    std::mt19937 random(1);
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2.0 * 3.14159265358979 * i / kCorners;
        const double radius = i % 2 == 0 ? 1000.0 : 990.0;
        text += fmt::format("v {} {} 0\n", radius * std::cos(angle), radius * std::sin(angle));
    }
    std::string gear = "f";
    std::string tangle = "f";
    for (int i = 0; i < kCorners; ++i) {
        gear += fmt::format(" {}", i + 1);
        tangle += fmt::format(" {}", random() % kCorners + 1);
    }
    const std::clock_t begin = std::clock();  // processor time, whatever else the machine does
    const LoadedScene loaded = load("a.obj", text + gear + "\n" + tangle + "\n");
    EXPECT_EQ(placed_triangles(loaded.scene), 2u * (kCorners - 2));
    EXPECT_LT(std::clock() - begin, 20 * CLOCKS_PER_SEC);
}

// --- Materials ----------------------------------------------------------------------------------

class Mtl : public Obj {
protected:
    Material material(const std::string& mtl) {
        write("m.mtl", "newmtl m\n" + mtl);
        LoadedScene loaded = load("a.obj", "mtllib m.mtl\nusemtl m\n" + kTriangle + "f 1 2 3\n");
        warnings_ = loaded.warnings;
        EXPECT_EQ(loaded.scene.materials.size(), 1u);
        return loaded.scene.materials.at(0);
    }

    std::vector<std::string> warnings_;
};

TEST_F(Mtl, MapsColoursToPhong) {
    const Material m =
        material("Ka 1 1 1\nKd .1 .2 .3\nKs 0.4\nKe 1 2 3\nNs 90\nNi 1.4\nillum 2\n");
    EXPECT_EQ(m.name, "m");
    EXPECT_EQ(m.diffuse, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.ambient, m.diffuse);
    EXPECT_EQ(m.specular, glm::vec3(0.4f));
    EXPECT_EQ(m.emissive, glm::vec3(1, 2, 3));
    EXPECT_EQ(m.shininess, 90.0f);
    EXPECT_FALSE(m.reflects());
    EXPECT_FALSE(m.transmits());
    EXPECT_EQ(m.ior, 1.0f);
}

TEST_F(Mtl, IllumSaysWhatShinesAndMirrors) {
    EXPECT_EQ(material("Ks 0.5 0.5 0.5\nillum 1\n").specular, glm::vec3(0.0f));
    EXPECT_EQ(material("Ks 0.5 0.5 0.5\nillum 3\n").reflect, glm::vec3(0.5f));
    EXPECT_EQ(material("Ks 0.5 0.5 0.5\nillum 5\n").reflect, glm::vec3(0.5f));
    EXPECT_EQ(material("Ks 0.5 0.5 0.5\nillum 9\n").reflect, glm::vec3(0.0f));
}

TEST_F(Mtl, DissolvesStraightThroughUnlessRefractionIsAskedFor) {
    const Material pane = material("Kd 0.8 0.8 0.8\nd 0.25\nTf 1 0.5 0\nNi 1.5\nillum 2\n");
    EXPECT_EQ(pane.transmit, glm::vec3(0.75f, 0.375f, 0.0f));
    EXPECT_EQ(pane.diffuse, glm::vec3(0.2f));
    EXPECT_EQ(pane.ior, 1.0f);
    EXPECT_EQ(material("d -halo 0.25\nNi 1.5\nillum 6\n").ior, 1.5f);
    EXPECT_EQ(material("d 0.25\nNi 1.5\nillum 4\n").ior, 1.5f);
    EXPECT_EQ(material("d 0.25\nillum 6\n").ior, 1.0f);
    // Fully opaque glass is what illum 7 says by its formula, not what illum 4 says.
    EXPECT_EQ(material("d 1\nKs 0.25 0.25 0.25\nTf 1 1 1\nillum 7\n").transmit, glm::vec3(0.75f));
    EXPECT_FALSE(material("d 1\nTf 1 1 1\nillum 4\n").transmits());
}

TEST_F(Mtl, TrIsOneMinusDAndDWins) {
    EXPECT_EQ(material("Tr 0.75\n").transmit, glm::vec3(0.75f));
    EXPECT_EQ(material("d 0.5\nTr 0.9\n").transmit, glm::vec3(0.5f));
    EXPECT_EQ(material("Tr 0.9\nd 0.5\n").transmit, glm::vec3(0.5f));
}

TEST_F(Mtl, MapsMakeNoMoreOfMirrorsThanScenesHold) {
    const Material m = material("Ks 1 0.5 0.5\nillum 3\nmap_Ks -mm 0 5 a.png\n");
    EXPECT_NEAR(m.reflect.x * m.map(MapSlot::reflect).gain, 2.0f, 0.01f);
    EXPECT_EQ(m.specular.x, 1.0f);
    material("map_Ks -mm 0 1e30 a.png\n");
    EXPECT_THAT(warnings_.at(0), HasSubstr("material \"m\": -mm must be within 1e+18: ignored"));
}

TEST_F(Mtl, EachMissingTextureIsAWarning) {
    material("map_Kd a.png\nmap_Bump -bm 0.2 b.png\n");
    ASSERT_EQ(warnings_.size(), 2u);
    EXPECT_THAT(warnings_[0], HasSubstr("a.png"));
    EXPECT_THAT(warnings_[1], HasSubstr("b.png"));
}

TEST_F(Mtl, LibrariesAreFoundByAwkwardNames) {
    const std::string rest = "usemtl m\n" + kTriangle + "f 1 2 3\n";
    const std::string red = "newmtl m\nKd 1 0 0\n";
    write("sub/my materials.mtl", red);
    write("b.mtl", "newmtl other\n");
    for (const char* name :
         {"sub/my materials.mtl", "sub\\my materials.mtl", ".\\sub\\my materials.mtl"}) {
        const LoadedScene loaded = load("a.obj", fmt::format("mtllib {}\n", name) + rest);
        EXPECT_EQ(loaded.scene.materials[0].diffuse, glm::vec3(1, 0, 0)) << name;
    }
    write("m.mtl", red);
    for (const char* name : {"b.mtl m.mtl", R"(C:\users\me\m.mtl)", "/home/me/m.mtl"}) {
        const LoadedScene loaded = load("a.obj", fmt::format("mtllib {}\n", name) + rest);
        EXPECT_EQ(loaded.scene.materials[0].diffuse, glm::vec3(1, 0, 0)) << name;
    }
}

TEST_F(Mtl, AMissingLibraryIsAWarningThatNamesIt) {
    const LoadedScene loaded =
        load("a.obj", "mtllib no such.mtl\nusemtl m\n" + kTriangle + "f 1 2 3\n");
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_THAT(loaded.warnings[0],
                HasSubstr("a.obj: material library \"no such.mtl\" is missing"));
    EXPECT_EQ(loaded.scene.materials[0].name, "m");
}

TEST_F(Mtl, AMissingMaterialIsAWarningThatNamesIt) {
    write("m.mtl", "newmtl other\n");
    const LoadedScene loaded =
        load("a.obj", "mtllib m.mtl\nusemtl my paint\n" + kTriangle + "f 1 2 3\n");
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_THAT(loaded.warnings[0], HasSubstr("material \"my paint\" is in no library"));
}

TEST_F(Mtl, WhatIsWrongNamesTheLibrary) {
    const auto error = [&](const std::string& mtl) {
        const std::filesystem::path file = write("m.mtl", mtl);
        try {
            load("a.obj", "mtllib m.mtl\n" + kTriangle + "f 1 2 3\n");
        } catch (const FileError& e) {
            EXPECT_EQ(e.file(), file.string());
            return std::string(e.what()).substr(e.file().size() + 2);
        }
        return std::string();
    };
    EXPECT_EQ(error("newmtl a\nKd 1 0\n"), "line 2: material \"a\": Kd is missing");
    EXPECT_EQ(error("newmtl a\n\nNs many\n"), "line 3: material \"a\": Ns: \"many\" is no number");
    EXPECT_EQ(error("Kd 1 0 0\n"), "line 1: \"Kd\" before the first newmtl");
    EXPECT_EQ(error("newmtl a\nNs inf\n"), "line 2: material \"a\": Ns is not finite");
    EXPECT_EQ(error("newmtl a\nNs -5\n"), "line 2: material \"a\": Ns must be 0 or more, not -5");
    EXPECT_EQ(error("newmtl a\nNi 0\n"), "line 2: material \"a\": Ni must be positive, not 0");
    EXPECT_EQ(error("newmtl a\nNi -1\n"), "line 2: material \"a\": Ni must be positive, not -1");
    EXPECT_EQ(error("newmtl a\nd -1\n"), "line 2: material \"a\": d must be from 0 to 1, not -1");
    EXPECT_EQ(error("newmtl a\nTr -1\n"), "line 2: material \"a\": Tr must be from 0 to 1, not -1");
    EXPECT_EQ(error("newmtl a\nKd 1e30 0 0\n"),
              "line 2: material \"a\": Kd must be no more than 1000000, not 1e+30");
    EXPECT_EQ(error("newmtl a\nd -halo 0.5\n"), "");
}

TEST_F(Mtl, MoreThanAllIsTakenAsAll) {
    write("m.mtl", "newmtl a\nd 2\nnewmtl b\nTr 1.5\nnewmtl c\nillum 3\nKs 5 1 1\n");
    const LoadedScene loaded =
        load("a.obj", "mtllib m.mtl\n" + kTriangle +
                          "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n");
    ASSERT_EQ(loaded.warnings.size(), 2u);
    EXPECT_THAT(
        loaded.warnings[0],
        HasSubstr("m.mtl: line 2: material \"a\": d must be from 0 to 1, not 2: taken as 1"));
    EXPECT_THAT(loaded.warnings[1], HasSubstr("line 4: material \"b\": Tr must be from 0 to 1"));
    EXPECT_FALSE(loaded.scene.materials.at(0).transmits());
    EXPECT_EQ(loaded.scene.materials.at(1).transmit, glm::vec3(1.0f));
    EXPECT_EQ(loaded.scene.materials.at(2).reflect, glm::vec3(2.0f, 1.0f, 1.0f));
    EXPECT_EQ(loaded.scene.materials.at(2).specular, glm::vec3(5.0f, 1.0f, 1.0f));
}

// --- Complaints ---------------------------------------------------------------------------------

TEST_F(Obj, ComplaintsNameTheLine) {
    EXPECT_EQ(complaint("a.obj", kTriangle + "f 1 2 4\n"),
              "line 4: \"4\": there is no such vertex (the file has 3 v lines)");
    EXPECT_EQ(complaint("a.obj", kTriangle + "f 0 2 3\n"),
              "line 4: \"0\": there is no such vertex (the file has 3 v lines; OBJ counts from 1)");
    EXPECT_EQ(complaint("a.obj", kTriangle + "f -4 2 3\n"),
              "line 4: \"-4\": there is no such vertex (the file has 3 v lines)");
    EXPECT_EQ(complaint("a.obj", kTriangle + "\nf 1/1 2 3\n"),
              "line 5: \"1/1\": there is no such texture coordinate (the file has 0 vt lines)");
    EXPECT_EQ(complaint("a.obj", kTriangle + "f 1//1 2 3\nvn 0 0 1\nf 1//2 2 3\n"),
              "line 6: \"1//2\": there is no such normal (the file has 1 vn lines)");
    EXPECT_EQ(complaint("a.obj", kTriangle + "f 1 2 99999999999999999999\n"),
              "line 4: \"99999999999999999999\": there is no such vertex (the file has 3 v lines)");
    EXPECT_EQ(complaint("a.obj", kTriangle + "f 1 2 x\n"),
              "line 4: \"x\" is no corner of a face: v, v/vt, v//vn or v/vt/vn");
    EXPECT_EQ(complaint("a.obj", kTriangle + "f 1/2/3/4 2 3\n"),
              "line 4: \"1/2/3/4\" is no corner of a face: v, v/vt, v//vn or v/vt/vn");
    EXPECT_EQ(complaint("a.obj", kTriangle + "f\n"), "line 4: a face without corners");
    EXPECT_EQ(complaint("a.obj", "v 0 0\n"), "line 1: z of a vertex is missing");
    EXPECT_EQ(complaint("a.obj", "\n\nv 0 1,5 0\n"), "line 3: y of a vertex: \"1,5\" is no number");
    EXPECT_EQ(complaint("a.obj", "v 0 nan 0\n"), "line 1: y is not a number");
    EXPECT_EQ(complaint("a.obj", "v 0 0 -inf\n"), "line 1: z is -inf: beyond 1e+18");
    EXPECT_EQ(complaint("a.obj", "v 1e400 0 0\n"), "line 1: x is inf: beyond 1e+18");
}

TEST_F(Obj, FilesWithoutFacesAreRefused) {
    EXPECT_EQ(complaint("a.obj", kTriangle), "has 3 vertices but no faces: nothing to show");
    EXPECT_EQ(complaint("a.obj", kTriangle + "f 1 2\nf 1\n"),
              "line 4: a face with fewer than 3 corners, and there is no other face");
    EXPECT_EQ(complaint("a.obj", "hello\nworld\n"),
              "line 1: \"hello\" is no OBJ keyword, and no face follows");
    EXPECT_EQ(complaint("a.obj", std::string_view("\xff\xfev\0 \0", 6)),
              "byte 0: UTF-16 text is not read: save it as UTF-8");
}

TEST_F(Obj, NumbersTooSmallForADoubleAreZero) {
    const LoadedScene loaded = load("a.obj", "v 1e-400 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(corner(loaded.scene, 0, 0, 0).x, 0.0);
}

TEST_F(Obj, NamesThatAreNoUtf8AreTakenForLatin1) {
    const LoadedScene loaded = load(
        "a.obj", kTriangle + "o T\xfcr\nf 1 2 3\no T\xc3\xbcr\nf 1 2 3\no bell\x07\nf 1 2 3\n");
    EXPECT_THAT(object_names(loaded.scene), ElementsAre("T\xc3\xbcr", "T\xc3\xbcr#2", "bell?"));
}

TEST_F(Obj, StopsWhenAskedTo) {
    std::stop_source source;
    source.request_stop();
    LoadOptions options;
    options.stop = source.get_token();
    EXPECT_THROW(load("a.obj", kTriangle + "f 1 2 3\n", options), Cancelled);
}

TEST_F(Obj, IdsGoOnFromTheSessions) {
    LoadOptions options;
    options.first_object_id = 40;
    const LoadedScene loaded = load("a.obj", kTriangle + "g a\nf 1 2 3\ng b\nf 1 2 3\n", options);
    EXPECT_EQ(loaded.scene.objects[0].id, 40u);
    EXPECT_EQ(loaded.scene.objects[1].id, 41u);
    EXPECT_EQ(loaded.scene.next_object_id, 42u);
}

TEST_F(Obj, BrokenFilesNeverCrash) {
    write("m.mtl", "newmtl a\nKd 1 0 0\n");
    expect_no_crash("a.obj", "mtllib m.mtl\n" + kTriangle +
                                 "v 1 1 0\nvt 0 1\nvn 0 0 1\no a\nusemtl a\nf 1/1/1 2//1 -2\n"
                                 "f 1 2 4 3 \\\n 2\n");
}

}  // namespace
}  // namespace raypick
