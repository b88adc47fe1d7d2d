// What the ballots keep of presentations, and files from before they did.
#include <algorithm>
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
    store.record_step(round, {Phase::presenting, 0, 2, true}, Event::back);
    EXPECT_TRUE(store.open_round()->voting) << "what people were told holds";
    store.vote(round, {"Di", 0, 2});
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

/// As Livery wrote it before it presented (format 2: its log's table took no such entries), or
/// before it knew waves, series and scales (3).
std::filesystem::path file_of_format(int format, const TemporaryFolder& folder) {
    const auto file = folder / "old.sqlite";
    { const BallotStore made(file); }
    Database raw = raw_ballots(file);
    Transaction transaction(raw);
    const std::vector<std::string> newer = {"ratings", "scales", "series", "sitters", "waves"};
    for (const std::string& table : newer) raw.run("DROP TABLE " + table);
    for (const char* table :
         {"ballots", "designs", "rounds", "seats", "invitations", "sessions", "log"}) {
        raw.run(std::string("DROP TABLE ") + table);
    }
    const auto old = log_schema(format), all = log_schema();
    for (const std::string& statement : ballot_tables_schema()) {
        const bool is_newer =
            statement.find("sitters") != std::string::npos ||
            std::any_of(newer.begin(), newer.end(), [&](const std::string& table) {
                return statement.find(" " + table + " (") != std::string::npos ||
                       statement.find("ON " + table) != std::string::npos;
            });
        if (!is_newer) raw.run(statement == all.front() ? old.front() : statement);
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
    if (format > 2) {
        record(raw,
               {.what = What::plan,
                .session = 1,
                .round = 1,
                .at = "t5",
                .text = text_of(PresentationPlan{{{0, 1}, {1, 0}}, {}, "", "f", {}})});
        record(raw,
               {.what = What::shown,
                .session = 1,
                .round = 1,
                .at = "t6",
                .text = text_of(PresentationState{Phase::voting}, Event::next)});
    }
    raw.set_version(format);
    transaction.commit();
    return file;
}

TEST(PresentationStore, AFileFromBeforeKeepsEveryEntryAndItsHash) {
    for (const int format : {2, 3}) {
        const TemporaryFolder folder;
        const auto file = file_of_format(format, folder);
        const auto log = [&] {
            return raw_ballots(file).run("SELECT id, at, what, text, hash FROM log ORDER BY id");
        };
        const auto before = log();
        ASSERT_EQ(before.size(), format == 2 ? 7u : 9u);
        {
            BallotStore store(file);
            EXPECT_EQ(store.open_round()->ballots, 1);
            EXPECT_EQ(store.open_round()->codes, (std::vector<int>{417, 418}));
            EXPECT_EQ(store.invitation(1)->token, "token");
            EXPECT_EQ(store.seat_of_phone(1, "h"), 1);
            EXPECT_EQ(store.turn_of(1, 1), Turn{}) << "nobody was dealt to a wave";
        }
        EXPECT_EQ(log(), before) << format;
        EXPECT_EQ(raw_ballots(file).version(), 4);
        BallotStore store(file);
        store.close_round(1);
        store.record_step(store.open_round(presented_setup()), {Phase::adapting}, Event::present);
        EXPECT_TRUE(BallotStore(file).presented());
    }
}

TEST(PresentationStore, AFileFromBeforeThatWasChangedIsRefusedAndStaysAsItIs) {
    for (const int format : {2, 3}) {
        const TemporaryFolder folder;
        const auto file = file_of_format(format, folder);
        raw_ballots(file).run("UPDATE ballots SET best = 1, second = 0");
        EXPECT_TRUE(fails_with([&] { BallotStore{file}; }, {"old.sqlite", "not those of the log"}));
        EXPECT_EQ(raw_ballots(file).version(), format);
    }
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
    waves.store.vote(waves.round, {"Bo", 1, 0});  // from paper, at any time

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

TEST(PresentationStore, TheTablesRefuseABallotBeforeItsTurnWhoeverWrites) {
    Waves waves;
    waves.show_to_one_wave();
    Database raw = raw_ballots(waves.file);
    raw.run("PRAGMA foreign_keys = ON");
    const auto vote = [&](int seat) {
        Transaction transaction(raw);
        record(raw,
               {.what = LogEntry::What::vote,
                .session = 1,
                .round = waves.round,
                .seat = seat,
                .at = "t",
                .second = 1});
        transaction.commit();
    };
    EXPECT_TRUE(fails_with([&] { vote(3); }, {"the turn of this seat is still to come"}));
    EXPECT_NO_THROW(vote(2));
    EXPECT_NO_THROW(BallotStore{waves.file});
    // Another wave, or one that votes too soon, is no longer what the log says.
    raw.run("UPDATE waves SET voting = 'now' WHERE wave = 2");
    EXPECT_TRUE(fails_with([&] { BallotStore{waves.file}; }, {"not that of the log"}));
    raw.run("UPDATE waves SET voting = NULL WHERE wave = 2");
    EXPECT_NO_THROW(BallotStore{waves.file});
    raw.run("UPDATE sitters SET wave = 0 WHERE seat = 5");
    EXPECT_TRUE(fails_with([&] { BallotStore{waves.file}; }, {"not that of the log"}));
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
