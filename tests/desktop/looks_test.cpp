// Looks on two monitors: number keys, deleting and bringing back, holding B, wiping, black, freeze,
// the glow of a clicked part.

#include <algorithm>
#include <filesystem>
#include <utility>

#include <gtest/gtest.h>

#include "core/image_io.h"
#include "desktop/two_monitors.h"
#include "session/session.h"

namespace livery {
namespace {

/// First and last column with light in them.
std::pair<int, int> lit_columns(const Image8& drive) {
    int first = drive.width, last = -1;
    for (int y = 0; y < drive.height; ++y) {
        for (int x = 0; x < drive.width; ++x) {
            if (distance(colour_at(drive, x, y), {}) == 0) continue;
            first = std::min(first, x);
            last = std::max(last, x);
        }
    }
    return {first, last};
}

Image8 columns(const Image8& picture, int from, int to) {
    Image8 part(to - from, picture.height, 3);
    for (int y = 0; y < part.height; ++y) {
        std::copy_n(picture.pixel(from, y), 3 * part.width, part.pixel(0, y));
    }
    return part;
}

using Looks = TwoMonitors;

TEST_F(Looks, NumberKeysShowThemAndDeletedOnesComeBack) {
    use_shared();
    for (const std::size_t place : {2u, 3u, 1u, 0u}) {
        desktop->press_key(std::to_string(place + 1));
        EXPECT_TRUE(projector_shows(drive_of_place(place))) << place;
    }
    desktop->press_key("Next");
    EXPECT_TRUE(projector_shows(drive_of_place(1)));
    desktop->press_key("Prior");
    EXPECT_TRUE(projector_shows(drive_of_place(0)));

    // A deleted look's neighbour shows; undo brings it back, on the projector too.
    desktop->press_key("3");
    ASSERT_TRUE(projector_shows(drive_of_place(2)));
    desktop->press_key("Delete");
    EXPECT_TRUE(projector_shows(drive_of_place(3)));
    // The mock-up comes first, the operator's window follows.
    const std::string third = "look:" + std::to_string(look_at_place(2));
    EXPECT_TRUE(wait_until([&] { return !program->has_item(third); }));
    desktop->press_key("ctrl+z");
    EXPECT_TRUE(projector_shows(drive_of_place(2)));
    EXPECT_TRUE(wait_until([&] { return program->has_item(third); }));
    desktop->press_key("ctrl+y");
    EXPECT_TRUE(projector_shows(drive_of_place(3)));
    desktop->press_key("ctrl+shift+z");
    desktop->press_key("ctrl+z");
    EXPECT_TRUE(projector_shows(drive_of_place(2)));
}

TEST_F(Looks, HoldsBAndWipes) {
    use_shared();
    const Image8 a = drive_of_place(0), b = drive_of_place(3);
    desktop->press_key("4");
    ASSERT_TRUE(projector_shows(b));
    desktop->press_key("1");
    ASSERT_TRUE(projector_shows(a));
    // B is the look that was shown before.
    desktop->hold_key("space");
    EXPECT_TRUE(projector_shows(b));
    desktop->release_key("space");
    EXPECT_TRUE(projector_shows(a));

    desktop->press_key("w");
    const auto [first, last] = lit_columns(a);
    const int middle = (first + last) / 2, near = (last - first) / 20;
    const auto is_split = [&] {
        const Image8 seen = projector_picture();
        return fraction_different(columns(seen, 0, middle - near), columns(a, 0, middle - near)) <
                   0.002 &&
               fraction_different(columns(seen, middle + near, a.width),
                                  columns(b, middle + near, a.width)) < 0.002;
    };
    EXPECT_TRUE(wait_until(is_split)) << saved(projector_picture(), "wipe");
    desktop->press_key("w");
    EXPECT_TRUE(projector_shows(a));
}

TEST_F(Looks, BlackAndFreezeWorkAlsoInDialogs) {
    use_shared();
    const Image8 a = drive_of_place(0), b = drive_of_place(3);
    desktop->press_key("b");
    EXPECT_TRUE(projector_is_black());
    // The operator keeps seeing what the mock-up would show.
    EXPECT_NE(painted_colour(), Rgb{});
    desktop->press_key("4");
    EXPECT_TRUE(projector_is_black());
    desktop->press_key("b");
    EXPECT_TRUE(projector_shows(b));

    desktop->press_key("f");
    program->wait_for_state("frozen", true);
    desktop->press_key("1");
    program->wait_for_state("shown_look", look_at_place(0));
    sleep_ms(500);
    EXPECT_TRUE(projector_shows_now(b));
    desktop->press_key("f");
    EXPECT_TRUE(projector_shows(a));

    desktop->press_key("ctrl+s");
    ASSERT_TRUE(wait_until([&] { return program->has_item("file-dialog:ok"); }));
    desktop->press_key("ctrl+b");
    EXPECT_TRUE(projector_is_black());
    desktop->press_key("ctrl+b");
    EXPECT_TRUE(projector_shows(a));
    program->click("file-dialog:cancel");
}

// What is under the pointer must not move away between looking and pressing.
TEST_F(Looks, TheLightPanelStaysWhereItIsWhileALightIsSolved) {
    // Of its own: a draft keeps what was solved at the normal quality.
    start();
    pick_projector();
    program->click("tab:Light");
    // To the end, where the panel would be pushed up or down by what comes and goes above.
    const glm::ivec2 tab = middle(program->item("tab:Light"));
    program->scroll({tab.x, tab.y + 200}, -40);
    program->wait_for_state("solving", false);
    const Rectangle strength = program->item("environment-strength");

    // What is solved in full gives way to everything and may take long; it begins at once.
    program->click("quality:normal");
    EXPECT_TRUE(wait_until([&] { return program->has_item("solving"); }, std::chrono::minutes(1)));
    EXPECT_EQ(program->item("environment-strength"), strength);
    program->scroll({tab.x, tab.y + 200}, 40);
    const Rectangle environment = program->item("environment");
    program->click("environment");
    const Rectangle overcast = program->item("environment:overcast");
    program->hover("environment:overcast");
    sleep_ms(500);
    EXPECT_EQ(program->item("environment"), environment);
    EXPECT_EQ(program->item("environment:overcast"), overcast);
    program->click("environment:overcast");
    program->wait_for_state("undo", "Change environment of " + document.looks.front().look.name);
    EXPECT_EQ(program->item("environment"), environment);
}

TEST_F(Looks, AClickedPartGlowsOnTheMockUp) {
    use_shared();
    const Image8 a = drive_of_place(0);
    program->click("part:rims");
    // Only for a moment, and only on the part.
    double most = 0.0;
    ASSERT_TRUE(wait_until([&] {
        const double different = fraction_different(projector_picture(), a, 8);
        most = std::max(most, different);
        return most > 1e-3;
    })) << most;
    program->move_away();
    EXPECT_TRUE(projector_shows(a));
    EXPECT_LT(most, 0.2);
}

TEST_F(Looks, AreShownOnTheMockUpWhilePeopleVote) {
    use_shared();
    program->click("menu:File");
    program->click("menu:ballot");
    program->click("ballot:start");
    program->item("ballot:best:3");
    desktop->press_key("3");
    EXPECT_TRUE(projector_shows(drive_of_place(2)));
    program->click("ballot:picture:1");
    EXPECT_TRUE(projector_shows(drive_of_place(1)));
    program->click("look:" + std::to_string(look_at_place(3)));
    EXPECT_TRUE(projector_shows(drive_of_place(3)));
    // Keys that would change a look rest.
    const auto undo = program->state("undo");
    program->press_key("Delete");
    program->press_key("b");  // design B, not black
    program->press_key("a");
    program->click("ballot:name");
    desktop->type("Bo");
    desktop->press_key("Return");
    EXPECT_EQ(program->state("undo"), undo);
    EXPECT_TRUE(projector_shows_now(drive_of_place(3)));
    program->click("ballot:confirm");
    program->item("ballot:thanks");
    program->click("ballot:close");
    program->click("ballot:close-confirmed");
    program->item("ballot:result");
    program->click("ballot:close-panel");
    EXPECT_TRUE(wait_until([&] { return program->has_item("tab:Paints"); }));
    desktop->press_key("1");
    EXPECT_TRUE(projector_shows(drive_of_place(0)));
}

TEST_F(Looks, NightlyAreShownWithoutAFileThatIsGoneAndTheBarSaysWhatIsShown) {
    start();
    studio->program.reset();
    const int look = look_at_place(0);
    const auto sky = studio->folder / "sky.exr";
    write_exr(sky, ImageF(16, 8, 3, 0.8f));
    {
        Session session = Session::open(studio->session_file());
        session.execute(SetEnvironment{look, {sky.string(), 0.0, 1.0}});
        document = session.document();
    }
    std::filesystem::remove(sky);
    start_program();
    pick_projector();
    const Document without = applied(document, SetEnvironment{look, {}});
    EXPECT_TRUE(projector_shows(expected_drive(without, look)));
    program->wait_for_state("projector_says", "showing");
    EXPECT_NE(program->state("notices").dump().find("sky.exr"), std::string::npos);
    // Paints still change what is shown, and so do the number keys.
    program->click("part:body");
    program->click("paint:solid red");
    program->move_away();
    EXPECT_TRUE(projector_shows(
        expected_drive(applied(without, SetPaint{look, "body", "solid red"}), look)));
    desktop->press_key("2");
    EXPECT_TRUE(projector_shows(drive_of_place(1)));
    program->wait_for_state("projector_says", "showing");
    desktop->press_key("f");
    program->wait_for_state("projector_says", "frozen");
    desktop->press_key("3");
    program->wait_for_state("projector_says", "frozen: not what you work on");
    desktop->press_key("b");
    program->wait_for_state("projector_says", "black");
}

}  // namespace
}  // namespace livery
