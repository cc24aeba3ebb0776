// `raypick render` as a shell runs it.
#include "command_fixture.h"

#include <csignal>

namespace raypick {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class RenderCommand : public CommandTest {};

TEST_F(RenderCommand, RenderWritesPngAndExr) {
    const std::string png = (folder_ / "a.png").string();
    const std::string exr = (folder_ / "a.EXR").string();
    EXPECT_EQ(run_program(render({"--resolution=64,48", "--output=" + png})).exit_code, 0);
    EXPECT_EQ(run_program(render({"--resolution=64,48", "--output=" + exr})).exit_code, 0);
    const std::string bytes = read_file(png);
    EXPECT_THAT(bytes, StartsWith("\x89PNG\r\n\x1a\n"));
    EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\0\x40\0\0\0\x30", 8)) << "64 x 48";
    EXPECT_THAT(read_file(exr), StartsWith("\x76\x2f\x31\x01"));
    EXPECT_THAT(folder_.names(), ElementsAre("a.EXR", "a.png", "squares.obj"));
}

TEST_F(RenderCommand, RenderWritesPngToStandardOutput) {
    const ProgramResult result = run_program(render({"--resolution=64,48", "--output=-"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, StartsWith("\x89PNG\r\n\x1a\n"));
    EXPECT_THAT(result.err, IsEmpty());
    const std::string png = (folder_ / "a.png").string();
    run_program(render({"--resolution=64,48", "--output=" + png}));
    EXPECT_EQ(read_file(png), result.out);
}

TEST_F(RenderCommand, StatsAreOneJsonObjectWithTheDocumentedKeys) {
    const ProgramResult result = run_program(
        render({"--resolution=64,48", "--output=" + (folder_ / "a.png").string(), "--stats=json"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    ASSERT_EQ(line_count(result.out), 1u);
    const json stats = json::parse(result.out);
    for (const char* key : {"load", "build", "trace"}) {
        EXPECT_TRUE(stats["seconds"][key].is_number()) << key;
        EXPECT_GE(stats["seconds"][key].get<double>(), 0.0) << key;
    }
    for (const char* key :
         {"eye", "eye_hits", "reflection", "refraction", "shadow", "shadow_blocked"}) {
        EXPECT_TRUE(stats["rays"][key].is_number_unsigned()) << key;
    }
    EXPECT_EQ(stats["rays"]["eye"], 64 * 48);
    EXPECT_GT(stats["rays"]["eye_hits"].get<int>(), 0);
    EXPECT_EQ(stats["objects"], 2);
    EXPECT_EQ(stats["triangles"], 4);
    EXPECT_EQ(stats["primitives"], 4);
    for (const auto& [key, value] : stats["memory_bytes"].items()) {
        EXPECT_TRUE(value.is_number_unsigned()) << key;
    }
    EXPECT_EQ(stats["memory_bytes"]["image"], 12 * 64 * 48) << "a PNG shows the colour alone";
    EXPECT_GT(stats["memory_bytes"]["peak"].get<double>(), 1e6);
}

TEST_F(RenderCommand, SamplingIsWhatTheOptionsSay) {
    const std::string output = "--output=" + (folder_ / "a.png").string();
    const auto stats = [&](const std::vector<std::string>& options) {
        std::vector<std::string> words = {"--resolution=20,10", output, "--stats=json"};
        words.insert(words.end(), options.begin(), options.end());
        return json::parse(run_program(render(words)).out);
    };
    EXPECT_EQ(stats({})["rays"]["eye"], 200);
    EXPECT_EQ(stats({"--sampling=corners"})["rays"]["eye"], 21 * 11);
    EXPECT_EQ(stats({"--samples=3"})["rays"]["eye"], 9 * 200);
    EXPECT_EQ(stats({"--filter=tent"})["rays"]["eye"], 16 * 200);
    EXPECT_EQ(stats({"--aperture=0.1", "--samples=2"})["rays"]["eye"], 4 * 200);
    const int adaptive = stats({"--contrast=0.1", "--samples=2"})["rays"]["eye"].get<int>();
    EXPECT_GT(adaptive, 200);
    EXPECT_LT(adaptive, 5 * 200);
    EXPECT_EQ(stats({})["nan_pixels"], 0);
    const json by_depth = stats({"--depth=3"})["rays"]["by_depth"];
    for (const char* kind : {"reflection", "refraction", "shadow"})
        EXPECT_EQ(by_depth[kind].size(), 3u) << kind;
}

TEST_F(RenderCommand, ShadowsCanBeLeftOut) {
    const std::string output = "--output=" + (folder_ / "a.png").string();
    const auto stats = [&](const std::string& option) {
        return json::parse(
            run_program(render({"--resolution=64,48", output, "--stats=json", option})).out);
    };
    EXPECT_GT(stats("--threads=1")["rays"]["shadow"].get<int>(), 0);
    EXPECT_EQ(stats("--no-shadows")["rays"]["shadow"], 0);
}

TEST_F(RenderCommand, TheImageDoesNotDependOnTheNumberOfThreads) {
    const auto image = [&](const std::string& threads) {
        return run_program(render({"--resolution=150,101", "--output=-", threads})).out;
    };
    const std::string one = image("--threads=1");
    EXPECT_FALSE(one.empty());
    EXPECT_EQ(one, image("--threads=3"));
    EXPECT_EQ(one, image("--threads=0"));
}

TEST_F(RenderCommand, AnImageThatNoMemoryHoldsIsRefused) {
    expect_refusal(run_program(render({"--resolution=65535,65535", "--output=-"})), 1, "memory");
}

// Found before the file is even read.
TEST_F(RenderCommand, AnOutputThatCanNotBeWrittenIsFoundFirst) {
    std::filesystem::create_directory(folder_ / "folder.png");
    for (const std::string& output :
         {(folder_ / "nowhere" / "a.png").string(), (folder_ / "folder.png").string(),
          std::string("/proc/a.png")}) {
        SCOPED_TRACE(output);
        expect_refusal(run_program({"render", "missing.obj", "--output=" + output}), 1, output);
    }
}

TEST_F(RenderCommand, AnInterruptedRenderWritesNothing) {
    for (const int signal : {SIGINT, SIGTERM}) {
        RunningProgram program(render({"--resolution=4096,2048", "--threads=1", "--verbose",
                                       "--output=" + (folder_ / "a.png").string()}),
                               {});
        ASSERT_TRUE(program.wait_for_error_text("built the tree"));
        program.send(signal);
        const ProgramResult result = program.wait();
        EXPECT_EQ(result.exit_code, 128 + signal) << result.err;
        EXPECT_THAT(folder_.names(), ElementsAre("squares.obj"));
    }
}

}  // namespace
}  // namespace raypick
