#include "studio/actions.h"

#include <set>

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "studio/studio.h"

namespace livery {
namespace {

Document three_looks() {
    Document document;
    document.library = read_paint_library();
    for (int id = 1; id <= 3; ++id) {
        SessionLook look;
        look.id = id;
        look.look.name = "look " + std::to_string(id);
        look.look.parts = {{"*", "solid red"}};
        document.looks.push_back(look);
    }
    document.next_look_id = 4;
    return document;
}

struct Window : ::testing::Test {
    Window() { keep_shown_looks_valid(studio); }

    bool press(int key, bool ctrl = false, bool shift = false, KeyboardOwner owner = {}) {
        const Action* action = action_for({key, ctrl, shift}, owner);
        return action && run_action(*action, studio);
    }
    const Document& document() const { return studio.session.document(); }

    Studio studio{Session::unsaved(three_looks(), "a test")};
};

TEST(Actions, NamesAndKeysAreEachUsedOnce) {
    std::set<std::string> ids, keys;
    for (const Action& action : all_actions()) {
        EXPECT_TRUE(ids.insert(action.id).second) << action.id;
        EXPECT_FALSE(action.label.empty()) << action.id;
        EXPECT_TRUE(action.run) << action.id;
        for (const KeyChord& chord : action.chords) {
            const std::string name = text_of(chord) + " " + std::to_string(chord.key);
            EXPECT_TRUE(keys.insert(name).second) << action.id << " " << name;
        }
    }
}

TEST(Actions, ChordsReadAsPeopleWriteThem) {
    EXPECT_EQ(text_of(KeyChord{GLFW_KEY_Z, true, true}), "Ctrl+Shift+Z");
    EXPECT_EQ(text_of(KeyChord{GLFW_KEY_F2, false, false}), "F2");
    EXPECT_EQ(text_of(KeyChord{GLFW_KEY_SLASH, false, true}), "?");
    EXPECT_THROW(action_named("no such action"), std::invalid_argument);
}

TEST(Actions, ATextFieldKeepsItsKeysButNotBlackAndFreeze) {
    const KeyboardOwner typing{.text_field = true, .dialog = true};
    EXPECT_EQ(action_for({GLFW_KEY_B, false, false}, typing), nullptr);
    EXPECT_EQ(action_for({GLFW_KEY_Z, true, false}, typing), nullptr);
    EXPECT_EQ(action_for({GLFW_KEY_1, false, false}, typing), nullptr);
    ASSERT_NE(action_for({GLFW_KEY_B, true, false}, typing), nullptr);
    EXPECT_EQ(action_for({GLFW_KEY_B, true, false}, typing)->id, "black");
    EXPECT_EQ(action_for({GLFW_KEY_F, true, false}, typing)->id, "freeze");
}

TEST(Actions, ADialogLeavesBlackAndFreezeWithCtrlAndNoSingleLetter) {
    const KeyboardOwner dialog{.dialog = true};
    EXPECT_EQ(action_for({GLFW_KEY_B, true, false}, dialog)->id, "black");
    EXPECT_EQ(action_for({GLFW_KEY_F, true, false}, dialog)->id, "freeze");
    for (int letter = GLFW_KEY_A; letter <= GLFW_KEY_Z; ++letter) {
        EXPECT_EQ(action_for({letter, false, false}, dialog), nullptr) << letter;
    }
    EXPECT_EQ(action_for({GLFW_KEY_N, false, false}, dialog), nullptr);
    EXPECT_EQ(action_for({GLFW_KEY_ESCAPE, false, false}, dialog), nullptr);
}

TEST(Actions, ABallotKeepsItsLettersAndWhateverChangesALookRests) {
    const KeyboardOwner voting{.ballot_letters = 4};
    EXPECT_EQ(action_for({GLFW_KEY_B, false, false}, voting), nullptr) << "design B";
    EXPECT_EQ(action_for({GLFW_KEY_B, true, false}, voting)->id, "black");
    EXPECT_EQ(action_for({GLFW_KEY_F, false, false}, voting)->id, "freeze") << "no design F";
    EXPECT_EQ(action_for({GLFW_KEY_2, false, false}, voting)->id, "look-2");
    EXPECT_EQ(action_for({GLFW_KEY_PAGE_DOWN, false, false}, voting)->id, "next-look");
    EXPECT_EQ(action_for({GLFW_KEY_SPACE, false, false}, voting)->id, "hold-b");
    EXPECT_EQ(action_for({GLFW_KEY_F6, false, false}, voting)->id, "view-eye");
    for (const int key : {GLFW_KEY_DELETE, GLFW_KEY_N, GLFW_KEY_F2}) {
        EXPECT_EQ(action_for({key, false, false}, voting), nullptr) << key;
    }
    EXPECT_EQ(action_for({GLFW_KEY_Z, true, false}, voting), nullptr);
    EXPECT_EQ(action_for({GLFW_KEY_D, true, false}, voting), nullptr);
}

TEST(Actions, ArrowsStepLooksUnlessTheyMoveBetweenItems) {
    EXPECT_EQ(action_for({GLFW_KEY_RIGHT, false, false}, {})->id, "next-look");
    EXPECT_EQ(action_for({GLFW_KEY_RIGHT, false, false}, {.keyboard_navigation = true}), nullptr);
    EXPECT_EQ(action_for({GLFW_KEY_PAGE_DOWN, false, false}, {.keyboard_navigation = true})->id,
              "next-look");
}

TEST_F(Window, NumbersAndStepsShowLooks) {
    EXPECT_EQ(studio.shown_look, 1);
    EXPECT_TRUE(press(GLFW_KEY_3));
    EXPECT_EQ(studio.shown_look, 3);
    EXPECT_EQ(studio.compared_look, 1) << "B is the look shown before";
    EXPECT_TRUE(press(GLFW_KEY_PAGE_DOWN));
    EXPECT_EQ(studio.shown_look, 1) << "after the last comes the first";
    EXPECT_TRUE(press(GLFW_KEY_PAGE_UP));
    EXPECT_EQ(studio.shown_look, 3);
    EXPECT_FALSE(press(GLFW_KEY_4)) << "there are three";
    EXPECT_EQ(document().looks.size(), 3u);
    EXPECT_FALSE(studio.session.can_undo()) << "showing is no change";
}

TEST_F(Window, DeletingShowsTheNeighbourAndUndoShowsItAgain) {
    press(GLFW_KEY_3);
    EXPECT_TRUE(press(GLFW_KEY_DELETE));
    EXPECT_EQ(document().looks.size(), 2u);
    EXPECT_EQ(studio.shown_look, 2);
    EXPECT_TRUE(press(GLFW_KEY_Z, true));
    EXPECT_EQ(document().looks.size(), 3u);
    EXPECT_EQ(studio.shown_look, 3);
    EXPECT_TRUE(press(GLFW_KEY_Y, true));
    EXPECT_EQ(document().looks.size(), 2u);
    EXPECT_FALSE(press(GLFW_KEY_Z, true, true)) << "nothing is left to redo";
}

TEST_F(Window, TheLastLookStays) {
    press(GLFW_KEY_DELETE);
    press(GLFW_KEY_DELETE);
    EXPECT_FALSE(press(GLFW_KEY_DELETE));
    EXPECT_EQ(document().looks.size(), 1u);
    EXPECT_FALSE(studio.compared_look);
    EXPECT_FALSE(press(GLFW_KEY_W)) << "there is nothing to wipe to";
}

TEST_F(Window, DuplicatesAreShown) {
    EXPECT_TRUE(press(GLFW_KEY_D, true));
    EXPECT_EQ(document().looks.size(), 4u);
    EXPECT_EQ(studio.shown_look, 4);
    EXPECT_TRUE(press(GLFW_KEY_N));
    EXPECT_EQ(document().looks.size(), 5u);
    EXPECT_EQ(studio.shown_look, 5);
}

TEST_F(Window, HoldingShowsBUntilItIsLetGo) {
    press(GLFW_KEY_2);
    EXPECT_TRUE(press(GLFW_KEY_SPACE));
    EXPECT_TRUE(studio.showing_b);
    action_named("hold-b").released(studio);
    EXPECT_FALSE(studio.showing_b);
}

TEST_F(Window, BlackAndFreezeSwitch) {
    EXPECT_TRUE(press(GLFW_KEY_B));
    EXPECT_TRUE(studio.black);
    EXPECT_TRUE(press(GLFW_KEY_B, true, false, {.text_field = true}));
    EXPECT_FALSE(studio.black);
    EXPECT_TRUE(press(GLFW_KEY_F));
    EXPECT_TRUE(studio.frozen);
}

TEST_F(Window, EscGivesUpTheTopmostThing) {
    show_panel(studio, "keys");
    studio.wiping = true;
    studio.selected_part = 1;
    notify(studio, {Notice::Level::warning, "What", "why", "fix"});
    press(GLFW_KEY_ESCAPE);
    EXPECT_FALSE(is_open(studio, "keys"));
    press(GLFW_KEY_ESCAPE);
    EXPECT_TRUE(studio.notices.empty());
    press(GLFW_KEY_ESCAPE);
    EXPECT_FALSE(studio.wiping);
    press(GLFW_KEY_ESCAPE);
    EXPECT_FALSE(studio.selected_part);
}

TEST_F(Window, WhatIsTriedShowsAndIsNotCommitted) {
    studio.tried = SetPaint{1, "*", "solid blue"};
    EXPECT_EQ(find_look(shown_document(studio), 1)->look.parts.at("*"), "solid blue");
    EXPECT_EQ(find_look(document(), 1)->look.parts.at("*"), "solid red");
    press(GLFW_KEY_ESCAPE);
    EXPECT_EQ(find_look(shown_document(studio), 1)->look.parts.at("*"), "solid red");
}

TEST_F(Window, ATrialOfALookThatIsGoneShowsTheDocument) {
    studio.tried = SetPaint{77, "*", "solid blue"};
    EXPECT_EQ(shown_document(studio).looks.size(), 3u);
}

TEST_F(Window, ACommandThatFailsIsTold) {
    commit(studio, RenameLook{1, ""});
    ASSERT_EQ(studio.notices.size(), 1u);
    EXPECT_EQ(studio.notices[0].level, Notice::Level::error);
    EXPECT_FALSE(studio.notices[0].cause.empty());
    EXPECT_FALSE(studio.session.can_undo());
}

TEST_F(Window, TheSameNoticeIsToldOnce) {
    notify(studio, {Notice::Level::error, "Full", "disk", ""});
    notify(studio, {Notice::Level::error, "Full", "disk still", ""});
    ASSERT_EQ(studio.notices.size(), 1u);
    EXPECT_EQ(studio.notices[0].cause, "disk still");
}

}  // namespace
}  // namespace livery
