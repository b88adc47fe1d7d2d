// Which of Xwayland's outputs is which of Mutter's monitors.
#include <gtest/gtest.h>

#include "mutter_messages.h"
#include "projection/mutter.h"

namespace livery {
namespace {

Output output_at(std::uint32_t number, int x, int y, int width, int height) {
    Output output;
    output.output = number;
    output.socket = "XWAYLAND" + std::to_string(number);
    output.monitor.id = output.monitor.name = output.socket;
    output.monitor.x = x;
    output.monitor.y = y;
    output.monitor.width = width;
    output.monitor.height = height;
    return output;
}

/// Sockets after the match, in the order of the outputs.
std::vector<std::string> sockets(const MutterState& state,
                                 std::vector<Output>& outputs,
                                 KnownConnectors& known) {
    name_outputs_after(state, outputs, known);
    std::vector<std::string> names;
    for (const Output& output : outputs) names.push_back(output.socket);
    return names;
}

using Names = std::vector<std::string>;

TEST(MutterMatch, NamesByPlaceAndSize) {
    KnownConnectors known;
    std::vector<Output> outputs = {output_at(0, 1280, 0, 1920, 1080),
                                   output_at(1, 0, 0, 1280, 800)};
    EXPECT_EQ(sockets(mutter_state(said_of_two()), outputs, known), (Names{"HDMI-1", "eDP-1"}));
    const Monitor& projector = outputs[0].monitor;
    EXPECT_EQ(projector.id, monitor_id("HDMI-1", {"EPS", "EPSON PJ", "X4KF123"}));
    EXPECT_EQ(projector.name, "HDMI-1, EPSON PJ");
    EXPECT_EQ(projector.mode_px, glm::ivec2(1920, 1080));
    EXPECT_EQ(outputs[0].preferred_px, glm::ivec2(1920, 1080));
    ASSERT_TRUE(projector.wayland);
    EXPECT_EQ(projector.wayland->scale, 1.0);
    EXPECT_EQ(projector.wayland->transform, 0);
    EXPECT_EQ(outputs[1].monitor.name, "eDP-1, BOE") << "a product without a name";
    EXPECT_EQ(known, (KnownConnectors{{0, "HDMI-1"}, {1, "eDP-1"}}));
}

TEST(MutterMatch, KnowsScaledAndTurnedMonitors) {
    const auto matched = [](const SaidState& said, Output output) {
        KnownConnectors known;
        std::vector<Output> outputs = {std::move(output)};
        name_outputs_after(mutter_state(said), outputs, known);
        return outputs[0];
    };
    Output found = matched(said_of_two(1.5), output_at(0, 1280, 0, 1280, 720));
    EXPECT_EQ(found.socket, "HDMI-1");
    EXPECT_EQ(found.monitor.mode_px, glm::ivec2(1920, 1080));
    EXPECT_EQ(found.monitor.wayland->scale, 1.5);
    EXPECT_FALSE(found.turned);
    found = matched(said_of_two(1.5, 1), output_at(0, 1280, 0, 720, 1280));
    EXPECT_EQ(found.socket, "HDMI-1");
    EXPECT_TRUE(found.turned);
    found = matched(said_of_two(1.0, 6), output_at(0, 1280, 0, 1920, 1080));
    EXPECT_EQ(found.monitor.wayland->transform, 6);
    EXPECT_FALSE(found.turned);
    // 1280 / 1.4953 is no whole number.
    auto odd = said_of_two();
    odd.logical_monitors[0].scale = 1.4953271150588989;
    EXPECT_EQ(matched(odd, output_at(0, 0, 0, 856, 535)).socket, "eDP-1");
    // Laid out in the monitors' own pixels.
    auto physical = said_of_two(2.0);
    physical.layout_mode = 2;
    found = matched(physical, output_at(0, 1280, 0, 1920, 1080));
    EXPECT_EQ(found.socket, "HDMI-1");
    EXPECT_EQ(found.monitor.wayland->scale, 2.0);
    // A size that cannot be is nobody's.
    EXPECT_EQ(matched(said_of_two(1.5), output_at(0, 1280, 0, 1920, 1080)).socket, "XWAYLAND0");
}

SaidState said_of_twins(int x_of_first, int x_of_second) {
    return {{{"HDMI-1", "EPS", "EPSON PJ", "0x00000000", {{1280, 800}}},
             {"HDMI-2", "EPS", "EPSON PJ", "0x00000000", {{1280, 800}}}},
            {{x_of_first, 0, 1.0, 0, {"HDMI-1"}}, {x_of_second, 0, 1.0, 0, {"HDMI-2"}}}};
}

TEST(MutterMatch, TellsTwinsApartAlsoWhenTheyExchangePlaces) {
    KnownConnectors known;
    std::vector<Output> outputs = {output_at(4, 0, 0, 1280, 800), output_at(5, 1280, 0, 1280, 800)};
    const auto before = mutter_state(said_of_twins(0, 1280));
    EXPECT_EQ(sockets(before, outputs, known), (Names{"HDMI-1", "HDMI-2"}));
    EXPECT_NE(outputs[0].monitor.id, outputs[1].monitor.id);
    // X knows of the exchange, and Mutter's word is still the old one; then the other way round.
    outputs = {output_at(5, 0, 0, 1280, 800), output_at(4, 1280, 0, 1280, 800)};
    EXPECT_EQ(sockets(before, outputs, known), (Names{"HDMI-2", "HDMI-1"}));
    outputs = {output_at(4, 0, 0, 1280, 800), output_at(5, 1280, 0, 1280, 800)};
    EXPECT_EQ(sockets(mutter_state(said_of_twins(1280, 0)), outputs, known),
              (Names{"HDMI-1", "HDMI-2"}));
}

TEST(MutterMatch, WaitsUntilBothSpeakOfTheSame) {
    KnownConnectors known;
    auto alone = said_of_two();
    alone.logical_monitors.pop_back();
    std::vector<Output> outputs = {output_at(0, 0, 0, 1280, 800),
                                   output_at(1, 1280, 0, 1920, 1080)};
    EXPECT_EQ(sockets(mutter_state(alone), outputs, known), (Names{"eDP-1", "XWAYLAND1"}))
        << "plugged in, and Mutter's word is still the old one";
    EXPECT_FALSE(outputs[1].monitor.wayland);
    outputs[1] = output_at(1, 1280, 0, 1920, 1080);
    EXPECT_EQ(sockets(mutter_state(said_of_two()), outputs, known), (Names{"eDP-1", "HDMI-1"}));
    outputs[1] = output_at(1, 1280, 0, 1920, 1080);
    EXPECT_EQ(sockets(mutter_state(alone), outputs, known), (Names{"eDP-1", "XWAYLAND1"}))
        << "pulled, and X's word is still the old one";
    EXPECT_EQ(known, (KnownConnectors{{0, "eDP-1"}}));
    outputs[1] = output_at(2, 1280, 0, 1920, 1080);
    EXPECT_EQ(sockets(mutter_state(said_of_two()), outputs, known), (Names{"eDP-1", "HDMI-1"}));
}

TEST(MutterMatch, DoesNotRememberWhichMirrorIsWhich) {
    auto mirrored = said_of_twins(0, 1280);
    mirrored.logical_monitors = {{0, 0, 1.0, 0, {"HDMI-1", "HDMI-2"}}};
    KnownConnectors known;
    std::vector<Output> outputs = {output_at(0, 0, 0, 1280, 800), output_at(1, 0, 0, 1280, 800)};
    EXPECT_EQ(sockets(mutter_state(mirrored), outputs, known), (Names{"HDMI-1", "HDMI-2"}));
    EXPECT_TRUE(known.empty());
    outputs = {output_at(0, 1280, 0, 1280, 800), output_at(1, 0, 0, 1280, 800)};
    EXPECT_EQ(sockets(mutter_state(said_of_twins(0, 1280)), outputs, known),
              (Names{"HDMI-2", "HDMI-1"}));
    // What was known before stays so while they mirror one another.
    outputs = {output_at(0, 0, 0, 1280, 800), output_at(1, 0, 0, 1280, 800)};
    EXPECT_EQ(sockets(mutter_state(mirrored), outputs, known), (Names{"HDMI-2", "HDMI-1"}));
    // One output for both is neither.
    known.clear();
    outputs = {output_at(0, 0, 0, 1280, 800)};
    EXPECT_EQ(sockets(mutter_state(mirrored), outputs, known), Names{"XWAYLAND0"});
}

TEST(MutterMatch, TakesTheNameWhereItIsTheConnectors) {
    // As Xwayland 24.1 has it, which may have more pixels than the desktop's units.
    KnownConnectors known{{0, "eDP-1"}};
    std::vector<Output> outputs = {output_at(0, 1280, 0, 2560, 1440),
                                   output_at(1, 0, 0, 1280, 800)};
    outputs[0].socket = "HDMI-1";
    outputs[1].socket = "eDP-1";
    auto said = said_of_two(1.5);
    said.monitors[1].colour_mode = 1;
    EXPECT_EQ(sockets(mutter_state(said), outputs, known), (Names{"HDMI-1", "eDP-1"}));
    EXPECT_EQ(outputs[0].monitor.mode_px, glm::ivec2(1920, 1080));
    EXPECT_EQ(outputs[0].monitor.wayland->colour_mode, 1u);
}

TEST(MutterMatch, MakesNothingOfNothing) {
    KnownConnectors known;
    std::vector<Output> outputs;
    name_outputs_after(mutter_state(said_of_two()), outputs, known);
    EXPECT_TRUE(outputs.empty());
    outputs = {output_at(0, 0, 0, 1280, 800)};
    EXPECT_EQ(sockets(MutterState(), outputs, known), Names{"XWAYLAND0"});
    // Lit by the layout, and no mode tells its size.
    auto dark = said_of_two();
    dark.monitors[0].modes.clear();
    EXPECT_EQ(sockets(mutter_state(dark), outputs, known), Names{"XWAYLAND0"});
}

}  // namespace
}  // namespace livery
