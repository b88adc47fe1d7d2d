// The path tracer beside a window: what it hands over, when it stops, and what it says of failures.
#include "live/reference_thread.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "frame_thread_fixture.h"

namespace livery {
namespace {

/// Coarse, and soon there.
const std::vector<double> kErrors = {0.6, 0.3};

TraceRequest request_of(std::uint64_t number) {
    const View view = test_view(64, 48);
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::clearcoat, 0.05));
    scene.lights = {light_from({0.4, 0.8, 0.5}, 3.0 * kDegree_rad)};
    return {number, scene, setup_of(view, scene), kErrors};
}

bool has_ended(const ReferenceThread& thread) {
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (thread.state().running && std::chrono::steady_clock::now() < until) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return !thread.state().running;
}

TEST(ReferenceThread, HandsOverTwoPicturesTheSecondNearer) {
    std::mutex mutex;
    std::vector<std::shared_ptr<const TracedFrame>> told;
    std::unique_ptr<ReferenceThread> thread;
    thread = std::make_unique<ReferenceThread>([&] {
        const auto newest = thread->state().newest;
        const std::lock_guard lock(mutex);
        if (newest && (told.empty() || told.back() != newest)) told.push_back(newest);
    });
    EXPECT_FALSE(thread->state().running);
    const TraceRequest request = request_of(7);
    thread->trace(request);
    EXPECT_TRUE(thread->state().running);
    ASSERT_TRUE(has_ended(*thread));
    EXPECT_EQ(thread->state().problem, "");
    ASSERT_EQ(told.size(), 2u);
    EXPECT_EQ(told[0]->error, kErrors[0]);
    EXPECT_EQ(told[1]->error, kErrors[1]);
    EXPECT_GT(told[1]->mean_samples, told[0]->mean_samples);
    for (const auto& frame : told) {
        EXPECT_EQ(frame->number, 7u);
        EXPECT_EQ(frame->plan.quality, Quality::reference);
        EXPECT_EQ(frame->radiance_working->width, 64);
        // Corrected as any other picture
        const Image8 expected = compensate(*request.setup->table, *frame->radiance_working);
        EXPECT_EQ(frame->drive->values, expected.values);
    }
}

TEST(ReferenceThread, StopsAtOnceAndBeginsAgain) {
    ReferenceThread thread([] {});
    thread.trace(request_of(1));
    thread.stop();
    ASSERT_TRUE(has_ended(thread));
    EXPECT_EQ(thread.state().problem, "");
    thread.trace(request_of(2));
    thread.trace(request_of(3));
    ASSERT_TRUE(has_ended(thread));
    ASSERT_TRUE(thread.state().newest);
    EXPECT_EQ(thread.state().newest->number, 3u);
}

TEST(ReferenceThread, SaysWhyNothingCameAndGoesOn) {
    ReferenceThread thread([] {});
    TraceRequest broken = request_of(1);
    broken.scene.part_materials.clear();
    thread.trace(broken);
    ASSERT_TRUE(has_ended(thread));
    EXPECT_NE(thread.state().problem, "");
    EXPECT_FALSE(thread.state().newest);
    thread.trace(request_of(2));
    ASSERT_TRUE(has_ended(thread));
    EXPECT_EQ(thread.state().problem, "");
    EXPECT_TRUE(thread.state().newest);
}

TEST(ReferenceThread, EndsInTheMiddle) {
    std::atomic<int> calls{0};
    {
        ReferenceThread thread([&] { ++calls; });
        thread.trace(request_of(1));
    }
    const int at_its_end = calls;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(calls, at_its_end) << "called back after its end";
}

}  // namespace
}  // namespace livery
