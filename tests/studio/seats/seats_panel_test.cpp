// The seats' panel without a window: pointer and buttons do to the session what they say.

#include "studio/seats/seats_panel.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "studio/panels_fixture.h"
#include "studio/presenting/presenting.h"

namespace livery {
namespace {

constexpr auto draw_seats = draw_seats_panel;

class SeatsPanel : public Panels {
  protected:
    SeatsPanel() { use_scale(1.0f); }
    const Document& document() const { return studio_.session.document(); }
    const EyeSeat& seat(int number) const { return *find_seat(document().seats, number); }
    /// Presses on an item and pulls it, in steps, without letting go.
    void pull(const std::string& name, ImVec2 by) {
        point_at(frames(studio_, draw_seats, 2), name);
        frames(studio_, draw_seats, 2);
        ImGui::GetIO().MouseDown[0] = true;
        frame(studio_, draw_seats);
        for (int k = 0; k < 4; ++k) {
            ImGui::GetIO().MousePos.x += 0.25f * by.x;
            ImGui::GetIO().MousePos.y += 0.25f * by.y;
            frame(studio_, draw_seats);
        }
    }
    void let_go() {
        ImGui::GetIO().MouseDown[0] = false;
        frames(studio_, draw_seats, 2);
    }

    Studio studio_ = make_studio();
};

TEST_F(SeatsPanel, FitsIntoTheNarrowestColumn) {
    studio_.session.execute(
        SetSeats{{{1, {0.0, 480.0, 900.0}}, {999, {-600.0, 480.0, 900.0}, false}}});
    studio_.session.execute(UseEye{{EyeSource::mean, 0}});
    for (const float scale : {1.0f, 2.0f}) {
        use_scale(scale);
        studio_.panels.of<SeatsPanelState>().selected = 999;
        const ItemPlaces places = frames(studio_, draw_seats, 3);
        for (const char* name : {"plan",
                                 "plan:seat:999",
                                 "plan:eye-in-use",
                                 "seats:eye",
                                 "seat:x",
                                 "seat:height",
                                 "seat:counts",
                                 "seats:row:1",
                                 "seats:map"}) {
            EXPECT_TRUE(places.contains(name)) << name;
        }
        for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
            if (!window->Active || window->Hidden) continue;
            EXPECT_LE(window->ContentSize.x, window->InnerRect.GetWidth() + 1.0f) << window->Name;
        }
    }
}

TEST_F(SeatsPanel, SeatsAreAddedPlacedInAnArcAndRemoved) {
    click(studio_, draw_seats, "seats:add");
    ASSERT_EQ(document().seats.size(), 1u);
    EXPECT_EQ(studio_.panels.of<SeatsPanelState>().selected, 1);
    click(studio_, draw_seats, "seats:add");
    ASSERT_EQ(document().seats.size(), 2u);
    click(studio_, draw_seats, "seats:remove");
    ASSERT_EQ(document().seats.size(), 1u);
    EXPECT_EQ(document().seats[0].number, 1);
    studio_.panels.of<SeatsPanelState>().arc = 7;
    click(studio_, draw_seats, "seats:arc");
    EXPECT_EQ(document().seats.size(), 7u);
    EXPECT_EQ(studio_.session.undo_label(), "Place 7 seats");
    studio_.session.undo();
    studio_.session.undo();
    EXPECT_EQ(document().seats.size(), 2u);
}

TEST_F(SeatsPanel, ADragIsOneStepAndIsTriedMeanwhile) {
    studio_.session.execute(SetSeats{{{1, {0.0, 480.0, 900.0}}, {2, {-700.0, 480.0, 600.0}}}});
    studio_.session.execute(UseEye{{EyeSource::seat, 1}});
    const std::uint64_t before = studio_.session.revision();
    pull("plan:seat:1", {24.0f, 8.0f});
    EXPECT_EQ(studio_.session.revision(), before);
    ASSERT_TRUE(studio_.tried);
    const glm::dvec3 tried = eye_in_use_mm(shown_document(studio_));
    EXPECT_GT(tried.x, 50.0);
    EXPECT_EQ(tried.y, 480.0);
    let_go();
    EXPECT_EQ(studio_.session.revision(), before + 1);
    EXPECT_EQ(seat(1).eye_mm, tried);
    EXPECT_EQ(std::fmod(tried.x, 10.0), 0.0) << "on steps of ten millimetres";
    studio_.session.undo();
    EXPECT_EQ(seat(1).eye_mm, glm::dvec3(0.0, 480.0, 900.0));
    // A press alone changes nothing but what is chosen.
    studio_.panels.of<SeatsPanelState>().selected = 0;
    click(studio_, draw_seats, "plan:seat:2");
    EXPECT_EQ(studio_.session.undo_label(), "Draw for the eye of seat 1");
    EXPECT_EQ(studio_.panels.of<SeatsPanelState>().selected, 2);
}

TEST_F(SeatsPanel, ASeatThatIsDraggedOverTheMockUpOrOutOfThePlanIsKeptAndToldWhy) {
    studio_.session.execute(SetSeats{{{1, {0.0, 480.0, 900.0}}}});
    const ItemPlaces places = frames(studio_, draw_seats, 2);
    const auto plan = places.at("plan");
    const PlanExtent extent = studio_.panels.of<SeatsPanelState>().extent;
    pull("plan:seat:1", {0.0f, 3.0f * static_cast<float>(plan.height)});
    EXPECT_NE(studio_.panels.of<SeatsPanelState>().why.find("plan ends"), std::string::npos);
    let_go();
    EXPECT_NEAR(seat(1).eye_mm.z, extent.high_mm.y, 1e-6);
    studio_.session.undo();
    frames(studio_, draw_seats, 2);
    // Onto the mock-up, which stands at the origin.
    const SeatsPanelState& state = studio_.panels.of<SeatsPanelState>();
    const double scale = plan.width / (state.extent.high_mm.x - state.extent.low_mm.x);
    pull("plan:seat:1", {0.0f, static_cast<float>(-900.0 * scale)});
    EXPECT_NE(state.why.find("on the mock-up"), std::string::npos) << state.why;
    let_go();
    EXPECT_GE(distance_to_outline(state.outline_mm, in_plan(seat(1).eye_mm)).mm,
              kLeastFromMockup_mm - 1.0);
}

TEST_F(SeatsPanel, TheEyeThatIsSetByHandIsDraggedAndAnothersIsNot) {
    const glm::dvec3 before = document().eye_mm;
    pull("plan:eye", {30.0f, 0.0f});
    let_go();
    EXPECT_GT(document().eye_mm.x, before.x + 50.0);
    EXPECT_EQ(document().eye_mm.y, before.y);
    EXPECT_EQ(studio_.session.undo_label(), "Move eye point");
    studio_.session.execute(SetSeats{{{1, {0.0, 480.0, 900.0}}}});
    studio_.session.execute(UseEye{{EyeSource::mean, 0}});
    EXPECT_FALSE(frames(studio_, draw_seats, 2).contains("plan:eye"));
}

TEST_F(SeatsPanel, NothingIsComputedWithoutSeats) {
    frames(studio_, draw_seats, 3);
    EXPECT_FALSE(studio_.panels.of<SeatsPanelState>().thread);
    EXPECT_FALSE(studio_.panels.of<SeatsPanelState>().results);
    EXPECT_FALSE(studio_.panels.of<SeatsPanelState>().map_texture);
}

TEST_F(SeatsPanel, SeatsStandStillWhileLooksAreFrozen) {
    studio_.session.execute(SetSeats{{{1, {0.0, 480.0, 900.0}}}});
    studio_.panels.of<PresentingState>().freezing.emplace();
    const std::uint64_t before = studio_.session.revision();
    pull("plan:seat:1", {24.0f, 8.0f});
    EXPECT_FALSE(studio_.tried);
    let_go();
    click(studio_, draw_seats, "seats:add");
    EXPECT_EQ(studio_.session.revision(), before);
    ASSERT_FALSE(studio_.notices.empty());
    EXPECT_EQ(studio_.notices.back().what, "Nothing can be changed now.");
}

}  // namespace
}  // namespace livery
