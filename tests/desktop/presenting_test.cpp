// A vote as its operator runs it, with mouse and keys on two monitors: the projector shows the
// frozen frames and nothing else, in the order that was stored, also after a kill.
#include <csignal>

#include <gtest/gtest.h>

#include "core/paths.h"
#include "desktop/presented_vote.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

/// Long enough to be seen, and stopped where a test looks closely.
constexpr const char* kQuickTurns = R"({"format_version": 1, "settings": {
  "presenting-adapt-s": "60", "presenting-look-s": "3", "presenting-grey-s": "3",
  "presenting-passes": "1", "presenting-seed": "7", "phones-port": "0"
}})";

using Presenting = PresentedVote;

TEST_F(Presenting, ShowsFrozenFramesInTheStoredOrderAlsoAfterAKillUntilTheRoundIsLocked) {
    start_vote(kQuickTurns, 3);
    let_phones_vote();
    program->click("present:least");
    program->click("present:scales");
    program->click("scales:remove:2");
    present_paused();
    EXPECT_NE(read_text_file(home / "desktop.json").find(R"("presenting-least": "yes")"),
              std::string::npos)
        << "the tick is not kept";
    const auto& order = presented.plan.sittings.at(0);
    ASSERT_EQ(order.size(), 3u);
    EXPECT_TRUE(presented.round.asks_least);
    EXPECT_EQ(
        presented.round.scales,
        (std::vector<SemanticScale>(suggested_scales().begin(), suggested_scales().begin() + 2)));

    // --- white, for the eyes ---
    EXPECT_TRUE(projector_shows_frame(kWhiteFrame));
    for (const auto& [name, frame] : frames) EXPECT_LE(brightness(name), brightness(kWhiteFrame));

    // --- the first look, by a presenter's remote, is what the session would send ---
    program->press_key("Next");
    program->wait_for_state("vote_code", code_of(order[0]));
    EXPECT_TRUE(projector_shows_frame(frame_of_look(order[0])));
    EXPECT_LE(fraction_different(*frames.at(frame_of_look(order[0])),
                                 drive_of_place(static_cast<std::size_t>(order[0])),
                                 2),
              2e-3);

    // --- nothing can be changed, and that is said ---
    const auto undo = program->state("undo"), shown = program->state("shown_look");
    program->press_key("ctrl+z");
    program->click("look:" + std::to_string(look_at_place(2)));
    EXPECT_EQ(program->state("undo"), undo);
    EXPECT_EQ(program->state("shown_look"), shown);
    EXPECT_EQ(program->state("notices").back(), "Nothing can be changed now.");
    EXPECT_TRUE(projector_shows_frame(frame_of_look(order[0])));

    // --- time goes by: its own grey comes by itself ---
    const std::string grey = frame_of_grey(order[0], order[1]);
    program->press_key("space");
    program->wait_for_state("vote_frame", grey);
    program->press_key("space");
    program->wait_for_state("vote_paused", true);
    EXPECT_EQ(program->state("vote_frame"), grey);
    EXPECT_TRUE(projector_shows_frame(grey));
    program->press_key("period");
    program->wait_for_state("vote_blank", true);
    EXPECT_TRUE(projector_shows_frame(kRestFrame));
    program->press_key("b");
    program->wait_for_state("vote_blank", false);

    // --- killed, it is back where it was ---
    program->press_key("Next");
    program->wait_for_state("vote_code", code_of(order[1]));
    program->process().send(SIGKILL);
    ASSERT_EQ(program->process().wait(60s), 128 + SIGKILL);
    const auto before = presented;
    start_program_at_home();
    program->wait_for_state("vote_loaded", true);
    load_frames();
    EXPECT_EQ(presented.plan, before.plan);
    EXPECT_EQ(presented.round.codes, before.round.codes);
    EXPECT_EQ(presented.round.seed, 7);
    EXPECT_EQ(program->state("vote"), "presenting");
    EXPECT_EQ(program->state("vote_paused"), true);
    EXPECT_EQ(program->state("vote_code"), code_of(order[1]));
    EXPECT_TRUE(projector_shows_frame(frame_of_look(order[1])));

    // --- by mouse to the end; then people vote before grey ---
    for (int click = 0; click < 3; ++click) program->click("vote:next");
    EXPECT_EQ(program->state("vote_frame"), kRestFrame);
    program->click("vote:repeat");
    EXPECT_TRUE(projector_shows_frame(frame_of_look(order[2])));
    for (int click = 0; click < 2; ++click) program->click("vote:next");
    program->wait_for_state("vote", "voting");
    EXPECT_TRUE(projector_shows_frame(kRestFrame));
    program->press_key("Next");
    EXPECT_EQ(program->state("vote"), "voting") << "a remote ends no vote";
    program->click("vote:back");
    EXPECT_EQ(program->state("vote"), "presenting");
    EXPECT_FALSE(program->has_item("vote:abort")) << "votes may have come";
    EXPECT_TRUE(projector_shows_frame(kRestFrame));
    program->click("vote:next");
    program->wait_for_state("vote", "voting");
    program->click("ballot:type-in");
    program->click("ballot:name");
    desktop->type("Bo");
    program->click("ballot:best:1");
    program->click("ballot:second:0");
    program->click("ballot:least:2");
    program->click("ballot:confirm");
    program->click("ballot:overview");
    program->item("vote:seat:1");

    // --- locked, it says what came of it; then the looks are back ---
    program->click("vote:lock");
    program->click("vote:confirm");
    program->wait_for_state("vote", "locked");
    program->item("ballot:result");
    program->item("ballot:verdict");

    // --- a duel of the first two: its first repeat says nothing yet ---
    const BallotStore::Presented first = presented;
    program->click("duel:begin");
    program->wait_for_state("vote", "adapting");
    program->press_key("space");
    program->wait_for_state("vote_loaded", true);
    load_frames();
    EXPECT_EQ(presented.round.designs,
              (std::vector<std::string>{first.round.designs[1], first.round.designs[0]}));
    EXPECT_EQ(presented.round.seed, 7);
    EXPECT_EQ(presented.plan.sittings.at(0).size(), 2u);
    EXPECT_FALSE(presented.round.asks_least);
    for (int click = 0; click < 5; ++click) program->click("vote:next");
    program->wait_for_state("vote", "voting");
    program->click("ballot:type-in");
    program->click("ballot:name");
    desktop->type("Bo");
    program->click("ballot:best:1");
    program->click("ballot:second:0");
    program->click("ballot:confirm");
    program->click("vote:lock");
    program->click("vote:confirm");
    program->wait_for_state("vote", "locked");
    program->item("duel:words");
    program->item("duel:next");
    EXPECT_FALSE(program->has_item("ballot:verdict")) << "it would sway the repeats to come";
    presented = first;
    program->click("vote:done");
    program->wait_for_state("vote", "edit");
    program->click("ballot:close-panel");
    desktop->press_key("1");
    EXPECT_TRUE(projector_shows(drive_of_place(0)));

    const BallotStore store(home / "ballots.sqlite");
    ASSERT_TRUE(store.series_under_way());
    EXPECT_EQ(store.series_under_way()->follows, presented.round.id);
    EXPECT_EQ(store.series_under_way()->rounds.size(), 1u);
    EXPECT_EQ(store.tally(presented.round.id).best, (std::vector<int>{0, 1, 0}));
    EXPECT_EQ(store.tally(presented.round.id).least, (std::vector<int>{0, 0, 1}));
    std::vector<int> seen;
    for (const PresentationStep& step : store.steps_of(presented.round.id)) {
        const int design = design_of(presented.plan, step.state);
        if (design >= 0 && (seen.empty() || seen.back() != design)) seen.push_back(design);
    }
    EXPECT_EQ(seen, order) << "what a report would print";
}

}  // namespace
}  // namespace livery
