// The mock-up's picture gets finer while nobody changes anything, by the pixels of the projector.
#include <algorithm>
#include <chrono>

#include <gtest/gtest.h>

#include "desktop/two_monitors.h"
#include "support/screen_watch.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

using RefinementTest = TwoMonitors;

/// Whether no channel of any pixel lies beyond both of the others, but for rounding.
bool lies_between(const Image8& picture, const Image8& one, const Image8& other) {
    for (std::size_t k = 0; k < picture.values.size(); ++k) {
        const auto [low, high] = std::minmax(one.values[k], other.values[k]);
        if (picture.values[k] + 1 < low || picture.values[k] > high + 1) return false;
    }
    return true;
}

TEST_F(RefinementTest, NightlyFadesInTheLevelsOfHigh) {
    refines = true;
    start();
    const Image8 draft = drive_of_place(0);
    Document finer = document;
    finer.quality = Quality::high;
    const Image8 high = expected_drive(finer, look_at_place(0));
    ASSERT_NE(draft.values, high.values);

    pick_projector();
    ASSERT_TRUE(projector_shows(draft));
    ScreenWatch watch(*desktop, desktop->projector_area(), [&](const Image8& seen) {
        return !lies_between(seen, draft, high);
    });
    // Solved behind everything else, and a machine may be busy
    ASSERT_TRUE(wait_until([&] { return program->state("quality") == "high"; }, 10min));
    EXPECT_TRUE(projector_shows(high));
    const auto seen = watch.stop();
    EXPECT_GT(seen.looks, 3);
    EXPECT_EQ(seen.wrong, 0) << "a step on the way was brighter or darker than both ends";
}

}  // namespace
}  // namespace livery
