// A presenter's remote control, pause, repeat, back and grey: what the projector shows after each.
#include <gtest/gtest.h>

#include "desktop/presented_vote.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

/// So long that nothing ends by itself.
constexpr const char* kSlow = R"({"format_version": 1, "settings": {
  "presenting-adapt-s": "600", "presenting-look-s": "600", "presenting-grey-s": "600",
  "presenting-passes": "1", "presenting-seed": "7"
}})";
/// So short that a test sees it end.
constexpr const char* kQuick = R"({"format_version": 1, "settings": {
  "presenting-adapt-s": "60", "presenting-look-s": "6", "presenting-grey-s": "60",
  "presenting-passes": "1", "presenting-seed": "7"
}})";

using Remote = PresentedVote;

TEST_F(Remote, EveryKeyShowsWhatItSays) {
    start_vote(kSlow, 3);
    present_paused();
    program->press_key("space");
    program->wait_for_state("vote_paused", false);
    EXPECT_TRUE(projector_shows_frame(kWhiteFrame));
    const auto& order = presented.plan.sittings.at(0);
    const std::string first = frame_of_look(order[0]), second = frame_of_look(order[1]),
                      between = frame_of_grey(order[0], order[1]);
    struct Press {
        const char* key;
        std::string frame;
    };
    const std::vector<Press> presses = {
        {"Right", first},       {"Down", between},      {"Next", second},       {"Left", first},
        {"Next", between},      {"Up", first},          {"Right", between},     {"Right", second},
        {"Prior", first},       {"Prior", kWhiteFrame}, {"Prior", kWhiteFrame}, {"Next", first},
        {"Down", between},      {"r", first},           {"b", kRestFrame},      {"b", first},
        {"period", kRestFrame}, {"period", first},      {"b", kRestFrame},      {"Right", between}};
    for (std::size_t k = 0; k < presses.size(); ++k) {
        program->press_key(presses[k].key);
        EXPECT_TRUE(projector_shows_frame(presses[k].frame)) << "press " << k << presses[k].key;
        EXPECT_EQ(program->state("vote_paused"), false) << presses[k].key;
    }

    // One that is held does not run through the looks.
    program->press_key("Left");
    EXPECT_TRUE(projector_shows_frame(first));
    desktop->hold_key("Next");
    sleep_ms(1500);
    desktop->release_key("Next");
    EXPECT_TRUE(projector_shows_frame(between));
    EXPECT_EQ(program->state("vote_frame"), between);

    // Ctrl+B is black as ever, and back.
    program->press_key("ctrl+b");
    EXPECT_TRUE(projector_is_black());
    program->wait_for_state("vote_paused", true);  // nobody sees its time go by
    program->press_key("ctrl+b");
    EXPECT_TRUE(projector_shows_frame(between));

    // One wrong key or click ends nothing.
    program->press_key("ctrl+q");
    program->click("vote:abort");
    program->item("vote:confirm");
    program->press_key("b");
    program->press_key("Escape");
    program->item("vote:abort");
    EXPECT_EQ(program->state("vote"), "presenting");
    EXPECT_TRUE(projector_shows_frame(between));
}

TEST_F(Remote, NightlyPauseHoldsEveryPixelAndRepeatGivesAllOfTheTime) {
    start_vote(kQuick, 2);
    present_paused();
    const auto& order = presented.plan.sittings.at(0);
    const std::string first = frame_of_look(order[0]);
    program->press_key("Next");
    EXPECT_EQ(program->state("vote_paused"), true) << "who pauses stays paused";
    EXPECT_TRUE(projector_shows_frame(first));
    const int whole = lit_beside();

    // Time goes by, then stands still: nothing on the projector changes, for longer than the look.
    program->press_key("space");
    EXPECT_TRUE(wait_until([&] { return lit_beside() < whole; })) << "the bar gets shorter";
    program->press_key("space");
    program->wait_for_state("vote_paused", true);
    ASSERT_EQ(program->state("vote_frame"), first) << "paused too late to tell";
    ASSERT_TRUE(projector_shows_frame(first));
    sleep_ms(500);
    const Image8 paused = projector_picture();
    const int left = lit_beside();
    EXPECT_LT(left, whole);
    sleep_ms(6500);
    EXPECT_EQ(projector_picture().values, paused.values);

    // Grey, and back to the same instant.
    program->press_key("b");
    EXPECT_TRUE(projector_shows_frame(kRestFrame));
    EXPECT_EQ(lit_beside(), 0) << "no code and no bar beside grey";
    program->press_key("b");
    EXPECT_TRUE(wait_until([&] { return projector_picture().values == paused.values; }));

    // Anew, for all of its time.
    program->press_key("r");
    EXPECT_TRUE(wait_until([&] { return lit_beside() == whole; }));
    EXPECT_TRUE(projector_shows_frame(first));

    // Let go, it ends by itself in the grey after it.
    program->press_key("space");
    EXPECT_TRUE(projector_shows_frame(frame_of_grey(order[0], order[1])));
    EXPECT_EQ(program->state("vote_paused"), false);
}

}  // namespace
}  // namespace livery
