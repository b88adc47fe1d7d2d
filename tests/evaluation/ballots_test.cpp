#include "evaluation/ballots.h"

#include <regex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evaluation/ballot_file.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

const std::vector<std::string> kDesigns = {"a", "b", "c", "d"};

/// The message of what `work` throws as E; fails when it throws nothing or something else.
template <typename E, typename Work>
std::string thrown(Work&& work) {
    try {
        work();
    } catch (const E& error) {
        return error.what();
    } catch (const std::exception& error) {
        ADD_FAILURE() << "another exception: " << error.what();
        return "";
    }
    ADD_FAILURE() << "nothing thrown";
    return "";
}

TEST(Ballots, CountTableThreeOfThePaper) {
    const TemporaryFolder folder;
    BallotStore store(folder / "votes.livery-ballots");
    const int round = store.open_round(kDesigns, "1234abcd");
    // Ten evaluators; best 1, 6, 1, 2 and second best 0, 3, 2, 5 of designs a to d.
    const std::pair<int, int> votes[] = {
        {0, 1}, {1, 3}, {1, 3}, {1, 3}, {1, 3}, {1, 3}, {1, 2}, {2, 1}, {3, 1}, {3, 2}};
    int number = 0;
    for (const auto& [best, second] : votes) {
        store.vote(round, "evaluator " + std::to_string(++number), {best, second});
    }
    EXPECT_EQ(store.rounds().at(0).ballots, 10);
    store.close_round(round);
    const VoteCounts tally = store.tally(round);
    EXPECT_EQ(store.round(round).designs, kDesigns);
    EXPECT_EQ(tally.best, (std::vector<int>{1, 6, 1, 2}));
    EXPECT_EQ(tally.second, (std::vector<int>{0, 3, 2, 5}));
    EXPECT_EQ(tally_csv(kDesigns, tally),
              "design,best,second\r\na,1,0\r\nb,6,3\r\nc,1,2\r\nd,2,5\r\n");
}

TEST(Ballots, AreNobodyElsesToRead) {
    const TemporaryFolder folder;
    const auto file = folder / "votes.livery-ballots";
    const auto rights = [&](const char* suffix) {
        auto path = file;
        path += suffix;
        return static_cast<unsigned>(std::filesystem::status(path).permissions());
    };
    {
        BallotStore store(file);
        store.open_round(kDesigns, "1234abcd");
        EXPECT_EQ(rights(""), 0600u);
        EXPECT_EQ(rights("-wal"), 0600u);
    }
    // A file of a program that left them open.
    std::filesystem::permissions(file, std::filesystem::perms{0644});
    const BallotStore store(file);
    EXPECT_EQ(rights(""), 0600u);
}

TEST(Ballots, ARoundIsKeptWithItsCircumstances) {
    const TemporaryFolder folder;
    const auto file = folder / "Stimmen für heute.ballots";
    {
        BallotStore store(file);
        EXPECT_EQ(store.file(), file);
        EXPECT_TRUE(store.rounds().empty());
        EXPECT_FALSE(store.open_round());
        const int first = store.open_round({"Blau", "Rot"}, "");
        store.vote(first, "Ann", {1, 0});
        store.close_round(first);
        store.vote(store.open_round({"x", "y", "z"}, "cafe"), "Bo", {2, 0});
    }
    const BallotStore store(file);
    const auto rounds = store.rounds();
    ASSERT_EQ(rounds.size(), 2u);
    EXPECT_TRUE(rounds[0].closed());
    EXPECT_EQ(rounds[0].calibration_id, "");
    EXPECT_EQ(rounds[0].designs, (std::vector<std::string>{"Blau", "Rot"}));
    EXPECT_EQ(rounds[0].ballots, 1);
    EXPECT_TRUE(
        std::regex_match(rounds[0].created, std::regex(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ)")));
    EXPECT_FALSE(rounds[1].closed());
    EXPECT_EQ(rounds[1].calibration_id, "cafe");
    EXPECT_EQ(store.open_round().value().id, rounds[1].id);
    EXPECT_EQ(store.tally(rounds[0].id).best, (std::vector<int>{0, 1}));
}

TEST(Ballots, ASecondOneReplacesTheFirstAndBothAreLogged) {
    const TemporaryFolder folder;
    const auto file = folder / "votes";
    BallotStore store(file);
    const int round = store.open_round(kDesigns, "");
    store.vote(round, "Åsa", {0, 1});
    store.vote(round, "Bo", {0, 2});
    store.vote(round, " åSA ", {3, 2});
    EXPECT_EQ(store.open_round().value().ballots, 2);
    store.close_round(round);
    const VoteCounts tally = store.tally(round);
    EXPECT_EQ(tally.best, (std::vector<int>{1, 0, 0, 1}));
    EXPECT_EQ(tally.second, (std::vector<int>{0, 0, 2, 0}));
    auto raw = raw_ballots(file);
    EXPECT_EQ(raw.run("SELECT seat, best, second FROM log WHERE what = 'vote' ORDER BY id"),
              (std::vector<std::vector<DatabaseValue>>{
                  {std::int64_t{1}, std::int64_t{0}, std::int64_t{1}},
                  {std::int64_t{2}, std::int64_t{0}, std::int64_t{2}},
                  {std::int64_t{1}, std::int64_t{3}, std::int64_t{2}}}));
    EXPECT_EQ(store.seats(1).at(0).name, "Åsa");
    EXPECT_EQ(store.seats(1).size(), 2u);
}

TEST(Ballots, CountsStayHiddenAndAClosedRoundStaysClosed) {
    const TemporaryFolder folder;
    BallotStore store(folder / "votes");
    const int round = store.open_round(kDesigns, "");
    store.vote(round, "Ann", {0, 1});
    EXPECT_EQ(thrown<Refused>([&] { store.tally(round); }),
              "round 1 is open: votes told now would sway those to come; close the round, then "
              "ask for its ballots");
    EXPECT_EQ(thrown<Refused>([&] {
                  store.open_round({"x", "y"}, "");
              }),
              "round 1 is still open; close it before opening the next");
    store.close_round(round);
    EXPECT_EQ(thrown<Refused>([&] {
                  store.vote(round, "Bo", {0, 1});
              }),
              "round 1 is closed, so the ballot of Bo is too late; open a new round and vote "
              "there");
    EXPECT_EQ(thrown<Refused>([&] {
                  store.vote(round, "Ann", {1, 0});
              }),
              "round 1 is closed, so the ballot of Ann is too late; open a new round and vote "
              "there");
    EXPECT_EQ(thrown<Refused>([&] { store.close_round(round); }),
              "round 1 is closed already; open a new round to vote again");
    EXPECT_EQ(store.tally(round).best, (std::vector<int>{1, 0, 0, 0}));
    EXPECT_EQ(store.open_round({"x", "y"}, ""), 2);
}

TEST(Ballots, RefuseWhatMakesNoSense) {
    const TemporaryFolder folder;
    BallotStore store(folder / "votes");
    const auto wrong = [&](auto work) { return thrown<std::invalid_argument>(work); };
    EXPECT_EQ(wrong([&] { store.open_round({"only"}, ""); }),
              "open_round: found 1 designs, expected at least 2 to choose between");
    EXPECT_EQ(wrong([&] {
                  store.open_round({"a", ""}, "");
              }),
              "open_round: found a design without a name");
    EXPECT_EQ(wrong([&] {
                  store.open_round({"a", "b", "a"}, "");
              }),
              "open_round: found \"a\" twice, expected different names");
    EXPECT_TRUE(store.rounds().empty());

    const int round = store.open_round(kDesigns, "");
    EXPECT_EQ(wrong([&] {
                  store.vote(round, "Ann", {2, 2});
              }),
              "ballot of Ann: found design 2 as best and as second best, expected two designs");
    EXPECT_EQ(wrong([&] {
                  store.vote(round, "Ann", {0, 4});
              }),
              "ballot of Ann: found design 4, expected 0 to 3");
    EXPECT_EQ(wrong([&] {
                  store.vote(round, "Ann", {-1, 0});
              }),
              "ballot of Ann: found design -1, expected 0 to 3");
    EXPECT_EQ(wrong([&] {
                  store.vote(7, "Ann", {0, 1});
              }),
              "found round 7, expected one of the 1 rounds");
    EXPECT_EQ(wrong([&] {
                  store.vote(round, " ", {0, 1});
              }),
              "evaluator: found no name, expected a name of 1 to 200 bytes");
    EXPECT_THROW(store.tally(0), std::invalid_argument);
    EXPECT_THROW(store.close_round(-1), std::invalid_argument);
    EXPECT_EQ(store.open_round().value().ballots, 0);
}

TEST(Ballots, TheLogIsOnlyAppendedToAndKeepsItsRulesWhoeverWrites) {
    const TemporaryFolder folder;
    const auto made = [&](const char* name) {
        const auto file = folder / name;
        BallotStore store(file);
        store.join(store.open_session(), "aa", 9);
        const int round = store.open_round(kDesigns, "");
        store.vote(round, "Ann", {0, 1});
        store.close_round(round);
        RoundSetup scales{{"a", "b"}};
        scales.scales = {{"cheap", "precious"}};
        store.vote(store.open_round(scales), 1, {0, 1});
        return file;
    };
    {
        auto raw = raw_ballots(made("raw"));
        for (const char* statement : {"UPDATE log SET best = 2", "DELETE FROM log"}) {
            const std::string message = thrown<FileError>([&] { raw.run(statement); });
            EXPECT_NE(message.find("only appended to"), std::string::npos) << message;
        }
    }
    using E = LogEntry;
    int number = 0;
    for (const auto& [round, what, why] : std::vector<std::tuple<int, E::What, std::string>>{
             {2, E::Vote{1, {1, 1}}, "as best and as second best"},
             {2, E::Vote{1, {0, 1, 1}}, "does not ask for it"},
             {2, E::Vote{1, {0, 9}}, "found design 9"},
             {2, E::Vote{3, {0, 1}}, "found no seat 3"},
             {1, E::Vote{2, {1, 2}}, "is closed"},
             {9, E::Vote{1, {0, 1}}, "found round 9"},
             {1, E::Close{}, "is closed already"},
             {3, E::Open{}, "round 2 is still open"},
             {2, E::Design{2, "b", 555}, "under vote"},
             {2, E::Rating{2, 0, 0, 4}, "has not voted"},
             {2, E::Rating{1, 0, 0, 8}, "found step 8"},
             {2, E::Rating{1, 2, 0, 4}, "found design 2"},
             {2, E::Rating{1, 0, 1, 4}, "found scale 1"},
             {2, E::Shown{}, "without a presentation"},
             {0, E::Seat{3, false, "anN"}, "second seat"},
             {0, E::Seat{4, true, "bb"}, "found seat 4, expected 3"}}) {
        const auto file = made(std::to_string(number++).c_str());
        forge(file, 1, round, what);
        const std::string message = thrown<FileError>([&] { BallotStore{file}; });
        EXPECT_NE(message.find(why), std::string::npos) << message;
        EXPECT_NE(message.find("log entry "), std::string::npos) << message;
    }
}

TEST(Ballots, OfManyStoresOnOneFileAreAllCounted) {
    const TemporaryFolder folder;
    const auto file = folder / "votes";
    const int stores = 4, each = 15;
    std::vector<std::thread> voters;
    // Who comes first makes the file and opens the round.
    for (int who = 0; who < stores; ++who) {
        voters.emplace_back([&, who] {
            try {
                BallotStore store(file);
                int round = 0;
                try {
                    round = store.open_round(kDesigns, "");
                } catch (const Refused&) {
                    round = store.open_round().value().id;
                }
                for (int k = 0; k < each; ++k) {
                    store.vote(
                        round, std::to_string(who) + "/" + std::to_string(k), {who, 3 - who});
                }
            } catch (const std::exception& error) {
                ADD_FAILURE() << error.what();
            }
        });
    }
    for (auto& voter : voters) voter.join();
    BallotStore store(file);
    ASSERT_EQ(store.rounds().size(), 1u);
    store.close_round(1);
    EXPECT_EQ(store.tally(1).best, (std::vector<int>{each, each, each, each}));
    EXPECT_EQ(store.tally(1).second, (std::vector<int>{each, each, each, each}));
}

TEST(TallyText, QuotesWhatASpreadsheetWouldTear) {
    EXPECT_EQ(tally_csv({"plain", "with, comma", "with \"quotes\"", "two\nlines"},
                        {{1, 2, 3, 4}, {0, 0, 1, 0}}),
              "design,best,second\r\nplain,1,0\r\n\"with, comma\",2,0\r\n"
              "\"with \"\"quotes\"\"\",3,1\r\n\"two\nlines\",4,0\r\n");
    // No name is a formula for a spreadsheet; numbers stay numbers.
    EXPECT_EQ(tally_csv({"=1+2", "+a", "-b", "@c", "\tx"}, {{1, 0, 0, 0, 0}, {0, 1, 0, 0, 0}}),
              "design,best,second\r\n'=1+2,1,0\r\n'+a,0,1\r\n'-b,0,0\r\n'@c,0,0\r\n'\tx,0,0\r\n");
    EXPECT_EQ(tally_csv({}, {}), "design,best,second\r\n");
    EXPECT_EQ(tally_csv({"a", "b"}, {{1, 2}, {2, 1}, {0, 3}}),
              "design,best,second,least\r\na,1,2,0\r\nb,2,1,3\r\n");
    EXPECT_EQ(thrown<std::invalid_argument>([] {
                  tally_csv({"a"}, {{1, 2}, {0}});
              }),
              "tally_csv: 1 designs, 2 and 1 counts");
}

}  // namespace
}  // namespace livery
