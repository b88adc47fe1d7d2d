// What the ballots keep of presentations, and files from before they did.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evaluation/ballot_file.h"
#include "evaluation/ballot_log.h"
#include "evaluation/ballot_tables.h"
#include "evaluation/ballots.h"
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
    EXPECT_THROW(store.vote(round, {"Bo", 0, 1}), Refused);
    store.record_step(round, {Phase::voting}, Event::next);
    EXPECT_TRUE(store.open_round()->voting);
    store.vote(round, {"Bo", 0, 1});
    store.record_step(round, {Phase::voting}, Event::resume);
    store.record_step(round, {Phase::locked}, Event::lock);
    EXPECT_FALSE(store.open_round());
    EXPECT_EQ(store.tally(round).best, (std::vector<int>{1, 0, 0}));
    EXPECT_EQ(store.presented()->step.state.phase, Phase::locked);
    store.record_step(round, {}, Event::done);
    EXPECT_FALSE(store.presented());

    const int aborted = store.open_round(presented_setup());
    store.record_step(aborted, {}, Event::abort);
    EXPECT_FALSE(store.open_round());
    EXPECT_FALSE(store.presented());
    EXPECT_EQ(read_closed_round(store.file(), std::nullopt, 1).id, round)
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
    {
        Database raw = raw_ballots(file);
        record(raw,
               {.what = LogEntry::What::shown,
                .session = 1,
                .round = round,
                .at = "t",
                .text = text_of(PresentationState{Phase::presenting, 0, 7}, Event::next)});
    }
    EXPECT_TRUE(fails_with([&] { store.presented(); }, {"ballots.sqlite", "round 2", "step"}));
}

/// As Livery wrote it before it presented: its log's table took no such entries.
std::filesystem::path file_of_format_2(const TemporaryFolder& folder) {
    const auto file = folder / "old.sqlite";
    { const BallotStore made(file); }
    Database raw = raw_ballots(file);
    Transaction transaction(raw);
    for (const char* table :
         {"ballots", "designs", "rounds", "seats", "invitations", "sessions", "log"}) {
        raw.run(std::string("DROP TABLE ") + table);
    }
    const auto old = log_schema(2), all = log_schema();
    for (const std::string& statement : ballot_tables_schema()) {
        raw.run(statement == all.front() ? old.front() : statement);
    }
    using What = LogEntry::What;
    record(raw, {.what = What::session, .session = 1, .at = "t0"});
    record(raw, {.what = What::seat, .session = 1, .seat = 1, .at = "t1", .text = "h", .best = 1});
    record(raw, {.what = What::open, .session = 1, .round = 1, .at = "t2", .second = 5});
    for (int k = 0; k < 2; ++k) {
        record(raw,
               {.what = What::design,
                .session = 1,
                .round = 1,
                .at = "t2",
                .text = k == 0 ? "a" : "b",
                .best = k,
                .second = 417 + k});
    }
    record(raw, {.what = What::voting, .session = 1, .round = 1, .at = "t3"});
    record(raw, {.what = What::vote, .session = 1, .round = 1, .seat = 1, .at = "t4", .second = 1});
    raw.run("INSERT INTO invitations VALUES (1, 'token', 'ABCDEF', 99)");
    raw.set_version(2);
    transaction.commit();
    return file;
}

TEST(PresentationStore, AFileFromBeforeKeepsEveryEntryAndItsHash) {
    const TemporaryFolder folder;
    const auto file = file_of_format_2(folder);
    const auto log = [&] {
        return raw_ballots(file).run("SELECT id, at, what, text, hash FROM log ORDER BY id");
    };
    const auto before = log();
    ASSERT_EQ(before.size(), 7u);
    {
        BallotStore store(file);
        EXPECT_EQ(store.open_round()->ballots, 1);
        EXPECT_EQ(store.open_round()->codes, (std::vector<int>{417, 418}));
        EXPECT_EQ(store.invitation(1)->token, "token");
        EXPECT_EQ(store.seat_of_phone(1, "h"), 1);
    }
    EXPECT_EQ(log(), before);
    EXPECT_EQ(raw_ballots(file).version(), 3);
    BallotStore store(file);
    store.close_round(1);
    store.record_step(store.open_round(presented_setup()), {Phase::adapting}, Event::present);
    EXPECT_TRUE(BallotStore(file).presented());
}

TEST(PresentationStore, AFileFromBeforeThatWasChangedIsRefusedAndStaysAsItIs) {
    const TemporaryFolder folder;
    const auto file = file_of_format_2(folder);
    raw_ballots(file).run("UPDATE ballots SET best = 1, second = 0");
    EXPECT_TRUE(fails_with([&] { BallotStore{file}; }, {"old.sqlite", "not those of the log"}));
    EXPECT_EQ(raw_ballots(file).version(), 2);
}

}  // namespace
}  // namespace livery
