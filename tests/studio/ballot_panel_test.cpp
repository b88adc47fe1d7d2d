// The ballot panel drawn without a window: letters fill a ballot in, and it follows the phones.
#include "studio/presenting/ballot_panel.h"

#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "studio/panels_fixture.h"
#include "studio/presenting/presenting.h"
#include "studio/studio.h"

namespace livery {
namespace {

TEST_F(Panels, ABallotIsFilledByTheLettersThatItShows) {
    use_scale(1.0f);
    Studio studio = make_studio();
    studio.ballots = std::make_unique<BallotStore>(home_ / "ballots.sqlite");
    studio.setup = std::make_shared<const ProjectorSetup>();
    EXPECT_EQ(ballot_letters(studio), 0u);
    click(studio, draw_ballot, "ballot:start");
    ItemPlaces places = frames(studio, draw_ballot, 2);
    for (const char* name : {"ballot:picture:1", "ballot:best:0", "ballot:second:1"}) {
        EXPECT_TRUE(places.contains(name)) << name;
        EXPECT_LE(places[name].x + places[name].width, kColumn) << name;
    }
    EXPECT_EQ(ballot_letters(studio), 2u);
    const BallotPanelState& state = studio.panels.of<BallotPanelState>();
    const auto type = [&](char letter) {
        ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(letter));
        frames(studio, draw_ballot, 2);
    };
    type('2');  // shows a look on the mock-up, and chooses nothing here
    type('c');  // no design of this round
    EXPECT_EQ(state.ballot, Ballot{});
    type('b');
    type('A');
    EXPECT_EQ(state.ballot.best, 1);
    EXPECT_EQ(state.ballot.second, 0);
    // Enter without a name asks for it.
    press(studio, draw_ballot, ImGuiKey_Enter);
    EXPECT_EQ(state.page, BallotPanelState::Page::vote);
    frames(studio, draw_ballot, 2);
    EXPECT_TRUE(ImGui::GetIO().WantTextInput);
    for (const char letter : std::string("Bo")) type(letter);
    EXPECT_EQ(state.evaluator, "Bo");
    EXPECT_EQ(state.ballot.best, 1) << "letters of a name choose nothing";
    press(studio, draw_ballot, ImGuiKey_Enter);
    EXPECT_EQ(state.page, BallotPanelState::Page::vote) << "the field is left, nothing more";
    press(studio, draw_ballot, ImGuiKey_Enter);
    EXPECT_EQ(state.page, BallotPanelState::Page::thanks);
    EXPECT_EQ(studio.ballots->rounds().at(0).ballots, 1);
    EXPECT_EQ(ballot_letters(studio), 2u) << "a letter too many is nobody's command";
    // A picture shows its look.
    press(studio, draw_ballot, ImGuiKey_Enter);
    click(studio, draw_ballot, "ballot:picture:1");
    EXPECT_EQ(studio.shown_look, studio.session.document().looks[1].id);
}

/// Until it is read nobody knows whether there is one: no warning, and no round that would be kept
/// as not corrected.
TEST_F(Panels, NoVoteBeginsBeforeTheCalibrationIsKnown) {
    use_scale(1.0f);
    Studio studio = make_studio();
    studio.ballots = std::make_unique<BallotStore>(home_ / "ballots.sqlite");
    EXPECT_FALSE(frames(studio, draw_ballot, 2).contains("ballot:uncorrected"));
    click(studio, draw_ballot, "ballot:start");
    EXPECT_TRUE(studio.ballots->rounds().empty());
    studio.setup = std::make_shared<const ProjectorSetup>();
    EXPECT_TRUE(frames(studio, draw_ballot, 2).contains("ballot:uncorrected"));
    click(studio, draw_ballot, "ballot:start");
    EXPECT_EQ(studio.ballots->rounds().size(), 1u);
}

TEST_F(Panels, TheBallotFollowsWhatPhonesDo) {
    use_scale(1.0f);
    Studio studio = make_studio();
    studio.ballots = std::make_unique<BallotStore>(home_ / "ballots.sqlite");
    studio.setup = std::make_shared<const ProjectorSetup>();
    BallotStore phones(home_ / "ballots.sqlite");
    const int session = phones.open_session(), seat = phones.join(session, "a phone's", 9);
    click(studio, draw_ballot, "ballot:start");
    const BallotPanelState& state = studio.panels.of<BallotPanelState>();
    ASSERT_EQ(state.rounds.size(), 1u);
    EXPECT_EQ(state.rounds[0].session, session);
    EXPECT_EQ(state.rounds[0].ballots, 0);
    phones.vote(1, seat, {0, 1});
    frames(studio, draw_ballot, 2);
    EXPECT_EQ(state.rounds.at(0).ballots, 1);
    EXPECT_EQ(state.page, BallotPanelState::Page::vote);
    phones.close_round(1);
    frames(studio, draw_ballot, 2);
    EXPECT_EQ(state.page, BallotPanelState::Page::start);
    EXPECT_EQ(state.problem, "");
}

TEST_F(Panels, ARoundAtOnceDrawsItsSeed) {
    use_scale(1.0f);
    Studio studio = make_studio();
    studio.ballots = std::make_unique<BallotStore>(home_ / "ballots.sqlite");
    studio.setup = std::make_shared<const ProjectorSetup>();
    BallotStore other(home_ / "ballots.sqlite");
    for (int round = 1; round <= 2; ++round) {
        click(studio, draw_ballot, "ballot:start");
        other.close_round(round);
        frames(studio, draw_ballot, 2);
    }
    const auto rounds = studio.ballots->rounds();
    EXPECT_NE(rounds.at(0).seed, rounds.at(1).seed);
}

TEST_F(Panels, ADuelIsOfferedAfterBallotsAlone) {
    use_scale(1.0f);
    Studio studio = make_studio();
    studio.ballots = std::make_unique<BallotStore>(home_ / "ballots.sqlite");
    Round round;
    round.id = studio.ballots->open_round({"red", "blue"}, "");
    round.voting_at = round.closed_at = "2026-11-27T22:00:00Z";
    static Round shown;
    const DrawPanel draw = [](Studio& its) { draw_duel(its, shown); };
    shown = round;
    EXPECT_FALSE(frames(studio, draw, 2).contains("duel:begin"));
    shown.ballots = 1;
    EXPECT_TRUE(frames(studio, draw, 2).contains("duel:begin"));
}

}  // namespace
}  // namespace livery
