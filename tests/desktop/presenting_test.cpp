// A vote as its operator runs it, with mouse and keys on two monitors: the projector shows the
// frozen frames and nothing else, in the order that was stored, also after a kill.
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <iostream>

#include <gtest/gtest.h>

#include "core/paths.h"
#include "desktop/two_monitors.h"
#include "evaluation/ballots.h"
#include "studio/presenting/frames_folder.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

/// Long enough to be seen, and stopped where a test looks closely.
constexpr const char* kSettings = R"({"format_version": 1, "settings": {
  "presenting-adapt-s": "60", "presenting-look-s": "3", "presenting-grey-s": "3",
  "presenting-passes": "1", "presenting-seed": "7", "phones-port": "0"
}})";

class Presenting : public TwoMonitors {
  protected:
    void load_frames() {
        const BallotStore store(home / "ballots.sqlite");
        const auto found = store.presented();
        ASSERT_TRUE(found);
        presented = *found;
        frames = read_vote_frames(home / presented.plan.folder, presented.plan.frames);
    }

    /// Waits until every pixel that the frame lights is on the projector, by its hash; what stands
    /// beside it has no colour.
    testing::AssertionResult projector_shows_frame(const std::string& name) {
        const Image8& frame = *frames.at(name);
        std::string why;
        const bool shown = wait_until(
            [&] {
                Image8 seen = projector_picture();
                int coloured = 0;
                for (std::size_t i = 0; i < seen.pixel_count(); ++i) {
                    std::uint8_t* at = &seen.values[3 * i];
                    const std::uint8_t* of = &frame.values[3 * i];
                    if (of[0] != 0 || of[1] != 0 || of[2] != 0) continue;
                    if (at[0] != at[1] || at[1] != at[2]) ++coloured;
                    at[0] = at[1] = at[2] = 0;
                }
                why = coloured > 0 ? std::to_string(coloured) + " coloured pixels beside it" : "";
                return coloured == 0 && hash_of(seen) == presented.plan.frames.at(name);
            },
            20s);
        if (shown) return testing::AssertionSuccess();
        return testing::AssertionFailure()
               << name << " is not shown. " << why << " state: " << program->state("vote") << " "
               << program->state("vote_frame") << " seen: " << saved(projector_picture(), "seen");
    }

    /// Of the lit pixels, all channels.
    double brightness(const std::string& name) const {
        double sum = 0.0, lit = 0.0;
        for (const std::uint8_t value : frames.at(name)->values) {
            sum += value;
            lit += value > 0 ? 1.0 : 0.0;
        }
        return sum / std::max(lit, 1.0);
    }

    int code_of(int design) const {
        return presented.round.codes.at(static_cast<std::size_t>(design));
    }

    BallotStore::Presented presented;
    VoteFrames frames;
};

TEST_F(Presenting, ShowsFrozenFramesInTheStoredOrderAlsoAfterAKillUntilTheRoundIsLocked) {
    start_at_home(kSettings);
    pick_projector();
    program->click("menu:File");
    program->click("menu:ballot");
    for (std::size_t place = 3; place < document.looks.size(); ++place) {
        program->click("ballot:look:" + std::to_string(look_at_place(place)));
    }
    program->click("phones:start");
    EXPECT_TRUE(wait_until([&] {
        return program->state("phones").get<std::string>().starts_with("http://127.0.0.1:");
    }));
    program->click("present:least");
    program->click("present:scales");
    program->click("scales:remove:2");
    program->click("ballot:present");
    program->wait_for_state("vote", "adapting");
    EXPECT_NE(read_text_file(home / "desktop.json").find(R"("presenting-least": "yes")"),
              std::string::npos)
        << "the tick is not kept";
    program->press_key("space");
    program->wait_for_state("vote_paused", true);
    program->wait_for_state("vote_loaded", true);
    load_frames();
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
    ASSERT_EQ(program->process().wait(10s), 128 + SIGKILL);
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
