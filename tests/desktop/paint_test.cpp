// The tab of one paint on two monitors: what it shows, another colour, another paint beside it.

#include <cstdlib>

#include <gtest/gtest.h>

#include "appearance/fit/recolour.h"
#include "appearance/paint_colour.h"
#include "appearance/subsurface/translucent_paint.h"
#include "desktop/prepared.h"
#include "desktop/two_monitors.h"
#include "session/commands.h"
#include "studio/kit/widgets.h"

namespace livery {
namespace {

using PaintTab = TwoMonitors;

TEST_F(PaintTab, GivesAFinishAnotherColourAndHoldsItAgainstAnother) {
    use_shared();
    const int look = look_at_place(0);
    const Image8 first = drive_of_place(0);
    const std::string worn = document.looks.front().look.parts.at("body");
    Recoloured made = with_colour(find_paint(document, worn), parse_colour("#b01020"));
    ASSERT_TRUE(made.reached) << made.why_not;
    made.material.name = worn;
    const Image8 red =
        expected_drive(applied(document, EditPaint{look, "body", made.material}), look);

    program->click("tab:Paint");
    EXPECT_TRUE(wait_until([&] { return program->has_item("angle:110"); }));
    program->click("paint-colour");
    desktop->type("#b01020");
    EXPECT_TRUE(projector_shows(red)) << "while it is typed";
    desktop->press_key("Escape");
    EXPECT_TRUE(projector_shows(first));
    program->click("paint-colour");
    desktop->type("#b01020");
    desktop->press_key("Return");
    EXPECT_TRUE(projector_shows(red));
    desktop->press_key("ctrl+z");
    EXPECT_TRUE(projector_shows(first));

    program->click("paint-compare");
    EXPECT_TRUE(program->has_item("compare:" + worn));
    desktop->type("silver metallic");
    EXPECT_TRUE(wait_until([&] { return !program->has_item("compare:" + worn); }));
    program->click("compare:silver metallic");
    EXPECT_TRUE(wait_until([&] { return program->has_item("paint-difference"); }));
    EXPECT_TRUE(projector_shows(first)) << "comparing changes nothing";
    program->click("paint-compare");
    program->click("compare:nothing");
    EXPECT_TRUE(wait_until([&] { return !program->has_item("paint-difference"); }));
    program->click("tab:Paints");
}

TEST_F(PaintTab, NightlyEditsATranslucentPaintByItsColourAndLength) {
    use_shared();
    const int look = look_at_place(0);
    const Image8 first = drive_of_place(0), marble = drive_with_body("marble");
    program->click("paint:marble");
    ASSERT_TRUE(projector_shows(marble));
    program->click("tab:Paint");
    EXPECT_TRUE(wait_until([&] { return program->has_item("param:mean-free-path"); }));
    EXPECT_TRUE(program->has_item("param:sheet-thickness"));
    EXPECT_TRUE(program->has_item("medium:reach"));

    program->click("param:albedo:hex");
    desktop->type("#b04020");
    desktop->press_key("Return");
    Material paint = find_paint(document, "marble");
    paint.medium = std::make_shared<const TranslucentMaterial>(
        with_entering_albedo(*paint.medium, *colour_of_hex("#b04020")));
    const Image8 tinted =
        expected_drive(applied(applied(document, SetPaint{look, "body", "marble"}),
                               EditPaint{look, "body", paint}),
                       look);
    EXPECT_TRUE(projector_shows(tinted));

    // Dragged: seen while it is held, and one step to undo
    const Rectangle green = program->item("param:albedo:g");
    const int x = green.x + green.width / 2, y = green.y + green.height / 2;
    desktop->move_pointer(x, y);
    desktop->press_button();
    for (int k = 1; k <= 8; ++k) desktop->move_pointer(x + 8 * k, y);
    EXPECT_TRUE(wait_until([&] { return !projector_shows_now(tinted); }));
    for (int k = 9; k <= 12; ++k) desktop->move_pointer(x + 8 * k, y);
    desktop->release_button();
    desktop->press_key("ctrl+z");
    EXPECT_TRUE(projector_shows(tinted));
    desktop->press_key("ctrl+z");
    EXPECT_TRUE(projector_shows(marble));

    program->click("medium:coefficients");
    EXPECT_TRUE(wait_until([&] { return program->has_item("param:sigma-a:x"); }));
    EXPECT_TRUE(program->has_item("param:sigma-s:z"));
    // The last rows are below the window's edge
    program->scroll(middle(program->item("param:sigma-a:x")), -6);
    EXPECT_TRUE(wait_until([&] { return program->has_item("param:g"); }));
    if (std::getenv("LIVERY_SAVE_PICTURES")) {
        saved(desktop->read(desktop->operator_area()), "translucent-paint");
    }
    program->click("medium:coefficients");
    desktop->press_key("ctrl+z");
    EXPECT_TRUE(projector_shows(first));
    program->click("tab:Paints");
}

TEST_F(PaintTab, NightlyShowsNothingOnTheMockUpThatNobodyTried) {
    use_shared();
    program->click("paint:solid red");
    ASSERT_TRUE(projector_shows(drive_with_body("solid red")));
    desktop->press_key("2");
    ASSERT_TRUE(projector_shows(drive_of_place(1)));
    // The swatches get their focus back, the pointer goes away.
    program->click("tab:Light");
    program->click("tab:Paints");
    program->move_away();
    program->item("swatches");
    EXPECT_EQ(program->state("tried"), nullptr);
    EXPECT_TRUE(projector_shows_now(drive_of_place(1)));
    // Undo leads back to the first look.
    desktop->press_key("ctrl+z");
    EXPECT_TRUE(projector_shows(drive_of_place(0)));
    program->click("tab:Light");
    program->click("tab:Paints");
    program->move_away();
    program->item("swatches");
    EXPECT_EQ(program->state("tried"), nullptr);
    EXPECT_TRUE(projector_shows_now(drive_of_place(0)));
    // What a list shows under the pointer when it opens is not what the pointer went to.
    program->click("tab:Light");
    program->click("environment");
    EXPECT_EQ(program->state("tried"), nullptr);
    desktop->press_key("Escape");
    program->click("tab:Paints");
}

}  // namespace
}  // namespace livery
