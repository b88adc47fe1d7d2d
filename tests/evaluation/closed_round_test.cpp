#include "evaluation/closed_round.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "evaluation/ballots.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

std::filesystem::path closed_then_open(const TemporaryFolder& folder) {
    const auto file = folder / "votes.livery-ballots";
    BallotStore store(file);
    const int round = store.open_round({"red, bright", "silver", "sand"}, "1234abcd");
    int number = 0;
    for (const auto& [best, second] :
         std::initializer_list<std::pair<int, int>>{{0, 1}, {0, 1}, {1, 2}, {2, 0}, {0, 2}}) {
        store.vote(round, "evaluator " + std::to_string(++number), {best, second});
    }
    store.close_round(round);
    store.open_round({"x", "y"}, "");
    return file;
}

std::vector<std::pair<int, int>> choices(const ClosedRound& round) {
    std::vector<std::pair<int, int>> all;
    for (const Ballot& ballot : round.ballots) all.emplace_back(ballot.best, ballot.second);
    return all;
}

TEST(ClosedRound, HasItsBallotsInAnOrderOfChance) {
    const TemporaryFolder folder;
    const auto file = closed_then_open(folder);
    const ClosedRound round = read_closed_round(file, {}, 1);
    EXPECT_EQ(round.round.id, 1);
    EXPECT_EQ(round.round.calibration_id, "1234abcd");
    EXPECT_EQ(round.round.designs.size(), 3u);
    EXPECT_EQ(counts_of(round.ballots, 3, false).best, (std::vector<int>{3, 1, 1}));
    EXPECT_EQ(choices(read_closed_round(file, 1, 1)), choices(round));
    // Some of ten seeds give another order, all the same ballots.
    int others = 0;
    auto sorted = choices(round);
    std::sort(sorted.begin(), sorted.end());
    for (std::uint64_t seed = 2; seed < 12; ++seed) {
        auto other = choices(read_closed_round(file, {}, seed));
        others += other != choices(round) ? 1 : 0;
        std::sort(other.begin(), other.end());
        EXPECT_EQ(other, sorted);
    }
    EXPECT_GT(others, 5);
}

TEST(ClosedRound, IsHandedOnWithItsSeed) {
    const TemporaryFolder folder;
    const ClosedRound round = read_closed_round(closed_then_open(folder), {}, 9);
    const std::string text = ballots_csv(round, 9);
    EXPECT_NE(text.find("# calibration 1234abcd\r\n"), std::string::npos) << text;
    EXPECT_NE(text.find("seed 9\r\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\r\n\"red, bright\",silver\r\n"), std::string::npos) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4 + 5);
    EXPECT_EQ(text.find("evaluator"), std::string::npos) << text;
}

TEST(ClosedRound, TellsNothingBeforeTheClose) {
    const TemporaryFolder folder;
    const auto file = closed_then_open(folder);
    EXPECT_NE(message_of([&] { read_closed_round(file, 2, 1); }).find("round 2 is open"),
              std::string::npos);
    EXPECT_NE(
        message_of([&] { read_closed_round(file, 3, 1); }).find("found round 3, expected one"),
        std::string::npos);
    const auto fresh = folder / "fresh.livery-ballots";
    { BallotStore(fresh).open_round({"x", "y"}, ""); }
    EXPECT_NE(message_of([&] { read_closed_round(fresh, {}, 1); }).find("no round"),
              std::string::npos);
    const auto none = folder / "none.livery-ballots";
    EXPECT_NE(message_of([&] { read_closed_round(none, {}, 1); }).find("no such file"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(none));
}

TEST(ClosedRound, KeepsTheLeastOnesAndSaysWhetherAllNamedOne) {
    const TemporaryFolder folder;
    const auto file = folder / "votes.sqlite";
    BallotStore store(file);
    RoundSetup setup{{"red", "silver", "sand"}};
    setup.asks_least = true;
    for (const bool all : {true, false}) {
        const int round = store.open_round(setup);
        store.vote(round, "one", {0, 1, 2});
        store.vote(round, "two", {2, 1, all ? 0 : -1});
        store.close_round(round);
        const ClosedRound closed = read_closed_round(file, round, 1);
        EXPECT_EQ(closed.all_name_least, all);
        const std::string csv = ballots_csv(closed, 1);
        EXPECT_NE(csv.find("best,second,least\r\n"), std::string::npos) << csv;
        EXPECT_NE(csv.find("red,silver,sand\r\n"), std::string::npos) << csv;
        EXPECT_NE(csv.find(all ? "sand,silver,red\r\n" : "sand,silver,\r\n"), std::string::npos)
            << csv;
        if (all) {
            EXPECT_EQ(counts_of(closed.ballots, 3, true).least, (std::vector<int>{1, 0, 1}));
        }
    }
}

}  // namespace
}  // namespace livery
