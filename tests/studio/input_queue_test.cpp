#include "studio/kit/input_queue.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace livery {
namespace {

using Kind = InputEvent::Kind;

InputEvent pointer(double x) {
    InputEvent event;
    event.x = x;
    return event;
}
InputEvent of(Kind kind, int code, bool down = true) {
    InputEvent event;
    event.kind = kind;
    event.code = code;
    event.down = down;
    return event;
}

/// How many events each frame takes.
std::vector<std::size_t> portions(InputQueue& queue) {
    std::vector<std::size_t> sizes;
    while (!queue.empty()) {
        sizes.push_back(0);
        queue.hand_out([&](const InputEvent&) {
            ++sizes.back();
            return EventUse::passed_on;
        });
    }
    return sizes;
}

TEST(InputQueue, MovesMergeIntoOneFrame) {
    InputQueue queue;
    for (int i = 0; i < 50; ++i) queue.push(pointer(i));
    EXPECT_EQ(portions(queue), (std::vector<std::size_t>{50}));
}

TEST(InputQueue, AClickStaysWhereItWas) {
    InputQueue queue;
    queue.push(pointer(10));
    queue.push(of(Kind::button, 0, true));
    queue.push(of(Kind::button, 0, false));
    queue.push(pointer(500));
    EXPECT_EQ(portions(queue), (std::vector<std::size_t>{1, 1, 1, 1}));
}

TEST(InputQueue, APressComesAFrameAfterTheMoveToIt) {
    InputQueue queue;
    queue.push(pointer(10));
    queue.push(pointer(500));
    queue.push(of(Kind::button, 0, true));
    EXPECT_EQ(portions(queue), (std::vector<std::size_t>{2, 1}));
}

TEST(InputQueue, WhatIsDraggedGetsToWhereItIsLetGo) {
    InputQueue queue;
    queue.push(pointer(510));
    queue.push(pointer(520));
    queue.push(of(Kind::button, 0, false));
    EXPECT_EQ(portions(queue), (std::vector<std::size_t>{2, 1}));
}

TEST(InputQueue, AQuickKeyIsDownInOneFrame) {
    InputQueue queue;
    queue.push(of(Kind::key, 'B', true));
    queue.push(of(Kind::key, 'B', false));
    EXPECT_EQ(portions(queue), (std::vector<std::size_t>{1, 1}));
}

TEST(InputQueue, TypingIsNotSlowedDown) {
    InputQueue queue;
    for (const char c : std::string("red")) {
        queue.push(of(Kind::key, c - 'a' + 'A', true));
        queue.push(of(Kind::character, c));
    }
    EXPECT_EQ(portions(queue), (std::vector<std::size_t>{6}));
}

TEST(InputQueue, TextAndEditingKeysKeepTheirOrder) {
    constexpr int enter = 257;
    InputQueue queue;
    queue.push(of(Kind::character, 'a'));
    queue.push(of(Kind::key, enter, true));
    queue.push(of(Kind::character, 'b'));
    EXPECT_EQ(portions(queue), (std::vector<std::size_t>{1, 1, 1}));
}

TEST(InputQueue, AKeyAfterOneThatMayEndATextFieldWaits) {
    constexpr int enter = 257, control = 341;
    InputQueue queue;
    queue.push(of(Kind::key, enter, true));
    queue.push(of(Kind::key, enter + 1, false));
    queue.push(of(Kind::key, control, true));
    queue.push(of(Kind::key, 'Z', true));
    EXPECT_EQ(portions(queue), (std::vector<std::size_t>{2, 2}));
}

TEST(InputQueue, TheWheelTurnsWhereThePointerWas) {
    InputQueue queue;
    queue.push(of(Kind::wheel, 0));
    queue.push(pointer(10));
    EXPECT_EQ(portions(queue), (std::vector<std::size_t>{1, 1}));
}

/// What each frame is handed: characters as they are, presses as capitals, releases left out.
std::vector<std::string> handed_out(InputQueue& queue, char command, char step) {
    std::vector<std::string> frames;
    while (!queue.empty()) {
        frames.emplace_back();
        queue.hand_out([&](const InputEvent& event) {
            if (event.kind == Kind::key && !event.down) return EventUse::passed_on;
            frames.back() += static_cast<char>(event.code);
            if (event.kind != Kind::key) return EventUse::passed_on;
            return event.code == command ? EventUse::command
                   : event.code == step  ? EventUse::step
                                         : EventUse::passed_on;
        });
    }
    return frames;
}

TEST(InputQueue, WhatIsTypedAfterACommandIsForWhatItOpens) {
    // The search of paints has the keyboard a frame after its key, however long that frame takes.
    InputQueue queue;
    for (const char c : std::string("/teal")) {
        const int key = c == '/' ? c : c - 'a' + 'A';
        queue.push(of(Kind::key, key, true));
        queue.push(of(Kind::character, c));
        queue.push(of(Kind::key, key, false));
    }
    EXPECT_EQ(handed_out(queue, '/', 0),
              (std::vector<std::string>{"/", "", "Tt", "Ee", "Aa", "Ll", ""}));
}

TEST(InputQueue, FiftyStepsTakeOneFrame) {
    InputQueue queue;
    for (int k = 0; k < 50; ++k) {
        queue.push(of(Kind::key, 'Z', true));
        queue.push(of(Kind::key, 'Z', false));
    }
    queue.push(of(Kind::key, 'B', true));
    EXPECT_EQ(handed_out(queue, 0, 'Z'), (std::vector<std::string>{std::string(50, 'Z') + 'B'}));
}

}  // namespace
}  // namespace livery
