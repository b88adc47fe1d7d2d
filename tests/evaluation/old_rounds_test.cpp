// Rounds that an older Livery held: presented to phones and typed in, a duel, one on paper.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "evaluation/ballot_file.h"
#include "evaluation/duel.h"
#include "evaluation/report/round_report.h"
#include "support/file_error.h"
#include "support/old_files.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

const std::vector<std::string> kLooks = {"nachtblau über alles 2",
                                         "blue metallic",
                                         "solid red 2",
                                         "nachtblau über alles",
                                         "solid ivory"};

std::filesystem::path old_ballots(const TemporaryFolder& folder) {
    return testing::unpacked_old_files(folder) / "ballots.sqlite";
}

/// By seat.
std::vector<std::pair<int, Ballot>> votes(const BallotStore& store, int round) {
    std::vector<std::pair<int, Ballot>> all;
    for (const CastBallot& ballot : store.ballots(round)) {
        all.emplace_back(ballot.seat, ballot.ballot);
    }
    return all;
}

TEST(OldRounds, HoldTheirLooksVotesAndAnswers) {
    const TemporaryFolder folder;
    const BallotStore store(old_ballots(folder));
    const auto rounds = store.rounds();
    ASSERT_EQ(rounds.size(), 5u);
    const Round& round = rounds[0];
    EXPECT_EQ(round.designs, kLooks);
    EXPECT_EQ(round.codes, (std::vector<int>{587, 738, 536, 651, 879}));
    EXPECT_EQ(round.created, "2026-11-27T21:59:45Z");
    EXPECT_EQ(round.calibration_id, testing::kOldCalibrationId);
    EXPECT_EQ(round.seed, 7);
    EXPECT_TRUE(round.asks_least);
    EXPECT_TRUE(round.closed());
    EXPECT_EQ(round.scales,
              (std::vector<SemanticScale>{{"cheap", "precious"}, {"calm", "lively"}}));

    EXPECT_EQ(votes(store, 1),
              (std::vector<std::pair<int, Ballot>>{
                  {1, {0, 1}}, {2, {0, 2}}, {3, {1, 0}}, {4, {1, 0, 2}}}));
    const VoteCounts tally = store.tally(1);
    EXPECT_EQ(tally.best, (std::vector<int>{2, 2, 0, 0, 0}));
    EXPECT_EQ(tally.second, (std::vector<int>{2, 1, 1, 0, 0}));
    EXPECT_EQ(tally.least, (std::vector<int>{0, 0, 1, 0, 0}));
    // Seat 1 took its second answer back.
    const auto ratings = store.ratings(1);
    ASSERT_EQ(ratings.size(), 2u);
    EXPECT_EQ(ratings.at(1).at(0), (ScaleSteps{7, 0}));
    EXPECT_EQ(ratings.at(3).at(1), (ScaleSteps{1, 4}));
    // The ballot that seat 2 changed is in the log too.
    const auto log = store.log();
    EXPECT_EQ(log.size(), 128u);
    std::vector<Ballot> seat_2;
    for (const LogEntry& entry : log) {
        const auto* vote = std::get_if<LogEntry::Vote>(&entry.what);
        if (vote && entry.round == 1 && vote->seat == 2) seat_2.push_back(vote->ballot);
    }
    EXPECT_EQ(seat_2, (std::vector<Ballot>{{2, 1}, {0, 2}}));
    std::vector<std::string> names;
    for (const Seat& seat : store.seats(1)) names.push_back(seat.name);
    EXPECT_EQ(names, (std::vector<std::string>{"", "", "", "Bo", "paper 1", "paper 2"}));
}

TEST(OldRounds, TellHowTheyWereShown) {
    const TemporaryFolder folder;
    const BallotStore store(old_ballots(folder));
    const auto plan = store.plan_of(1);
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->sittings, (std::vector<std::vector<int>>{{1, 0, 2, 4, 3, 0, 1, 4, 2, 3}}));
    EXPECT_EQ(plan->times, (PresentationTimes{0.5, 0.5, 0.5}));
    EXPECT_EQ(plan->session, "/srv/livery/session.livery");
    EXPECT_EQ(plan->frames.size(), 14u);
    EXPECT_EQ(plan->frames.at(kWhiteFrame), "51a1c2b91318c5e4efb50fa79c99b424");
    std::vector<int> shown;
    for (const PresentationStep& step : store.steps_of(1)) {
        const int design = design_of(*plan, step.state);
        if (design >= 0) shown.push_back(design);
    }
    EXPECT_EQ(shown, plan->sittings[0]);
    EXPECT_EQ(store.steps_of(1).back().event, PresentationEvent::done);
    EXPECT_FALSE(store.presented());
    EXPECT_FALSE(store.open_round());
}

TEST(OldRounds, HoldTheDuelAndThePapers) {
    const TemporaryFolder folder;
    const BallotStore store(old_ballots(folder));
    const auto series = store.series_of(3);
    ASSERT_TRUE(series);
    EXPECT_EQ(series->id, 2);
    EXPECT_EQ(series->follows, 1);
    EXPECT_EQ(series->rounds, (std::vector<int>{2, 3, 4}));
    EXPECT_TRUE(series->over);
    for (const int round : series->rounds) {
        EXPECT_EQ(store.tally(round).best, (std::vector<int>{2, 1})) << round;
    }
    const auto duel = duel_of(store, 4);
    ASSERT_TRUE(duel);
    EXPECT_EQ(duel->statistics.consistent, 3);

    const Round papers = store.rounds()[4];
    EXPECT_EQ(papers.designs, (std::vector<std::string>{"red", "silver", "ivory"}));
    EXPECT_EQ(papers.codes, (std::vector<int>{481, 376, 912}));
    EXPECT_EQ(papers.calibration_id, "");
    EXPECT_EQ(votes(store, 5), (std::vector<std::pair<int, Ballot>>{{5, {2, 1}}, {6, {1, 2, 0}}}));
}

TEST(OldRounds, AreReportedWithWhatStandsBesideThem) {
    const TemporaryFolder folder;
    const auto file = old_ballots(folder);
    const RoundReportSource source = round_report_source(file, 1, 1);
    ASSERT_TRUE(source.record);
    EXPECT_EQ(source.record->seats, 6);
    EXPECT_EQ(source.record->round.voting_at, "2026-11-27T22:00:00Z");
    EXPECT_EQ(source.record->round.closed_at, "2026-11-27T22:00:18Z");
    ASSERT_EQ(source.record->showings.size(), 1u);
    EXPECT_EQ(source.record->showings[0].codes,
              (std::vector<int>{738, 587, 536, 879, 651, 587, 738, 879, 536, 651}));
    const RoundDetails& details = source.details;
    ASSERT_EQ(details.looks.size(), 5u);
    for (const LookDetails& look : details.looks) {
        EXPECT_TRUE(std::filesystem::exists(details.folder / look.picture)) << look.picture;
    }
    EXPECT_EQ(details.looks[1].code, 738);
    ASSERT_TRUE(details.looks[1].reachability);
    EXPECT_EQ(details.looks[1].reachability->reachable_fraction, 0.9541910331384016);
    ASSERT_TRUE(details.eye);
    EXPECT_EQ(details.eye->of, "of seat 7");
    EXPECT_EQ(details.eye->eye_mm, glm::dvec3(0.5, 480.0, 1000.0));
    ASSERT_EQ(details.eye->seats.size(), 2u);
    EXPECT_EQ(details.eye->seats[0].looks[1],
              (SeatMiss{738, 1.0825674533843994, 30.5997371673584, 0.36398467432950193}));
    EXPECT_FALSE(details.eye->seats[1].counts);
    EXPECT_FALSE(round_report(source).blocks.empty());
}

TEST(OldRounds, StayAsTheyWereWhenTheFileGoesOn) {
    const TemporaryFolder folder;
    const auto file = old_ballots(folder);
    const std::size_t entries = BallotStore(file).log().size();
    const std::string last = BallotStore(file).log().back().hash;
    {
        BallotStore store(file);
        const int round = store.open_round({"a", "b"}, "");
        EXPECT_EQ(round, 6);
        // Whose name it was in round 1, and a phone that joined then.
        EXPECT_EQ(store.vote(round, "bO", {1, 0}).seat, 4);
        store.vote(round, 2, {0, 1});
        store.close_round(round);
    }
    const BallotStore store(file);
    EXPECT_EQ(store.tally(6).best, (std::vector<int>{1, 1}));
    EXPECT_EQ(store.tally(1).best, (std::vector<int>{2, 2, 0, 0, 0}));
    EXPECT_EQ(store.log().at(entries - 1).hash, last);
}

TEST(OldRounds, ThatWereAlteredAreRefusedAndStayAsTheyAre) {
    const auto statements = [](Database& raw) {
        return raw.run("SELECT count(*) FROM sqlite_schema").at(0);
    };
    for (const auto& [statement, part] : std::vector<std::pair<const char*, const char*>>{
             {"UPDATE log SET best = 1, second = 0 WHERE id = 37", "log entry 37"},
             {"DELETE FROM log WHERE id = 37", "log entry 37"},
             {"DELETE FROM log WHERE id > 127", "log"},
             {"DROP TABLE rounds", "rounds"}}) {
        const TemporaryFolder folder;
        const auto file = old_ballots(folder);
        Database raw = raw_ballots(file);
        for (const char* event : {"UPDATE", "DELETE"}) {
            raw.run(std::string("DROP TRIGGER log_without_") + event);
        }
        raw.run(statement);
        const auto before = statements(raw);
        EXPECT_TRUE(fails_with([&] { BallotStore{file}; }, {"ballots.sqlite", part})) << statement;
        EXPECT_EQ(raw.version(), 4) << statement;
        EXPECT_EQ(statements(raw), before) << statement;
    }
}

TEST(OldRounds, AreKeptOnceAfterwards) {
    const TemporaryFolder folder;
    const auto file = old_ballots(folder);
    const auto log = [&] { return raw_ballots(file).run("SELECT * FROM log ORDER BY id"); };
    const auto before = log();
    { const BallotStore store(file); }
    EXPECT_EQ(log(), before);
    Database raw = raw_ballots(file);
    EXPECT_EQ(raw.version(), 5);
    EXPECT_EQ(raw.run("SELECT name FROM sqlite_schema WHERE type = 'table' ORDER BY name"),
              (std::vector<std::vector<DatabaseValue>>{{"invitations"}, {"log"}, {"seal"}}));
    EXPECT_EQ(raw.run("SELECT count(*) FROM invitations"),
              (std::vector<std::vector<DatabaseValue>>{{std::int64_t{1}}}));
}

}  // namespace
}  // namespace livery
