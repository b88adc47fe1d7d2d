// The plan of the room, drawn, with what is dragged in it.
#include <algorithm>
#include <cfloat>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <imgui.h>
#include <imgui_internal.h>

#include "live/projector_setup.h"
#include "studio/kit/imgui_versions.h"
#include "studio/seats/seats_panel.h"
#include "studio/studio.h"

namespace livery {

namespace {

constexpr float kAspect = 1.4f;  // wider than high: people sit side by side
constexpr double kWhyShown_s = 6.0;
const ImU32 kOutline = IM_COL32(150, 150, 150, 255), kInside = IM_COL32(72, 72, 72, 255);
const ImU32 kLight = IM_COL32(225, 196, 120, 255), kLightShape = IM_COL32(225, 196, 120, 34);
const ImU32 kCamera = IM_COL32(140, 190, 205, 255), kCameraShape = IM_COL32(140, 190, 205, 22);

struct PlanFrame {
    ImVec2 low, high;
    PlanExtent extent;

    float scale() const {
        return (high.x - low.x) / static_cast<float>(extent.high_mm.x - extent.low_mm.x);
    }
    ImVec2 at(const glm::dvec2& mm) const {
        return {low.x + scale() * static_cast<float>(mm.x - extent.low_mm.x),
                low.y + scale() * static_cast<float>(mm.y - extent.low_mm.y)};
    }
    glm::dvec2 under(const ImVec2& px) const {
        return extent.low_mm + glm::dvec2(static_cast<double>((px.x - low.x) / scale()),
                                          static_cast<double>((px.y - low.y) / scale()));
    }
};

/// Text that stays inside the plan.
void label(const PlanFrame& plan, ImVec2 at, ImU32 colour, const std::string& text) {
    ImFont* font = small_font();
    const ImVec2 size = font->CalcTextSizeA(font->FontSize, FLT_MAX, 0.0f, text.c_str());
    const float pad = em(0.2f);
    at.x = std::clamp(at.x - 0.5f * size.x, plan.low.x + pad, plan.high.x - size.x - pad);
    at.y = std::clamp(at.y, plan.low.y + pad, plan.high.y - size.y - pad);
    ImGui::GetWindowDrawList()->AddText(font, font->FontSize, at, colour, text.c_str());
}

void draw_mockup(const PlanFrame& plan, const std::vector<glm::dvec2>& outline_mm) {
    if (outline_mm.size() < 3) return;
    std::vector<ImVec2> points;
    ImVec2 bottom(0.0f, -FLT_MAX);
    for (const glm::dvec2& point : outline_mm) {
        points.push_back(plan.at(point));
        if (points.back().y > bottom.y) bottom = points.back();
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddConvexPolyFilled(points.data(), static_cast<int>(points.size()), kInside);
    list.AddPolyline(points.data(),
                     static_cast<int>(points.size()),
                     kOutline,
                     ImDrawFlags_Closed,
                     std::max(1.0f, em(0.08f)));
}

/// A projector or a camera: its place, what it sees, its name.
void draw_device(const PlanFrame& plan,
                 const View& view,
                 const glm::dvec2& middle_mm,
                 ImU32 colour,
                 ImU32 shape,
                 const char* name,
                 bool above) {
    const glm::dvec2 from_mm = in_plan(centre_in_world(view));
    const double reach_mm = 1.25 * glm::distance(from_mm, middle_mm);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 from = plan.at(from_mm);
    if (const auto cone = cone_in_plan(view, reach_mm)) {
        const ImVec2 left = plan.at(cone->left_mm), right = plan.at(cone->right_mm);
        list.AddTriangleFilled(from, left, right, shape);
        list.AddLine(from, left, (shape & 0x00ffffffu) | 0x70000000u);
        list.AddLine(from, right, (shape & 0x00ffffffu) | 0x70000000u);
    }
    const float half = em(0.4f);
    list.AddRectFilled({from.x - half, from.y - half}, {from.x + half, from.y + half}, colour);
    const float down = above ? -1.4f * half - small_font()->FontSize : 1.4f * half;
    label(plan, {from.x, from.y + down}, colour, name);
}

void draw_scale_bar(const PlanFrame& plan) {
    const double longest_mm = 0.28 * (plan.extent.high_mm.x - plan.extent.low_mm.x);
    const double mm = scale_bar_mm(longest_mm);
    const float length = plan.scale() * static_cast<float>(mm), pad = em(0.6f);
    const ImVec2 left(plan.low.x + pad, plan.high.y - pad), right(left.x + length, left.y);
    const ImU32 colour = ImGui::GetColorU32(colours::dim_text);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float tick = em(0.25f), width = std::max(1.0f, em(0.1f));
    list.AddLine(left, right, colour, width);
    for (const ImVec2& end : {left, right}) {
        list.AddLine({end.x, end.y - tick}, {end.x, end.y + tick}, colour, width);
    }
    ImFont* font = small_font();
    list.AddText(font,
                 font->FontSize,
                 {left.x, left.y - tick - font->FontSize - em(0.1f)},
                 colour,
                 length_in_words(mm).c_str());
}

struct DiscState {
    bool chosen = false, lit = false, in_use = false, counts = true, unfair = false;
};

void draw_disc(const ImVec2& at, float radius, int number, const DiscState& look) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec4 fill = look.unfair ? colours::warning
                        : look.lit  ? ImVec4(1.0f, 1.0f, 1.0f, 1.0f)
                                    : ImVec4(0.80f, 0.80f, 0.80f, 1.0f);
    const float line = std::max(1.5f, em(0.12f));
    if (look.counts) {
        list.AddCircleFilled(at, radius, ImGui::GetColorU32(fill), 32);
    } else {
        list.AddCircleFilled(at, radius, ImGui::GetColorU32(colours::panel), 32);
        list.AddCircle(at, radius, ImGui::GetColorU32(fill), 32, line);
    }
    if (look.chosen) {
        list.AddCircle(
            at, radius + 1.5f * line, ImGui::GetColorU32(colours::accent), 32, 1.6f * line);
    }
    const std::string text = fmt::format("{}", number);
    ImFont* font = small_font();
    const ImVec2 size = font->CalcTextSizeA(font->FontSize, FLT_MAX, 0.0f, text.c_str());
    list.AddText(font,
                 font->FontSize,
                 {std::round(at.x - 0.5f * size.x), std::round(at.y - 0.5f * size.y)},
                 look.counts ? IM_COL32(20, 20, 20, 255) : ImGui::GetColorU32(fill),
                 text.c_str());
}

/// The eye that highlights are drawn for.
void draw_eye(const ImVec2& at, bool lit) {
    const float wide = em(0.95f), high = em(0.55f), line = std::max(1.5f, em(0.13f));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 colour = lit ? IM_COL32(255, 255, 255, 255) : ImGui::GetColorU32(colours::accent);
    const std::array<ImVec2, 4> lids{ImVec2{at.x - wide, at.y},
                                     ImVec2{at.x, at.y - 1.7f * high},
                                     ImVec2{at.x + wide, at.y},
                                     ImVec2{at.x, at.y + 1.7f * high}};
    list.AddBezierQuadratic(lids[0], lids[1], lids[2], colour, line);
    list.AddBezierQuadratic(lids[0], lids[3], lids[2], colour, line);
    list.AddCircleFilled(at, 0.45f * high, colour, 16);
}

void tell_why(Studio& studio, const std::string& why) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    if (why.empty()) {
        state.why.clear();
        return;
    }
    state.why = why;
    state.why_until_s = studio.now_s + kWhyShown_s;
}

void draw_seats(Studio& studio, const PlanFrame& plan, std::vector<EyeSeat>& seats) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    const Document& document = studio.session.document();
    const float radius = em(0.72f);
    for (EyeSeat& seat : seats) {
        const ImVec2 at = plan.at(in_plan(seat.eye_mm));
        const float reach = 1.15f * radius;
        ImGui::PushID(seat.number);
        ImGui::SetCursorScreenPos({at.x - reach, at.y - reach});
        ImGui::InvisibleButton("seat", {2.0f * reach, 2.0f * reach});
        if (ImGui::IsItemActivated()) {
            state.selected = seat.number;
            state.grabbed_mm = plan.under(ImGui::GetIO().MousePos) - in_plan(seat.eye_mm);
            tell_why(studio, "");
        }
        if (ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left, em(0.15f))) {
            const PlacedSeat placed =
                placed_seat(seat,
                            plan.under(ImGui::GetIO().MousePos) - state.grabbed_mm,
                            document.seats,
                            state.outline_mm,
                            plan.extent);
            seat.eye_mm = placed.eye_mm;
            tell_why(studio, placed.why);
            ImGui::MarkItemEdited(ImGui::GetItemID());
        }
        state.dragging = state.dragging || ImGui::IsItemActive();
        state.held.after_item();
        name_last_item(fmt::format("plan:seat:{}", seat.number));
        const bool lit = ImGui::IsItemHovered() || ImGui::IsItemActive();
        edit_with_last_item(studio, SetSeat{seat.number, seat.eye_mm, seat.counts});
        const SeatErrorMap* error = seat_error_of(studio, studio.shown_look, seat.number);
        draw_disc(plan.at(in_plan(seat.eye_mm)),
                  radius,
                  seat.number,
                  {state.selected == seat.number,
                   lit,
                   document.eye_choice.seat == seat.number,
                   seat.counts,
                   error && !is_fair(error->error)});
        if (lit) {
            tooltip(error ? in_words(SeatSees{seat.number, studio.shown_look, error->error})
                          : fmt::format("Seat {}. Drag it to where its eyes are.", seat.number));
        }
        ImGui::PopID();
    }
}

/// Dragged only where it is nobody's.
void draw_eye_in_use(Studio& studio, const PlanFrame& plan) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    const Document& document = studio.session.document();
    const Document shown = shown_document(studio);
    if (document.eye_choice.source != EyeSource::by_hand) {
        const ImVec2 at = plan.at(in_plan(eye_in_use_mm(shown)));
        // Above the disc of the seat that it is
        const float up = document.eye_choice.source == EyeSource::seat ? em(1.45f) : 0.0f;
        draw_eye({at.x, at.y - up}, false);
        name_rectangle("plan:eye-in-use", at.x - em(0.5f), at.y - em(0.5f), em(1.0f), em(1.0f));
        return;
    }
    glm::dvec3& eye_mm = state.held_eye_mm.start(document.eye_mm);
    const ImVec2 at = plan.at(in_plan(eye_mm));
    const float reach = em(0.9f);
    ImGui::SetCursorScreenPos({at.x - reach, at.y - reach});
    ImGui::InvisibleButton("eye", {2.0f * reach, 2.0f * reach});
    if (ImGui::IsItemActivated()) {
        state.grabbed_mm = plan.under(ImGui::GetIO().MousePos) - in_plan(eye_mm);
        tell_why(studio, "");
    }
    if (ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left, em(0.15f))) {
        const PlacedSeat placed =
            placed_seat({0, eye_mm, true},
                        plan.under(ImGui::GetIO().MousePos) - state.grabbed_mm,
                        {},
                        state.outline_mm,
                        plan.extent);
        eye_mm = placed.eye_mm;
        tell_why(studio, placed.why);
        ImGui::MarkItemEdited(ImGui::GetItemID());
    }
    state.dragging = state.dragging || ImGui::IsItemActive();
    state.held_eye_mm.after_item();
    name_last_item("plan:eye");
    const bool lit = ImGui::IsItemHovered() || ImGui::IsItemActive();
    edit_with_last_item(studio, SetEye{eye_mm});
    state.held_eye_mm.finish();
    draw_eye(plan.at(in_plan(eye_mm)), lit);
    tooltip("The eye that highlights are drawn for, set by hand. Drag it.");
}

/// A double click where nothing is puts a seat there.
void handle_background(Studio& studio, const PlanFrame& plan) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    if (!ImGui::IsItemHovered()) return;
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) state.selected = 0;
    if (!ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) return;
    const auto& seats = studio.session.document().seats;
    if (seats.size() >= kMostSeats) {
        return tell_why(studio,
                        fmt::format("There are {} seats; no more are possible.", kMostSeats));
    }
    EyeSeat seat{free_seat_number(seats), {}, true};
    const glm::dvec2 wanted_mm = plan.under(ImGui::GetIO().MousePos);
    seat.eye_mm = {wanted_mm.x, seated_eye_height_mm(state.bounds), wanted_mm.y};
    const PlacedSeat placed = placed_seat(seat, wanted_mm, seats, state.outline_mm, plan.extent);
    tell_why(studio, placed.why);
    state.selected = seat.number;
    commit(studio, SetSeat{seat.number, placed.eye_mm, true});
}

PlanExtent extent_of(const Studio& studio) {
    const SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    const Document& document = studio.session.document();
    std::vector<glm::dvec2> points = state.outline_mm;
    for (const EyeSeat& seat : document.seats) points.push_back(in_plan(seat.eye_mm));
    points.push_back(in_plan(eye_in_use_mm(document)));
    if (studio.setup) points.push_back(in_plan(centre_in_world(studio.setup->view)));
    return plan_extent(points, static_cast<double>(kAspect));
}

}  // namespace

void take_outline(Studio& studio) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    if (!studio.product || state.outline_of == studio.product) return;
    state.outline_of = studio.product;
    state.outline_mm = outline_from_above(studio.product->mesh);
    state.bounds = bounds_of(studio.product->mesh);
}

void draw_room_plan(Studio& studio, std::vector<EyeSeat>& seats, float width) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    take_outline(studio);
    if (!state.dragging) state.extent = extent_of(studio);
    state.dragging = false;
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const PlanFrame plan{
        low, {low.x + std::floor(width), low.y + std::floor(width / kAspect)}, state.extent};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 size(plan.high.x - plan.low.x, plan.high.y - plan.low.y);
    begin_overlapped_item();
    ImGui::InvisibleButton("plan", size);
    end_overlapped_item();
    name_last_item("plan");
    handle_background(studio, plan);
    list.AddRectFilled(
        plan.low, plan.high, ImGui::GetColorU32(ImGui::GetStyleColorVec4(ImGuiCol_FrameBg)));
    ImGui::PushClipRect(plan.low, plan.high, true);
    const glm::dvec2 middle_mm = in_plan(0.5 * (state.bounds.low + state.bounds.high));
    if (studio.setup) {
        if (studio.setup->origin && studio.setup->origin->room) {
            draw_device(plan,
                        studio.setup->origin->room->camera,
                        middle_mm,
                        kCamera,
                        kCameraShape,
                        "camera",
                        true);
        }
        draw_device(plan, studio.setup->view, middle_mm, kLight, kLightShape, "projector", false);
    }
    draw_mockup(plan, state.outline_mm);
    draw_scale_bar(plan);
    draw_seats(studio, plan, seats);
    draw_eye_in_use(studio, plan);
    ImGui::PopClipRect();
    ImGui::SetCursorScreenPos(low);
    ImGui::Dummy(size);
    if (!state.why.empty() && studio.now_s > state.why_until_s && !state.dragging) {
        state.why.clear();
    }
}

}  // namespace livery
