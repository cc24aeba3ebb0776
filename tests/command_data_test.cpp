// The real program on real models.
#include "needs.h"
#include "program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <set>
#include <sstream>

namespace raypick {
namespace {

using nlohmann::json;

struct RealModel {
    const char* file;
    std::uint64_t triangles;  // as MODELS.md says
    std::size_t objects;      // at least
};

void PrintTo(const RealModel& model, std::ostream* out) {
    *out << model.file;
}

class RealModelTest : public testing::TestWithParam<RealModel> {};

// `ROW COL` of a grid of 24 x 24 pixels over an image of 480 x 480.
std::string pixel_grid() {
    std::ostringstream lines;
    for (int row = 10; row < 480; row += 20) {
        for (int col = 10; col < 480; col += 20)
            lines << row << ' ' << col << '\n';
    }
    return lines.str();
}

TEST_P(RealModelTest, InfoCountsItAndPicksNameItsObjects) {
    RAYPICK_REQUIRE_MODEL(GetParam().file);
    const std::string file = model(GetParam().file).string();
    const ProgramResult info_result = run_program({"info", file, "--json", "--objects"});
    ASSERT_EQ(info_result.exit_code, 0) << info_result.err;
    const json info = json::parse(info_result.out);
    EXPECT_EQ(info["triangles"], GetParam().triangles);
    EXPECT_GE(info["objects"].get<std::size_t>(), GetParam().objects);
    std::set<std::string> names;
    std::uint64_t primitives = 0;
    for (const json& object : info["object_list"]) {
        EXPECT_TRUE(names.insert(object["name"]).second) << object["name"] << " twice";
        primitives += object["primitives"].get<std::uint64_t>();
    }
    EXPECT_EQ(primitives, info["primitives"]);

    const ProgramResult picks =
        run_program_on({"pick", file, "--resolution=480,480", "--pixel=-"}, pixel_grid());
    ASSERT_EQ(picks.exit_code, 0) << picks.err;
    std::istringstream lines(picks.out);
    int hits = 0;
    int count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        const json pick = json::parse(line);
        if (!pick["hit"]) continue;
        ++hits;
        EXPECT_TRUE(names.contains(pick["object"])) << line;
    }
    EXPECT_EQ(count, 24 * 24);
    EXPECT_GT(hits, 24) << "the view shows little of it";
    std::cout << GetParam().file << ": " << hits << " of " << count << " pixels hit, load "
              << info["seconds"]["load"] << " s, build " << info["seconds"]["build"] << " s\n";
}

INSTANTIATE_TEST_SUITE_P(
    Models, RealModelTest,
    testing::Values(RealModel{"stanford/bunny_binary.ply", 69451, 1},
                    RealModel{"stanford/chinesedragon.gltf", 100960, 1},
                    RealModel{"openfoam/motorBike.obj", 331653, 60},
                    RealModel{"sweethome3d/poolTable/poolTable.obj", 57184, 1},
                    RealModel{"cura/UltimakerRobot_support.stl", 187974, 1},
                    RealModel{"bitterli/kitchen.glb", 1443517, 299},
                    RealModel{"assimp/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb",
                              121496, 10}));

TEST(RealStream, AMillionPixelsOfTheBunny) {
    RAYPICK_REQUIRE_MODEL("stanford/bunny_binary.ply");
    const TemporaryFolder folder;
    std::ofstream questions(folder / "million");
    for (int i = 0; i < 1000000; ++i)
        questions << i / 1000 << ' ' << i % 1000 << '\n';
    questions.close();
    const ProgramResult result = run_program({"pick", model("stanford/bunny_binary.ply").string(),
                                              "--resolution=1000,1000", "--pixel=-"},
                                             {folder / "million", folder / "answers"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_LT(result.seconds, 60.0);
    std::ifstream answers(folder / "answers");
    int lines = 0;
    for (std::string line; std::getline(answers, line);)
        ++lines;
    EXPECT_EQ(lines, 1000000);
    std::cout << "a million pixels of the bunny in " << result.seconds << " s, peak "
              << result.peak_bytes / 1000000 << " MB\n";
}

}  // namespace
}  // namespace raypick
