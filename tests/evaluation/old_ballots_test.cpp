// Files that an older Livery wrote.

#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "evaluation/ballot_file.h"
#include "evaluation/ballots.h"
#include "evaluation/design_codes.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// The file of format 1, a statement a line, and more statements after it.
std::filesystem::path old_file(const TemporaryFolder& folder,
                               const std::vector<std::string>& more = {}) {
    const auto file = folder / "old.sqlite";
    Database raw(file, Database::Mode::create, kBallotsId, 1, ballots_schema());
    std::ifstream lines(std::filesystem::path(LIVERY_TEST_DATA) / "ballots-v1.sql");
    int statements = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("--")) continue;
        raw.run(line);
        ++statements;
    }
    EXPECT_GT(statements, 30);
    for (const auto& statement : more) raw.run(statement);
    raw.set_version(1);
    return file;
}

TEST(OldBallots, BecomeOnesWithSeatsAndCodes) {
    const TemporaryFolder folder;
    const auto file = old_file(folder);
    const auto look = [&](const BallotStore& store) {
        const auto rounds = store.rounds();
        ASSERT_EQ(rounds.size(), 2u);
        EXPECT_EQ(rounds[0].designs,
                  (std::vector<std::string>{"Blau metallic", "Rot, solid", "Elfenbein"}));
        EXPECT_EQ(rounds[0].codes, draw_codes(3, 1, 1));
        EXPECT_EQ(rounds[0].calibration_id, "1234abcd");
        EXPECT_EQ(rounds[0].created, "2026-11-25T03:36:03Z");
        EXPECT_TRUE(rounds[0].closed);
        EXPECT_EQ(rounds[0].ballots, 3);
        EXPECT_FALSE(rounds[1].closed);
        EXPECT_TRUE(rounds[1].voting);
        EXPECT_EQ(store.tally(1).best, (std::vector<int>{0, 2, 1}));
        EXPECT_EQ(store.tally(1).second, (std::vector<int>{1, 1, 1}));
        ASSERT_EQ(store.session(), 1);
        const auto seats = store.seats(1);
        ASSERT_EQ(seats.size(), 3u);
        EXPECT_EQ(seats[0].name, "Åsa");
        EXPECT_EQ(seats[1].name, "Bo");
        EXPECT_EQ(seats[2].name, "Cem");
    };
    {
        BallotStore store(file);
        look(store);
        // The round goes on, and one person stays one.
        store.vote(2, {"bO", 1, 0});
        store.vote(2, {"Åsa", 0, 1});
        EXPECT_EQ(store.voted(2), (std::vector<int>{1, 2}));
    }
    look(BallotStore(file));
    auto raw = raw_ballots(file);
    EXPECT_EQ(raw.version(), 4);
    EXPECT_EQ(raw.run("SELECT text FROM log WHERE what = 'migrated'"),
              (std::vector<std::vector<DatabaseValue>>{{"cc03d3b63d3020fabd89947e6ac56c22"}}));
    // The replaced ballot is in the new log too.
    EXPECT_EQ(raw.run("SELECT count(*) FROM log WHERE what = 'vote' AND round = 1"),
              (std::vector<std::vector<DatabaseValue>>{{std::int64_t{4}}}));
}

TEST(OldBallots, ThatWereChangedAreRefusedAndStayAsTheyAre) {
    const std::string drop = "DROP TRIGGER log_without_UPDATE";
    for (const auto& [statements, part] :
         std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{drop, "UPDATE log SET best = 1, second = 0 WHERE id = 6"}, "log entry 6"},
             {{"UPDATE ballots SET best = 1, second = 0 WHERE round = 2"}, "not those of the log"},
             {{"DROP TRIGGER ballot_kept", "DELETE FROM ballots WHERE round = 2"},
              "not those of the log"},
             {{"UPDATE designs SET name = 'z' WHERE name = 'x'"}, "not those of the log"}}) {
        const TemporaryFolder folder;
        const auto file = old_file(folder, statements);
        EXPECT_TRUE(fails_with([&] { BallotStore{file}; }, {"old.sqlite", part})) << part;
        EXPECT_EQ(raw_ballots(file).version(), 1) << part;
    }
}

TEST(OldBallots, AnEmptyFileBecomesAnEmptyOne) {
    const TemporaryFolder folder;
    const auto file = old_file(folder,
                               {"DROP TRIGGER log_without_DELETE",
                                "DROP TRIGGER ballot_kept",
                                "DELETE FROM ballots",
                                "DELETE FROM designs",
                                "DELETE FROM rounds",
                                "DELETE FROM log"});
    BallotStore store(file);
    EXPECT_TRUE(store.rounds().empty());
    EXPECT_FALSE(store.session());
    EXPECT_EQ(store.open_round({"a", "b"}, ""), 1);
}

}  // namespace
}  // namespace livery
