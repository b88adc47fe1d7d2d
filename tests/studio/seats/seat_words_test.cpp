// What the panels say of what seats miss.

#include <gtest/gtest.h>

#include "studio/seats/seats_panel.h"

namespace livery {
namespace {

const std::vector<EyeSeat> kSeats{{1, {-400.0, 480.0, 900.0}}, {4, {400.0, 480.0, 900.0}}};

SeatErrorResults found(std::map<int, std::map<int, SeatError>> errors) {
    SeatErrorResults results;
    for (const auto& [look, seats] : errors) {
        for (const auto& [seat, error] : seats) results.looks[look][seat] = {error, nullptr};
    }
    return results;
}

TEST(SeatWords, ASeatIsToldByTheLookWhereItMissesMost) {
    const auto results = found({{7, {{1, {0.1, 0.4, 0.0}}, {4, {0.5, 11.24, 0.24}}}},
                                {8, {{1, {0.2, 2.9, 0.04}}, {4, {0.5, 6.0, 0.1}}}}});
    const auto all = worst_looks(results, kSeats, {7, 8});
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].look, 8);
    EXPECT_EQ(in_words(all[0]), "Seat 1 sees what it should: 95% within 2.9.");
    EXPECT_EQ(all[1].look, 7);
    EXPECT_EQ(in_words(all[1]),
              "Seat 4 sees highlights where none should be: 95% within CIEDE2000 11.2.");
}

TEST(SeatWords, MoreThanAFifthOverThreeIsNamed) {
    const auto at = [](double first, double second) {
        return worst_looks(
            found({{7, {{1, {0.0, 9.0, first}}, {4, {0.0, 9.0, second}}}}}), kSeats, {7});
    };
    EXPECT_EQ(unfair_in_words(at(0.0, 0.2)), "") << "a fifth is no more than a fifth";
    EXPECT_EQ(unfair_in_words(at(0.0, 0.21)),
              "Seat 4 sees other looks than it should: up to 21% of one is more than 3 "
              "(CIEDE2000) off.");
    EXPECT_EQ(unfair_in_words(at(0.5, 0.3)).substr(0, 40),
              "Seats 1, 4 see other looks than they sho");
}

TEST(SeatWords, NothingIsSaidOfASeatBeforeAllOfItsLooksAreFound) {
    const auto results =
        found({{7, {{1, {0.1, 0.4, 0.0}}, {4, {0.5, 11.0, 0.24}}}}, {8, {{4, {0.5, 6.0, 0.1}}}}});
    const auto all = worst_looks(results, kSeats, {7, 8});
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].seat, 4);
    EXPECT_TRUE(worst_looks(results, kSeats, {}).empty());
    EXPECT_TRUE(worst_looks(results, kSeats, {9}).empty());
}

}  // namespace
}  // namespace livery
