// What the ballots keep of presentations.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evaluation/ballot_file.h"
#include "evaluation/closed_round.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using Phase = PresentationPhase;
using Event = PresentationEvent;

RoundSetup presented_setup() {
    RoundSetup setup;
    setup.designs = {"red", "blue", "ivory"};
    setup.seed = 11;
    setup.presenting = true;
    setup.plan = PresentationPlan{{{2, 0, 1}}, {1.0, 2.0, 3.0}, "a.livery", "frames/x", {}};
    return setup;
}

TEST(PresentationStore, KeepsThePlanAndEveryStep) {
    const TemporaryFolder folder;
    const auto file = folder / "ballots.sqlite";
    std::vector<PresentationState> told;
    int round = 0;
    std::vector<int> codes;
    {
        BallotStore store(file);
        round = store.open_round(presented_setup());
        codes = store.open_round()->codes;
        PresentationState state;
        for (const Event event : {Event::present, Event::next, Event::next, Event::next}) {
            state = after(*presented_setup().plan, state, event, 5.0);
            store.record_step(round, state, event);
            told.push_back(state);
        }
    }
    BallotStore store(file);
    EXPECT_EQ(store.plan_of(round), presented_setup().plan);
    const auto steps = store.steps_of(round);
    ASSERT_EQ(steps.size(), told.size());
    for (std::size_t k = 0; k < told.size(); ++k) {
        EXPECT_EQ(steps[k].state.phase, told[k].phase);
        EXPECT_EQ(steps[k].state.place, told[k].place);
        EXPECT_EQ(steps[k].state.grey, told[k].grey);
        EXPECT_EQ(steps[k].at.size(), std::string("2026-11-21T08:36:00.123Z").size());
    }
    const auto found = store.presented();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->round.codes, codes);
    EXPECT_EQ(found->step.state.place, 1);
    EXPECT_EQ(design_of(found->plan, found->step.state), 0);
}

TEST(PresentationStore, VotingBeginsAndEndsWithTheSteps) {
    const TemporaryFolder folder;
    BallotStore store(folder / "ballots.sqlite");
    const int round = store.open_round(presented_setup());
    EXPECT_EQ(store.presented()->step.state.phase, Phase::adapting) << "killed before its step";
    EXPECT_THROW(store.vote(round, "Bo", {0, 1}), Refused);
    store.record_step(round, {Phase::voting}, Event::next);
    EXPECT_TRUE(store.open_round()->voting());
    store.vote(round, "Bo", {0, 1});
    store.record_step(round, {Phase::presenting, 0, 2, true}, Event::back);
    EXPECT_TRUE(store.open_round()->voting()) << "what people were told holds";
    store.vote(round, "Di", {0, 2});
    store.record_step(round, {Phase::voting}, Event::next);
    store.record_step(round, {Phase::voting}, Event::resume);
    store.record_step(round, {Phase::locked}, Event::lock);
    EXPECT_FALSE(store.open_round());
    EXPECT_EQ(store.tally(round).best, (std::vector<int>{2, 0, 0}));
    EXPECT_EQ(store.presented()->step.state.phase, Phase::locked);
    store.record_step(round, {}, Event::done);
    EXPECT_FALSE(store.presented());

    const int aborted = store.open_round(presented_setup());
    store.record_step(aborted, {}, Event::abort);
    EXPECT_FALSE(store.open_round());
    EXPECT_FALSE(store.presented());
    EXPECT_EQ(read_closed_round(store.file(), std::nullopt, 1).round.id, round)
        << "nobody could vote in the other";
}

TEST(PresentationStore, ALockFromElsewhereIsALock) {
    const TemporaryFolder folder;
    BallotStore store(folder / "ballots.sqlite"), other(folder / "ballots.sqlite");
    const int round = store.open_round(presented_setup());
    store.record_step(round, {Phase::voting}, Event::next);
    other.close_round(round);
    EXPECT_EQ(store.presented()->step.state.phase, Phase::locked);
    store.record_step(round, {}, Event::done);
    EXPECT_FALSE(store.presented());
}

TEST(PresentationStore, RefusesWhatMakesNoSense) {
    const TemporaryFolder folder;
    const auto file = folder / "ballots.sqlite";
    BallotStore store(file);
    RoundSetup setup = presented_setup();
    setup.plan->sittings = {{0, 1}};
    EXPECT_THROW(store.open_round(setup), std::invalid_argument) << "a look that nobody sees";
    setup = presented_setup();
    setup.presenting = false;
    EXPECT_THROW(store.open_round(setup), std::invalid_argument);
    const int plain = store.open_round({"a", "b"}, "");
    EXPECT_THROW(store.record_step(plain, {Phase::voting}, Event::next), Refused);
    EXPECT_FALSE(store.plan_of(plain));
    EXPECT_FALSE(store.presented());
    store.close_round(plain);
    const int round = store.open_round(presented_setup());
    EXPECT_THROW(store.record_step(round, {Phase::presenting, 0, 7}, Event::next),
                 std::invalid_argument);
    EXPECT_THROW(store.record_step(round, {Phase::presenting, 1, 0}, Event::next),
                 std::invalid_argument);
    forge(file, 1, round, LogEntry::Shown{{Phase::presenting, 0, 7}, Event::next});
    EXPECT_TRUE(fails_with([&] { store.presented(); }, {"ballots.sqlite", "log entry", "place"}));
}

/// Five phones and a name in three waves, of which each sees two looks.
struct Waves {
    TemporaryFolder folder;
    std::filesystem::path file = folder / "ballots.sqlite";
    BallotStore store{file};
    int round = 0;
    PresentationState state;
    Waves() {
        const int session = store.open_session();
        for (int phone = 1; phone <= 5; ++phone) {
            store.join(session, "phone " + std::to_string(phone), 40);
        }
        RoundSetup setup;
        setup.designs = {"red", "blue"};
        setup.presenting = true;
        setup.plan = PresentationPlan{{{0, 1}, {1, 0}, {0, 1}}, {1.0, 1.0, 1.0}, "", "f", {}};
        round = store.open_round(setup);
    }
    void step(Event event) {
        state = after(store.plan_of(round).value(), state, event, 0.0);
        store.record_step(round, state, event);
    }
    /// From the beginning, or from another wave's votes, to the votes of the next.
    void show_to_one_wave() {
        if (state.phase == Phase::edit) step(Event::present);
        while (state.phase != Phase::voting) step(Event::next);
    }
};

TEST(PresentationStore, SeatsAreDealtToWavesAndVoteInTheirTurn) {
    Waves waves;
    const std::vector<std::vector<int>> dealt = {{1, 2}, {3, 4}, {5}};
    EXPECT_EQ(waves.store.plan_of(waves.round)->seats, dealt);
    EXPECT_EQ(waves.store.turn_of(waves.round, 4), (Turn{1, 3, false, false}));
    waves.show_to_one_wave();
    EXPECT_EQ(waves.store.turn_of(waves.round, 2), (Turn{0, 3, true, true}));
    EXPECT_EQ(waves.store.turn_of(waves.round, 4), (Turn{1, 3, false, false}));
    waves.store.vote(waves.round, 1, {0, 1});
    for (const int early : {3, 4, 5}) {
        EXPECT_THROW(waves.store.vote(waves.round, early, {0, 1}), Refused) << early;
    }
    waves.store.vote(waves.round, "Bo", {1, 0});  // from paper, at any time

    // The second wave looks: it still cannot vote, while the first may change its ballots.
    waves.step(Event::next);
    EXPECT_EQ(waves.store.turn_of(waves.round, 3), (Turn{1, 3, true, false}));
    EXPECT_THROW(waves.store.vote(waves.round, 3, {0, 1}), Refused);
    waves.store.vote(waves.round, 1, {1, 0});
    waves.show_to_one_wave();
    waves.store.vote(waves.round, 3, {0, 1});
    EXPECT_THROW(waves.store.vote(waves.round, 5, {0, 1}), Refused);

    // Killed: the deal and whose turn it was are in the file.
    {
        BallotStore again(waves.file);
        EXPECT_EQ(again.presented()->plan.seats, dealt);
        EXPECT_EQ(again.turn_of(waves.round, 3), (Turn{1, 3, true, true}));
        EXPECT_EQ(again.turn_of(waves.round, 5), (Turn{2, 3, false, false}));
        EXPECT_THROW(again.vote(waves.round, 5, {0, 1}), Refused);
    }
    waves.step(Event::next);
    waves.show_to_one_wave();
    waves.store.vote(waves.round, 5, {1, 0});
    waves.store.vote(waves.round, 2, {1, 0});
    waves.step(Event::lock);
    EXPECT_EQ(waves.store.tally(waves.round).best, (std::vector<int>{1, 4}));
    EXPECT_THROW(waves.store.vote(waves.round, 4, {0, 1}), Refused);
}

TEST(PresentationStore, ABallotBeforeItsTurnIsRefusedWhoeverWrites) {
    Waves waves;
    waves.show_to_one_wave();
    forge(waves.file, 1, waves.round, LogEntry::Vote{2, {0, 1}});
    EXPECT_EQ(waves.store.voted(waves.round), std::vector<int>{2});
    forge(waves.file, 1, waves.round, LogEntry::Vote{3, {0, 1}});
    EXPECT_TRUE(fails_with([&] { BallotStore{waves.file}; }, {"log entry", "too early"}));
}

TEST(PresentationStore, SeatsOfAPlanMustBeThere) {
    const TemporaryFolder folder;
    BallotStore store(folder / "ballots.sqlite");
    RoundSetup setup = presented_setup();
    setup.plan->sittings = {{2, 0, 1}, {0, 1, 2}};
    for (const auto& seats :
         std::vector<std::vector<std::vector<int>>>{{{1}}, {{1}, {1}}, {{0}, {1}}, {{1}, {2}}}) {
        setup.plan->seats = seats;
        EXPECT_ANY_THROW(store.open_round(setup));
        EXPECT_FALSE(store.open_round()) << "nothing is left of it";
    }
}

}  // namespace
}  // namespace livery
