// What accuracy costs, measured from the window while the mock-up goes on answering.
#include <chrono>

#include <gtest/gtest.h>

#include "desktop/two_monitors.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

using AccuracyPageTest = TwoMonitors;

TEST_F(AccuracyPageTest, NightlyMeasuresBesideTheMockUpAndStops) {
    start();
    pick_projector();
    const Image8 first = drive_of_place(0), second = drive_of_place(1);
    ASSERT_NE(first.values, second.values);
    ASSERT_TRUE(projector_shows(first));
    program->click("menu:View");
    program->click("menu:accuracy-page");
    EXPECT_TRUE(wait_until([&] { return program->has_item("accuracy:chart"); }));
    EXPECT_TRUE(program->has_item("accuracy:quality:draft"));
    program->click("accuracy:measure");
    ASSERT_TRUE(wait_until([&] { return program->has_item("accuracy:stop"); }));
    desktop->press_key("2");
    EXPECT_TRUE(projector_shows(second)) << "looks are shown while it measures";
    program->click("accuracy:stop");
    EXPECT_TRUE(wait_until([&] { return program->has_item("accuracy:measure"); }, 120s));
    program->press_key("Escape");
    EXPECT_TRUE(wait_until([&] { return !program->has_item("accuracy:chart"); }));
}

}  // namespace
}  // namespace livery
