// `raypick save`, and `raypick info` of what it wrote, by the real program.
#include "program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace raypick {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kScene = R"({"raypick": 1,
    "materials": {"red": {"diffuse": [1, 0, 0]}},
    "lights": [{"type": "point", "position": [1, 2, 3], "attenuation": [0, 0, 1]},
               {"type": "directional", "direction": [0, -1, 0]},
               {"type": "spot", "position": [0, 3, 0], "direction": [0, -1, 0]},
               {"type": "sphere", "centre": [0, 3, 0], "radius": 0.5},
               {"type": "rectangle", "corner": [0, 3, 0], "edge_u": [1, 0, 0], "edge_v": [0, 0, 1]}],
    "objects": [
        {"type": "spheres", "name": "drops", "spheres": [[0, 0, 0, 1], [3, 0, 0, 0.5]],
         "parts": [{"first": 0, "count": 2, "material": "red"}]},
        {"type": "torus", "name": "ring", "major_radius": 2, "minor_radius": 0.3}]})";

TEST(SaveCommand, WritesWhatRendersTheSame) {
    const TemporaryFolder folder;
    const std::filesystem::path scene = folder.write("scene.json", kScene);
    const std::string saved = (folder / "saved.json").string();
    const ProgramResult result = run_program({"save", scene.string(), "--output=" + saved});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "");
    const auto picture = [&](const std::string& file) {
        const std::filesystem::path image = folder / "image.png";
        const ProgramResult rendered =
            run_program({"render", file, "--resolution=60,40", "--output=" + image.string()});
        EXPECT_EQ(rendered.exit_code, 0) << rendered.err;
        return read_file(image);
    };
    EXPECT_TRUE(picture(scene.string()) == picture(saved));
    EXPECT_THAT(folder.names(), ElementsAre("image.png", "saved.json", "scene.json"));
}

TEST(SaveCommand, InfoSaysWhatIsSaved) {
    const TemporaryFolder folder;
    const std::filesystem::path scene = folder.write("scene.json", kScene);
    const std::filesystem::path saved = folder / "saved.json";
    ASSERT_EQ(run_program({"save", scene.string(), "--output=" + saved.string()}).exit_code, 0);
    const ProgramResult result = run_program({"info", saved.string(), "--json", "--objects"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json info = json::parse(result.out);
    std::vector<std::string> types;
    for (const json& light : info["lights"])
        types.push_back(light["type"]);
    EXPECT_THAT(types, ElementsAre("point", "directional", "spot", "sphere", "rectangle"));
    EXPECT_EQ(info["object_list"][0]["parts"][0]["material"], "red");
    EXPECT_EQ(info["object_list"][0]["primitives"], 2);
    EXPECT_EQ(info["object_list"][1]["shape"], "torus");
}

TEST(SaveCommand, RefusesWhatItCannotWrite) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("scene.json", kScene).string();
    const ProgramResult no_output = run_program({"save", scene});
    EXPECT_EQ(no_output.exit_code, 2);
    EXPECT_THAT(no_output.err, HasSubstr("--output"));
    const ProgramResult wrong_ending = run_program({"save", scene, "--output=a.obj"});
    EXPECT_EQ(wrong_ending.exit_code, 2);
    EXPECT_THAT(wrong_ending.err, HasSubstr("scenes are written as .json"));
    const std::string nowhere = (folder / "no folder" / "a.json").string();
    const ProgramResult failed = run_program({"save", scene, "--output=" + nowhere});
    EXPECT_EQ(failed.exit_code, 1);
    EXPECT_THAT(failed.err, HasSubstr(nowhere + ": can't be written"));
}

}  // namespace
}  // namespace raypick
