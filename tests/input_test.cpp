// Mouse and key events to what was asked for, and where things stand in the window.
#include "viewer/app/input_state.h"
#include "viewer/app/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace raypick {
namespace {

using testing::IsEmpty;

// A window of 800 x 600 units whose framebuffer is larger by these factors.
WindowMetrics metrics(double scale_x, double scale_y) {
    return {800.0, 600.0, static_cast<int>(800 * scale_x), static_cast<int>(600 * scale_y)};
}

CursorAt at(double x, double y, const WindowMetrics& window = metrics(1.0, 1.0)) {
    return {{x, y}, window};
}

// The view is the left 500 x 400 window units; a panel stands right of it.
class InputTest : public testing::Test {
protected:
    void SetUp() override { show(1.0, 1.0); }

    void show(double scale_x, double scale_y) {
        window_ = metrics(scale_x, scale_y);
        screen_.view = {{0, 0}, {static_cast<int>(400 * scale_y), static_cast<int>(500 * scale_x)}};
        screen_.ui = {{500.0, 0.0, 300.0, 600.0}, {0.0, 400.0, 800.0, 200.0}};
        input_.set_screen(screen_);
    }
    void move(double x, double y) { input_.move(at(x, y, window_)); }
    void press(double x, double y, MouseButton button = MouseButton::left, Modifiers mods = {}) {
        move(x, y);
        input_.press(button, at(x, y, window_), mods);
    }
    void release(double x, double y, MouseButton button = MouseButton::left, Modifiers mods = {}) {
        input_.release(button, at(x, y, window_), mods);
    }
    template <typename Action>
    Action only_action() {
        const std::vector<InputAction> actions = input_.take_actions();
        EXPECT_EQ(actions.size(), 1u);
        const Action* action = actions.empty() ? nullptr : std::get_if<Action>(&actions.front());
        EXPECT_NE(action, nullptr) << "another kind of action";
        return action == nullptr ? Action{} : *action;
    }

    InputState input_;
    WindowMetrics window_;
    ScreenState screen_;
};

TEST_F(InputTest, AClickNamesThePixelThatWasPressed) {
    press(120.7, 33.2);
    release(122.0, 34.0);
    const auto click = only_action<ClickAction>();
    EXPECT_EQ(click.pixel, (Pixel{33, 120}));
    EXPECT_FALSE(click.add);
}

TEST_F(InputTest, ShiftClickAdds) {
    press(10, 20, MouseButton::left, {.shift = true});
    release(10, 20, MouseButton::left, {.shift = true});
    EXPECT_TRUE(only_action<ClickAction>().add);
}

TEST_F(InputTest, ClickUsesTheScaleOfEachAxis) {
    for (const auto& [x, y] : {std::pair{1.25, 1.25}, {1.5, 1.5}, {2.0, 2.0}, {2.0, 1.5}}) {
        show(x, y);
        press(101.5, 50.5);
        release(101.5, 50.5);
        EXPECT_EQ(only_action<ClickAction>().pixel,
                  (Pixel{static_cast<int>(50.5 * y), static_cast<int>(101.5 * x)}))
            << x << " " << y;
    }
}

TEST_F(InputTest, ClickUsesTheScaleAtTheTimeOfTheEvent) {
    // The window was moved to a screen with twice the density between two clicks.
    press(100, 50);
    release(100, 50);
    window_ = metrics(2.0, 2.0);
    screen_.view.size = {800, 1000};
    input_.set_screen(screen_);
    press(100, 50);
    release(100, 50);
    const auto actions = input_.take_actions();
    ASSERT_EQ(actions.size(), 2u);
    EXPECT_EQ(std::get<ClickAction>(actions[0]).pixel, (Pixel{50, 100}));
    EXPECT_EQ(std::get<ClickAction>(actions[1]).pixel, (Pixel{100, 200}));
}

TEST_F(InputTest, ClickCountsFromTheViewsCorner) {
    screen_.view.top_left = {30, 200};
    input_.set_screen(screen_);
    press(210.5, 31.5);
    release(210.5, 31.5);
    EXPECT_EQ(only_action<ClickAction>().pixel, (Pixel{1, 10}));
    press(199.5, 31.5);  // left of the view
    release(199.5, 31.5);
    EXPECT_THAT(input_.take_actions(), IsEmpty());
}

TEST_F(InputTest, ADragIsNoClickEvenIfItComesBack) {
    press(100, 100);
    move(140, 100);
    move(100, 100);
    release(100, 100);
    const auto orbit = only_action<OrbitAction>();
    EXPECT_NEAR(orbit.right, 0.0, 1e-12);
    EXPECT_NEAR(orbit.down, 0.0, 1e-12);
}

TEST_F(InputTest, OrbitIsMeasuredInHeightsOfTheView) {
    for (const double scale : {1.0, 2.0}) {
        show(scale, scale);
        press(100, 100);
        move(150, 80);
        move(200, 60);
        release(200, 60);
        const auto orbit = only_action<OrbitAction>();
        EXPECT_NEAR(orbit.right, 100.0 / 400.0, 1e-12) << scale;
        EXPECT_NEAR(orbit.down, -40.0 / 400.0, 1e-12) << scale;
    }
}

TEST_F(InputTest, UnsteadyHandsDoNotTurnTheScene) {
    press(100, 100);
    move(102, 101);
    EXPECT_THAT(input_.take_actions(), IsEmpty());
}

TEST_F(InputTest, ShiftDragAndMiddleDragPanByFramebufferPixels) {
    show(2.0, 1.5);
    for (const auto& [button, mods] : {std::pair{MouseButton::left, Modifiers{.shift = true}},
                                       {MouseButton::middle, Modifiers{}},
                                       {MouseButton::middle, Modifiers{.alt = true}}}) {
        press(100, 100, button, mods);
        move(110, 100);
        move(110, 120);
        release(110, 120, button, mods);
        const auto pan = only_action<PanAction>();
        EXPECT_EQ(pan.from.r, 150.0);
        EXPECT_EQ(pan.from.c, 200.0);
        EXPECT_EQ(pan.to.r, 180.0);
        EXPECT_EQ(pan.to.c, 220.0);
    }
}

TEST_F(InputTest, ADragGoesOnOverAPanelAndOutsideTheWindow) {
    press(490, 100);
    move(700, 100);
    move(900, -50);
    release(900, -50);
    const auto orbit = only_action<OrbitAction>();
    EXPECT_NEAR(orbit.right, 410.0 / 400.0, 1e-12);
    EXPECT_NEAR(orbit.down, -150.0 / 400.0, 1e-12);
}

TEST_F(InputTest, APressOnAPanelStaysThePanels) {
    press(600, 100);
    EXPECT_EQ(input_.hover(), std::nullopt);
    move(100, 100);
    EXPECT_EQ(input_.hover(), std::nullopt) << "the panel's slider is being dragged";
    release(100, 100);
    EXPECT_THAT(input_.take_actions(), IsEmpty());
    EXPECT_EQ(input_.hover(), (Pixel{100, 100}));
}

TEST_F(InputTest, AnOverlayInsideTheViewTakesItsClicks) {
    screen_.ui.push_back({20.0, 20.0, 100.0, 50.0});
    input_.set_screen(screen_);
    press(50, 50);
    release(50, 50);
    EXPECT_THAT(input_.take_actions(), IsEmpty());
    press(121, 50);
    release(121, 50);
    EXPECT_EQ(only_action<ClickAction>().pixel, (Pixel{50, 121}));
}

TEST_F(InputTest, ADialogTakesMouseAndKeys) {
    screen_.modal = true;
    input_.set_screen(screen_);
    press(50, 50);
    release(50, 50);
    input_.wheel(1.0, at(50, 50));
    input_.key(Key::r, {});
    EXPECT_THAT(input_.take_actions(), IsEmpty());
    EXPECT_EQ(input_.hover(), std::nullopt);
    input_.key(Key::escape, {});
    EXPECT_EQ(only_action<Command>(), Command::escape);
    input_.key(Key::enter, {});
    EXPECT_EQ(only_action<Command>(), Command::confirm);
    input_.key(Key::q, {.control = true});
    EXPECT_EQ(only_action<Command>(), Command::quit);
}

TEST_F(InputTest, LettersTypedIntoATextFieldAreNoCommands) {
    screen_.typing = true;
    input_.set_screen(screen_);
    for (const Key key : {Key::f, Key::r, Key::h, Key::home, Key::tab, Key::enter})
        input_.key(key, {});
    EXPECT_THAT(input_.take_actions(), IsEmpty());
}

TEST_F(InputTest, WheelZoomsToTheCursor) {
    show(2.0, 2.0);
    input_.wheel(1.0, at(100.25, 60.5, window_));
    input_.wheel(0.5, at(100.25, 60.5, window_));
    const auto zoom = only_action<ZoomAction>();
    EXPECT_EQ(zoom.steps, 1.5);
    ASSERT_TRUE(zoom.at.has_value());
    EXPECT_EQ(zoom.at->r, 121.0);
    EXPECT_EQ(zoom.at->c, 200.5);
    input_.wheel(1.0, at(600, 60, window_));  // over the panel: it scrolls that
    EXPECT_THAT(input_.take_actions(), IsEmpty());
}

TEST_F(InputTest, AltRightDragMovesInAndOut) {
    press(100, 100, MouseButton::right, {.alt = true});
    move(100, 60);
    release(100, 60, MouseButton::right, {.alt = true});
    const auto zoom = only_action<ZoomAction>();
    EXPECT_GT(zoom.steps, 0.0) << "upwards is nearer";
    EXPECT_FALSE(zoom.at.has_value());
}

TEST_F(InputTest, OnlyPlainLeftClicksSelect) {
    press(50, 50, MouseButton::right);
    release(50, 50, MouseButton::right);
    press(50, 50, MouseButton::middle);
    release(50, 50, MouseButton::middle);
    press(50, 50, MouseButton::left, {.control = true});
    release(50, 50, MouseButton::left, {.control = true});
    EXPECT_THAT(input_.take_actions(), IsEmpty());
}

TEST_F(InputTest, ASecondButtonMeanwhileMakesItNoClick) {
    press(50, 50);
    press(50, 50, MouseButton::right);
    release(50, 50, MouseButton::right);
    release(50, 50);
    EXPECT_THAT(input_.take_actions(), IsEmpty());
}

TEST_F(InputTest, LosingTheFocusForgetsThePress) {
    press(50, 50);
    input_.lose_focus();
    release(50, 50);
    EXPECT_THAT(input_.take_actions(), IsEmpty());
    press(600, 50);
    input_.lose_focus();
    move(50, 50);
    EXPECT_EQ(input_.hover(), (Pixel{50, 50}));
}

TEST_F(InputTest, HoverIsThePixelUnderTheCursor) {
    EXPECT_EQ(input_.hover(), std::nullopt);
    move(7.9, 8.1);
    EXPECT_EQ(input_.hover(), (Pixel{8, 7}));
    move(500.0, 10.0);
    EXPECT_EQ(input_.hover(), std::nullopt) << "the first unit of the panel";
    move(499.9, 10.0);
    EXPECT_EQ(input_.hover(), (Pixel{10, 499}));
    move(10.0, -0.25);
    EXPECT_EQ(input_.hover(), std::nullopt);
    move(std::numeric_limits<double>::quiet_NaN(), 1.0);
    EXPECT_EQ(input_.hover(), std::nullopt);
    move(10.0, 10.0);
    input_.leave();
    EXPECT_EQ(input_.hover(), std::nullopt);
}

TEST_F(InputTest, ActionsKeepTheirOrder) {
    press(10, 10);
    release(10, 10);
    input_.wheel(1.0, at(10, 10));
    input_.key(Key::home, {});
    press(20, 20);
    release(20, 20);
    const auto actions = input_.take_actions();
    ASSERT_EQ(actions.size(), 4u);
    EXPECT_TRUE(std::holds_alternative<ClickAction>(actions[0]));
    EXPECT_TRUE(std::holds_alternative<ZoomAction>(actions[1]));
    EXPECT_EQ(std::get<Command>(actions[2]), Command::frame_all);
    EXPECT_TRUE(std::holds_alternative<ClickAction>(actions[3]));
    EXPECT_THAT(input_.take_actions(), IsEmpty());
}

TEST_F(InputTest, ADroppedFileIsOpened) {
    const std::filesystem::path files[] = {"a.obj", "b.glb"};
    input_.drop(files);
    EXPECT_EQ(only_action<OpenAction>().file, "b.glb");
    input_.drop({});
    EXPECT_THAT(input_.take_actions(), IsEmpty());
}

TEST_F(InputTest, AnEmptyWindowAsksForNothing) {
    screen_.view.size = {0, 0};
    input_.set_screen(screen_);
    const CursorAt nowhere{{10.0, 10.0}, {0.0, 0.0, 0, 0}};
    input_.move(nowhere);
    input_.press(MouseButton::left, nowhere, {});
    input_.move(at(200, 200));
    input_.release(MouseButton::left, nowhere, {});
    input_.wheel(1.0, nowhere);
    EXPECT_THAT(input_.take_actions(), IsEmpty());
}

TEST(Commands, FollowTheUsualKeys) {
    EXPECT_EQ(command_for(Key::f, {}), Command::frame_selected);
    EXPECT_EQ(command_for(Key::home, {}), Command::frame_all);
    EXPECT_EQ(command_for(Key::r, {}), Command::toggle_trace);
    EXPECT_EQ(command_for(Key::escape, {}), Command::escape);
    EXPECT_EQ(command_for(Key::f1, {}), Command::toggle_help);
    EXPECT_EQ(command_for(Key::h, {}), Command::toggle_help);
    EXPECT_EQ(command_for(Key::tab, {}), Command::toggle_panels);
    EXPECT_EQ(command_for(Key::f12, {}), Command::screenshot);
    EXPECT_EQ(command_for(Key::o, {.control = true}), Command::open);
    EXPECT_EQ(command_for(Key::s, {.control = true}), Command::save);
    EXPECT_EQ(command_for(Key::s, {.shift = true, .control = true}), Command::save_scene);
    EXPECT_EQ(command_for(Key::c, {.control = true}), Command::copy_view);
    EXPECT_EQ(command_for(Key::q, {.control = true}), Command::quit);
}

TEST(Commands, DigitsLookFromASideAndWithCtrlFromTheOther) {
    EXPECT_EQ(command_for(Key::one, {}), Command::view_front);
    EXPECT_EQ(command_for(Key::three, {}), Command::view_right);
    EXPECT_EQ(command_for(Key::seven, {}), Command::view_top);
    EXPECT_EQ(command_for(Key::one, {.control = true}), Command::view_back);
    EXPECT_EQ(command_for(Key::three, {.control = true}), Command::view_left);
    EXPECT_EQ(command_for(Key::seven, {.control = true}), Command::view_bottom);
    EXPECT_EQ(command_for(Key::five, {}), Command::toggle_projection);
    EXPECT_EQ(command_for(Key::five, {.control = true}), std::nullopt);
}

TEST(Commands, OtherCombinationsMeanNothing) {
    EXPECT_EQ(command_for(Key::q, {}), std::nullopt);
    EXPECT_EQ(command_for(Key::s, {}), std::nullopt);
    EXPECT_EQ(command_for(Key::r, {.control = true}), std::nullopt);
    EXPECT_EQ(command_for(Key::s, {.shift = true}), std::nullopt);
    EXPECT_EQ(command_for(Key::tab, {.alt = true}), std::nullopt);
    EXPECT_EQ(command_for(Key::q, {.control = true, .alt = true}), std::nullopt);
}

TEST(LayoutTest, TheViewIsWhatThePanelsLeave) {
    const Layout layout = lay_out({1280.0, 720.0, 1280, 720}, 1.0, true);
    EXPECT_EQ(layout.view.size.cols + layout.side_panel.width, 1280.0);
    EXPECT_EQ(layout.view.size.rows + layout.status_bar.height, 720.0);
    EXPECT_EQ(layout.view.top_left, (Pixel{0, 0}));
    EXPECT_GT(layout.view.size.cols, 640);
}

TEST(LayoutTest, WithoutPanelsTheViewIsTheWholeFramebuffer) {
    const Layout layout = lay_out({800.0, 600.0, 1600, 900}, 1.0, false);
    EXPECT_EQ(layout.view.size, (ImageSize{900, 1600}));
    EXPECT_FALSE(layout.side_panel.contains({799.0, 10.0}));
    EXPECT_FALSE(layout.status_bar.contains({10.0, 599.0}));
}

TEST(LayoutTest, ScalesAndUnequalAxesLeaveNoPixelThatIsBothViewAndPanel) {
    for (const double scale : {1.0, 1.25, 1.5, 2.0}) {
        const WindowMetrics window{801.0, 603.0, static_cast<int>(801 * scale),
                                   static_cast<int>(603 * scale * 1.1)};
        const Layout layout = lay_out(window, scale, true);
        const double panel_start = layout.side_panel.x * window.framebuffer_cols / 801.0;
        const double bar_start = layout.status_bar.y * window.framebuffer_rows / 603.0;
        EXPECT_LE(layout.view.size.cols, panel_start);
        EXPECT_GT(layout.view.size.cols, panel_start - 1.0);
        EXPECT_LE(layout.view.size.rows, bar_start);
        EXPECT_GT(layout.view.size.rows, bar_start - 1.0);
    }
}

TEST(LayoutTest, ANarrowWindowKeepsHalfForTheView) {
    const Layout layout = lay_out({300.0, 30.0, 300, 30}, 2.0, true);
    EXPECT_EQ(layout.view.size, (ImageSize{15, 150}));
    const Layout nothing = lay_out({0.0, 0.0, 0, 0}, 1.0, true);
    EXPECT_EQ(nothing.view.size, (ImageSize{0, 0}));
}

}  // namespace
}  // namespace raypick
