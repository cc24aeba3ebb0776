#include "picking/selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace raypick {
namespace {

PixelPick on(ObjectId object, Pixel pixel = {1, 2}) {
    Pick pick;
    pick.hit.object = object;
    pick.hit.t = 3.0f;
    return {pixel, pick};
}

const PixelPick kBackground{{5, 6}, std::nullopt};

std::vector<ObjectId> ids(const Selection& selection) {
    std::vector<ObjectId> result;
    for (const Selection::Entry& entry : selection.entries())
        result.push_back(entry.object);
    return result;
}

using testing::ElementsAre;

TEST(Selection, BeginsEmpty) {
    const Selection selection;
    EXPECT_TRUE(selection.empty());
    EXPECT_EQ(selection.primary(), nullptr);
    EXPECT_FALSE(selection.contains(0));
}

TEST(Selection, AClickSelectsJustThatObject) {
    Selection selection;
    EXPECT_TRUE(selection.click(on(7), false));
    EXPECT_TRUE(selection.click(on(9), false));
    EXPECT_THAT(ids(selection), ElementsAre(9));
    ASSERT_NE(selection.primary(), nullptr);
    EXPECT_EQ(selection.primary()->object, 9u);
}

TEST(Selection, ClickingTheSameObjectElsewhereRemembersTheNewPick) {
    Selection selection;
    selection.click(on(7, {1, 2}), false);
    EXPECT_FALSE(selection.click(on(7, {1, 2}), false)) << "nothing changed";
    EXPECT_TRUE(selection.click(on(7, {3, 4}), false));
    EXPECT_EQ(selection.primary()->pick.pixel, (Pixel{3, 4}));
}

TEST(Selection, AClickOnTheBackgroundClears) {
    Selection selection;
    selection.click(on(7), false);
    EXPECT_TRUE(selection.click(kBackground, false));
    EXPECT_TRUE(selection.empty());
    EXPECT_FALSE(selection.click(kBackground, false)) << "there was nothing to clear";
}

TEST(Selection, ShiftAddsInOrderAndTheLastIsPrimary) {
    Selection selection;
    selection.click(on(7), false);
    EXPECT_TRUE(selection.click(on(3), true));
    EXPECT_TRUE(selection.click(on(5), true));
    EXPECT_THAT(ids(selection), ElementsAre(7, 3, 5));
    EXPECT_EQ(selection.primary()->object, 5u);
    EXPECT_TRUE(selection.contains(3));
}

TEST(Selection, ShiftOnASelectedObjectRemovesIt) {
    Selection selection;
    selection.click(on(7), true);
    selection.click(on(3), true);
    EXPECT_TRUE(selection.click(on(7, {8, 8}), true));
    EXPECT_THAT(ids(selection), ElementsAre(3));
    EXPECT_FALSE(selection.contains(7));
}

TEST(Selection, ShiftOnTheBackgroundChangesNothing) {
    Selection selection;
    selection.click(on(7), false);
    EXPECT_FALSE(selection.click(kBackground, true));
    EXPECT_THAT(ids(selection), ElementsAre(7));
}

TEST(Selection, APlainClickReplacesSeveral) {
    Selection selection;
    selection.click(on(7), true);
    selection.click(on(3), true);
    EXPECT_TRUE(selection.click(on(3), false));
    EXPECT_THAT(ids(selection), ElementsAre(3));
}

}  // namespace
}  // namespace raypick
