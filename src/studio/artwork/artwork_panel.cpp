// What lies over the paints of the shown look, topmost first, and the chosen one's fields.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "studio/artwork/artwork_edit.h"
#include "studio/artwork/artwork_values.h"
#include "studio/kit/widgets.h"
#include "studio/paint/parts_panel.h"
#include "studio/paint/swatches.h"

namespace livery {

namespace {

constexpr const char* kAddPopup = "add-artwork";

/// "Stripes on body, solid ivory".
std::string summary_of(const Artwork& artwork) {
    const std::string what =
        is_relief(artwork) ? words_of(artwork.use).label : words_of(artwork.shape).label;
    const std::string where = artwork.part == "*" ? "all parts" : artwork.part;
    if (is_relief(artwork)) return fmt::format("{} on {}", what, where);
    const bool is_print =
        artwork.shape == ArtworkShape::picture && artwork.use == PictureUse::colours;
    const std::string paint = artwork.paint.empty() ? "the part's own paint" : artwork.paint;
    return fmt::format("{} on {}, {}", what, where, is_print ? "ink on " + paint : paint);
}

/// What it is painted with, as far as one paint says that.
const Material* paint_of(Studio& studio, const Artwork& artwork) {
    if (!artwork.paint.empty()) return paint_named(studio, artwork.paint);
    const SessionLook* look = find_look(studio.session.document(), studio.shown_look);
    const std::string worn = look ? worn_paint(look->look, artwork.part) : "";
    return worn.empty() ? nullptr : paint_named(studio, worn);
}

/// A place in the list; the panel shows the last on top.
struct InList {
    std::size_t at = 0, count = 0;
    bool can_rise() const { return at + 1 < count; }
    bool can_sink() const { return at > 0; }
};

void rise(Studio& studio, std::size_t at) {
    set_artwork(studio, moved(shown_artwork(studio), at, at + 1), at + 1);
}
void sink(Studio& studio, std::size_t at) {
    set_artwork(studio, moved(shown_artwork(studio), at, at - 1), at - 1);
}
void duplicate(Studio& studio, std::size_t at) {
    set_artwork(studio, with_copy(shown_artwork(studio), at), at + 1);
}
void remove(Studio& studio, std::size_t at) {
    std::vector<Artwork> list = shown_artwork(studio);
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(at));
    stop_trying(studio);
    const auto next = list.empty() ? std::nullopt : std::optional(std::min(at, list.size() - 1));
    set_artwork(studio, list, next);
}

void draw_row_menu(Studio& studio, const InList& place, bool full) {
    if (!ImGui::BeginPopupContextItem("row")) return;
    if (ImGui::MenuItem("Duplicate", nullptr, false, !full)) duplicate(studio, place.at);
    ImGui::Separator();
    if (ImGui::MenuItem("Move up", nullptr, false, place.can_rise())) rise(studio, place.at);
    if (ImGui::MenuItem("Move down", nullptr, false, place.can_sink())) sink(studio, place.at);
    ImGui::Separator();
    if (ImGui::MenuItem("Delete")) remove(studio, place.at);
    ImGui::EndPopup();
}

void draw_row(Studio& studio, const Artwork& artwork, const InList& place, bool chosen) {
    ImGui::PushID(static_cast<int>(place.at));
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const float height = 2.0f * ImGui::GetTextLineHeight() + em(0.45f);
    if (ImGui::Selectable("##artwork", chosen, 0, {width, height})) {
        stop_trying(studio);
        choose_artwork(studio, place.at);
    }
    name_last_item(fmt::format("artwork:{}", place.at));
    draw_row_menu(studio, place, place.count >= kMostArtworks);
    const float side = height - em(0.3f);
    if (const Material* paint = paint_of(studio, artwork)) {
        draw_swatch(studio, *paint, {from.x + em(0.2f), from.y + em(0.15f)}, side);
    }
    const bool seen = why_not_seen(studio, place.at).empty();
    const ImVec4 clip(from.x, from.y, from.x + width, from.y + height);
    const ImVec2 at(from.x + side + em(0.7f), from.y + em(0.15f));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const auto add =
        [&](ImFont* font, const ImVec2& where, const ImVec4& colour, const std::string& text) {
            list.AddText(font,
                         font->FontSize,
                         where,
                         ImGui::GetColorU32(colour),
                         text.c_str(),
                         nullptr,
                         0.0f,
                         &clip);
        };
    add(ImGui::GetFont(), at, colours::text, shown_name(artwork));
    add(small_font(),
        {at.x, at.y + ImGui::GetTextLineHeight() + em(0.1f)},
        seen ? (chosen ? colours::text : colours::dim_text) : colours::warning,
        seen ? summary_of(artwork) : "Not seen. " + summary_of(artwork));
    ImGui::PopID();
}

void draw_add_menu(Studio& studio) {
    if (!ImGui::BeginPopup(kAddPopup)) return;
    for (std::size_t i = 0; i < kArtworkShapes.size(); ++i) {
        const auto shape = static_cast<ArtworkShape>(i);
        const Words words = words_of(shape);
        const bool picture = shape == ArtworkShape::picture;
        const bool picked = ImGui::MenuItem((words.label + (picture ? "…" : "")).c_str());
        name_last_item(std::string("artwork:add:") + kArtworkShapes[i]);
        tooltip(words.meaning);
        if (picked) {
            add_artwork(studio, shape);
        } else if (ImGui::IsItemHovered() && !picture) {
            SetArtwork command{studio.shown_look, shown_artwork(studio)};
            command.artwork.push_back(artwork_to_add(studio, shape));
            try_out(studio, command);
        }
    }
    ImGui::EndPopup();
}

void draw_buttons(Studio& studio, const InList& place) {
    const bool full = place.count >= kMostArtworks, none = place.count == 0;
    begin_disabled(full);
    if (ImGui::Button("Add…")) ImGui::OpenPopup(kAddPopup);
    name_last_item("artwork:add");
    tooltip(full ? fmt::format("A look has at most {}.", kMostArtworks)
                 : "A second tone, stripes, a pattern or a picture over the chosen part's paint.");
    end_disabled();
    draw_add_menu(studio);
    const auto change = [&](const char* label,
                            const char* name,
                            const char* meaning,
                            bool possible,
                            void (*run)(Studio&, std::size_t)) {
        place_in_row(button_width(label));
        begin_disabled(!possible);
        const bool pressed = button(label, std::string("artwork:") + name, meaning);
        end_disabled();
        if (pressed) run(studio, place.at);
    };
    change("↑", "up", "Over the one before it in this list.", !none && place.can_rise(), rise);
    change("↓", "down", "Under the one behind it in this list.", !none && place.can_sink(), sink);
    change("Duplicate", "duplicate", "A copy of the chosen one.", !none && !full, duplicate);
    change("Delete", "delete", "Takes the chosen one off. Ctrl+Z brings it back.", !none, remove);
}

}  // namespace

void draw_artwork_panel(Studio& studio) {
    if (!find_look(studio.session.document(), studio.shown_look) || !studio.product) {
        dim_text("There is no look that could have artwork.");
        return;
    }
    const auto chosen = chosen_artwork(studio);
    choose_artwork(studio, chosen);
    draw_buttons(studio, {chosen.value_or(0), shown_artwork(studio).size()});
    // A copy: a row may change the list.
    const std::vector<Artwork> list = shown_artwork(studio);
    if (list.empty()) {
        dim_text(
            "Only paint so far. Add a second tone, stripes, a pattern or a picture: it lies over "
            "the paint of the chosen part.");
        return;
    }
    for (std::size_t i = list.size(); i-- > 0;) {
        draw_row(studio, list[i], {i, list.size()}, chosen_artwork(studio) == i);
    }
    ImGui::Spacing();
    ImGui::Separator();
    if (const auto at = chosen_artwork(studio)) draw_artwork_fields(studio, *at);
}

namespace {

bool give_up_placing(Studio& studio) {
    if (!is_placing(studio)) return false;
    stop_placing(studio);
    stop_trying(studio);
    return true;
}

void describe_artwork(const Studio& studio, MapState& state) {
    // As the command that would make it: what is kept, not what is being tried.
    state["artwork"] = text_of(SetArtwork{studio.shown_look, shown_artwork(studio)});
    state["placing"] = map_text(is_placing(studio));
}

}  // namespace

Panel artwork_panel() {
    return {.name = "Artwork",
            .place = PanelPlace::tab,
            .draw = draw_artwork_panel,
            .give_up = give_up_placing,
            .describe = describe_artwork};
}

}  // namespace livery
