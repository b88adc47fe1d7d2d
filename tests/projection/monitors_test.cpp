// Which monitors there are.
#include "projection/monitors.h"

#include <array>
#include <cstdint>
#include <stdexcept>

#include <gtest/gtest.h>
#include <xcb/randr.h>

#include "projection/outputs.h"
#include "support/desktop.h"

namespace livery {
namespace {

/// A block as a monitor sends it: maker EPS, and a name where one is given.
std::vector<std::uint8_t> edid(const std::string& name) {
    std::vector<std::uint8_t> block(128, 0);
    block[8] = 0x16;  // E 00101, P 10000, S 10011
    block[9] = 0x13;
    if (!name.empty()) {
        block[54 + 18 + 3] = 0xFC;
        std::string text = name + '\n';
        text.resize(13, ' ');
        std::copy(text.begin(), text.end(), block.begin() + 54 + 18 + 5);
    }
    return block;
}

std::string edid_name(const std::vector<std::uint8_t>& block) {
    return display_name(identity_of_edid(block));
}

void set_edid(const std::string& socket, const std::vector<std::uint8_t>& block) {
    const XConnection x;
    for (const auto& output : read_outputs(x, nullptr)) {
        if (output.socket != socket) continue;
        xcb_randr_change_output_property(x.get(),
                                         output.output,
                                         x.atom("EDID"),
                                         XCB_ATOM_INTEGER,
                                         8,
                                         XCB_PROP_MODE_REPLACE,
                                         static_cast<std::uint32_t>(block.size()),
                                         block.data());
    }
    x.synchronise();
}

TEST(Monitors, AreNumberedFromLeftToRightAndTopToBottom) {
    Desktop desktop({{1280, 800}, {1024, 768}, false});
    auto list = list_monitors();
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].id, "DUMMY0");
    EXPECT_EQ(list[0].name, "DUMMY0");
    EXPECT_EQ(list[0].number, 1);
    EXPECT_TRUE(list[0].primary);
    EXPECT_EQ(list[1].id, "DUMMY1");
    EXPECT_EQ(list[1].number, 2);
    EXPECT_FALSE(list[1].primary);
    EXPECT_EQ(list[1].x, 1280);
    EXPECT_EQ(list[1].y, 0);
    EXPECT_EQ(list[1].width, 1024);
    EXPECT_EQ(list[1].height, 768);
    EXPECT_GT(list[1].refresh_hz, 55.0);
    EXPECT_LT(list[1].refresh_hz, 90.0);

    desktop.plug_projector(Desktop::Side::left);
    list = list_monitors();
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].id, "DUMMY1");
    EXPECT_EQ(list[0].number, 1);
    desktop.plug_projector(Desktop::Side::below);
    EXPECT_EQ(list_monitors()[1].id, "DUMMY1");
    desktop.plug_projector(Desktop::Side::above);
    EXPECT_EQ(list_monitors()[0].id, "DUMMY1");
}

TEST(Monitors, KeepTheirIdentityWhenPluggedInAgain) {
    Desktop desktop;
    set_edid("DUMMY1", edid("EPSON PJ"));
    const auto before = list_monitors().at(1);
    EXPECT_EQ(before.name, "DUMMY1, EPSON PJ");
    EXPECT_EQ(before.id.substr(0, 7), "DUMMY1:");
    EXPECT_EQ(before.id.size(), 7u + 16u);
    desktop.unplug_projector();
    EXPECT_EQ(list_monitors().size(), 1u);
    EXPECT_FALSE(find_monitor(list_monitors(), before.id));
    desktop.plug_projector(Desktop::Side::left);
    const auto again = find_monitor(list_monitors(), before.id);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->x, 0);
    set_edid("DUMMY1", edid("ANOTHER"));
    EXPECT_FALSE(find_monitor(list_monitors(), before.id));
}

TEST(Monitors, AreNamedByWhateverTheirEdidHolds) {
    EXPECT_EQ(edid_name(edid("EPSON PJ")), "EPSON PJ");
    EXPECT_EQ(edid_name(edid("")), "EPS");
    EXPECT_EQ(edid_name({}), "");
    EXPECT_EQ(edid_name(std::vector<std::uint8_t>(127, 0xFF)), "");
    EXPECT_EQ(edid_name(std::vector<std::uint8_t>(128, 0xFF)), "");
    EXPECT_EQ(edid_name(std::vector<std::uint8_t>(256, 0)), "");
    EXPECT_EQ(edid_name(edid(" \x01\x7f  ")), "EPS");
    auto cut = edid("EPSON PJ");
    cut.resize(100);
    EXPECT_EQ(edid_name(cut), "");
}

TEST(Monitors, HaveTheIdentityThatGnomeToldOfTheSameEdid) {
    auto block = edid("EPSON PJ");
    block[10] = 0x2b;
    block[11] = 0x1a;
    block[12] = 0x01;
    EXPECT_EQ(identity_of_edid(block), (DisplayIdentity{"EPS", "EPSON PJ", "0x00000001"}));
    // The third descriptor: a serial number in letters.
    block[54 + 36 + 3] = 0xFF;
    const std::string serial = "X4KF123\n     ";
    std::copy(serial.begin(), serial.end(), block.begin() + 54 + 36 + 5);
    EXPECT_EQ(identity_of_edid(block), (DisplayIdentity{"EPS", "EPSON PJ", "X4KF123"}));
    block[54 + 18 + 3] = 0;
    EXPECT_EQ(identity_of_edid(block).product, "0x1a2b");
    EXPECT_EQ(identity_of_edid(std::vector<std::uint8_t>(127, 1)), DisplayIdentity());
    EXPECT_TRUE(has_serial({"EPS", "EPSON PJ", "X4KF123"}));
    for (const char* none : {"", "0x00000000", "0x01010101"}) {
        EXPECT_FALSE(has_serial({"EPS", "EPSON PJ", none})) << none;
    }
}

TEST(Monitors, AreFoundByWhatAnEarlierStartRemembered) {
    Desktop desktop;
    const auto block = edid("EPSON PJ");
    set_edid("DUMMY1", block);
    const auto list = list_monitors();
    EXPECT_EQ(find_remembered_monitor(list, list[1].id)->number, 2);
    // By version 0.1: every byte of the EDID.
    const std::string former = former_monitor_id("DUMMY1", block);
    EXPECT_NE(former, list[1].id);
    EXPECT_FALSE(find_monitor(list, former));
    ASSERT_TRUE(find_remembered_monitor(list, former));
    EXPECT_EQ(find_remembered_monitor(list, former)->number, 2);
    EXPECT_FALSE(find_remembered_monitor(list, "DUMMY1:0123456789abcdef"));
    EXPECT_FALSE(find_remembered_monitor(list, ""));
}

TEST(Monitors, AreFoundInAnotherSocketByTheirSerialNumberAlone) {
    const auto monitor = [](const char* socket, const DisplayIdentity& identity) {
        Monitor made;
        made.identity = identity;
        made.id = monitor_id(socket, identity);
        return made;
    };
    const DisplayIdentity numbered{"EPS", "EPSON PJ", "X4KF123"}, other{"EPS", "EPSON PJ", "Y"},
        none{"EPS", "EPSON PJ", "0x00000000"};
    const auto found = find_remembered_monitor(
        {monitor("HDMI-1", other), monitor("DP-2", numbered)}, monitor_id("HDMI-0", numbered));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->id, monitor_id("DP-2", numbered));
    EXPECT_FALSE(find_remembered_monitor({monitor("HDMI-1", none)}, monitor_id("HDMI-0", none)));
    EXPECT_FALSE(find_remembered_monitor({monitor("DP-1", numbered), monitor("DP-2", numbered)},
                                         monitor_id("HDMI-0", numbered)))
        << "which of the two?";
    EXPECT_FALSE(find_remembered_monitor({monitor("DP-1", {}), monitor("DP-2", {})}, "HDMI-0"));
}

TEST(Monitors, WithoutAServerSayWhatIsMissing) {
    const Desktop desktop;
    const std::string display = desktop.display();
    ::setenv("DISPLAY", ":4711", 1);
    try {
        list_monitors();
        ADD_FAILURE() << "listed";
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(),
                     "no X server answers at DISPLAY=:4711. The projector needs a desktop on Xorg, "
                     "or Xwayland");
    }
    ::setenv("DISPLAY", display.c_str(), 1);
    EXPECT_EQ(list_monitors().size(), 2u);
}

}  // namespace
}  // namespace livery
