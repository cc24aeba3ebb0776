// Opening files and saving pictures beside a running window.
#include "viewer/app/document.h"
#include "needs.h"
#include "program.h"
#include "tracer/io/load.h"
#include "viewer/app/file_saver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
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

TEST_F(DocumentTest, OpensAFileThatCanBePicked) {
    opener_.open(asset("default.json"), 30.0, 100);
    ASSERT_TRUE(opener_.progress().has_value());
    EXPECT_EQ(opener_.progress()->file, asset("default.json"));
    const std::optional<OpenResult> opened = result();
    ASSERT_TRUE(opened && std::holds_alternative<Document>(*opened));
    const auto& document = std::get<Document>(*opened);
    EXPECT_EQ(document.file, asset("default.json"));
    EXPECT_FALSE(document.accel->bounds().empty());
    EXPECT_GE(document.scene().objects.front().id, 100u);
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
    const auto accel = std::make_shared<const Accel>(std::make_shared<Scene>(std::move(scene)));
    saver.save(accel, folder / "a.json");
    std::optional<SaveResult> result = wait_for([&] { return saver.take_result(); });
    ASSERT_TRUE(result.has_value());
    EXPECT_EQ(result->error, "");
    EXPECT_EQ(result->kind, SaveKind::scene);
    EXPECT_EQ(load_scene(folder / "a.json").scene.objects.at(0).name, "ball");
    saver.save(accel, folder / "no such folder" / "a.json");
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
