// OBJ files read in pieces: nothing may tell where one piece ends and the next one begins.
#include "model_files.h"
#include "tracer/error.h"
#include "tracer/io/obj_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

namespace raypick {
namespace {

struct Parsed {
    ObjFile obj;
    std::vector<std::string> warnings;
    std::string error;
};

Parsed parse(const std::filesystem::path& file, std::size_t chunk_bytes) {
    Parsed parsed;
    try {
        parsed.obj = parse_obj(file, {}, parsed.warnings, chunk_bytes);
    } catch (const FileError& error) {
        parsed.error = error.what();
    }
    return parsed;
}

using Numbers = std::vector<std::array<std::uint32_t, 4>>;

Numbers numbers(const std::vector<ObjCorner>& corners) {
    Numbers numbers;
    for (const ObjCorner& c : corners)
        numbers.push_back({c.position, c.uv, c.normal, 0});
    return numbers;
}

Numbers numbers(const std::vector<ObjRun>& runs) {
    Numbers numbers;
    for (const ObjRun& run : runs) {
        numbers.push_back({run.first_face, static_cast<std::uint32_t>(run.object),
                           static_cast<std::uint32_t>(run.group),
                           static_cast<std::uint32_t>(run.material)});
    }
    return numbers;
}

void expect_same(const Parsed& a, const Parsed& b, std::size_t chunk_bytes) {
    SCOPED_TRACE(chunk_bytes);
    EXPECT_EQ(a.error, b.error);
    EXPECT_EQ(a.warnings, b.warnings);
    EXPECT_EQ(a.obj.positions, b.obj.positions);
    EXPECT_EQ(a.obj.uvs, b.obj.uvs);
    EXPECT_EQ(a.obj.normals, b.obj.normals);
    EXPECT_EQ(numbers(a.obj.corners), numbers(b.obj.corners));
    EXPECT_EQ(a.obj.face_begin, b.obj.face_begin);
    EXPECT_EQ(numbers(a.obj.runs), numbers(b.obj.runs));
    EXPECT_EQ(a.obj.objects, b.obj.objects);
    EXPECT_EQ(a.obj.groups, b.obj.groups);
    EXPECT_EQ(a.obj.materials, b.obj.materials);
    EXPECT_EQ(a.obj.libraries, b.obj.libraries);
}

constexpr std::size_t kWhole = std::size_t{1} << 30u;

class ObjChunks : public ModelFiles {
protected:
    // Every border between lines comes to be one between pieces. Returns what was read.
    Parsed same_in_all_pieces(const std::string& text) {
        const std::filesystem::path file = write("pieces.obj", text);
        const Parsed whole = parse(file, kWhole);
        for (std::size_t bytes = 1; bytes < 2 * text.size(); bytes += 1 + bytes / 16)
            expect_same(parse(file, bytes), whole, bytes);
        return whole;
    }
};

// All that depends on lines further up.
const std::string kEverything =
    "# made by hand\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nvt 0.5 1\n  v 0 1 0 \nvn 0 0 1\nf 1 2 3\n"
    "f -3 -2 -1\no one\nf 1/1/1 2/1/1 3/-1/-1\nv 1 \\\n 2 \\\r\n 3\nf 9 1 2\ng left right\n"
    "f 1 2 -1\nusemtl red\nf 1 2 3 4\no two\\\nf 1 2 3\ng default\nusemtl blue\nusemtl red\n"
    "\tv 7 8 9 1.0\r\nf 1 2 -1\ng left right\nf 1 2 3\nl 1 2\ns off\nvt 3.1+e2\n# tail \\\n"
    "v 4 5 6\nv 4 5 7\nv 4 5 8\nv 4 5 9\np 1\nf 1 2\ncurv 1 2\nbevel on\nsurf 3\nshadow_obj x\n"
    "f 1 2 3\no two\nusemtl red\ng left right\nf -1 -2 -3\nmtllib b.mtl\nf 1//1 2//1 3//1";

TEST_F(ObjChunks, PiecesSayTheSameAsTheWhole) {
    const Parsed whole = same_in_all_pieces(kEverything);
    EXPECT_EQ(whole.error, "");
    EXPECT_EQ(whole.warnings.size(), 5u);
    EXPECT_EQ(whole.obj.face_count(), 12u);
    EXPECT_EQ(whole.obj.positions.size(), 9u);
}

TEST_F(ObjChunks, AKeywordSplitOverLinesIsCountedByTheParser) {
    // What seems to be three v lines is one; what seems none is one.
    const Parsed whole = same_in_all_pieces(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\n# a\nv 1 1 1 \\\nv 2 \\\nv 3\nv\\\n 5 5 5\nf 1 2 -1\n"
        "f 1 2 5\nf 1 2 3\n# the end\n");
    EXPECT_EQ(whole.error, "");
    EXPECT_EQ(whole.obj.positions.size(), 5u);
}

TEST_F(ObjChunks, ComplaintsAreTheSame) {
    const std::string begin = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n# more\n\n";
    for (const std::string wrong :
         {"v 1 2\n", "v 1 2 x\n", "f 1 2 z\n", "f 1 2 77\n", "f 1 2 -4\n", "f 0 1 2\n", "f\n",
          "vt a\n", "vn 1 2\n", "v nan 0 0\n", "f 1/2/3/4 2 3\n"}) {
        const Parsed whole = same_in_all_pieces(begin + wrong + "f 3 2 1\nf 99 1 2\nv 1\n# tail\n");
        EXPECT_NE(whole.error, "") << wrong;
    }
    EXPECT_THAT(same_in_all_pieces("v 1 2 3\nv 2 3 4\n# none\nbevel\n# x\nf 1 2\n").error,
                testing::HasSubstr("line 4"));
    EXPECT_THAT(same_in_all_pieces("f 1 2 5\nv 1 2 3\nf 6 1 2\nv 3 4 5\n\n\nf 1 2 6\n").error,
                testing::HasSubstr("line 3"));
}

TEST_F(ObjChunks, ALargeFileIsReadInPieces) {
    std::string text;
    for (int i = 0; i < 60'000; ++i) {
        text += fmt::format("v {} {}.25 {}\n", i, i % 7, -i);
        if (i % 1000 == 0) text += fmt::format("g group {}\nusemtl m{}\n", i % 5, i % 3);
        if (i > 2) text += i % 2 == 0 ? "f -1 -2 -3\n" : fmt::format("f 1 {} {}\n", i, i + 1);
    }
    ASSERT_GT(text.size(), 3 * kObjChunkBytes);
    const std::filesystem::path file = write("large.obj", text);
    const Parsed whole = parse(file, kWhole);
    EXPECT_EQ(whole.obj.face_count(), 59'997u);
    expect_same(parse(file, kObjChunkBytes), whole, kObjChunkBytes);
    expect_same(parse(file, 10'000), whole, 10'000);
}

TEST_F(ObjChunks, CanBeCancelled) {
    std::string text;
    for (int i = 0; i < 60'000; ++i)
        text += fmt::format("v {} 0 0\n", i);
    const std::filesystem::path file = write("cancelled.obj", text + "f 1 2 3\n");
    std::stop_source stop;
    stop.request_stop();
    LoadOptions options;
    options.stop = stop.get_token();
    std::vector<std::string> warnings;
    EXPECT_THROW(parse_obj(file, options, warnings, 100'000), Cancelled);
}

}  // namespace
}  // namespace raypick
