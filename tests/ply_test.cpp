// PLY files: ascii and binary, both byte orders, polygons, strips and complaints.
#include "model_files.h"

#include <gmock/gmock.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>

namespace raypick {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Ply : public ModelFiles {};

// Bytes of binary files, in either order.
class Bytes {
public:
    explicit Bytes(bool big_endian) : big_(big_endian) {}

    template <typename T>
    Bytes& add(T value) {
        auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
        if (big_) std::reverse(raw.begin(), raw.end());
        text_.append(raw.data(), raw.size());
        return *this;
    }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    bool big_;
    std::string text_;
};

std::string header(const std::string& format, int vertices, int faces) {
    return fmt::format(
        "ply\nformat {} 1.0\ncomment made by hand\nelement vertex {}\nproperty float x\n"
        "property float y\nproperty float z\nelement face {}\n"
        "property list uchar int vertex_indices\nend_header\n",
        format, vertices, faces);
}

const std::string kSquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST_F(Ply, ReadsAscii) {
    const LoadedScene loaded =
        load("my square.ply", header("ascii", 4, 2) + kSquare + "3 0 1 2\n3 0 2 3\n");
    EXPECT_THAT(loaded.warnings, IsEmpty());
    EXPECT_THAT(object_names(loaded.scene), ElementsAre("my square"));
    ASSERT_EQ(placed_triangles(loaded.scene), 2u);
    EXPECT_EQ(corner(loaded.scene, 0, 1, 2), glm::dvec3(0, 1, 0));
}

TEST_F(Ply, ReadsPolygons) {
    const LoadedScene loaded =
        load("a.ply", header("ascii", 4, 3) + kSquare + "4 0 1 2 3\n5 0 1 2 3 3\n2 0 1\n");
    EXPECT_EQ(placed_triangles(loaded.scene), 5u);
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_THAT(loaded.warnings[0], HasSubstr("1 faces with fewer than 3 corners"));
}

TEST_F(Ply, ReadsBothByteOrdersAndAllTypes) {
    for (const bool big : {false, true}) {
        SCOPED_TRACE(big);
        std::string text = fmt::format(
            "ply\r\nformat binary_{}_endian 1.0\r\nobj_info x\r\nelement edge 1\r\n"
            "property int32 vertex1\r\nproperty list uint8 float64 weights\r\nelement vertex 3\r\n"
            "property uchar red\r\nproperty double x\r\nproperty int16 y\r\nproperty uint8 z\r\n"
            "property list ushort int8 extra\r\nproperty float32 nx\r\nproperty float ny\r\n"
            "property float nz\r\nproperty float s\r\nproperty float t\r\nelement face 1\r\n"
            "property uint flags\r\nproperty list uint16 uint32 vertex_index\r\n"
            "property char after\r\nend_header\r\n",
            big ? "big" : "little");
        Bytes bytes(big);
        bytes.add(std::int32_t{7}).add(std::uint8_t{2}).add(1.0).add(2.0);
        for (int i = 0; i < 3; ++i) {
            bytes.add(std::uint8_t{255}).add(0.5 * i).add(static_cast<std::int16_t>(-300 * i * i));
            bytes.add(static_cast<std::uint8_t>(200 + i));
            bytes.add(static_cast<std::uint16_t>(i));
            for (int k = 0; k < i; ++k)
                bytes.add(std::int8_t{-1});
            bytes.add(0.0f).add(0.0f).add(-2.0f).add(0.25f).add(0.75f);
        }
        bytes.add(std::uint32_t{1}).add(std::uint16_t{3});
        bytes.add(std::uint32_t{2}).add(std::uint32_t{0}).add(std::uint32_t{1});
        bytes.add(std::int8_t{0});
        const LoadedScene loaded = load("a.ply", text + bytes.text());
        EXPECT_EQ(corner(loaded.scene, 0, 0, 0), glm::dvec3(1, -1200, 202));
        EXPECT_EQ(corner(loaded.scene, 0, 0, 2), glm::dvec3(0.5, -300, 201));
        const Mesh& mesh = mesh_of(loaded.scene);
        EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, -1));
        EXPECT_EQ(mesh.uvs[0], glm::vec2(0.25f, 0.75f));
    }
}

TEST_F(Ply, ReadsTriangleStrips) {
    const LoadedScene loaded = load("a.ply",
                                    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                                    "property float y\nproperty float z\nelement tristrips 1\n"
                                    "property list int int vertex_indices\nend_header\n"
                                    "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 1 2\n");
    const Scene& scene = loaded.scene;
    ASSERT_EQ(placed_triangles(scene), 3u);
    for (std::size_t t = 0; t < 3; ++t) {
        const glm::dvec3 a = corner(scene, 0, t, 0);
        EXPECT_GT(glm::cross(corner(scene, 0, t, 1) - a, corner(scene, 0, t, 2) - a).z, 0.0) << t;
    }
}

TEST_F(Ply, BadNormalsAreReplacedByTheFaces) {
    const LoadedScene loaded =
        load("a.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
             "property float y\nproperty float z\nproperty float nx\nproperty float ny\n"
             "property float nz\nelement face 1\nproperty list uchar int vertex_indices\n"
             "end_header\n0 0 0 0 0 0\n1 0 0 nan 0 0\n0 1 0 5 0 0\n3 0 1 2\n");
    const Mesh& mesh = mesh_of(loaded.scene);
    EXPECT_EQ(mesh.normals[mesh.triangles[0].x], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[mesh.triangles[0].y], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[mesh.triangles[0].z], glm::vec3(1, 0, 0));
}

TEST_F(Ply, SubMillimetreDetailSurvivesFarFromTheOrigin) {
    std::string text = header("ascii", 3, 1);
    text.replace(text.find("float x"), 5, "double");
    const LoadedScene loaded =
        load("a.ply", text +
                          "4999500.0001 4999500 100\n5000500 4999500.0002 100\n"
                          "4999500 5000500.0003 100.0004\n3 0 1 2\n");
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 0).x, 4999500.0001, 5e-5);
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 1).y, 4999500.0002, 5e-5);
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 2).y, 5000500.0003, 5e-5);
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 2).z, 100.0004, 5e-5);
}

TEST_F(Ply, ReadsAsciiWithoutALastLineEndAndWithBlankLines) {
    EXPECT_EQ(placed_triangles(
                  load("a.ply", header("ascii", 4, 1) + "\n\n" + kSquare + "\n3 0 1 2").scene),
              1u);
}

TEST_F(Ply, ComplaintsNameTheLine) {
    const std::string text = header("ascii", 4, 1);  // 10 lines
    EXPECT_EQ(complaint("a.ply", text + "0 0 0\n1 0\n1 1 0\n0 1 0\n3 0 1 2\n"),
              "line 12: a value is missing");
    EXPECT_EQ(complaint("a.ply", text + "0 0 0\n1 x 0\n1 1 0\n0 1 0\n3 0 1 2\n"),
              "line 12: a value: \"x\" is no number");
    EXPECT_EQ(complaint("a.ply", text + "0 0 0\n1 0 inf\n1 1 0\n0 1 0\n3 0 1 2\n"),
              "line 12: vertex 1: z is inf: beyond 1e+18");
    EXPECT_EQ(complaint("a.ply", text + kSquare + "3 0 1 4\n"),
              "line 15: there is no vertex 4 (the file has 4, counted from 0)");
    EXPECT_EQ(complaint("a.ply", text + kSquare + "3 0 1 -1\n"),
              "line 15: there is no vertex -1 (the file has 4, counted from 0)");
    EXPECT_EQ(complaint("a.ply", text + kSquare + "3 0 1 0.5\n"),
              "line 15: there is no vertex 0.5 (the file has 4, counted from 0)");
    EXPECT_EQ(complaint("a.ply", text + kSquare + "-3 0 1 2\n"),
              "line 15: the list \"vertex_indices\" has the length -3");
    EXPECT_EQ(complaint("a.ply", text + kSquare + "99 0 1 2\n"),
              "line 15: the list \"vertex_indices\" has the length 99, but only 7 bytes follow");
    EXPECT_EQ(complaint("a.ply", text + kSquare + "\n"), "line 16: a value is missing");
    EXPECT_EQ(complaint("a.ply", text + kSquare),
              "line 8: the header promises 1 elements \"face\", but only 0 bytes follow");
}

TEST_F(Ply, ComplaintsAboutTheHeaderNameTheLine) {
    const std::string vertices = "property float x\nproperty float y\nproperty float z\n";
    EXPECT_EQ(complaint("a.ply", "ply\nformat binary 1.0\nend_header\n"),
              "line 2: \"binary\" is no PLY format: ascii, binary_little_endian or "
              "binary_big_endian");
    EXPECT_EQ(complaint("a.ply", "ply\nformat ascii 1.0\nelement vertex many\n"),
              "line 3: the number of elements \"vertex\" is \"many\": not a count");
    EXPECT_EQ(complaint("a.ply", "ply\nproperty float x\n"),
              "line 2: a property before the first element");
    EXPECT_EQ(complaint("a.ply", "ply\nelement vertex 1\nproperty real x\n"),
              "line 3: \"real\" is no PLY type");
    EXPECT_EQ(complaint("a.ply", "ply\nelement face 1\nproperty list float int a\n"),
              "line 3: the length of a list must have an integer type");
    EXPECT_THAT(complaint("a.ply", "ply\nformat ascii 1.0\n"), HasSubstr("no end_header"));
    EXPECT_THAT(complaint("a.ply", "ply\nend_header\n"), HasSubstr("no format line"));
    EXPECT_EQ(complaint("a.ply",
                        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                        "end_header\n0\n"),
              "line 3: the vertices have no x, y and z");
    EXPECT_EQ(complaint("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + vertices +
                                     "element face 1\nproperty int vertex_indices\nend_header\n"
                                     "0 0 0\n1\n"),
              "line 7: the elements \"face\" have no list vertex_indices");
    EXPECT_EQ(complaint("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + vertices +
                                     "end_header\n0 0 0\n"),
              "has 1 vertices but no faces: nothing to show");
}

TEST_F(Ply, PromisesThatTheFileCannotKeepCostNoMemory) {
    for (const char* format : {"ascii", "binary_little_endian"}) {
        std::string text = header(format, 4, 1);
        text.replace(text.find("vertex 4"), 8, "vertex 4000000000");
        EXPECT_EQ(complaint("a.ply", text + "0 0 0\n"),
                  "line 4: the header promises 4000000000 elements \"vertex\", but only 6 bytes "
                  "follow");
    }
    // Elements without properties take no bytes: any number is there.
    std::string text = header("ascii", 4, 1);
    text.insert(text.find("element vertex"), "element nothing 1000000000\n");
    EXPECT_EQ(placed_triangles(load("a.ply", text + kSquare + "3 0 1 2\n").scene), 1u);
}

TEST_F(Ply, ComplaintsAboutBinaryFilesNameTheByte) {
    const std::string text = header("binary_little_endian", 3, 2);
    Bytes bytes(false);
    for (int i = 0; i < 9; ++i)
        bytes.add(static_cast<float>(i * i));
    const std::size_t faces = text.size() + bytes.text().size();
    Bytes good = bytes;
    for (int face = 0; face < 2; ++face)
        good.add(std::uint8_t{3}).add(0).add(1).add(2);
    EXPECT_EQ(complaint("a.ply", text + good.text()), "");
    EXPECT_EQ(complaint("a.ply", text + good.text().substr(0, good.text().size() - 3)),
              fmt::format("byte {}: the list \"vertex_indices\" has the length 3, but only 9 bytes "
                          "follow",
                          faces + 13));
    Bytes bad = bytes;
    bad.add(std::uint8_t{3}).add(0).add(1).add(3).add(std::uint8_t{3}).add(0).add(1).add(2);
    EXPECT_EQ(complaint("a.ply", text + bad.text()),
              fmt::format("byte {}: there is no vertex 3 (the file has 3, counted from 0)", faces));
}

TEST_F(Ply, BrokenFilesNeverCrash) {
    expect_no_crash("a.ply", header("ascii", 4, 2) + kSquare + "4 0 1 2 3\n3 0 2 3\n");
    Bytes bytes(true);
    for (int i = 0; i < 12; ++i)
        bytes.add(static_cast<float>(i * i));
    bytes.add(std::uint8_t{4}).add(0).add(1).add(2).add(3);
    expect_no_crash("b.ply", header("binary_big_endian", 4, 1) + bytes.text());
}

}  // namespace
}  // namespace raypick
