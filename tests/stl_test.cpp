// STL files: ascii with any number of solids, binary, and which is which.
#include "model_files.h"

#include <gmock/gmock.h>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>

namespace raypick {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Stl : public ModelFiles {};

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
    return fmt::format(
        "facet normal 0 0 1\n outer loop\n  vertex {}\n  vertex {}\n  vertex {}\n endloop\n"
        "endfacet\n",
        a, b, c);
}

const std::string kFacet = facet("0 0 0", "1 0 0", "0 1 0");

std::string binary(std::string header, const std::vector<float>& coordinates) {
    header.resize(80, ' ');
    const auto add = [&](auto value) {
        const auto raw = std::bit_cast<std::array<char, sizeof(value)>>(value);
        header.append(raw.data(), raw.size());
    };
    add(static_cast<std::uint32_t>(coordinates.size() / 9));
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        if (i % 9 == 0) {
            for (int k = 0; k < 3; ++k)
                add(0.0f);
        }
        add(coordinates[i]);
        if (i % 9 == 8) add(std::uint16_t{0});
    }
    return header;
}

const std::vector<float> kTwoFacets = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

TEST_F(Stl, SolidsAreObjects) {
    const LoadedScene loaded =
        load("parts.stl", "solid left  hand\n" + kFacet + "endsolid left  hand\nsolid\n" + kFacet +
                              kFacet + "endsolid\nsolid empty\nendsolid empty\nSOLID left  hand\n" +
                              kFacet + "ENDSOLID\n");
    EXPECT_THAT(loaded.warnings, IsEmpty());
    EXPECT_THAT(object_names(loaded.scene), ElementsAre("left  hand", "parts", "left  hand#2"));
    EXPECT_EQ(loaded.scene.objects[1].path, "/parts");
    EXPECT_EQ(primitive_count(loaded.scene, loaded.scene.objects[1]), 2u);
}

TEST_F(Stl, ReadsBinary) {
    const LoadedScene loaded = load("two.stl", binary("made by hand", kTwoFacets));
    EXPECT_THAT(object_names(loaded.scene), ElementsAre("two"));
    ASSERT_EQ(placed_triangles(loaded.scene), 2u);
    EXPECT_EQ(corner(loaded.scene, 0, 1, 1), glm::dvec3(1, 1, 0));
    // Welded: the two triangles share two vertices.
    EXPECT_EQ(mesh_of(loaded.scene).positions.size(), 4u);
}

TEST_F(Stl, BinaryMayBeginWithSolid) {
    EXPECT_EQ(placed_triangles(load("a.stl", binary("solid facet", kTwoFacets)).scene), 2u);
    // Also with bytes after the last facet, which hide the size that tells.
    const LoadedScene loaded =
        load("a.stl", binary("solid facet", kTwoFacets) + std::string("\0\0\0", 3));
    EXPECT_EQ(placed_triangles(loaded.scene), 2u);
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_THAT(loaded.warnings[0], HasSubstr("byte 184: 3 bytes after the last facet"));
}

TEST_F(Stl, NormalsComeFromTheOrderOfTheCorners) {
    std::string text = "solid\n" + kFacet + "endsolid\n";
    text.replace(text.find("0 0 1"), 5, "1 0 0");
    const LoadedScene loaded = load("a.stl", text);
    EXPECT_EQ(mesh_of(loaded.scene).normals[0], glm::vec3(0, 0, 1));
}

TEST_F(Stl, SubMillimetreDetailSurvivesFarFromTheOrigin) {
    const LoadedScene loaded =
        load("a.stl", "solid\n" +
                          facet("4999500.0001 4999500 100", "5000500 4999500.0002 100",
                                "4999500 5000500.0003 100.0004") +
                          "endsolid\n");
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 0).x, 4999500.0001, 5e-5);
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 1).y, 4999500.0002, 5e-5);
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 2).y, 5000500.0003, 5e-5);
    EXPECT_NEAR(corner(loaded.scene, 0, 0, 2).z, 100.0004, 5e-5);
}

TEST_F(Stl, ComplaintsNameTheLine) {
    EXPECT_EQ(complaint("a.stl", "solid\n" + facet("0 0 0", "1 x 0", "0 1 0")),
              "line 5: a coordinate: \"x\" is no number");
    EXPECT_EQ(complaint("a.stl", "solid\n" + facet("0 0 0", "1 0", "0 1 0")),
              "line 5: a coordinate is missing");
    EXPECT_EQ(complaint("a.stl", "solid\n" + facet("0 0 0", "1 0 nan", "0 1 0")),
              "line 5: z is not a number");
    EXPECT_EQ(complaint("a.stl", "solid\n" + kFacet), "line 9: the file ends before endsolid");
    EXPECT_EQ(complaint("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n"),
              "line 5: \"endloop\" where vertex should stand");
    EXPECT_EQ(complaint("a.stl", "solid\nfacet normal 0 0 1\nouter"),
              "line 3: the file ends where loop should stand");
    EXPECT_EQ(complaint("a.stl", "solid\n" + kFacet + "endsolid\n" + kFacet),
              "line 10: facet outside of a solid");
    EXPECT_EQ(complaint("a.stl", "solid a\nsolid b\n"),
              "line 2: solid before the endsolid of the one before");
    EXPECT_EQ(complaint("a.stl", "solid a\nface\n"),
              "line 2: \"face\" where solid, facet or endsolid should stand");
    EXPECT_EQ(complaint("a.stl", "solid a\nendsolid a\n"), "has no facets: nothing to show");
}

TEST_F(Stl, ComplaintsAboutBinaryFilesNameTheByte) {
    const std::string text = binary("made by hand", kTwoFacets);
    EXPECT_EQ(complaint("a.stl", text.substr(0, 150)),
              "byte 80: promises 2 facets (184 bytes), but the file has 150 bytes");
    EXPECT_EQ(complaint("a.stl", text.substr(0, 50)),
              "byte 50: the file ends in the header of a binary STL, which is 84 bytes long");
    std::vector<float> bad = kTwoFacets;
    bad[13] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(complaint("a.stl", binary("", bad)), "byte 158: y is not a number");
    std::string huge = text;
    huge.replace(80, 4, "\xff\xff\xff\xff");
    EXPECT_EQ(complaint("a.stl", huge),
              "byte 80: promises 4294967295 facets (214748364834 bytes), but the file has 184 "
              "bytes");
    EXPECT_EQ(complaint("a.stl", binary("nothing", {})), "has no facets: nothing to show");
}

TEST_F(Stl, BrokenFilesNeverCrash) {
    expect_no_crash("a.stl",
                    "solid a\n" + kFacet + "endsolid a\nsolid b\n" + kFacet + "endsolid\n");
    expect_no_crash("b.stl", binary("solid", kTwoFacets));
}

}  // namespace
}  // namespace raypick
