// Seats round a mock-up: whose eye it is, where they are at first, what cannot be.

#include "scene/seats.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace livery {
namespace {

/// A model car on a table: 180 mm long, along z.
const Bounds kCar{{-36.0, 0.0, -90.0}, {36.0, 55.0, 90.0}};
const glm::dvec3 kEye_mm{281.0, 425.0, 696.0};

double azimuth(const glm::dvec3& x) { return std::atan2(x.x, x.z); }

TEST(Seats, TheEyeIsAPointASeatOrTheMeanOfThoseThatCount) {
    const std::vector<EyeSeat> seats{
        {1, {-300.0, 480.0, 900.0}}, {2, {100.0, 500.0, 700.0}}, {9, {5000.0, 0.0, 0.0}, false}};
    const glm::dvec3 hand(1.0, 2.0, 3.0);
    EXPECT_EQ(eye_in_use_mm(hand, seats, {}), hand);
    EXPECT_EQ(eye_in_use_mm(hand, seats, {EyeSource::seat, 9}), seats[2].eye_mm);
    EXPECT_EQ(eye_in_use_mm(hand, seats, {EyeSource::mean, 0}), glm::dvec3(-100.0, 490.0, 800.0));
    EXPECT_THROW(eye_in_use_mm(hand, seats, {EyeSource::seat, 3}), std::invalid_argument);
    EXPECT_THROW(eye_in_use_mm(hand, {seats[2]}, {EyeSource::mean, 0}), std::invalid_argument);
    EXPECT_EQ(in_words(seats, {EyeSource::mean, 0}), "in the mean of 2 seats");
    EXPECT_EQ(in_words(seats, {EyeSource::seat, 9}), "of seat 9");
}

TEST(Seats, SeatedEyesAreAboveTheFloorThatTheMockUpsTableStandsOn) {
    // 1.2 m above the floor, the table's top at 0.72 m
    EXPECT_DOUBLE_EQ(seated_eye_height_mm(kCar), 480.0);
    // The same on another height of the frame
    EXPECT_DOUBLE_EQ(seated_eye_height_mm({{0.0, 100.0, 0.0}, {50.0, 150.0, 50.0}}), 580.0);
    // A car of full size stands on the floor
    EXPECT_DOUBLE_EQ(seated_eye_height_mm({{-900.0, 0.0, -2250.0}, {900.0, 1400.0, 2250.0}}),
                     1200.0);
}

TEST(Seats, AnArcIsBeforeTheEyeAtArmsLengthAndFromLeftToRight) {
    const double radius_mm = std::hypot(36.0, 90.0) + 700.0;
    const auto seats = seats_in_an_arc(kCar, kEye_mm, 3);
    ASSERT_EQ(seats.size(), 3u);
    EXPECT_FALSE(seats_problem(seats));
    for (const EyeSeat& seat : seats) {
        EXPECT_NEAR(std::hypot(seat.eye_mm.x, seat.eye_mm.z), radius_mm, 1e-9);
        EXPECT_DOUBLE_EQ(seat.eye_mm.y, 480.0);
        EXPECT_TRUE(seat.counts);
    }
    EXPECT_NEAR(azimuth(seats[1].eye_mm), azimuth(kEye_mm), 1e-9);
    // 650 mm along the arc to the next, and number 1 on the left of who faces the mock-up
    EXPECT_NEAR(radius_mm * (azimuth(seats[2].eye_mm) - azimuth(seats[1].eye_mm)), 650.0, 1e-9);
    EXPECT_LT(azimuth(seats[0].eye_mm), azimuth(seats[1].eye_mm));
    EXPECT_TRUE(seats_in_an_arc(kCar, kEye_mm, 0).empty());
    EXPECT_THROW(seats_in_an_arc(kCar, kEye_mm, 41), std::invalid_argument);
}

TEST(Seats, ALongArcIsWiderAndNeverGoesMoreThanHalfRound) {
    for (const int count : {5, 10, 20, 40}) {
        const auto seats = seats_in_an_arc(kCar, {0.0, 400.0, 700.0}, count);
        ASSERT_EQ(seats.size(), static_cast<std::size_t>(count));
        EXPECT_FALSE(seats_problem(seats)) << count;
        for (const EyeSeat& seat : seats) EXPECT_GT(seat.eye_mm.z, -1e-6) << count;
        // Symmetrical: their mean is right before the mock-up.
        EXPECT_NEAR(mean_eye_mm(seats)->x, 0.0, 1e-6);
    }
}

TEST(Seats, OneByOneTheyFillTheArcFromItsMiddleAndThenAWiderOne) {
    std::vector<EyeSeat> seats;
    for (int k = 1; k <= static_cast<int>(kMostSeats); ++k) {
        const EyeSeat next = next_seat(kCar, kEye_mm, seats);
        EXPECT_EQ(next.number, k);
        seats.push_back(next);
        ASSERT_FALSE(seats_problem(seats)) << *seats_problem(seats);
    }
    EXPECT_NEAR(azimuth(seats.front().eye_mm), azimuth(kEye_mm), 1e-9);
    EXPECT_GT(glm::length(seats.back().eye_mm), glm::length(seats.front().eye_mm));
    EXPECT_THROW(next_seat(kCar, kEye_mm, seats), std::invalid_argument);
    // A gap is filled again, with its number.
    const EyeSeat third = seats[2];
    seats.erase(seats.begin() + 2);
    EXPECT_EQ(next_seat(kCar, kEye_mm, seats).number, 3);
    EXPECT_LT(glm::distance(next_seat(kCar, kEye_mm, seats).eye_mm, third.eye_mm), 1e-6);
    // Right over the mock-up no direction is before the eye.
    EXPECT_GT(next_seat(kCar, {0.0, 900.0, 0.0}, {}).eye_mm.z, 700.0);
}

TEST(Seats, WhatCannotBeIsToldWithItsSeat) {
    const auto problem = [](const std::vector<EyeSeat>& seats) {
        return seats_problem(seats).value_or("");
    };
    const glm::dvec3 here(0.0, 480.0, 900.0);
    EXPECT_EQ(problem({{1, here}, {1, {500.0, 480.0, 900.0}}}),
              "there are two seats 1; expected each number once");
    EXPECT_EQ(problem({{1, here}, {2, here + glm::dvec3(149.0, 0.0, 0.0)}}),
              "the eyes of seats 1 and 2 are 149 mm apart; expected 150 or more");
    EXPECT_EQ(problem({{1, here}, {2, here + glm::dvec3(150.0, 0.0, 0.0)}}), "");
    EXPECT_NE(problem({{0, here}}).find("number is 0"), std::string::npos);
    EXPECT_NE(problem({{1000, here}}).find("number is 1000"), std::string::npos);
    EXPECT_NE(problem({{4, {0.0, std::numeric_limits<double>::quiet_NaN(), 0.0}}}).find("seat 4"),
              std::string::npos);
    EXPECT_NE(problem({{4, {1.1e6, 0.0, 0.0}}}).find("seat 4"), std::string::npos);
    std::vector<EyeSeat> many;
    for (int k = 1; k <= 41; ++k) many.push_back({k, {1000.0 * k, 0.0, 0.0}});
    EXPECT_EQ(problem(many), "there are 41 seats; expected at most 40");
}

}  // namespace
}  // namespace livery
