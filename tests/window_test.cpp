// The real program in a real window (Xvfb), with real mouse and keyboard events (xdotool).
#include "desktop.h"
#include "needs.h"
#include "tracer/render/coarse_pace.h"
#include "viewer/app/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <thread>

namespace raypick {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

constexpr int kWindowWidth = 1200;
constexpr int kWindowHeight = 800;

// The outline's orange on the screen, which no scene of ours has: OutlineStyle::selected.
bool is_outline(const Desktop::Colour& c) {
    return std::abs(c.red - 255) <= 2 && std::abs(c.green - 140) <= 2 && std::abs(c.blue - 13) <= 2;
}

class WindowTest : public testing::Test {
protected:
    void SetUp() override {
        const std::string missing = missing_for_windows();
        RAYPICK_REQUIRE(missing.empty(), missing);
        desktop_.emplace();
    }

    // Opens the window and waits until it shows the file.
    void view(const std::filesystem::path& file, double ui_scale = 1.0) {
        start(file, ui_scale);
        ASSERT_TRUE(desktop_->wait_for_title("raypick - " + file.filename().string()))
            << desktop_->title();
    }
    void start(const std::filesystem::path& file, double ui_scale = 1.0,
               const std::vector<std::string>& more = {}) {
        const WindowMetrics window{kWindowWidth, kWindowHeight, kWindowWidth, kWindowHeight};
        layout_ = lay_out(window, ui_scale, true);
        ProgramFiles files;
        files.display = desktop_->display();
        files.folder = folder_.path();
        std::vector<std::string> arguments = {
            "view", file.string(), "--print-picks", "--ui-scale=" + std::to_string(ui_scale),
            "--resolution=" + std::to_string(kWindowWidth) + "," + std::to_string(kWindowHeight)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        program_.emplace(arguments, files);
    }
    // The window's size as `raypick pick` and `raypick render` take the view's.
    [[nodiscard]] std::string resolution() const {
        const ImageSize size = layout_.view.size;
        return "--resolution=" + std::to_string(size.cols) + "," + std::to_string(size.rows);
    }
    std::string line() { return program_->read_line().value_or("no line"); }
    json click(Pixel pixel, const std::string& modifier = "") {
        desktop_->click(pixel.col, pixel.row, modifier);
        return json::parse(line(), nullptr, false);
    }
    // What the command line says is there, seen with the file's own camera.
    [[nodiscard]] json pick(const std::filesystem::path& file, Pixel pixel) const {
        const ProgramResult result =
            run_program({"pick", file.string(), resolution(),
                         "--pixel=" + std::to_string(pixel.row) + "," + std::to_string(pixel.col)});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return json::parse(result.out, nullptr, false);
    }
    int quit() {
        desktop_->key("ctrl+q");
        return program_->wait().exit_code;
    }
    // Waits until that many pixels of outline are on the screen.
    [[nodiscard]] bool outline_is(bool there) const {
        for (int i = 0; i < 200; ++i) {
            if ((desktop_->count_pixels(is_outline) > 50) == there) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        return false;
    }

    TemporaryFolder folder_;
    std::optional<Desktop> desktop_;
    std::optional<RunningProgram> program_;
    Layout layout_;
    std::filesystem::path scene_ = asset("default.json");
};

TEST_F(WindowTest, AClickSaysExactlyWhatThePickCommandSays) {
    view(scene_);
    for (const Pixel pixel : {Pixel{400, 200}, Pixel{300, 600}, Pixel{550, 700}, Pixel{0, 0},
                              Pixel{layout_.view.size.rows - 1, layout_.view.size.cols - 1}}) {
        EXPECT_EQ(click(pixel), pick(scene_, pixel)) << pixel.row << ", " << pixel.col;
    }
    EXPECT_EQ(quit(), 0);
}

TEST_F(WindowTest, AClickBeforeTheTreeIsThereIsAnsweredLater) {
    RAYPICK_REQUIRE_MODEL("bitterli/kitchen.glb");
    const std::filesystem::path kitchen = model("bitterli/kitchen.glb");
    // The title comes with the first picture, and the first tree takes longer than a click.
    view(kitchen);
    const Pixel pixel{400, 450};
    desktop_->click(pixel.col, pixel.row);
    desktop_->drag(300, 300, 420, 340);  // the answer is of the picture that was clicked on
    const json answer = json::parse(line(), nullptr, false);
    EXPECT_TRUE(answer.value("hit", false));
    EXPECT_EQ(answer, pick(kitchen, pixel));
    EXPECT_EQ(quit(), 0) << "while the better tree is built";
}

TEST_F(WindowTest, AClickOutlinesAnObjectAndEscClearsIt) {
    view(scene_);
    EXPECT_TRUE(outline_is(false));
    ASSERT_TRUE(click({400, 450}).value("hit", false));
    EXPECT_TRUE(outline_is(true));
    desktop_->key("Escape");
    EXPECT_TRUE(outline_is(false));
    EXPECT_TRUE(click({400, 450}, "shift").value("hit", false));
    EXPECT_TRUE(outline_is(true));
    EXPECT_TRUE(click({400, 450}, "shift").value("hit", false)) << "Shift takes it away again";
    EXPECT_TRUE(outline_is(false));
}

TEST_F(WindowTest, ADragTurnsTheViewAndPicksNothing) {
    view(scene_);
    const Pixel middle{380, 430};
    const json before = click(middle);
    const auto screen = desktop_->screenshot();
    desktop_->drag(300, 300, 420, 340);
    // A click picks in the frame that is shown.
    ASSERT_TRUE(desktop_->wait_for_change(screen));
    const json after = click(middle);
    // The next line is this click's: the drag wrote none. The view is another one now.
    EXPECT_EQ(after.value("row", -1), middle.row);
    EXPECT_EQ(after.value("col", -1), middle.col);
    EXPECT_NE(after, before);
}

TEST_F(WindowTest, PanelsKeepTheirClicks) {
    view(scene_);
    desktop_->click(layout_.view.size.cols + 5, kWindowHeight / 2);
    desktop_->click(kWindowWidth / 4, layout_.view.size.rows + 3);
    // From the panel into the view, and back.
    desktop_->drag(layout_.view.size.cols + 5, 200, 300, 200);
    const json click_now = click({390, 431});
    EXPECT_EQ(click_now, pick(scene_, {390, 431})) << "a panel's event reached the scene";
}

TEST_F(WindowTest, WheelGoesTowardsWhatIsUnderTheCursor) {
    view(scene_);
    const Pixel pixel{420, 300};
    const json before = click(pixel);
    ASSERT_TRUE(before.value("hit", false));
    ASSERT_TRUE(outline_is(true));
    auto screen = desktop_->screenshot();
    for (int i = 0; i < 4; ++i) {
        desktop_->press(4);  // X11's wheel
        desktop_->release(4);
    }
    ASSERT_TRUE(desktop_->wait_for_change(screen));
    const json after = click(pixel);
    EXPECT_EQ(after.value("object", ""), before.value("object", "?"));
    EXPECT_LT(after.value("t", 1e9), 0.8 * before.value("t", 0.0));
    screen = desktop_->screenshot();
    desktop_->key("Home");
    ASSERT_TRUE(desktop_->wait_for_change(screen));
    EXPECT_GT(click(pixel).value("t", 1e9), after.value("t", 0.0));
}

TEST_F(WindowTest, TheTracedPreviewPicksOutlinesAndSavesWhatItShows) {
    view(scene_);
    const Pixel pixel{400, 450};
    const json before = click(pixel);
    desktop_->key("r");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - default.json - traced", 240.0));
    EXPECT_TRUE(outline_is(true)) << "on top of the traced picture, too";
    EXPECT_EQ(click(pixel), before);

    desktop_->key("ctrl+s");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - default.json - save"));
    desktop_->type("from-window.png");
    desktop_->key("Return");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - default.json - traced"));
    const std::filesystem::path saved = folder_ / "from-window.png";
    for (int i = 0; i < 600 && !std::filesystem::exists(saved); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    EXPECT_EQ(quit(), 0);
    const std::filesystem::path rendered = folder_ / "from-command.png";
    ASSERT_EQ(
        run_program({"render", scene_.string(), resolution(), "--output=" + rendered.string()})
            .exit_code,
        0);
    EXPECT_TRUE(read_file(saved) == read_file(rendered)) << "the window shows another picture";
}

TEST_F(WindowTest, TheTracedPreviewFollowsTheCamera) {
    view(scene_);
    desktop_->key("r");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - default.json - traced", 240.0));
    const json before = click({400, 450});
    const auto screen = desktop_->screenshot();
    desktop_->drag(300, 300, 420, 340);
    ASSERT_TRUE(desktop_->wait_for_change(screen));
    ASSERT_TRUE(desktop_->wait_for_title("raypick - default.json - traced", 240.0));
    EXPECT_NE(click({400, 450}), before);
    desktop_->key("r");
    EXPECT_TRUE(desktop_->wait_for_title("raypick - default.json"));
}

TEST_F(WindowTest, AFrameThatWouldTakeForEverHoldsNothingUp) {
    // Each ray in glass splits in two at every surface.
    start(asset("glass.json"), 1.0, {"--trace", "--depth=30"});
    const std::string name = "raypick - glass.json";
    ASSERT_TRUE(desktop_->wait_for_title(name + " - tracing")) << desktop_->title();
    const Pixel pixel{layout_.view.size.rows / 2, layout_.view.size.cols / 2};
    // Of the pixel whose sample is shown there, which a coarse picture's may be.
    EXPECT_NEAR(click(pixel).value("row", -100), pixel.row, CoarsePace::kCoarsest);
    desktop_->drag(300, 300, 420, 340);
    EXPECT_NEAR(click(pixel).value("row", -100), pixel.row, CoarsePace::kCoarsest);
    desktop_->key("Escape");
    ASSERT_TRUE(desktop_->wait_for_title(name + " - stopped")) << desktop_->title();
    desktop_->key("r");
    ASSERT_TRUE(desktop_->wait_for_title(name));
    desktop_->key("r");
    ASSERT_TRUE(desktop_->wait_for_title(name + " - tracing"));
    EXPECT_EQ(quit(), 0);
}

TEST_F(WindowTest, ScreenshotGoesToTheCurrentFolder) {
    view(scene_);
    desktop_->key("F12");
    for (int i = 0; i < 600 && folder_.names().empty(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    EXPECT_EQ(quit(), 0);  // not before the file is complete
    EXPECT_EQ(folder_.names(), std::vector<std::string>{"default-1.png"});
    EXPECT_THAT(read_file(folder_ / "default-1.png"), StartsWith("\x89PNG"));
}

TEST_F(WindowTest, KeyFiveShowsWhatTheOrthographicOptionShows) {
    view(scene_);
    const Pixel pixel{400, 450};
    const auto screen = desktop_->screenshot();
    desktop_->key("5");
    ASSERT_TRUE(desktop_->wait_for_change(screen));
    const json parallel = click(pixel);
    EXPECT_TRUE(outline_is(true));
    const ProgramResult command =
        run_program({"pick", scene_.string(), resolution(), "--orthographic", "--pixel=400,450"});
    EXPECT_EQ(parallel.value("object", "window"),
              json::parse(command.out, nullptr, false).value("object", "command"))
        << command.err;
}

TEST_F(WindowTest, TheSavedSceneIsWhatTheSaveCommandWrites) {
    view(scene_);
    desktop_->key("ctrl+shift+s");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - default.json - save"));
    desktop_->type("from-window.json");
    desktop_->key("Return");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - default.json"));
    EXPECT_EQ(quit(), 0);  // not before the file is complete
    const std::filesystem::path command = folder_ / "from-command.json";
    ASSERT_EQ(run_program({"save", scene_.string(), "--output=" + command.string()}).exit_code, 0);
    ASSERT_EQ(folder_.names(), (std::vector<std::string>{"from-command.json", "from-window.json"}));
    EXPECT_TRUE(read_file(folder_ / "from-window.json") == read_file(command));
}

TEST_F(WindowTest, TwiceTheScaleTakesTwiceTheSpaceAndStillPicksRight) {
    view(scene_, 2.0);
    const Layout usual = lay_out(layout_.window, 1.0, true);
    ASSERT_LT(layout_.view.size.cols, usual.view.size.cols - 100);
    // Here the view was, and the panel is now.
    desktop_->click(usual.view.size.cols - 50, 400);
    const Pixel pixel{401, 303};
    EXPECT_EQ(click(pixel), pick(scene_, pixel));
    EXPECT_EQ(quit(), 0);
}

TEST_F(WindowTest, HiddenPanelsLeaveTheWholeWindowToTheView) {
    view(scene_);
    desktop_->key("Tab");
    layout_ = lay_out(layout_.window, 1.0, false);
    // The camera stays, so only pixels that follow from the size can be compared.
    const Pixel corner{kWindowHeight - 1, kWindowWidth - 1};
    json answer;
    for (int i = 0; i < 100 && !answer.is_object(); ++i) {
        desktop_->click(corner.col, corner.row);
        const std::optional<std::string> text = program_->read_line(0.5);
        if (text) answer = json::parse(*text, nullptr, false);
    }
    EXPECT_EQ(answer.value("row", -1), corner.row);
    EXPECT_EQ(answer.value("col", -1), corner.col);
}

TEST_F(WindowTest, AFileThatCannotBeReadIsShownAndTheWindowGoesOn) {
    start(folder_ / "nothing.obj");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - error"));
    ASSERT_TRUE(desktop_->wait_for_change({}));  // until it is drawn
    const auto message = desktop_->screenshot();
    desktop_->key("Return");
    ASSERT_TRUE(desktop_->wait_for_title("raypick"));
    EXPECT_TRUE(desktop_->wait_for_change(message)) << "there was no message to go away";
    desktop_->key("ctrl+o");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - open"));
    desktop_->type(scene_.string());
    desktop_->key("Return");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - default.json"));
    const Pixel pixel{400, 450};
    const json before = click(pixel);
    EXPECT_EQ(before, pick(scene_, pixel));

    // Another bad file leaves the open scene as it is.
    const std::filesystem::path bad = folder_.write("bad.json", "{ \"version\": ");
    desktop_->key("ctrl+o");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - default.json - open"));
    desktop_->type(bad.string());
    desktop_->key("Return");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - default.json - error"));
    desktop_->click(pixel.col, pixel.row);  // beside the message: the dialog keeps it
    desktop_->key("Escape");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - default.json"));
    EXPECT_EQ(click(pixel), before);
    EXPECT_EQ(quit(), 0);
}

TEST_F(WindowTest, ObjectIdsAreNotUsedAgainForTheNextFile) {
    view(scene_);
    const Pixel pixel{400, 450};
    const json first = click(pixel);
    desktop_->key("ctrl+o");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - default.json - open"));
    desktop_->type(asset("shapes.json").string());
    desktop_->key("Return");
    ASSERT_TRUE(desktop_->wait_for_title("raypick - shapes.json"));
    const auto screen = desktop_->screenshot();
    desktop_->key("Home");
    ASSERT_TRUE(desktop_->wait_for_change(screen));
    const json second = click({layout_.view.size.rows / 2, layout_.view.size.cols / 2});
    ASSERT_TRUE(second.value("hit", false));
    EXPECT_GT(second.value("object_id", 0u), first.value("object_id", 0u));
}

// Without a display there is one message, and it comes soon.
void expect_refusal(const std::string& display, double seconds) {
    ProgramFiles files;
    files.display = display;
    const ProgramResult result = run_program({"view", asset("default.json").string()}, files);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, StartsWith("raypick: "));
    for (const char* command : {"raypick render", "raypick pick", "raypick info"}) {
        EXPECT_THAT(result.err, HasSubstr(command));
    }
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_LT(result.seconds, seconds);
}

TEST(NoWindowTest, NoDisplayNamesTheHeadlessCommands) {
    expect_refusal("", 5.0);
}

TEST(NoWindowTest, ADeadDisplayIsNoDisplay) {
    expect_refusal(":4711", 10.0);
}

TEST(NoWindowTest, ASilentDisplayIsNoDisplay) {
    // A server that takes the connection and never says a word.
    const int server = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string number = std::to_string(20000 + ::getpid() % 20000);
    const std::string name = "/tmp/.X11-unix/X" + number;
    // Linux' abstract name space, where X clients look first.
    std::memcpy(address.sun_path + 1, name.data(), name.size());
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    ASSERT_EQ(::bind(server, reinterpret_cast<const sockaddr*>(&address), length), 0);
    ASSERT_EQ(::listen(server, 5), 0);
    expect_refusal(":" + number, 30.0);
    ::close(server);
}

}  // namespace
}  // namespace raypick
