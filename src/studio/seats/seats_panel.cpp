#include "studio/seats/seats_panel.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

namespace livery {

namespace {

constexpr double kCoarseStep = 10.0, kFineStep = 0.1;  // with Shift, with Ctrl

const EyeSeat* selected_seat(const Studio& studio) {
    return find_seat(studio.session.document().seats, studio.panels.of<SeatsPanelState>().selected);
}

void move_selected(Studio& studio, const glm::dvec3& by_mm) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    take_outline(studio);
    const EyeSeat* seat = selected_seat(studio);
    if (!seat) return;
    const glm::dvec3 to_mm = seat->eye_mm + by_mm;
    const auto to_mockup_mm = [&](const glm::dvec3& eye_mm) {
        return distance_to_outline(state.outline_mm, in_plan(eye_mm)).mm;
    };
    const double far_mm = to_mockup_mm(to_mm);
    if (far_mm < kLeastFromMockup_mm && far_mm < to_mockup_mm(seat->eye_mm)) {
        state.why = "Nobody sits on the mock-up: the seat stays beside it.";
        state.why_until_s = studio.now_s + 6.0;
        return;
    }
    state.why.clear();
    commit(studio, SetSeat{seat->number, to_mm, seat->counts});
}

void remove_selected(Studio& studio) {
    const EyeSeat* seat = selected_seat(studio);
    if (!seat) return;
    stop_trying(studio);
    commit(studio, RemoveSeat{seat->number});
}

void add_seat(Studio& studio) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    const Document& document = studio.session.document();
    const EyeSeat seat = next_seat(state.bounds, eye_in_use_mm(document), document.seats);
    state.selected = seat.number;
    commit(studio, SetSeat{seat.number, seat.eye_mm, seat.counts});
}

std::string choice_label(const Document& document, const EyeChoice& choice) {
    switch (choice.source) {
        case EyeSource::by_hand:
            return "a point set by hand";
        case EyeSource::mean:
            return fmt::format("the mean of {} seats", counting_seats(document.seats));
        case EyeSource::seat:
            break;
    }
    return fmt::format("seat {}", choice.seat);
}

void draw_eye_choice(Studio& studio) {
    const Document& document = studio.session.document();
    row_label("Highlights for", 0.36f);
    ImGui::SetNextItemWidth(-1.0f);
    const bool open =
        ImGui::BeginCombo("##eye-of", choice_label(document, document.eye_choice).c_str());
    name_last_item("seats:eye");
    tooltip("Whose eye the projected highlights are drawn for: everybody sees the same light.");
    if (!open) return;
    std::vector<EyeChoice> choices{{EyeSource::by_hand, 0}};
    if (mean_eye_mm(document.seats)) choices.push_back({EyeSource::mean, 0});
    for (const EyeSeat& seat : document.seats) choices.push_back({EyeSource::seat, seat.number});
    std::optional<EyeChoice> chosen;
    for (const EyeChoice& choice : choices) {
        const std::string label = choice_label(document, choice);
        if (ImGui::Selectable(label.c_str(), choice == document.eye_choice)) chosen = choice;
        const char* kind = choice.source == EyeSource::by_hand ? "hand"
                           : choice.source == EyeSource::mean  ? "mean"
                                                               : nullptr;
        name_last_item(kind ? fmt::format("seats:eye:{}", kind)
                            : fmt::format("seats:eye:{}", choice.seat));
    }
    ImGui::EndCombo();
    if (chosen) commit(studio, UseEye{*chosen});
}

void draw_buttons(Studio& studio) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    const Document& document = studio.session.document();
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float half = std::floor(0.5f * (ImGui::GetContentRegionAvail().x - gap));
    begin_disabled(document.seats.size() >= kMostSeats);
    if (button("Add a seat", "seats:add", "", half)) add_seat(studio);
    end_disabled();
    tooltip(
        "Beside the others, at arm's length from the mock-up. A double click in the plan puts "
        "one there.");
    ImGui::SameLine(0.0f, gap);
    const EyeSeat* selected = selected_seat(studio);
    begin_disabled(!selected);
    const std::string remove =
        selected ? fmt::format("Remove seat {}###remove", selected->number) : "Remove###remove";
    if (button(remove, "seats:remove", "", half)) remove_selected(studio);
    end_disabled();
    tooltip("The chosen seat (Del).");
    ImGui::SetNextItemWidth(half);
    ImGui::InputInt("##arc", &state.arc);
    state.arc = std::clamp(state.arc, 1, static_cast<int>(kMostSeats));
    name_last_item("seats:arc-count");
    ImGui::SameLine(0.0f, gap);
    if (ImGui::Button(fmt::format("{} in an arc###arc", state.arc).c_str(), {half, 0.0f})) {
        state.selected = 0;
        commit(studio, SetSeats{seats_in_an_arc(state.bounds, eye_in_use_mm(document), state.arc)});
    }
    name_last_item("seats:arc");
    tooltip("Places all seats anew: side by side round the mock-up, before the eye.");
}

void draw_selected(Studio& studio, std::vector<EyeSeat>& seats) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    const auto found = std::find_if(seats.begin(), seats.end(), [&](const EyeSeat& seat) {
        return seat.number == state.selected;
    });
    if (found == seats.end()) {
        dim_text("Click a seat to choose it.");
        return;
    }
    EyeSeat& seat = *found;
    heading(fmt::format("Seat {}", seat.number).c_str());
    vector_row("x, y, z (mm)",
               "seat",
               seat.eye_mm,
               2.0f,
               "%.0f",
               "Of its eyes, in the product's frame: y is up. Double-click to type.",
               [&] {
                   state.held.after_item();
                   edit_with_last_item(studio, SetSeat{seat.number, seat.eye_mm, seat.counts});
               });
    const double above_mm = seat.eye_mm.y - floor_height_mm(state.bounds);
    row_label("Above the floor");
    double height_mm = above_mm;
    number_slider("##height", height_mm, 500.0, 2200.0, "%.0f mm");
    if (last_item_is_held()) seat.eye_mm.y += height_mm - above_mm;
    name_last_item("seat:height");
    tooltip("Seated eyes are 1200 mm above it; a small mock-up stands on a table of 720 mm.");
    state.held.after_item();
    edit_with_last_item(studio, SetSeat{seat.number, seat.eye_mm, seat.counts});
    bool counts = seat.counts;
    if (named(ImGui::Checkbox("Counts in the mean", &counts), "seat:counts")) {
        commit(studio, SetSeat{seat.number, seat.eye_mm, counts});
    }
}

void draw_figures_row(Studio& studio, const EyeSeat& seat) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    const SeatErrorMap* map = seat_error_of(studio, studio.shown_look, seat.number);
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    if (ImGui::Selectable(fmt::format("{}##seat", seat.number).c_str(),
                          state.selected == seat.number,
                          ImGuiSelectableFlags_SpanAllColumns)) {
        state.selected = seat.number;
    }
    name_last_item(fmt::format("seats:row:{}", seat.number));
    const auto cell = [&](const std::string& text) {
        ImGui::TableNextColumn();
        const bool fair = !map || is_fair(map->error);
        ImGui::TextColored(fair ? colours::text : colours::warning, "%s", text.c_str());
    };
    if (!map) {
        for (int k = 0; k < 3; ++k) cell("…");
        return;
    }
    cell(fmt::format("{:.1f}", map->error.de00_median));
    cell(fmt::format("{:.1f}", map->error.de00_p95));
    cell(fmt::format("{:.0f}%", 100.0 * map->error.share_over));
}

void draw_what_they_miss(Studio& studio) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    const Document& document = studio.session.document();
    heading("What each seat misses");
    if (document.seats.empty()) {
        dim_text("There are no seats: everybody is taken to look from the eye.");
        return;
    }
    if (toggle_button(
            "Show it on the stage", state.map_on_stage, ImGui::GetContentRegionAvail().x)) {
        show_seat_map(studio, !state.map_on_stage);
    }
    name_last_item("seats:map");
    tooltip("The chosen seat's differences over the mock-up, in the projector's pixels.");
    if (const auto progress = seat_errors_progress(studio)) {
        progress_bar(*progress, "Shading the look for each seat…");
        name_last_item("seats:progress");
    }
    if (state.results && !state.results->problem.empty()) warning_text(state.results->problem);
    constexpr ImGuiTableFlags flags = ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg;
    if (ImGui::BeginTable("misses", 4, flags)) {
        for (const char* title : {"Seat", "Median", "95%", "Over 3"}) {
            ImGui::TableSetupColumn(title);
        }
        ImGui::TableHeadersRow();
        for (const EyeSeat& seat : document.seats) {
            ImGui::PushID(seat.number);
            draw_figures_row(studio, seat);
            ImGui::PopID();
        }
        ImGui::EndTable();
    }
    std::vector<SeatSees> all;
    if (state.results && state.results->number == state.number) {
        all = worst_looks(*state.results, document.seats, {studio.shown_look});
    }
    const auto worst =
        std::max_element(all.begin(), all.end(), [](const SeatSees& a, const SeatSees& b) {
            return a.error.de00_p95 < b.error.de00_p95;
        });
    if (worst != all.end() && all.size() == document.seats.size()) {
        const std::string words = "Worst off: " + in_words(*worst);
        is_fair(worst->error) ? dim_text(words) : warning_text(words);
        name_last_item("seats:worst");
    }
}

}  // namespace

void show_seats(Studio& studio, bool shown) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    if (shown == state.open) return;
    stop_trying(studio);
    state.open = shown;
    if (!shown) show_seat_map(studio, false);
}

bool seats_key(Studio& studio, const KeyChord& chord) {
    if (!selected_seat(studio)) return false;
    const double step_mm = kSeatStep_mm * (chord.shift  ? kCoarseStep
                                           : chord.ctrl ? kFineStep
                                                        : 1.0);
    if (chord.key == GLFW_KEY_DELETE) {
        remove_selected(studio);
        return true;
    }
    static const std::pair<int, glm::dvec3> ways[] = {{GLFW_KEY_LEFT, {-1.0, 0.0, 0.0}},
                                                      {GLFW_KEY_RIGHT, {1.0, 0.0, 0.0}},
                                                      {GLFW_KEY_UP, {0.0, 0.0, -1.0}},
                                                      {GLFW_KEY_DOWN, {0.0, 0.0, 1.0}},
                                                      {GLFW_KEY_PAGE_UP, {0.0, 1.0, 0.0}},
                                                      {GLFW_KEY_PAGE_DOWN, {0.0, -1.0, 0.0}}};
    for (const auto& [key, way] : ways) {
        if (key != chord.key) continue;
        move_selected(studio, step_mm * way);
        return true;
    }
    return false;
}

void draw_seats_panel(Studio& studio) {
    SeatsPanelState& state = studio.panels.of<SeatsPanelState>();
    const float side = ImGui::GetFrameHeight();
    heading("Seats in the room");
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - side);
    if (button("×##close-seats", "seats:close", "Back to the paints. Seats stay.", side))
        show_seats(studio, false);
    draw_eye_choice(studio);
    std::vector<EyeSeat>& seats = state.held.start(studio.session.document().seats);
    // Undo while one is held: what is there counts
    if (seats.size() != studio.session.document().seats.size()) {
        seats = studio.session.document().seats;
    }
    draw_room_plan(studio, seats, ImGui::GetContentRegionAvail().x);
    if (!state.why.empty()) {
        warning_text(state.why);
    } else {
        dim_text("Drag a seat, or move the chosen one with the arrow keys.");
    }
    name_last_item("seats:why");
    draw_buttons(studio);
    draw_selected(studio, seats);
    state.held.finish();
    draw_what_they_miss(studio);
}

namespace {

bool is_seats_open(const Studio& studio) {
    return studio.panels.of<SeatsPanelState>().open && !is_editing_locked(studio);
}

void describe_seats(const Studio& studio, MapState& state) {
    const Document& document = studio.session.document();
    state["seats"] = text_of(SetSeats{document.seats});
    state["eye_of"] = text_of(UseEye{document.eye_choice});
    state["selected_seat"] = std::to_string(studio.panels.of<SeatsPanelState>().selected);
    state["seat_errors"] = map_text(seat_errors_found(studio));
    state["seat_map"] = map_text(seat_map_size(studio).x > 0 && shows_seat_map(studio));
}

}  // namespace

Panel seats_panel() {
    return {.name = "seats",
            .place = PanelPlace::column,
            .draw = draw_seats_panel,
            .is_open = is_seats_open,
            .show = show_seats,
            .step = step_seat_errors,
            .stop = stop_seat_errors,
            .press =
                [](Studio& s, const KeyChord& chord, bool) {
                    return is_seats_open(s) && seats_key(s, chord) ? EventUse::step
                                                                   : EventUse::passed_on;
                },
            .esc_closes = true,
            .describe = describe_seats,
            .actions =
                [] {
                    return std::vector{
                        panel_action("seats", "seats", "Projector", "Seats in the room…")};
                }};
}

}  // namespace livery
