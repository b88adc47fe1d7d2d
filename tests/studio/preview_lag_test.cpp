#include <gtest/gtest.h>

#include "studio/drawing.h"

namespace livery {
namespace {

TEST(PreviewLag, PicturesOfAnotherViewAreNotShown) {
    PreviewLag lag;
    note_asked(lag, 1, StageView::preview, 0.0);
    note_asked(lag, 2, StageView::preview, 1.0);
    EXPECT_TRUE(is_of_view(lag, 1, StageView::preview));
    EXPECT_FALSE(is_of_view(lag, 2, StageView::eye)) << "the eye's view is open, not asked for yet";
    note_asked(lag, 3, StageView::eye, 2.0);
    EXPECT_FALSE(is_of_view(lag, 2, StageView::eye));
    EXPECT_TRUE(is_of_view(lag, 3, StageView::eye));
    note_asked(lag, 4, StageView::preview, 3.0);
    EXPECT_FALSE(is_of_view(lag, 2, StageView::preview)) << "what was changed since is not in it";
    EXPECT_FALSE(is_of_view(lag, 3, StageView::preview));
    EXPECT_TRUE(is_of_view(lag, 4, StageView::preview));
}

TEST(PreviewLag, IsToldFromTheFirstChangeThatAPictureLacks) {
    PreviewLag lag;
    EXPECT_FALSE(behind_since_s(lag, 0));
    note_asked(lag, 1, StageView::preview, 1.0);
    note_asked(lag, 2, StageView::preview, 1.2);
    note_asked(lag, 3, StageView::preview, 1.4);
    EXPECT_EQ(behind_since_s(lag, 0), 1.0);
    // A picture that comes while more is asked for: turning the product is never behind for long
    EXPECT_EQ(behind_since_s(lag, 2), 1.4);
    EXPECT_FALSE(behind_since_s(lag, 3));
}

TEST(PreviewLag, WhatIsHeldBackForTheMockUpCountsFromTheChange) {
    PreviewLag lag;
    note_asked(lag, 1, StageView::preview, 1.0);
    EXPECT_FALSE(behind_since_s(lag, 1));
    lag.held_since = 5.0;
    EXPECT_EQ(behind_since_s(lag, 1), 5.0);
    note_asked(lag, 2, StageView::preview, 5.3);
    EXPECT_EQ(behind_since_s(lag, 1), 5.0);
    EXPECT_FALSE(behind_since_s(lag, 2));
}

}  // namespace
}  // namespace livery
