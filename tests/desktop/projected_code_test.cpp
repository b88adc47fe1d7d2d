// The QR code beside the mock-up, read from the projector's pixels by a reader of others.
#include <gtest/gtest.h>

#include "desktop/presented_vote.h"
#include "support/ballot_phone.h"
#include "support/zbar.h"

namespace livery {
namespace {

using namespace std::chrono_literals;

constexpr const char* kLongAdapting = R"({"format_version": 1, "settings": {
  "presenting-adapt-s": "60", "presenting-passes": "1", "presenting-seed": "7", "phones-port": "0"
}})";

class ProjectedCode : public PresentedVote {
  protected:
    /// What a phone reads there; empty for none.
    std::string read_code(const Image8& picture) const {
        std::vector<unsigned char> grey;
        for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
            const std::uint8_t* at = &picture.values[3 * i];
            grey.push_back(static_cast<unsigned char>((at[0] + at[1] + at[2]) / 3));
        }
        return reader.read(grey, picture.width, picture.height);
    }

    std::string read_panel() const { return read_code(desktop->read(desktop->operator_area())); }

    ZBar reader;
};

bool is_lit(const Image8& picture, std::size_t pixel) {
    const std::uint8_t* at = &picture.values[3 * pixel];
    return at[0] != 0 || at[1] != 0 || at[2] != 0;
}

TEST_F(ProjectedCode, NightlyStandsBesideTheMockUpUntilItIsUntickedOrTheLooksAreFrozen) {
    ASSERT_TRUE(reader.is_there()) << "libzbar.so.0 is not installed";
    start_vote(kLongAdapting, 2);
    const Image8 look = drive_of_place(0);
    ASSERT_TRUE(projector_shows(look));
    const Image8 before = projector_picture();
    const std::string address = let_phones_vote();
    EXPECT_EQ(read_code(before), "");
    EXPECT_TRUE(wait_until([&] { return read_panel() == address; }))
        << saved(desktop->read(desktop->operator_area()), "operator");
    EXPECT_EQ(read_code(projector_picture()), "") << "nobody has ticked it";

    // --- on the wall ---
    program->click("phones:project-qr");
    program->move_away();
    Image8 seen;
    ASSERT_TRUE(wait_until([&] {
        seen = projector_picture();
        return read_code(seen) == address;
    })) << "read \""
        << read_code(seen) << "\" from " << saved(seen, "seen");
    EXPECT_TRUE(testing::BallotPhone(address).has_seat()) << "whoever scans it is in";

    // The mock-up is grey, as if there were no code: each pixel that it lights is its own.
    const Image8 grey = expected_grey(document, look_at_place(0));
    Image8 mock_up = seen;
    int beside = 0, tinted = 0, on_the_look = 0;
    for (std::size_t i = 0; i < seen.pixel_count(); ++i) {
        if (is_lit(grey, i) || !is_lit(seen, i)) continue;
        std::uint8_t* at = &mock_up.values[3 * i];
        ++beside;
        tinted += at[0] != 255 || at[1] != 255 || at[2] != 255 ? 1 : 0;
        on_the_look += is_lit(look, i) ? 1 : 0;
        at[0] = at[1] = at[2] = 0;
    }
    // Half of a code is light, and it is at least 37 modules and a quiet zone across.
    EXPECT_GT(beside, 45 * 45 / 2);
    EXPECT_EQ(tinted, 0) << saved(seen, "seen");
    EXPECT_EQ(on_the_look, 0) << saved(seen, "seen");
    EXPECT_LE(fraction_different(mock_up, grey, 2), 2e-3) << saved(mock_up, "mock-up");

    // --- unticked, everything is as it was ---
    program->click("phones:project-qr");
    program->move_away();
    EXPECT_TRUE(wait_until([&] { return projector_picture().values == before.values; }))
        << saved(projector_picture(), "seen");

    // --- it does not stay while looks are judged ---
    program->click("phones:project-qr");
    EXPECT_TRUE(wait_until([&] { return read_code(projector_picture()) == address; }));
    present_paused();
    EXPECT_TRUE(projector_shows_frame(kWhiteFrame));
    EXPECT_EQ(read_code(projector_picture()), "");
    EXPECT_EQ(read_panel(), "") << "joining is closed";
    program->press_key("Next");
    EXPECT_TRUE(projector_shows_frame(frame_of_look(presented.plan.sittings.at(0).at(0))));
    EXPECT_EQ(read_code(projector_picture()), "");

    // Nor does it come back by itself.
    program->click("vote:abort");
    program->click("vote:confirm");
    program->wait_for_state("vote", "edit");
    EXPECT_TRUE(projector_shows(look));
    EXPECT_EQ(read_code(projector_picture()), "");

    // A server that has stopped is nothing to scan.
    program->click("phones:project-qr");
    EXPECT_TRUE(wait_until([&] { return read_code(projector_picture()) == address; }));
    // The panel begins at its upper end again; the button is its last, below the window's edge.
    program->scroll(middle(program->item("phones:project-qr")), -20);
    program->click("phones:stop");
    EXPECT_TRUE(projector_shows(look));
    EXPECT_EQ(read_code(projector_picture()), "");
}

}  // namespace
}  // namespace livery
