// The paints: swatches to hover and to click, found by typing, walked through with the arrow keys.
#include "studio/paint/library_panel.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include "appearance/subsurface/translucent_material.h"
#include "studio/kit/imgui_versions.h"
#include "studio/paint/paint_rows.h"
#include "studio/paint/parts_panel.h"
#include "studio/studio.h"
#include "studio/users_library.h"

namespace livery {

namespace {

/// One swatch of the grid.
struct SwatchCell {
    const Material* paint = nullptr;
    std::string distance;  ///< from the colour that was searched for; empty: none was
    ImVec2 centre{0.0f, 0.0f};
};

struct Section {
    const char* title;
    const std::vector<Material>* paints;
    std::vector<NearPaint> found;  ///< without a colour all are 0 away from it
};

/// Farther away than this nobody takes a paint for the colour that was asked for.
constexpr double kNear_de00 = 5.0;

/// What a click paints.
struct Target {
    std::string part;   ///< "*": every part without a paint of its own
    std::string label;  ///< "body"
    std::string paint;  ///< that it wears
    bool is_product = false;
};

SessionCommand paint_command(const Studio& studio, const Target& target, const std::string& paint) {
    const int id = studio.shown_look;
    const std::string part = target.is_product ? "" : target.part;
    const SessionLook* look = find_look(studio.session.document(), id);
    const std::string look_name = look ? look_name_after(look->look, part, paint) : "";
    if (target.is_product) return PaintProduct{id, paint, look_name};
    return SetPaint{id, part, paint, look_name};
}

Target target_of(const Studio& studio) {
    Target target;
    const SessionLook* look = find_look(studio.session.document(), studio.shown_look);
    if (!look || !studio.product) return target;
    const auto& parts = studio.product->mesh.parts;
    const auto& painted = look->look.parts;
    const auto rest = painted.find("*");
    if (studio.paint_target == PaintTarget::product) {
        target = {"*", "every part", "", true};
        if (rest != painted.end() && painted.size() == 1) target.paint = rest->second;
    } else if (studio.paint_target == PaintTarget::rest) {
        target = {"*", "every part without a paint of its own", ""};
        if (rest != painted.end()) target.paint = rest->second;
    } else if (const auto part = chosen_part(studio)) {
        target.part = target.label = parts[*part].name;
        const auto own = painted.find(target.part);
        if (own != painted.end()) {
            target.paint = own->second;
        } else if (rest != painted.end()) {
            target.paint = rest->second;
        }
    }
    return target;
}

/// Whether some parts have paints of their own and others wear "*".
bool has_rest(const Studio& studio) {
    const SessionLook* look = find_look(studio.session.document(), studio.shown_look);
    if (!look || !studio.product) return false;
    const auto& parts = studio.product->mesh.parts;
    const auto named = std::count_if(parts.begin(), parts.end(), [&](const Part& part) {
        return look->look.parts.contains(part.name);
    });
    return named > 0 && named < static_cast<std::ptrdiff_t>(parts.size());
}

/// The arrows up and down leave the text alone and walk through what was found.
int on_arrow_in_search(ImGuiInputTextCallbackData* data) {
    auto& state = *static_cast<LibraryPanelState*>(data->UserData);
    if (data->EventKey == ImGuiKey_DownArrow) ++state.cursor_rows;
    if (data->EventKey == ImGuiKey_UpArrow) --state.cursor_rows;
    return 0;
}

void draw_search(LibraryPanelState& state) {
    const float clear_width = button_width("×");
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x -
                            (state.search.empty() ? 0.0f : clear_width + gap));
    if (state.focus_search) focus_next_field("##search");
    state.focus_search = false;
    state.cursor_rows = 0;
    if (ImGui::InputTextWithHint("##search",
                                 "Name, family or colour  ( / )",
                                 &state.search,
                                 ImGuiInputTextFlags_CallbackHistory,
                                 on_arrow_in_search,
                                 &state)) {
        state.cursor.reset();
    }
    name_last_item("paint-search");
    // Not over what is found while one types.
    if (!ImGui::IsItemActive())
        tooltip(
            "A colour finds the nearest paints: #b01020, rgb(176, 16, 32), a name as in CSS "
            "(tomato), lab:45,30,-20 or xyz:20.1,15.2,5.");
    // Enter lets the text go in the frame in which it is pressed.
    state.searching = ImGui::IsItemActive() || ImGui::IsItemDeactivated();
    if (state.search.empty()) return;
    ImGui::SameLine(0.0f, gap);
    if (button("×##clear", "paint-search-clear", "Shows all paints again.", clear_width))
        state.search.clear();
}

/// By name, else by colour; the colour that was searched for.
std::optional<glm::dvec3> find_in(const LibraryPanelState& state, std::vector<Section>& sections) {
    const auto colour = colour_in(state.search);
    // Food and drinks answer to their name and family alone
    const auto left_out = [&](const Section& section, std::size_t k) {
        return state.family.empty() && (*section.paints)[k].family == kMeasuredMedia;
    };
    bool named = false;
    if (!colour || !is_marked_colour(state.search)) {
        for (Section& section : sections) {
            for (const std::size_t k : search_paints(*section.paints, state.search, state.family)) {
                if (state.search.empty() && left_out(section, k)) continue;
                section.found.push_back({k, 0.0});
                named = true;
            }
        }
    }
    if (!colour || named) return std::nullopt;
    for (Section& section : sections) {
        section.found = find_near_paints(*section.paints, *colour, state.family);
        std::erase_if(section.found,
                      [&](const auto& found) { return left_out(section, found.index); });
    }
    return colour;
}

/// What was searched for, beside what was found; or that the text is a colour's name, too.
void draw_colour(LibraryPanelState& state,
                 const std::optional<glm::dvec3>& searched,
                 const std::vector<Section>& sections) {
    const auto colour = colour_in(state.search);
    if (!colour) return;
    const float side = ImGui::GetFrameHeight();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::Dummy({1.6f * side, side});
    ImGui::GetWindowDrawList()->AddRectFilled(corner,
                                              {corner.x + 1.6f * side, corner.y + side},
                                              screen_colour(*colour),
                                              ImGui::GetStyle().FrameRounding);
    name_last_item("searched-colour");
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    if (!searched) {
        if (ImGui::SmallButton("Nearest to this colour")) {
            state.search = fmt::format("lab:{:.2f},{:.2f},{:.2f}", colour->x, colour->y, colour->z);
        }
        name_last_item("paint-by-colour");
        tooltip("The text is also a colour's name.");
        return;
    }
    double nearest = DBL_MAX;
    for (const Section& section : sections) {
        if (!section.found.empty()) nearest = std::min(nearest, section.found.front().de00);
    }
    ImGui::PushTextWrapPos(0.0f);
    if (nearest > kNear_de00) {
        ImGui::TextColored(colours::warning,
                           nearest < DBL_MAX ? "No paint is near: the nearest is %.1f away."
                                             : "There is no paint to compare.",
                           nearest);
        name_last_item("nothing-near");
    } else {
        ImGui::TextUnformatted("Wanted; below, how far each is.");
    }
    ImGui::PopTextWrapPos();
    tooltip(
        "CIEDE2000 between this colour and the paint's at 45 degrees: at 1 one sees the difference "
        "side by side, at 5 it is another colour.");
}

void draw_families(LibraryPanelState& state, const std::vector<Section>& sections) {
    std::vector<std::string> families;
    for (const Section& section : sections) {
        for (const Material& paint : *section.paints) {
            const bool known =
                std::find(families.begin(), families.end(), paint.family) != families.end();
            if (!known && !paint.family.empty()) families.push_back(paint.family);
        }
    }
    std::sort(families.begin(), families.end());
    if (named(chip("All", state.family.empty()), "family:all")) state.family.clear();
    for (const std::string& family : families) {
        place_in_row(button_width(family.c_str()));
        const bool on = state.family == family;
        if (named(chip(family.c_str(), on), "family:" + family)) state.family = on ? "" : family;
    }
}

void draw_target(Studio& studio, const Target& target) {
    ImGui::AlignTextToFramePadding();
    ImGui::PushTextWrapPos(0.0f);
    ImGui::Text("Painting: %s", target.label.c_str());
    ImGui::PopTextWrapPos();
    tooltip("What a click paints. Choose another part on the product or in the list.");
    using enum PaintTarget;
    PaintTarget& chosen = studio.paint_target;
    const auto offer =
        [&](const char* label, const char* name, PaintTarget one, const char* meaning) {
            place_in_row(button_width(label));
            if (named(chip(label, chosen == one), name, meaning))
                chosen = chosen == one ? part : one;
        };
    offer("Whole product",
          "paint-target:product",
          product,
          "Paints every part of this look alike, and takes off what parts wear by themselves, "
          "artwork as well.");
    if (has_rest(studio)) {
        offer("All other parts",
              "paint-target:rest",
              rest,
              "Paints every part of this look that has no paint of its own.");
    } else if (chosen == rest) {
        chosen = part;
    }
}

/// One swatch; true when it was clicked.
bool draw_cell(Studio& studio, const Target& target, SwatchCell& cell, float width, float height) {
    LibraryPanelState& state = studio.panels.of<LibraryPanelState>();
    const Material& paint = *cell.paint;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    cell.centre = {corner.x + 0.5f * width, corner.y + 0.5f * height};
    const bool clicked = ImGui::InvisibleButton(paint.name.c_str(), {width, height});
    name_last_item("paint:" + paint.name);
    const bool hovered = ImGui::IsItemHovered();
    // Whatever moved last says what is meant: the arrow keys, or the pointer.
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    if (hovered && (moved.x != 0.0f || moved.y != 0.0f)) state.cursor.reset();
    const bool on_cursor = state.cursor == paint.name;
    const bool led_here = on_cursor && std::exchange(state.cursor_moved, false);
    const bool meant = on_cursor || (hovered && !state.cursor);
    const bool worn = !target.paint.empty() && same_paint_name(target.paint, paint.name);
    if (meant && !worn) {
        // What the arrows are on is meant only as long as the keys come here.
        const bool has_keys = state.owns_arrows || state.searching;
        if (!on_cursor || has_keys) {
            try_out(studio, paint_command(studio, target, paint.name), led_here);
        }
    } else if (meant) {
        // Undo takes it off: not to be tried out again while pointer and keys rest on it.
        studio.untried_item = ImGui::GetItemID();
        studio.untried_item_still_there = true;
    }
    // Dear ImGui shows no keyboard in a window that reads its own keys.
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    if (g.NavId == ImGui::GetItemID() && g.NavDisableMouseHover && ImGui::IsWindowFocused()) {
        ImGui::GetWindowDrawList()->AddRect(corner,
                                            {corner.x + width, corner.y + height},
                                            ImGui::GetColorU32(ImGuiCol_NavHighlight),
                                            ImGui::GetStyle().FrameRounding,
                                            0,
                                            std::max(2.0f, em(0.13f)));
    }
    if (led_here) ImGui::SetScrollHereY();
    if (ImGui::IsItemVisible()) {
        draw_swatch_cell(studio, paint, cell.distance, corner, width, worn, meant);
    }
    if (hovered && meant) paint_tooltip(paint);
    return clicked;
}

/// The swatch that an arrow key leads to: the next in reading order, or the nearest in the row
/// above or below.
std::optional<std::size_t> neighbour(const std::vector<SwatchCell>& cells,
                                     std::optional<std::size_t> from,
                                     int across,
                                     int down) {
    if (cells.empty()) return std::nullopt;
    if (!from) return std::size_t{0};
    if (across != 0) {
        const auto to = static_cast<std::ptrdiff_t>(*from) + across;
        if (to < 0 || to >= static_cast<std::ptrdiff_t>(cells.size())) return from;
        return static_cast<std::size_t>(to);
    }
    const ImVec2 here = cells[*from].centre;
    std::optional<std::size_t> best;
    float best_y = FLT_MAX, best_x = FLT_MAX;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const float y = (cells[i].centre.y - here.y) * static_cast<float>(down);
        const float x = std::abs(cells[i].centre.x - here.x);
        if (y < 1.0f) continue;
        if (y < best_y - 1.0f || (y < best_y + 1.0f && x < best_x)) {
            best = i;
            best_y = y;
            best_x = x;
        }
    }
    return best ? best : from;
}

void follow_keys(Studio& studio, const Target& target, const std::vector<SwatchCell>& cells) {
    LibraryPanelState& state = studio.panels.of<LibraryPanelState>();
    if (!state.owns_arrows && !state.searching) return;
    std::optional<std::size_t> at;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (state.cursor == cells[i].paint->name) at = i;
    }
    // While a text is being typed the sideways arrows move in it.
    int across = 0, down = state.cursor_rows;
    if (state.owns_arrows) {
        across = int{was_pressed(ImGuiKey_RightArrow)} - int{was_pressed(ImGuiKey_LeftArrow)};
        down = int{was_pressed(ImGuiKey_DownArrow)} - int{was_pressed(ImGuiKey_UpArrow)};
    }
    if (across != 0 || down != 0) {
        // From the paint that the part wears, when nothing was tried before.
        for (std::size_t i = 0; i < cells.size() && !at && state.owns_arrows; ++i) {
            if (same_paint_name(cells[i].paint->name, target.paint)) at = i;
        }
        const auto to = neighbour(cells, at, across, down);
        if (to && to != at) {
            state.cursor = cells[*to].paint->name;
            state.cursor_moved = true;
        }
    }
    const bool enter = was_pressed(ImGuiKey_Enter) || was_pressed(kKeypadEnter);
    if (enter) {
        // Enter in the search takes the first that was found.
        if (!at && state.searching && !cells.empty() && !state.search.empty()) at = 0;
        if (at) {
            state.cursor = cells[*at].paint->name;
            commit(studio, paint_command(studio, target, *state.cursor));
        }
    }
    if (was_pressed(ImGuiKey_Escape)) state.cursor.reset();
}

void draw_grid(Studio& studio,
               const Target& target,
               const std::vector<Section>& sections,
               bool by_colour) {
    const float gap = em(0.3f), available = ImGui::GetContentRegionAvail().x;
    const auto columns =
        std::max(1, static_cast<int>(std::floor((available + gap) / (em(5.4f) + gap))));
    const float width = std::floor((available - gap * static_cast<float>(columns - 1)) /
                                   static_cast<float>(columns));
    const float height = std::floor(0.78f * width) + em(by_colour ? 3.85f : 2.75f);
    std::vector<SwatchCell> cells;
    std::optional<std::string> clicked;
    std::optional<unsigned> current;
    begin_tab_group();
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {gap, gap});
    for (const Section& section : sections) {
        if (section.found.empty()) continue;
        dim_text(section.title);
        ImGui::PushID(section.title);
        for (std::size_t i = 0; i < section.found.size(); ++i) {
            if (i % static_cast<std::size_t>(columns) != 0) ImGui::SameLine(0.0f, gap);
            const NearPaint& found = section.found[i];
            SwatchCell cell{&(*section.paints)[found.index],
                            by_colour ? fmt::format("ΔE {:.1f}", found.de00) : "",
                            {}};
            if (draw_cell(studio, target, cell, width, height)) clicked = cell.paint->name;
            const bool worn = same_paint_name(cell.paint->name, target.paint);
            const auto& cursor = studio.panels.of<LibraryPanelState>().cursor;
            if (cursor ? *cursor == cell.paint->name : worn) current = ImGui::GetItemID();
            cells.push_back(cell);
        }
        ImGui::PopID();
        ImGui::Dummy({0.0f, gap});
    }
    ImGui::PopStyleVar();
    end_tab_group(current);
    follow_keys(studio, target, cells);
    if (clicked) {
        studio.panels.of<LibraryPanelState>().cursor = clicked;
        commit(studio, paint_command(studio, target, *clicked));
    }
}

void draw_nothing_found(LibraryPanelState& state, const PaintLibrary& library) {
    std::string text = "No paint";
    if (!state.family.empty()) text += fmt::format(" of family {}", state.family);
    if (!state.search.empty()) text += fmt::format(" answers \"{}\"", state.search);
    dim_text(text + ".");
    if (!state.search.empty()) {
        const auto near = library.nearest(state.search, 1);
        if (!near.empty()) {
            ImGui::AlignTextToFramePadding();
            ImGui::TextUnformatted("Nearest:");
            ImGui::SameLine();
            if (named(ImGui::SmallButton(near.front().c_str()), "paint-nearest")) {
                state.search = near.front();
                state.family.clear();
            }
        }
    }
    if (button("Show all paints", "paint-show-all")) {
        state.search.clear();
        state.family.clear();
    }
}

}  // namespace

void draw_library_panel(Studio& studio) {
    LibraryPanelState& state = studio.panels.of<LibraryPanelState>();
    const PaintLibrary& library = current_library(studio);
    const LibraryReadings& readings = studio.panels.of<LibraryReadings>();
    if (!readings.problem.empty()) {
        warning_text("The paint library cannot be read anew. " + readings.problem);
    }
    const std::vector<Material>& own = studio.session.document().paints;
    std::vector<Section> sections{{"This session's own", &own, {}},
                                  {"Saved by you", &library.users, {}},
                                  {"Library", &library.shipped, {}},
                                  {"Translucent", &library.media, {}}};
    draw_search(state);
    const auto searched = find_in(state, sections);
    const bool found_any = std::any_of(
        sections.begin(), sections.end(), [](const Section& one) { return !one.found.empty(); });
    draw_colour(state, searched, sections);
    draw_families(state, sections);
    const Target target = target_of(studio);
    if (target.part.empty()) {
        dim_text("There is no part to paint.");
        return;
    }
    draw_target(studio, target);
    for (const std::string& problem : library.problems) warning_text("Left out: " + problem);
    for (const auto& file : readings.now.files) {
        dim_text("Reading " + file.filename().string() + "…");
    }

    const float height = std::max(ImGui::GetContentRegionAvail().y, em(12.0f));
    ImGui::BeginChild("swatches", {0.0f, height}, false, ImGuiWindowFlags_NoNavInputs);
    state.owns_arrows = found_any && ImGui::IsWindowFocused() && !state.searching;
    if (state.owns_arrows) studio.arrows_taken_in_frame = ImGui::GetFrameCount();
    const ImVec2 corner = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    name_rectangle("swatches", corner.x, corner.y, size.x, size.y);
    if (found_any) {
        draw_grid(studio, target, sections, searched.has_value());
    } else {
        draw_nothing_found(state, library);
    }
    ImGui::EndChild();
}

namespace {

std::vector<Action> library_actions() {
    return {{"find-paint",
             "Edit",
             "Find a paint",
             {key(GLFW_KEY_SLASH), ctrl(GLFW_KEY_K)},
             [](Studio& s) {
                 s.tab_to_open = "Paints";
                 s.panels.of<LibraryPanelState>().focus_search = true;
             }}};
}

}  // namespace

Panel library_panel() {
    return {.name = "Paints",
            .place = PanelPlace::tab,
            .draw = draw_library_panel,
            .step = take_swatches,
            .actions = library_actions};
}

}  // namespace livery
