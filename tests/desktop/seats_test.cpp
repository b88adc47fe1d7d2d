// Seats are dragged in the plan of the room, and the mock-up's highlights follow the eye.

#include "scene/seats.h"

#include <gtest/gtest.h>

#include "core/paths.h"
#include "desktop/two_monitors.h"
#include "session/commands.h"

namespace livery {
namespace {

class SeatsWindow : public TwoMonitors {
  protected:
    std::vector<EyeSeat> seats() {
        return std::get<SetSeats>(
                   parse_session_command(program->state("seats").dump(), "the window"))
            .seats;
    }
    Image8 drive_for(const glm::dvec3& eye_mm) {
        Document seen = document;
        seen.eye_mm = eye_mm;
        return expected_drive(seen, look_at_place(0));
    }
};

TEST_F(SeatsWindow, ASeatThatIsDraggedMovesTheHighlightsAndUndoBringsThemBack) {
    use_shared();
    program->click("menu:Projector");
    program->click("menu:seats");
    program->click("seats:arc");
    program->wait_for_state("undo", "Place 5 seats");
    ASSERT_EQ(seats().size(), 5u);
    // Seats alone change nothing on the mock-up.
    EXPECT_TRUE(projector_shows(drive_of_place(0)));

    program->click("seats:eye");
    program->click("seats:eye:4");
    program->move_away();
    const EyeSeat before = *find_seat(seats(), 4);
    const Image8 at_four = drive_for(before.eye_mm);
    ASSERT_TRUE(projector_shows(at_four));
    const Image8 seen_before = projector_picture();

    const glm::ivec2 fourth = middle(program->item("plan:seat:4"));
    program->drag(fourth, fourth + glm::ivec2(-40, 30));
    program->move_away();
    program->wait_for_state("undo", "Move seat 4");
    const EyeSeat after = *find_seat(seats(), 4);
    EXPECT_LT(after.eye_mm.x, before.eye_mm.x - 50.0);
    EXPECT_GT(after.eye_mm.z, before.eye_mm.z + 50.0);
    EXPECT_EQ(after.eye_mm.y, before.eye_mm.y);
    // Where it was let go, however few frames the way there had; it stands on steps of 10 mm.
    const glm::ivec2 got_to = middle(program->item("plan:seat:4"));
    EXPECT_NEAR(got_to.x, fourth.x - 40, 2);
    EXPECT_NEAR(got_to.y, fourth.y + 30, 2);
    EXPECT_TRUE(projector_shows(drive_for(after.eye_mm)));
    EXPECT_FALSE(projector_shows_now(at_four));

    // One step back.
    program->press_key("ctrl+z");
    program->wait_for_state("undo", "Draw for the eye of seat 4");
    EXPECT_TRUE(projector_shows(at_four));
    EXPECT_TRUE(wait_until([&] { return projector_picture().values == seen_before.values; }))
        << "undo restores every pixel";

    // Keys move the chosen seat; ten millimetres, and a hundred.
    program->press_key("Right");
    program->press_key("shift+Down");
    program->wait_for_state("undo", "Move seat 4");
    const EyeSeat nudged = *find_seat(seats(), 4);
    EXPECT_NEAR(nudged.eye_mm.x, before.eye_mm.x + 10.0, 1e-9);
    EXPECT_NEAR(nudged.eye_mm.z, before.eye_mm.z + 100.0, 1e-9);
    program->press_key("Delete");
    program->wait_for_state("undo", "Remove seat 4");
    EXPECT_EQ(program->state("looks"), static_cast<int>(document.looks.size())) << "the look stays";
    program->click("seats:close");
}

TEST_F(SeatsWindow, ASeatIsNotPutOnTheMockUpNorOutOfThePlan) {
    use_shared();
    program->click("menu:Projector");
    program->click("menu:seats");
    program->click("seats:add");
    program->wait_for_state("undo", "Add seat 1");
    const glm::ivec2 seat = middle(program->item("plan:seat:1"));
    const Rectangle plan = program->item("plan");
    program->drag(seat, {plan.x + plan.width + 400, seat.y});
    program->move_away();
    program->wait_for_state("undo", "Move seat 1");
    const auto at_the_edge = seats();
    const Rectangle disc = program->item("plan:seat:1");
    EXPECT_LT(disc.x, plan.x + plan.width);
    program->press_key("ctrl+z");
    program->wait_for_state("undo", "Add seat 1");
    EXPECT_NE(seats(), at_the_edge);
    // Escape while it is held gives it up.
    const glm::ivec2 again = middle(program->item("plan:seat:1"));
    desktop->move_pointer(again.x, again.y);
    desktop->press_button();
    for (int k = 1; k <= 5; ++k) desktop->move_pointer(again.x - 6 * k, again.y);
    program->press_key("Escape");
    desktop->release_button();
    program->move_away();
    EXPECT_EQ(program->state("undo"), "Add seat 1");
    program->click("seats:close");
}

TEST_F(SeatsWindow, WhatASeatMissesIsShownOnTheStage) {
    use_shared();
    program->click("menu:Projector");
    program->click("menu:seats");
    EXPECT_EQ(program->state("seat_errors"), false) << "nothing is computed without seats";
    program->click("seats:arc");
    program->wait_for_state("seat_errors", true);
    program->click("plan:seat:5");
    program->wait_for_state("selected_seat", 5);
    program->click("seats:map");
    program->wait_for_state("seat_map", true);
    EXPECT_TRUE(program->has_item("seat-map:legend"));
    // The ramp's dark and bright ends are on the stage.
    const Image8 stage = stage_picture();
    EXPECT_GT(fraction_different(stage, Image8(stage.width, stage.height, 3, 18), 40), 0.02);
    program->click("view:preview");
    program->wait_for_state("seat_map", false);
    program->click("seats:close");
}

}  // namespace
}  // namespace livery
