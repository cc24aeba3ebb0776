// The real program, headless, on small files that the tests write.
#include "command_fixture.h"
#include "sanitized.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <fstream>

namespace raypick {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

TEST_F(CommandTest, HelpAndVersionGoToStandardOutput) {
    const std::vector<std::vector<std::string>> questions = {
        {"--help"},         {"-h"},           {"--version"},     {"view", "--help"},
        {"pick", "--help"}, {"render", "-h"}, {"info", "--help"}};
    for (const auto& words : questions) {
        const ProgramResult result = run_program(words);
        EXPECT_EQ(result.exit_code, 0) << words[0];
        EXPECT_THAT(result.out, Not(IsEmpty())) << words[0];
        EXPECT_THAT(result.err, IsEmpty()) << words[0];
    }
    EXPECT_THAT(run_program({"--version"}).out, StartsWith("raypick "));
    EXPECT_THAT(run_program({"pick", "--help"}).out, HasSubstr("--pixel=ROW,COL"));
}

struct WrongUse {
    const char* command;
    std::vector<std::string> words;  // after the file's name
    const char* named;               // what the message must name
};

TEST_F(CommandTest, WrongUsageNamesTheOptionAndExitsWith2) {
    const std::vector<WrongUse> cases = {
        {"pick", {}, "--pixel"},
        {"pick", {"--pixel=1,1"}, "--resolution"},
        {"pick", {"--pixel=-"}, "--resolution"},
        {"pick", {"--resolution=10,10", "--pixel=10,0"}, "row 10, column 0 is outside"},
        {"pick", {"--resolution=10,10", "--pixel=-1,0"}, "outside"},
        {"pick", {"--resolution=20,10", "--pixel=10,15"}, "outside the image of 10 rows"},
        {"pick", {"--resolution=10,10", "--pixel=1.0,1"}, "--pixel"},
        {"pick", {"--resolution=10,10", "--pixel=1,1x"}, "--pixel"},
        {"pick", {"--resolution=10,10", "--pixel= 1,1"}, "--pixel"},
        {"pick", {"--resolution=10,10", "--pixel=1"}, "--pixel"},
        {"pick", {"--resolution=10,10", "--pixel=1,2,3"}, "--pixel"},
        {"pick", {"--resolution=10,10", "--pixel=1,"}, "--pixel"},
        {"pick", {"--resolution=10,10", "--pixel="}, "--pixel"},
        {"pick", {"--resolution=10,10", "--pixel=99999999999,1"}, "--pixel"},
        {"pick", {"--resolution=10,10", "--pixel=1,1", "2,2"}, "2,2"},
        {"pick", {"--resolution=10,10", "--pixel=-", "--ray=-"}, "standard input"},
        {"pick", {"--resolution=10x10", "--pixel=1,1"}, "--resolution"},
        {"pick", {"--resolution=0,10", "--pixel=1,1"}, "--resolution"},
        {"pick", {"--resolution=10,-10", "--pixel=1,1"}, "--resolution"},
        {"pick", {"--resolution=1000000,1", "--pixel=1,1"}, "--resolution"},
        {"pick", {"--ray=0,0,5,0,0"}, "--ray"},
        {"pick", {"--ray=0,0,5,0,0,0"}, "--ray"},
        {"pick", {"--ray=0,0,5,0,0,nan"}, "--ray"},
        {"pick", {"--ray=0,0,1e39,0,0,1"}, "--ray"},
        {"pick", {"--ray=0,0,5,0,0,-1", "--eye=1,2"}, "--eye"},
        {"pick", {"--ray=0,0,5,0,0,-1", "--eye=1,2,inf"}, "--eye"},
        {"pick", {"--ray=0,0,5,0,0,-1", "--fovy=180"}, "--fovy"},
        {"pick", {"--ray=0,0,5,0,0,-1", "--fovy=0"}, "--fovy"},
        {"pick", {"--ray=0,0,5,0,0,-1", "--up=0,0,0"}, "--up"},
        {"pick", {"--ray=0,0,5,0,0,-1", "--crease=-1"}, "--crease"},
        {"pick", {"--resolution=9,9", "--pixel=1,1", "--eye=1,1,1", "--look-at=1,1,1"}, "--eye"},
        {"pick", {"--bogus"}, "--bogus"},
        {"render", {}, "--output"},
        {"render", {"--output=x.jpg"}, "--output=x.jpg"},
        {"render", {"--output=x"}, "--output=x"},
        {"render", {"--output=-", "--stats=json"}, "standard output"},
        {"render", {"--output=-", "--stats=xml"}, "--stats"},
        {"render", {"--output=-", "--depth=0"}, "--depth"},
        {"render", {"--output=-", "--depth=many"}, "--depth"},
        {"render", {"--output=-", "--threads=-1"}, "--threads"},
        {"render", {"--output=-", "--sampling=grid"}, "--sampling"},
        {"render", {"--output=-", "--samples=0"}, "--samples"},
        {"render", {"--output=-", "--samples=65"}, "--samples"},
        {"render", {"--output=-", "--raster", "--samples=4"}, "--samples: is for traced images"},
        {"render", {"--output=-", "--raster", "--depth=3"}, "--depth: is for traced images"},
        {"render", {"--output=-", "--raster", "--seed=3"}, "--seed: is for traced images"},
        {"render", {"--output=-", "--samples=2", "--sampling=centre"}, "--samples"},
        {"render", {"--output=-", "--filter=tent", "--sampling=corners"}, "--filter"},
        {"render", {"--output=-", "--filter=blur"}, "box|tent|gaussian|mitchell"},
        {"render", {"--output=-", "--contrast=1.5"}, "--contrast"},
        {"render", {"--output=-", "--contrast=0.1", "--sampling=stratified"}, "--contrast"},
        {"render", {"--output=-", "--aperture=-1"}, "--aperture"},
        {"render", {"--output=-", "--aperture=1", "--sampling=centre"}, "--aperture"},
        {"render", {"--output=-", "--focus-distance=2"}, "--focus-distance"},
        {"render", {"--output=-", "--seed=-1"}, "--seed"},
        {"render", {"--output=-", "--cutoff=2"}, "--cutoff"},
        {"render", {"--output=-", "--cutoff=0.1", "--no-cutoff"}, "--cutoff"},
        {"render", {"--output=-", "--glass-shadows=grey"}, "--glass-shadows"},
        {"render", {"--output=-", "--orthographic=0"}, "--orthographic"},
        {"render", {"--output=-", "--orthographic=wide"}, "--orthographic"},
        {"pick", {"--ray=0,0,5,0,0,-1", "--orthographic=-2"}, "--orthographic"},
        {"info", {"--json=maybe"}, "--json"},
        {"info", {"another.obj"}, "another.obj"},
        {"view", {"another.obj"}, "another.obj"},
        {"view", {"--ui-scale=big"}, "--ui-scale"},
    };
    for (const WrongUse& wrong : cases) {
        std::vector<std::string> words = {wrong.command, squares_.string()};
        words.insert(words.end(), wrong.words.begin(), wrong.words.end());
        SCOPED_TRACE(testing::PrintToString(words));
        expect_refusal(run_program(words), 2, wrong.named);
    }
    EXPECT_THAT(folder_.names(), ElementsAre("squares.obj"));
}

TEST_F(CommandTest, ACommandWithoutAFileIsWrongUsage) {
    for (const char* name : {"pick", "render", "info"}) {
        SCOPED_TRACE(name);
        expect_refusal(run_program({name}), 2, "FILE");
    }
}

TEST_F(CommandTest, WithoutADisplayTheWindowSaysWhatElseThereIs) {
    for (const auto& words : std::vector<std::vector<std::string>>{
             {squares_.string()}, {"view", squares_.string()}, {}}) {
        SCOPED_TRACE(testing::PrintToString(words));
        const ProgramResult result = run_program(words);
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_THAT(result.err, HasSubstr("raypick pick"));
        EXPECT_THAT(result.err, HasSubstr("raypick render"));
        EXPECT_EQ(line_count(result.err), 1u) << result.err;
    }
}

TEST_F(CommandTest, AMistypedCommandIsAFileThatIsNotThere) {
    const ProgramResult result = run_program({"rendr"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err, "raypick: rendr: no such file\n");
}

TEST_F(CommandTest, PickAnswersEachPixelInOrder) {
    const ProgramResult result = run_program(
        pick({"--resolution=101,101", "--pixel=50,50", "--pixel=50,24", "--pixel", "0,0"}));
    EXPECT_EQ(result.exit_code, 0) << "hitting nothing is an answer; " << result.err;
    const auto lines = json_lines(result.out);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0]["object"], "near");
    EXPECT_EQ(lines[0]["row"], 50);
    EXPECT_EQ(lines[0]["col"], 50);
    EXPECT_NEAR(lines[0]["t"].get<double>(), 5.0, 1e-5);
    EXPECT_EQ(lines[0]["front_face"], true);
    EXPECT_EQ(lines[1]["object"], "far");
    EXPECT_EQ(lines[2], json::parse(R"({"row":0,"col":0,"hit":false})"));
}

TEST_F(CommandTest, PickPrintsTheDocumentedKeys) {
    const ProgramResult result = run_program(pick({"--resolution=101,101", "--pixel=50,50"}));
    const auto line = nlohmann::ordered_json::parse(result.out);
    std::vector<std::string> keys;
    for (const auto& [key, value] : line.items())
        keys.push_back(key);
    EXPECT_THAT(keys, ElementsAre("row", "col", "hit", "object", "object_id", "primitive", "t",
                                  "point", "normal", "uv", "front_face", "material"));
}

// Rows count from the top: a pixel in the upper half sees y > 0.
TEST_F(CommandTest, RowZeroIsTheTopRow) {
    const auto lines = json_lines(
        run_program(pick({"--resolution=151,101", "--pixel=40,75", "--pixel=50,90"})).out);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_GT(lines[0]["point"][1].get<double>(), 0.0);
    EXPECT_GT(lines[1]["point"][0].get<double>(), 0.0);
}

TEST_F(CommandTest, AllGivesEveryHit) {
    const auto lines = json_lines(
        run_program(pick({"--resolution=101,101", "--pixel=49,50", "--pixel=0,0", "--all"})).out);
    ASSERT_EQ(lines.size(), 2u);
    ASSERT_EQ(lines[0]["hits"].size(), 2u);
    EXPECT_EQ(lines[0]["hits"][0]["object"], "near");
    EXPECT_EQ(lines[0]["hits"][1]["object"], "far");
    EXPECT_EQ(lines[0]["object"], "near");
    EXPECT_EQ(lines[1]["hits"], json::array());
}

TEST_F(CommandTest, ARayOfAnyLengthPicksByDistance) {
    const auto lines =
        json_lines(run_program({"pick", squares_.string(), "--ray=0.5,0.25,5,0,0,-100", "--ray",
                                "-0.5,0.25,-5,0,0,1e-200"})
                       .out);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[0]["object"], "near");
    EXPECT_NEAR(lines[0]["t"].get<double>(), 5.0, 1e-6);
    EXPECT_EQ(lines[0]["direction"], json::parse("[0,0,-1]"));
    EXPECT_EQ(lines[1]["object"], "far");
    EXPECT_EQ(lines[1]["front_face"], false);
    EXPECT_NEAR(lines[1]["t"].get<double>(), 4.0, 1e-6);
}

TEST_F(CommandTest, AFileMayBeCalledLikeACommand) {
    const std::string file = folder_.write("pick", "not a model").string();
    expect_refusal(run_program({"info", file}), 1, file);
}

TEST_F(CommandTest, AStreamOfPixelsIsAnsweredLineByLine) {
    const ProgramResult result =
        run_program_on(pick({"--resolution=101,101", "--pixel=-"}), "50 50\n  50\t24  \r\n0 0");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto lines = json_lines(result.out);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0]["object"], "near");
    EXPECT_EQ(lines[1]["object"], "far");
    EXPECT_EQ(lines[2]["hit"], false);
}

TEST_F(CommandTest, WhatAStreamCanNotAnswerIsSaidInItsPlace) {
    const std::string long_line(100000, '9');
    const ProgramResult result = run_program_on(
        pick({"--resolution=101,101", "--pixel=-"}),
        "50 50\n101 0\nabc\n\n1 2 3\n-1 5\n1.0 2\n99999999999 1\n" + long_line + " 1\n50 24\n");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(line_count(result.err), 1u) << result.err;
    const auto lines = json_lines(result.out);
    ASSERT_EQ(lines.size(), 10u) << "one line for each line";
    EXPECT_EQ(lines[0]["object"], "near");
    EXPECT_EQ(lines[1]["row"], 101);
    EXPECT_EQ(lines[1]["col"], 0);
    EXPECT_EQ(lines[5]["row"], -1);
    for (std::size_t i = 1; i < 9; ++i) {
        EXPECT_TRUE(lines[i].contains("error")) << lines[i];
        EXPECT_EQ(lines[i]["line"], i + 1);
    }
    EXPECT_TRUE(lines[2]["row"].is_null());
    EXPECT_EQ(lines[9]["object"], "far") << "it goes on";
}

TEST_F(CommandTest, AStreamOfRays) {
    const ProgramResult result =
        run_program_on({"pick", squares_.string(), "--ray=-"},
                       "0.5 0.25 5 0 0 -1\n0 0 5 0 0 0\n0 0 5 0 0\n9 9 5 0 0 -1\n");
    EXPECT_EQ(result.exit_code, 2);
    const auto lines = json_lines(result.out);
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[0]["object"], "near");
    EXPECT_TRUE(lines[1].contains("error"));
    EXPECT_TRUE(lines[2].contains("error"));
    EXPECT_EQ(lines[3]["hit"], false);
}

// Someone who writes one line and waits for its answer must get it.
TEST_F(CommandTest, AnAnswerComesBeforeTheNextQuestion) {
    RunningProgram program(pick({"--resolution=101,101", "--pixel=-"}), {}, true);
    for (int i = 0; i < 3; ++i) {
        program.write("50 5");
        program.write("0\n");
        const auto line = program.read_line();
        ASSERT_TRUE(line) << "no answer to line " << i;
        EXPECT_EQ(json::parse(*line)["object"], "near");
    }
    EXPECT_EQ(program.wait().exit_code, 0);
}

TEST_F(CommandTest, AMillionLinesStreamInBoundedMemory) {
    std::ofstream questions(folder_ / "million");
    for (int i = 0; i < 1000000; ++i)
        questions << i / 1000 << ' ' << i % 1000 << '\n';
    questions.close();
    const ProgramResult result = run_program(pick({"--resolution=1000,1000", "--pixel=-"}),
                                             {folder_ / "million", folder_ / "answers"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    RecordProperty("seconds", std::to_string(result.seconds));
    EXPECT_LT(result.seconds, 60.0);
    if (!is_sanitized()) {
        EXPECT_LT(result.peak_bytes, std::size_t{200} << 20);
    }
    std::ifstream answers(folder_ / "answers");
    int lines = 0;
    int hits = 0;
    std::string last;
    for (std::string line; std::getline(answers, line); ++lines) {
        const std::string place = "{\"row\":" + std::to_string(lines / 1000) +
                                  ",\"col\":" + std::to_string(lines % 1000) + ",";
        ASSERT_THAT(line, StartsWith(place)) << "line " << lines;
        if (line.find("\"hit\":true") != std::string::npos) ++hits;
    }
    EXPECT_EQ(lines, 1000000);
    // The far square's half width 2 at distance 6 over the view's half width tan(30) * 6.
    EXPECT_NEAR(hits, 1e6 * 1.0 / 3.0, 5000.0);
}

TEST_F(CommandTest, AReaderThatHasEnoughEndsItQuietly) {
    std::ofstream questions(folder_ / "many");
    for (int i = 0; i < 200000; ++i)
        questions << "50 50\n";
    questions.close();
    RunningProgram program(pick({"--resolution=101,101", "--pixel=-"}), {folder_ / "many", {}});
    ASSERT_TRUE(program.read_line());
    program.close_output();
    const ProgramResult result = program.wait();
    EXPECT_THAT(result.err, IsEmpty());
    EXPECT_TRUE(result.signal == SIGPIPE || result.exit_code == 128 + SIGPIPE)
        << result.signal << ' ' << result.exit_code;
}

TEST_F(CommandTest, AFullDiskIsAnError) {
    const ProgramResult result =
        run_program(pick({"--resolution=101,101", "--pixel=50,50"}), {"/dev/null", "/dev/full"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("standard output"));
}

TEST_F(CommandTest, UnreadableFilesAreOneLineAndExit1AndWriteNothing) {
    const std::string before = "a picture from yesterday";
    const auto output = folder_.write("old.png", before);
    const std::vector<std::filesystem::path> files = {
        folder_ / "missing.obj",
        folder_.path(),
        folder_.write("empty.obj", ""),
        folder_.write("noise.ply", std::string("\x00\xff\x13 noise", 9)),
        folder_.write("cut.ply", "ply\nformat ascii 1.0\nelement vertex 3\n"),
        folder_.write("bad.json", R"({"raypick": 1, "objects": [})"),
        folder_.write("bad.gltf", "{\"asset\":"),
        folder_.write("cut.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0"),
        folder_.write("unknown.xyz", "1 2 3\n"),
        folder_.write("line\nbreak.obj", "f 1 2 3\n"),
    };
    const auto names = folder_.names();
    for (const auto& file : files) {
        SCOPED_TRACE(file);
        std::string shown = file.string();
        std::replace(shown.begin(), shown.end(), '\n', '?');
        expect_refusal(run_program({"info", file.string(), "--json"}), 1, shown);
        expect_refusal(run_program({"pick", file.string(), "--resolution=9,9", "--pixel=1,1"}), 1,
                       shown);
        expect_refusal(run_program({"render", file.string(), "--output=" + output.string()}), 1,
                       shown);
    }
    EXPECT_EQ(folder_.names(), names);
    EXPECT_EQ(read_file(output), before);
}

// At a height of 10 over 10 rows a pixel is a unit: the near square's half width of 1 and the far
// one's of 2 are seen in their true size.
TEST_F(CommandTest, PicksInAnOrthographicView) {
    const auto object = [&](const std::string& view, const std::string& pixel) {
        const auto result = run_program(pick({view, "--resolution=10,10", "--pixel=" + pixel}));
        const json line = json::parse(result.out);
        return line["hit"].get<bool>() ? line["object"].get<std::string>() : std::string();
    };
    EXPECT_EQ(object("--orthographic=10", "4,4"), "near");
    EXPECT_EQ(object("--orthographic=10", "5,5"), "near");
    EXPECT_EQ(object("--orthographic=10", "5,6"), "far");
    EXPECT_EQ(object("--orthographic=10", "3,3"), "far");
    EXPECT_EQ(object("--orthographic=10", "5,7"), "");
    EXPECT_EQ(object("--orthographic=10", "2,5"), "");
    // What is looked at keeps the size that it has at fovy 60 from a distance of 5.
    EXPECT_EQ(object("--orthographic=5.773502691896258", "3,3"), object("--orthographic", "3,3"));
}

TEST_F(CommandTest, InfoIsATableForPeople) {
    const ProgramResult result = run_program({"info", squares_.string(), "--objects"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    for (const char* part : {"objects     2", "triangles   4", "near", "far", "(-2, -2, -1) to"}) {
        EXPECT_THAT(result.out, HasSubstr(part));
    }
}

TEST_F(CommandTest, InfoIsJsonForScripts) {
    const ProgramResult result = run_program({"info", squares_.string(), "--json", "--objects"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json info = json::parse(result.out);
    EXPECT_EQ(info["objects"], 2);
    EXPECT_EQ(info["triangles"], 4);
    EXPECT_EQ(info["bounds"], json::parse(R"({"min":[-2,-2,-1],"max":[2,2,0]})"));
    EXPECT_TRUE(info["seconds"]["load"].is_number());
    EXPECT_TRUE(info["seconds"]["build"].is_number());
    EXPECT_TRUE(info["memory_bytes"]["peak"].is_number());
    for (const char* key : {"materials", "lights", "cameras"}) {
        EXPECT_TRUE(info[key].is_array()) << key;
    }
    const json& objects = info["object_list"];
    ASSERT_EQ(objects.size(), 2u);
    EXPECT_EQ(objects[0]["name"], "near");
    EXPECT_EQ(objects[0]["primitives"], 2);
    EXPECT_EQ(objects[0]["bounds"], json::parse(R"({"min":[-1,-1,0],"max":[1,1,0]})"));
    ASSERT_EQ(objects[0]["parts"].size(), 1u);
    EXPECT_EQ(objects[0]["parts"][0]["count"], 2);
    for (const char* key : {"id", "path"})
        EXPECT_TRUE(objects[0].contains(key)) << key;
    EXPECT_FALSE(json::parse(run_program({"info", squares_.string(), "--json"}).out)
                     .contains("object_list"));
}

TEST_F(CommandTest, VerboseSaysWhatItDoesWithoutTouchingTheOutput) {
    auto words = pick({"--resolution=101,101", "--pixel=50,50"});
    const std::string quiet = run_program(words).out;
    words.emplace_back("--verbose");
    const ProgramResult after = run_program(words);
    EXPECT_EQ(after.out, quiet);
    EXPECT_THAT(after.err, HasSubstr("loaded "));
    words.pop_back();
    words.insert(words.begin(), "--verbose");
    EXPECT_THAT(run_program(words).err, HasSubstr("loaded "));
}

}  // namespace
}  // namespace raypick
