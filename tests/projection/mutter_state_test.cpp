// What Mutter answers, as values.
#include <cmath>
#include <limits>
#include <stdexcept>

#include <dbus/dbus.h>
#include <gtest/gtest.h>

#include "mutter_messages.h"
#include "projection/mutter.h"
#include "support/message_of.h"

namespace livery {
namespace {

TEST(MutterStateTest, HoldsMonitorsModesAndLayout) {
    auto said = said_of_two(1.5, 3);
    said.monitors[1].modes = {{1920, 1080, true, false}, {4096, 2160, false, true}};
    const MutterState state = mutter_state(said);
    ASSERT_EQ(state.monitors.size(), 2u);
    const MutterMonitor& projector = state.monitors[1];
    EXPECT_EQ(projector.connector, "HDMI-1");
    EXPECT_EQ(projector.identity, (DisplayIdentity{"EPS", "EPSON PJ", "X4KF123"}));
    EXPECT_EQ(projector.mode_px, glm::ivec2(1920, 1080));
    EXPECT_EQ(projector.preferred_px, glm::ivec2(4096, 2160));
    EXPECT_EQ(projector.refresh_hz, 60.0);
    EXPECT_EQ(projector.colour_mode, 0u) << "Mutter 43 has none";
    ASSERT_EQ(state.logical_monitors.size(), 2u);
    const MutterLogicalMonitor& logical = state.logical_monitors[1];
    EXPECT_EQ(logical.x, 1280);
    EXPECT_EQ(logical.y, 0);
    EXPECT_EQ(logical.scale, 1.5);
    EXPECT_EQ(logical.transform, 3);
    EXPECT_EQ(logical.connectors, std::vector<std::string>{"HDMI-1"});
    EXPECT_FALSE(state.physical_layout);
    said.layout_mode = 2;
    said.monitors[1].colour_mode = 1;
    EXPECT_TRUE(mutter_state(said).physical_layout);
    EXPECT_EQ(mutter_state(said).monitors[1].colour_mode, 1u);
    EXPECT_EQ(state.find("HDMI-1"), &projector);
    EXPECT_EQ(state.find("HDMI-2"), nullptr);
}

TEST(MutterStateTest, DoesWithoutWhatIsOptional) {
    auto said = said_of_two();
    said.layout_mode.reset();
    said.monitors[0].modes = {{1280, 800, false, false}};
    said.monitors[1] = {"HDMI-1", "unknown", "unknown", "unknown", {}};
    const MutterState state = mutter_state(said);
    EXPECT_FALSE(state.physical_layout);
    EXPECT_EQ(state.monitors[0].mode_px, glm::ivec2(0, 0)) << "no mode is the current one";
    EXPECT_EQ(state.monitors[0].preferred_px, glm::ivec2(0, 0));
    EXPECT_EQ(state.monitors[1].identity, DisplayIdentity()) << "a monitor without EDID";
    EXPECT_EQ(mutter_state({}), MutterState());
}

std::string refusal(const SaidState& said) {
    return message_of([&] { mutter_state(said); });
}

TEST(MutterStateTest, RefusesWhatCannotBe) {
    auto said = said_of_two();
    said.logical_monitors[1].connectors = {"HDMI-1", "DP-7"};
    EXPECT_EQ(refusal(said),
              "a logical monitor: found \"DP-7\", expected one of the monitors' connectors");
    for (const double scale : {0.0,
                               -1.0,
                               std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()}) {
        EXPECT_NE(refusal(said_of_two(scale)).find("expected a number over 0"), std::string::npos)
            << scale;
    }
    EXPECT_EQ(refusal(said_of_two(1.0, 8)), "transform: found 8, expected 0 to 7");
    said = said_of_two();
    said.monitors[1].modes[0].width = -5;
    EXPECT_EQ(refusal(said), "a mode of HDMI-1: found -5x1080, expected 1 to 65535 pixels each");
}

TEST(MutterStateTest, RefusesOtherTypes) {
    const BusMessage empty(dbus_message_new(DBUS_MESSAGE_TYPE_METHOD_RETURN));
    EXPECT_NE(
        message_of([&] { read_mutter_state(*empty); }).find("found the types \"\", expected \"ua("),
        std::string::npos);
    const BusMessage cut(dbus_message_new(DBUS_MESSAGE_TYPE_METHOD_RETURN));
    const dbus_uint32_t serial = 2;
    const char* text = "nonsense";
    dbus_message_append_args(
        cut.get(), DBUS_TYPE_UINT32, &serial, DBUS_TYPE_STRING, &text, DBUS_TYPE_INVALID);
    EXPECT_NE(message_of([&] { read_mutter_state(*cut); }).find("found the types \"us\""),
              std::string::npos);
}

}  // namespace
}  // namespace livery
