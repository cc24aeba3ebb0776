// The real program drawing by OpenGL off screen.
#include "needs.h"
#include "program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace raypick {
namespace {

constexpr const char* kTriangle = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";
constexpr int kNoOpenGLExit = 77;

TEST(RasterCommand, DrawsWithoutADisplay) {
    const TemporaryFolder folder;
    const std::string triangle = folder.write("triangle.obj", kTriangle).string();
    const std::string png = (folder / "a.png").string();
    const ProgramResult result = run_program(
        {"render", triangle, "--raster", "--resolution=65,49", "--output=" + png, "--stats=json"});
    RAYPICK_REQUIRE(result.exit_code != kNoOpenGLExit, result.err);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string bytes = read_file(png);
    EXPECT_THAT(bytes, testing::StartsWith("\x89PNG\r\n\x1a\n"));
    EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\0\x41\0\0\0\x31", 8)) << "65 x 49";
    const auto stats = nlohmann::json::parse(result.out);
    EXPECT_GT(stats["seconds"]["raster"].get<double>(), 0.0);
    EXPECT_EQ(stats["rays"]["eye"], 0);
    EXPECT_EQ(stats["triangles"], 1);
}

TEST(RasterCommand, ThePictureIsNotEmpty) {
    const TemporaryFolder folder;
    const std::string triangle = folder.write("triangle.obj", kTriangle).string();
    const auto picture = [&](const std::string& eye) {
        return run_program({"render", triangle, "--raster", "--resolution=65,49", "--output=-",
                            "--eye=" + eye, "--look-at=0,0,0"});
    };
    const ProgramResult seen = picture("0,0,4");
    RAYPICK_REQUIRE(seen.exit_code != kNoOpenGLExit, seen.err);
    const ProgramResult edge_on = picture("0,-4,0");
    EXPECT_EQ(seen.exit_code, 0) << seen.err;
    EXPECT_EQ(edge_on.exit_code, 0) << edge_on.err;
    EXPECT_NE(seen.out, edge_on.out);
}

}  // namespace
}  // namespace raypick
