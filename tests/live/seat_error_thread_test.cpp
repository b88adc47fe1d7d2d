// Seat errors beside the window: all are found, what stands is kept, the newest request wins.

#include "live/seat_error_thread.h"

#include <condition_variable>
#include <mutex>

#include <gtest/gtest.h>

#include "radiance/scenes.h"

namespace livery {
namespace {

Scene ball(const glm::dvec3& eye_mm) {
    Material paint;
    paint.model = ReflectanceModel::ggx;
    paint.f0 = {0.6, 0.6, 0.6};
    paint.alpha = {0.3, 0.3};
    static const Scene made = scene_of(make_sphere({0, 0, 0}, 40.0, 64, "body"), paint);
    Scene scene = made;
    DirectionalLight light;
    light.direction = {0.0, 0.6, 0.8};
    light.radiance_rec709 = glm::dvec3(1.0);
    scene.lights = {light};
    scene.eye_in_world_mm = eye_mm;
    return scene;
}

class SeatErrorThreads : public ::testing::Test {
  protected:
    /// Waits until everything of the request is found.
    std::shared_ptr<const SeatErrorResults> found(SeatErrorRequest request) {
        const std::uint64_t number = request.number;
        thread_.ask(std::move(request));
        std::unique_lock lock(mutex_);
        std::shared_ptr<const SeatErrorResults> results;
        changed_.wait_for(lock, std::chrono::minutes(5), [&] {
            results = thread_.newest();
            return results && results->number == number &&
                   (results->complete() || !results->problem.empty());
        });
        return results;
    }
    SeatErrorRequest request(std::uint64_t number, const glm::dvec3& eye_mm) {
        SeatErrorRequest asked;
        asked.number = number;
        asked.looks = {{7, ball(eye_mm)}};
        asked.seats = seats_;
        asked.view = look_at({0.0, 250.0, 900.0}, glm::dvec3(0.0), 0.12, 60, 40);
        asked.levels = levels_of(Quality::draft);
        return asked;
    }

    const glm::dvec3 eye_mm_{0.0, 300.0, 800.0};
    std::vector<EyeSeat> seats_{
        {1, eye_mm_, true}, {2, {300.0, 300.0, 750.0}, true}, {3, {600.0, 300.0, 500.0}, true}};
    std::mutex mutex_;
    std::condition_variable changed_;
    SeatErrorThread thread_{[this] {
        const std::scoped_lock lock(mutex_);
        changed_.notify_all();
    }};
};

TEST_F(SeatErrorThreads, EachSeatIsFoundAndWhatStandsIsNotDrawnAgain) {
    const auto first = found(request(1, eye_mm_));
    ASSERT_TRUE(first && first->complete()) << (first ? first->problem : "nothing");
    const auto& errors = first->looks.at(7);
    EXPECT_EQ(errors.at(1).error, SeatError());
    EXPECT_GT(errors.at(3).error.de00_p95, errors.at(2).error.de00_p95);
    EXPECT_EQ(errors.at(3).steps->width, 60);
    EXPECT_EQ(thread_.drawn(), 3u) << "for the eye, which is the first seat's, and the others";

    // One seat moved: for it, and for the eye in use anew.
    seats_[1].eye_mm.x += 100.0;
    const auto second = found(request(2, eye_mm_));
    ASSERT_TRUE(second && second->complete());
    EXPECT_EQ(thread_.drawn(), 5u);
    EXPECT_EQ(second->looks.at(7).at(3).steps, errors.at(3).steps) << "the same as before";
    EXPECT_NE(second->looks.at(7).at(2).error, errors.at(2).error);

    // Nothing changed, and one seat fewer: nothing is drawn.
    seats_.pop_back();
    const auto third = found(request(3, eye_mm_));
    ASSERT_TRUE(third && third->complete());
    EXPECT_EQ(thread_.drawn(), 5u);
    EXPECT_FALSE(third->looks.at(7).contains(3));

    // Another eye: all anew.
    const auto fourth = found(request(4, {100.0, 300.0, 800.0}));
    ASSERT_TRUE(fourth && fourth->complete());
    EXPECT_EQ(thread_.drawn(), 8u);
    // And back.
    const auto fifth = found(request(5, eye_mm_));
    ASSERT_TRUE(fifth && fifth->complete());
    EXPECT_EQ(thread_.drawn(), 8u);
}

TEST_F(SeatErrorThreads, TheNewestRequestWins) {
    for (std::uint64_t number = 1; number < 20; ++number) {
        thread_.ask(request(number, {10.0 * static_cast<double>(number), 300.0, 800.0}));
    }
    const auto last = found(request(20, eye_mm_));
    ASSERT_TRUE(last && last->complete());
    EXPECT_EQ(last->number, 20u);
    EXPECT_EQ(last->looks.at(7).at(1).error, SeatError());
}

TEST_F(SeatErrorThreads, WhatGoesWrongIsToldAndTheNextRequestWorks) {
    SeatErrorRequest bad = request(1, eye_mm_);
    bad.looks.front().scene.part_materials.clear();
    const auto told = found(bad);
    ASSERT_TRUE(told);
    EXPECT_FALSE(told->problem.empty());
    EXPECT_FALSE(told->complete());
    const auto good = found(request(2, eye_mm_));
    ASSERT_TRUE(good);
    EXPECT_TRUE(good->complete()) << good->problem;
}

TEST(SeatMapSteps, HoldTheDifferenceAndWhereTheMockUpIs) {
    ImageF de00(4, 1, 1);
    de00.values = {std::nanf(""), 0.0f, 10.0f, 40.0f};
    const Image8 steps = seat_map_steps(de00);
    EXPECT_EQ(steps.values[0], 0);
    EXPECT_EQ(steps.values[1], 1);
    EXPECT_EQ(steps.values[2], 128);
    EXPECT_EQ(steps.values[3], 255);
}

}  // namespace
}  // namespace livery
