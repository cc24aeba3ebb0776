// The view on the screen: what is shown, and that a pick sees the same.
#include "gl_fixture.h"
#include "tracer/io/load.h"
#include "viewer/app/scene_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <thread>

namespace raypick {
namespace {

constexpr ImageSize kSize{181, 297};

class SceneViewTest : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        if (!context_) return;
        accel_ = open("default.json");
        view_ = std::make_unique<SceneView>();
        show(accel_);
    }
    void show(const std::shared_ptr<const Accel>& accel) {
        show_without_trees(accel->shared_scene());
        view_->set_accel(accel);
    }
    void show_without_trees(const std::shared_ptr<const Scene>& scene) {
        view_->set_scene(scene, scene_bounds(*scene), choose_camera(*scene, kSize, {}));
    }
    static std::shared_ptr<const Accel> open(const std::string& name) {
        return std::make_shared<const Accel>(
            std::make_shared<const Scene>(load_scene(asset(name)).scene));
    }
    // Prepares frames until the condition holds.
    template <typename Condition>
    bool prepare_until(const RenderSettings* trace, Condition condition) {
        for (int i = 0; i < 12000; ++i) {
            view_->prepare(kSize, trace);
            if (condition()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return false;
    }
    [[nodiscard]] bool in_state(PreviewStatus::State state) const {
        return view_->trace_status().state == state;
    }
    [[nodiscard]] bool traced() const { return view_->shown() && view_->shown()->traced; }
    // Every pixel's pick is the object that the shown picture has there.
    void expect_picks_match(const Image& picture) {
        std::mt19937 random(3);
        int objects = 0;
        for (int i = 0; i < 3000; ++i) {
            const Pixel pixel{static_cast<int>(random() % kSize.rows),
                              static_cast<int>(random() % kSize.cols)};
            const std::optional<PixelPick> pick = view_->pick(pixel);
            ASSERT_TRUE(pick.has_value());
            const ObjectId shown = picture.object[kSize.index(pixel)];
            ASSERT_EQ(pick->pick ? pick->pick->hit.object : kNoObject, shown)
                << pixel.row << ", " << pixel.col;
            if (shown != kNoObject) ++objects;
        }
        EXPECT_GT(objects, 1000);
    }

    RenderSettings settings_;
    std::shared_ptr<const Accel> accel_;
    std::unique_ptr<SceneView> view_;
};

TEST_F(SceneViewTest, ShowsNothingBeforeItIsPrepared) {
    EXPECT_EQ(view_->shown(), std::nullopt);
    EXPECT_EQ(view_->pick({0, 0}), std::nullopt);
    view_->prepare({0, 0}, nullptr);
    EXPECT_EQ(view_->shown(), std::nullopt);
    view_->prepare(kSize, nullptr);
    ASSERT_TRUE(view_->shown().has_value());
    EXPECT_EQ(view_->pick({kSize.rows, 0}), std::nullopt);
}

TEST_F(SceneViewTest, TracedPicksAreWhatTheFinishedPictureShows) {
    ASSERT_TRUE(
        prepare_until(&settings_, [&] { return in_state(PreviewStatus::State::finished); }));
    view_->prepare(kSize, &settings_);  // it may have finished since the last one
    ASSERT_TRUE(traced());
    expect_picks_match(view_->picture());
}

TEST_F(SceneViewTest, TracedPicksAreWhatTheCoarsePictureShows) {
    settings_.threads = 1;
    settings_.depth = 24;  // slow enough to be caught in the middle
    settings_.cutoff = 0.0f;
    ASSERT_TRUE(prepare_until(&settings_, [&] { return traced(); }));
    view_->cancel_trace();
    ASSERT_TRUE(
        prepare_until(&settings_, [&] { return in_state(PreviewStatus::State::cancelled); }));
    ASSERT_LT(view_->trace_status().progress.fraction, 1.0) << "not caught in the middle";
    expect_picks_match(view_->picture());
}

TEST_F(SceneViewTest, APickUsesTheShownCameraNotTheNextOne) {
    view_->prepare(kSize, nullptr);
    const Pixel pixel{90, 140};
    const auto before = view_->pick(pixel);
    view_->camera().orbit(0.8, 0.1);
    const auto still = view_->pick(pixel);
    ASSERT_TRUE(before->pick && still->pick);
    EXPECT_EQ(before->pick->hit, still->pick->hit);
    view_->prepare(kSize, nullptr);
    const auto after = view_->pick(pixel);
    EXPECT_FALSE(after->pick && after->pick->hit == before->pick->hit);
}

TEST_F(SceneViewTest, AMovingCameraIsTracedToo) {
    // Each frame asks for another view; traced pictures come nevertheless, each of its own camera.
    int pictures = 0;
    std::optional<Camera> last;
    for (int i = 0; i < 4000 && pictures < 5; ++i) {
        view_->camera().orbit(0.002, 0.0);
        view_->prepare(kSize, &settings_);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        if (!traced() || last == view_->shown()->camera) continue;
        last = view_->shown()->camera;
        ++pictures;
    }
    EXPECT_EQ(pictures, 5);
    ASSERT_TRUE(
        prepare_until(&settings_, [&] { return in_state(PreviewStatus::State::finished); }));
    EXPECT_EQ(view_->shown()->camera, view_->camera().camera());
}

TEST_F(SceneViewTest, CancellingOnTheWayToAnotherViewDoesNotTraceThatOne) {
    settings_.depth = 24;
    settings_.cutoff = 0.0f;
    ASSERT_TRUE(prepare_until(&settings_, [&] { return traced(); }));
    view_->camera().orbit(0.5, 0.0);
    view_->cancel_trace();
    ASSERT_TRUE(
        prepare_until(&settings_, [&] { return in_state(PreviewStatus::State::cancelled); }));
    for (int i = 0; i < 20; ++i)
        view_->prepare(kSize, &settings_);
    EXPECT_TRUE(in_state(PreviewStatus::State::cancelled));
    EXPECT_EQ(view_->shown()->camera, view_->camera().camera()) << "the picture of another view";
    view_->camera().orbit(0.1, 0.0);
    EXPECT_TRUE(prepare_until(&settings_, [&] { return traced(); })) << "moving starts it again";
}

TEST_F(SceneViewTest, EditedSettingsStartAgain) {
    ASSERT_TRUE(
        prepare_until(&settings_, [&] { return in_state(PreviewStatus::State::finished); }));
    const Image deep = view_->picture();
    settings_.depth = 1;
    view_->prepare(kSize, &settings_);
    // It may have ended by now: that it ran again shows in the picture.
    ASSERT_TRUE(
        prepare_until(&settings_, [&] { return in_state(PreviewStatus::State::finished); }));
    EXPECT_NE(view_->picture().colour, deep.colour);
}

TEST_F(SceneViewTest, SwitchingOffShowsOpenGlAgainAtOnce) {
    ASSERT_TRUE(prepare_until(&settings_, [&] { return traced(); }));
    view_->prepare(kSize, nullptr);
    EXPECT_FALSE(traced());
    EXPECT_TRUE(in_state(PreviewStatus::State::off));
    EXPECT_TRUE(prepare_until(nullptr, [&] { return !view_->busy(); }));
}

TEST_F(SceneViewTest, ABadCameraIsAMessageNotACrash) {
    Camera bad;
    bad.at = bad.eye;
    Preview preview;
    preview.want({accel_, bad, kSize, settings_});
    EXPECT_EQ(preview.status().state, PreviewStatus::State::failed);
    EXPECT_NE(preview.status().error, "");
    preview.want({accel_, choose_camera(accel_->scene(), kSize, {}), kSize, settings_});
    EXPECT_THAT(preview.status().state,
                testing::AnyOf(PreviewStatus::State::tracing, PreviewStatus::State::finished));
}

TEST_F(SceneViewTest, AnotherSceneReplacesPictureAndPicks) {
    ASSERT_TRUE(prepare_until(&settings_, [&] { return traced(); }));
    const auto other = open("triangle.json");
    show(other);
    EXPECT_EQ(view_->shown(), std::nullopt);
    view_->prepare(kSize, nullptr);
    EXPECT_EQ(view_->shown()->scene, other->shared_scene());
}

TEST_F(SceneViewTest, OpenGlNeedsNoTree) {
    view_->prepare(kSize, nullptr);
    const Image wanted = view_->picture();
    show_without_trees(accel_->shared_scene());
    view_->prepare(kSize, &settings_);
    ASSERT_TRUE(view_->shown().has_value());
    EXPECT_FALSE(traced());
    EXPECT_TRUE(in_state(PreviewStatus::State::off)) << "rays wait for the tree";
    EXPECT_EQ(view_->picture().colour, wanted.colour);
    EXPECT_EQ(view_->picture().object, wanted.object);
    view_->zoom(1.0, std::nullopt);  // without knowing what is there
    view_->prepare(kSize, &settings_);
    EXPECT_NE(view_->picture().object, wanted.object);
    view_->set_accel(accel_);
    EXPECT_TRUE(prepare_until(&settings_, [&] { return traced(); }));
}

TEST_F(SceneViewTest, AQuestionIsAnsweredLaterAsItWouldHaveBeenAtOnce) {
    view_->prepare(kSize, nullptr);
    const Pixel pixel{90, 140};
    const auto wanted = view_->pick(pixel);
    ASSERT_TRUE(wanted && wanted->pick);
    show_without_trees(accel_->shared_scene());
    EXPECT_FALSE(view_->question(pixel).has_value()) << "nothing is shown yet";
    view_->prepare(kSize, nullptr);
    const std::optional<PickQuestion> question = view_->question(pixel);
    ASSERT_TRUE(question.has_value());
    EXPECT_FALSE(view_->answer(*question).has_value());
    EXPECT_FALSE(view_->pick(pixel).has_value());
    view_->camera().orbit(0.8, 0.1);
    view_->prepare(kSize, nullptr);
    view_->set_accel(accel_);
    const auto answer = view_->answer(*question);
    ASSERT_TRUE(answer && answer->pick);
    EXPECT_EQ(answer->pixel, wanted->pixel);
    EXPECT_EQ(answer->pick->hit, wanted->pick->hit);
    EXPECT_EQ(answer->pick->point, wanted->pick->point);
    // What was asked of one scene is not answered from another.
    show(open("triangle.json"));
    EXPECT_FALSE(view_->answer(*question).has_value());
}

TEST_F(SceneViewTest, BetterTreesReplaceTheFirstOnesWithoutAHitch) {
    const BuildOptions soon{.quality = TreeQuality::first};
    const auto first = std::make_shared<const Accel>(accel_->shared_scene(), soon);
    view_->set_accel(first);
    settings_.threads = 1;
    settings_.depth = 24;  // slow enough to be caught in the middle
    settings_.cutoff = 0.0f;
    ASSERT_TRUE(prepare_until(&settings_, [&] { return traced(); }));
    const std::uint64_t rays = view_->trace_status().progress.rays.eye;
    view_->set_accel(accel_);
    view_->prepare(kSize, &settings_);
    EXPECT_TRUE(traced()) << "the picture stays";
    EXPECT_GE(view_->trace_status().progress.rays.eye, rays) << "it was begun again";
    ASSERT_TRUE(
        prepare_until(&settings_, [&] { return in_state(PreviewStatus::State::finished); }));
    const Image picture = view_->picture();
    view_->prepare(kSize, nullptr);
    ASSERT_TRUE(
        prepare_until(&settings_, [&] { return in_state(PreviewStatus::State::finished); }));
    EXPECT_EQ(view_->picture().colour, picture.colour);
    EXPECT_EQ(view_->picture().object, picture.object);
}

TEST_F(SceneViewTest, ZoomingInGoesToTheObjectUnderTheCursor) {
    view_->prepare(kSize, nullptr);
    const Pixel pixel{90, 140};
    const auto before = view_->pick(pixel);
    ASSERT_TRUE(before->pick.has_value());
    for (int i = 0; i < 8; ++i) {
        view_->zoom(1.0, pixel_centre(pixel));
        view_->prepare(kSize, nullptr);
    }
    const auto after = view_->pick(pixel);
    ASSERT_TRUE(after->pick.has_value());
    EXPECT_EQ(after->pick->object, before->pick->object);
    EXPECT_LT(after->pick->hit.t, 0.5f * before->pick->hit.t);
    EXPECT_LT(glm::distance(after->pick->point, before->pick->point), 0.01 * before->pick->hit.t);
}

TEST_F(SceneViewTest, FramingBringsObjectsToTheMiddle) {
    view_->prepare(kSize, nullptr);
    const Object* knot = nullptr;
    for (const Object& object : accel_->scene().objects) {
        if (object.name == "golden knot") knot = &object;
    }
    ASSERT_NE(knot, nullptr);
    const ObjectId ids[] = {knot->id};
    view_->frame_objects(ids, {0.0, 0.0, 0.0});
    const glm::dvec3 centre(object_bounds(accel_->scene(), *knot).centre());
    const auto at = project(view_->camera().camera(), kSize, centre);
    ASSERT_TRUE(at.has_value());
    EXPECT_NEAR(at->r, 0.5 * kSize.rows, 0.1 * kSize.rows);
    EXPECT_NEAR(at->c, 0.5 * kSize.cols, 0.1 * kSize.cols);
}

}  // namespace
}  // namespace raypick
