// Opening files and saving pictures beside a running window.
#include "viewer/app/document.h"
#include "needs.h"
#include "program.h"
#include "tracer/error.h"
#include "tracer/io/load.h"
#include "viewer/app/document_trees.h"
#include "viewer/app/file_saver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <new>
#include <thread>
#include <tuple>

namespace raypick {
namespace {

using testing::HasSubstr;

template <typename Take>
auto wait_for(Take take) -> decltype(take()) {
    for (int i = 0; i < 6000; ++i) {
        if (auto result = take()) return result;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return {};
}

class DocumentTest : public testing::Test {
protected:
    std::optional<OpenResult> result() {
        return wait_for([this] { return opener_.take_result(); });
    }

    std::atomic<int> notified_ = 0;
    DocumentOpener opener_{[this] { ++notified_; }};
};

TEST_F(DocumentTest, OpensAFileThatCanBeShown) {
    opener_.open(asset("default.json"), 30.0, 100);
    ASSERT_TRUE(opener_.progress().has_value());
    EXPECT_EQ(opener_.progress()->file, asset("default.json"));
    const std::optional<OpenResult> opened = result();
    ASSERT_TRUE(opened && std::holds_alternative<Document>(*opened));
    const auto& document = std::get<Document>(*opened);
    EXPECT_EQ(document.file, asset("default.json"));
    EXPECT_FALSE(document.bounds.empty());
    EXPECT_GE(document.scene->objects.front().id, 100u);
    EXPECT_GT(document.load_seconds, 0.0);
    EXPECT_EQ(opener_.take_result(), std::nullopt) << "once";
    EXPECT_EQ(opener_.progress(), std::nullopt);
    EXPECT_EQ(notified_, 1);
}

TEST_F(DocumentTest, SaysWhyAFileCannotBeOpened) {
    const TemporaryFolder folder;
    const std::filesystem::path bad = folder.write("bad.json", "{ \"raypick\": ");
    opener_.open(bad, 30.0, 0);
    const std::optional<OpenResult> opened = result();
    ASSERT_TRUE(opened && std::holds_alternative<OpenFailure>(*opened));
    EXPECT_THAT(std::get<OpenFailure>(*opened).message, HasSubstr("bad.json"));
    EXPECT_THAT(std::get<OpenFailure>(*opened).message, HasSubstr("line"));
}

TEST_F(DocumentTest, TheLastFileAskedForIsTheOneThatOpens) {
    for (int i = 0; i < 20; ++i)
        opener_.open(asset("default.json"), 30.0, 0);
    opener_.open(asset("triangle.json"), 30.0, 0);
    const std::optional<OpenResult> opened = result();
    ASSERT_TRUE(opened && std::holds_alternative<Document>(*opened));
    EXPECT_EQ(std::get<Document>(*opened).file, asset("triangle.json"));
    EXPECT_EQ(opener_.take_result(), std::nullopt);
}

TEST_F(DocumentTest, CancellingLeavesNothingBehind) {
    opener_.open(asset("default.json"), 30.0, 0);
    opener_.cancel();
    EXPECT_EQ(opener_.progress(), std::nullopt);
    while (notified_ == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(opener_.take_result(), std::nullopt);
}

TEST_F(DocumentTest, BigFilesAreGivenUpSoon) {
    RAYPICK_REQUIRE_MODEL("bitterli/kitchen.glb");
    const auto start = std::chrono::steady_clock::now();
    {
        DocumentOpener opener([] {});
        opener.open(model("bitterli/kitchen.glb"), 30.0, 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    EXPECT_LT(taken.count(), 5.0);
}

TEST_F(DocumentTest, ASceneThatRaysCannotGoThroughIsNotOpened) {
    const TemporaryFolder folder;
    const std::filesystem::path flat = folder.write(
        "flat.json",
        R"({"raypick": 1, "objects": [{"type": "sphere", "radius": 1, "scale": [1, 0, 1]}]})");
    opener_.open(flat, 30.0, 0);
    const std::optional<OpenResult> opened = result();
    ASSERT_TRUE(opened && std::holds_alternative<OpenFailure>(*opened));
    EXPECT_THAT(std::get<OpenFailure>(*opened).message, HasSubstr("flat.json"));
}

class DocumentTreesTest : public testing::Test {
protected:
    DocumentTreesTest() {
        Scene scene;
        add_object(scene, {.name = "ball", .shape = Sphere{}});
        scene_ = std::make_shared<const Scene>(std::move(scene));
    }
    // Updates until the condition holds.
    template <typename Condition>
    bool update_until(DocumentTrees& trees, bool hold, Condition condition) {
        const auto held = [&] {
            trees.update(hold);
            return condition() ? std::optional(true) : std::nullopt;
        };
        return wait_for(held).has_value();
    }
    // Of the better trees nothing ends before this is so, unless it is cancelled.
    std::atomic<bool> go_ = false;
    std::atomic<int> begun_ = 0;
    std::atomic<int> cancelled_ = 0;
    std::shared_ptr<const Scene> scene_;
    DocumentTrees trees_{{}, [this](std::shared_ptr<const Scene> scene, const BuildOptions& how) {
                             if (how.quality == TreeQuality::many_rays) ++begun_;
                             while (how.quality == TreeQuality::many_rays && !go_) {
                                 if (how.stop.stop_requested()) {
                                     ++cancelled_;
                                     throw Cancelled();
                                 }
                                 std::this_thread::yield();
                             }
                             return std::make_shared<const Accel>(std::move(scene), how);
                         }};
    [[nodiscard]] bool has_first() const { return trees_.progress().accel != nullptr; }
    [[nodiscard]] bool has_better() const {
        return trees_.progress().quality == TreeQuality::many_rays;
    }
};

TEST_F(DocumentTreesTest, ComeOneAfterTheOther) {
    EXPECT_FALSE(trees_.update(false)) << "without a scene there is nothing to do";
    EXPECT_FALSE(trees_.building());
    trees_.set_scene(scene_);
    EXPECT_FALSE(trees_.building()) << "not before the next update";
    ASSERT_TRUE(update_until(trees_, false, [&] { return has_first(); }));
    EXPECT_FALSE(has_better());
    EXPECT_TRUE(trees_.building());
    EXPECT_FALSE(trees_.update(false)) << "once";
    const auto first = trees_.progress().accel;
    go_ = true;
    ASSERT_TRUE(update_until(trees_, false, [&] { return !trees_.building(); }));
    EXPECT_TRUE(has_better());
    EXPECT_NE(trees_.progress().accel, first);
    EXPECT_GT(trees_.progress().first_seconds, 0.0);
    EXPECT_FALSE(trees_.update(false));
    EXPECT_FALSE(trees_.building()) << "there is nothing better";
}

TEST_F(DocumentTreesTest, TheBetterOnesMakeRoomAndComeBack) {
    trees_.set_scene(scene_);
    ASSERT_TRUE(update_until(trees_, false, [&] { return has_first() && begun_ == 1; }));
    const auto first = trees_.progress().accel;
    const double first_seconds = trees_.progress().first_seconds;
    EXPECT_FALSE(trees_.update(true));
    EXPECT_FALSE(trees_.building());
    ASSERT_TRUE(wait_for([&] { return cancelled_ == 1 ? std::optional(1) : std::nullopt; }));
    EXPECT_EQ(trees_.progress().accel, first);
    go_ = true;
    ASSERT_TRUE(update_until(trees_, false, [&] { return has_better(); }));
    EXPECT_EQ(begun_, 2);
    EXPECT_EQ(trees_.progress().first_seconds, first_seconds);
}

TEST_F(DocumentTreesTest, FirstOnesAreFinishedInAnyCase) {
    trees_.set_scene(scene_);
    trees_.update(false);
    ASSERT_TRUE(update_until(trees_, true, [&] { return has_first(); }));
    EXPECT_FALSE(trees_.building()) << "but not the better ones";
}

TEST_F(DocumentTreesTest, AnotherSceneGivesTheOldOneUp) {
    trees_.set_scene(scene_);
    ASSERT_TRUE(update_until(trees_, false, [&] { return has_first() && begun_ == 1; }));
    const auto other = std::make_shared<const Scene>(*scene_);
    trees_.set_scene(other);
    EXPECT_EQ(trees_.progress().accel, nullptr);
    ASSERT_TRUE(wait_for([&] { return cancelled_ == 1 ? std::optional(1) : std::nullopt; }));
    go_ = true;
    ASSERT_TRUE(update_until(trees_, false, [&] { return has_better(); }));
    EXPECT_EQ(trees_.progress().accel->shared_scene(), other);
}

TEST_F(DocumentTreesTest, AfterAFailureNothingIsTriedAgain) {
    int tried = 0;
    DocumentTrees trees({}, [&](std::shared_ptr<const Scene> scene, const BuildOptions& how) {
        ++tried;
        if (how.quality == TreeQuality::many_rays) throw std::bad_alloc();
        return std::make_shared<const Accel>(std::move(scene), how);
    });
    trees.set_scene(scene_);
    ASSERT_TRUE(update_until(trees, false, [&] { return trees.progress().finished; }));
    EXPECT_NE(trees.progress().accel, nullptr);
    EXPECT_EQ(trees.progress().error, "not enough memory");
    for (int i = 0; i < 10; ++i)
        EXPECT_FALSE(trees.update(false));
    EXPECT_EQ(tried, 2);
}

TEST_F(DocumentTreesTest, BigTreesAreGivenUpSoon) {
    RAYPICK_REQUIRE_MODEL("bitterli/kitchen.glb");
    const auto scene =
        std::make_shared<const Scene>(load_scene(model("bitterli/kitchen.glb")).scene);
    DocumentTrees trees({});
    trees.set_scene(scene);
    ASSERT_TRUE(update_until(trees, false, [&] { return trees.progress().accel != nullptr; }));
    const auto start = std::chrono::steady_clock::now();
    trees.set_scene(scene_);
    ASSERT_TRUE(update_until(trees, false, [&] { return !trees.building(); }));
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    EXPECT_LT(taken.count(), 1.0);
}

TEST(FileSaverTest, WritesAndReportsFailure) {
    const TemporaryFolder folder;
    FileSaver saver([] {});
    const Image image = make_image({3, 5});
    saver.save(image, folder / "a.png");
    std::optional<SaveResult> result = wait_for([&] { return saver.take_result(); });
    ASSERT_TRUE(result.has_value());
    EXPECT_EQ(result->error, "");
    EXPECT_TRUE(std::filesystem::exists(folder / "a.png"));
    saver.save(image, folder / "no such folder" / "a.png");
    result = wait_for([&] { return saver.take_result(); });
    ASSERT_TRUE(result.has_value());
    EXPECT_THAT(result->error, HasSubstr("no such folder"));
    EXPECT_FALSE(saver.busy());
}

TEST(FileSaverTest, WritesScenesAndSaysWhichKindFailed) {
    const TemporaryFolder folder;
    FileSaver saver([] {});
    Scene scene;
    add_object(scene, {.name = "ball", .shape = Sphere{}});
    const auto shared = std::make_shared<const Scene>(std::move(scene));
    saver.save(shared, folder / "a.json");
    std::optional<SaveResult> result = wait_for([&] { return saver.take_result(); });
    ASSERT_TRUE(result.has_value());
    EXPECT_EQ(result->error, "");
    EXPECT_EQ(result->kind, SaveKind::scene);
    EXPECT_EQ(load_scene(folder / "a.json").scene.objects.at(0).name, "ball");
    saver.save(shared, folder / "no such folder" / "a.json");
    result = wait_for([&] { return saver.take_result(); });
    ASSERT_TRUE(result.has_value());
    EXPECT_EQ(result->kind, SaveKind::scene);
    EXPECT_THAT(result->error, HasSubstr("no such folder"));
}

TEST(FileSaverTest, ScreenshotsNeverReplaceAFile) {
    const TemporaryFolder folder;
    EXPECT_EQ(free_picture_name(folder.path(), "view"), folder / "view-1.png");
    std::ignore = folder.write("view-1.png", "");
    std::ignore = folder.write("view-2.png", "");
    EXPECT_EQ(free_picture_name(folder.path(), "view"), folder / "view-3.png");
}

}  // namespace
}  // namespace raypick
