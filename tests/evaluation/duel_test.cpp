// Blind repeats in a ballots file: linked, each with codes of its own, told when all are over.
#include "evaluation/duel.h"

#include <functional>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "evaluation/ballots.h"
#include "evaluation/closed_round.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// Whether `work` throws Refused with every part in its message.
template <typename Work>
::testing::AssertionResult refused_with(Work&& work,
                                        std::initializer_list<std::string_view> parts) {
    try {
        work();
    } catch (const Refused& refused) {
        const std::string message = refused.what();
        for (const auto part : parts) {
            if (message.find(part) != std::string::npos) continue;
            return ::testing::AssertionFailure() << "no \"" << part << "\" in \"" << message << '"';
        }
        return ::testing::AssertionSuccess();
    }
    return ::testing::AssertionFailure() << "nothing refused";
}

class DuelTest : public ::testing::Test {
  protected:
    DuelTest() {
        const int session = store_.open_session();
        for (int phone = 1; phone <= 10; ++phone) {
            store_.join(session, "phone " + std::to_string(phone), 40);
        }
        // Table 3 of the paper
        first_ = store_.open_round({"a", "b", "c", "d"}, "1234");
        const std::pair<int, int> votes[] = {
            {0, 1}, {1, 3}, {1, 3}, {1, 3}, {1, 3}, {1, 3}, {1, 2}, {2, 1}, {3, 1}, {3, 2}};
        int seat = 0;
        for (const auto& [best, second] : votes) store_.vote(first_, ++seat, {best, second});
        store_.close_round(first_);
    }
    /// The next repeat, in which the first `for_first` seats choose the first look and the others
    /// the other; its round.
    int repeat(int of, int for_first, int voters = 10) {
        const int round = store_.open_round(next_repeat(store_, of, 7));
        store_.start_voting(round);
        for (int seat = 1; seat <= voters; ++seat) {
            store_.vote(round, seat, seat <= for_first ? Ballot{0, 1} : Ballot{1, 0});
        }
        store_.close_round(round);
        return round;
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "ballots.sqlite";
    BallotStore store_{file_};
    int first_ = 0;
};

TEST_F(DuelTest, IsOfTheTwoLargestWorths) {
    const VoteCounts table3{{1, 6, 1, 2}, {0, 3, 2, 5}};
    EXPECT_EQ(leading_two(table3, {"a", "b", "c", "d"}), (std::array<int, 2>{1, 3}));
    EXPECT_EQ(leading_two({{2, 5}, {5, 2}}, {"a", "b"}), (std::array<int, 2>{1, 0}));
    EXPECT_TRUE(refused_with(
        [] {
            leading_two({{6, 2, 2}, {2, 4, 4}}, {"a", "b", "c"});
        },
        {"second place is shared", "b and c"}));
    EXPECT_TRUE(refused_with(
        [] {
            leading_two({{4, 4, 4}, {4, 4, 4}}, {"a", "b", "c"});
        },
        {"a, b and c"}));
    EXPECT_TRUE(refused_with([] { leading_two({{0, 0}, {0, 0}}, {"a", "b"}); }, {"nobody"}));
    EXPECT_NO_THROW(leading_two({{4, 4, 1}, {4, 4, 1}}, {"a", "b", "c"})) << "a tie for the first";
}

TEST_F(DuelTest, RepeatsAreLinkedRoundsWithCodesOfTheirOwn) {
    const RoundSetup setup = next_repeat(store_, first_, 7);
    EXPECT_EQ(setup.designs, (std::vector<std::string>{"b", "d"}));
    EXPECT_EQ(setup.calibration_id, "1234");
    const int one = repeat(first_, 9), two = repeat(one, 8), three = repeat(two, 9);
    const auto series = store_.series_of(two);
    ASSERT_TRUE(series);
    EXPECT_EQ(series->id, one);
    EXPECT_EQ(series->rounds, (std::vector<int>{one, two, three}));
    EXPECT_EQ(series->follows, first_);
    EXPECT_TRUE(series->over);
    EXPECT_FALSE(store_.series_of(first_));
    std::set<int> seeds, codes;
    for (const Round& round : store_.rounds()) {
        if (round.id == first_) continue;
        seeds.insert(round.seed);
        codes.insert(round.codes.begin(), round.codes.end());
    }
    EXPECT_EQ(seeds, (std::set<int>{7, 8, 9}));
    EXPECT_GE(codes.size(), 5u) << "drawn anew";
    EXPECT_TRUE(refused_with([&] { next_repeat(store_, two, 7); }, {"is over"}));

    const auto duel = duel_of(store_, three);
    ASSERT_TRUE(duel);
    EXPECT_EQ(duel->statistics.majorities, (std::array<int, 2>{9, 1}));
    EXPECT_EQ(duel->statistics.consistent, 9);
    EXPECT_EQ(duel->votes, (std::vector<std::array<int, 2>>{{9, 1}, {8, 2}, {9, 1}}));
    EXPECT_NE(duel->words.find("b is preferred to d in the duel: 9 of 10"), std::string::npos)
        << duel->words;
    EXPECT_FALSE(duel_of(store_, first_)) << "what came before is no part of it";
    EXPECT_EQ(store_.tally(first_).best, (std::vector<int>{1, 6, 1, 2}));
    EXPECT_NO_THROW(BallotStore{file_}) << "the log leads to the same series";
}

TEST_F(DuelTest, NothingIsToldBeforeTheLastRepeat) {
    const int one = repeat(first_, 9);
    for (const auto& tell :
         std::vector<std::function<void()>>{[&] { store_.tally(one); },
                                            [&] { store_.ballots(one); },
                                            [&] { duel_of(store_, one); },
                                            [&] { read_closed_round(file_, one, 1); }}) {
        EXPECT_TRUE(refused_with(tell, {"1 are locked", "would sway the repeats to come"}));
    }
    EXPECT_NO_THROW(store_.tally(first_));
    ASSERT_TRUE(store_.series_under_way());
    EXPECT_EQ(store_.series_under_way()->id, one);
    // A repeat that was broken off before people could vote is held again.
    const int broken = store_.open_round(next_repeat(store_, one, 7));
    store_.close_round(broken);
    EXPECT_EQ(store_.series_of(one)->rounds, (std::vector<int>{one}));
    const int two = repeat(one, 9, 4);
    // Killed and back: the series goes on.
    EXPECT_EQ(BallotStore(file_).series_under_way()->rounds, (std::vector<int>{one, two}));
    // Given up: what there is is told, and that it is not all.
    const int other = store_.open_round({"x", "y"}, "");
    EXPECT_FALSE(store_.series_under_way());
    store_.close_round(other);
    const auto duel = duel_of(store_, two);
    ASSERT_TRUE(duel);
    EXPECT_EQ(duel->statistics.incomplete, 10);
    EXPECT_EQ(duel->statistics.majorities, (std::array<int, 2>{4, 0}));
    EXPECT_NE(duel->words.find("broken off after 2 of 3"), std::string::npos) << duel->words;
    EXPECT_TRUE(refused_with([&] { next_repeat(store_, two, 7); }, {"is over"}));
}

TEST_F(DuelTest, ANewAudienceEndsASeries) {
    const int one = repeat(first_, 9);
    store_.open_session();
    EXPECT_TRUE(store_.series_of(one)->over);
    EXPECT_NO_THROW(store_.tally(one));
}

TEST_F(DuelTest, OtherQuestionsAreNoRepeats) {
    const int one = repeat(first_, 9);
    const RoundSetup good = next_repeat(store_, one, 7);
    RoundSetup setup = good;
    setup.designs = {"d", "b"};
    EXPECT_THROW(store_.open_round(setup), std::invalid_argument);
    setup = good;
    setup.series->repeats = 5;
    EXPECT_THROW(store_.open_round(setup), std::invalid_argument);
    setup = good;
    setup.series->series = first_;
    EXPECT_THROW(store_.open_round(setup), std::invalid_argument);
    setup = good;
    setup.designs = {"b", "d", "a"};
    setup.series->series = 0;
    EXPECT_THROW(store_.open_round(setup), std::invalid_argument) << "a duel is of two";
    EXPECT_FALSE(store_.open_round());
}

}  // namespace
}  // namespace livery
