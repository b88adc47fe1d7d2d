#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "core/error.h"
#include "scene/library.h"
#include "studio/artwork/artwork_edit.h"
#include "studio/artwork/artwork_values.h"
#include "studio/kit/ui_map.h"
#include "studio/kit/widgets.h"
#include "studio/paint/swatches.h"

namespace livery {

namespace {

constexpr const char* kOwnPaint = "The part's own";

/// One artwork's rows; an edit is tried and committed by what was just drawn.
class ArtworkRows {
  public:
    ArtworkRows(Studio& studio, std::size_t at, Artwork& edited)
        : studio_(studio), before_(shown_artwork(studio)[at]), at_(at), edited_(edited) {}

    const Artwork& before() const { return before_; }
    Studio& studio() { return studio_; }
    /// Asks for a file; `changed` with it is kept.
    void ask_for_file(Artwork changed) {
        const std::filesystem::path now(before_.picture);
        ask_for_picture(studio_,
                        "Open a picture",
                        now.is_absolute() ? now : std::filesystem::path(),
                        [&studio = studio_, at = at_, changed](const auto& file) mutable {
                            changed.picture = file.string();
                            set_artwork_at(studio, at, changed);
                        });
    }

    /// After a control that holds the value while it is dragged.
    void after_item(const std::string& name, const std::string& meaning) {
        name_last_item("artwork:" + name);
        tooltip(meaning);
        after_item();
    }
    void after_item() {
        ArtworkPanelState& state = studio_.panels.of<ArtworkPanelState>();
        state.held.after_item();
        const bool touched = last_item_is_held() || ImGui::IsItemDeactivatedAfterEdit();
        // What was put back where it was is no edit.
        if (!touched || edited_ == before_) return;
        edit_with_last_item(studio_, artwork_command(studio_, at_, edited_));
    }

    /// An entry of a list: shown while the pointer is on it, kept when it is picked.
    void offer(const Artwork& other,
               bool picked,
               const std::string& name,
               const std::string& meaning) {
        name_last_item("artwork:" + name);
        const bool over = ImGui::IsItemHovered();
        const std::string problem = over || picked ? wearing_problem(studio_, other) : "";
        tooltip(problem.empty() ? meaning : sentence(problem));
        if (other == before_) return;
        if (over && problem.empty()) try_out(studio_, artwork_command(studio_, at_, other));
        if (picked) set_artwork_at(studio_, at_, other);
    }
    void keep(const Artwork& other) { set_artwork_at(studio_, at_, other); }

  private:
    Studio& studio_;
    const Artwork before_;  ///< a copy: what is kept changes the list
    std::size_t at_;
    Artwork& edited_;
};

/// A row with a list; true while it is open.
bool begin_list(const char* label,
                const char* name,
                const std::string& shown,
                const std::string& meaning,
                int flags = 0) {
    row_label(label);
    ImGui::SetNextItemWidth(-1.0f);
    const bool open = ImGui::BeginCombo((std::string("##") + name).c_str(), shown.c_str(), flags);
    name_last_item(std::string("artwork:") + name);
    if (!open) tooltip(meaning);
    return open;
}

void draw_name(ArtworkRows& rows) {
    ArtworkPanelState& state = rows.studio().panels.of<ArtworkPanelState>();
    row_label("Name");
    if (!state.naming) state.name = rows.before().name;
    ImGui::InputTextWithHint("##name",
                             words_of(rows.before().shape).label.c_str(),
                             &state.name,
                             ImGuiInputTextFlags_AutoSelectAll);
    name_last_item("artwork:name");
    tooltip("What it is called in this list and in messages.");
    const bool gave_up = rows.studio().gave_up;
    if (ImGui::IsItemDeactivatedAfterEdit() && !gave_up) {
        Artwork named = rows.before();
        named.name = state.name;
        rows.keep(named);
    }
    state.naming = ImGui::IsItemActive();
}

void draw_part(ArtworkRows& rows) {
    const Artwork& before = rows.before();
    const auto shown = [](const std::string& part) { return part == "*" ? "All parts" : part; };
    if (!begin_list("Part", "part", shown(before.part), "What wears it: one part, or all.")) return;
    const auto offer = [&](const std::string& part, const std::string& meaning) {
        Artwork other = before;
        other.part = part;
        const bool picked = ImGui::Selectable(shown(part).c_str(), part == before.part);
        rows.offer(other, picked, "part:" + part, meaning);
    };
    offer("*", "It goes over every part that it meets.");
    for (const Part& part : rows.studio().product->mesh.parts) offer(part.name, "");
    ImGui::EndCombo();
}

void draw_shape(ArtworkRows& rows) {
    const Artwork& before = rows.before();
    const Words now = words_of(before.shape);
    if (!begin_list("Shape", "shape", now.label, now.meaning)) return;
    for (std::size_t i = 0; i < kArtworkShapes.size(); ++i) {
        const auto shape = static_cast<ArtworkShape>(i);
        const Words words = words_of(shape);
        const bool picture = shape == ArtworkShape::picture;
        const bool same = shape == before.shape;
        const bool picked =
            ImGui::Selectable((words.label + (picture && !same ? "…" : "")).c_str(), same);
        if (!picture || same) {
            rows.offer(with_shape(before, shape),
                       picked && !same,
                       std::string("shape:") + kArtworkShapes[i],
                       words.meaning);
            continue;
        }
        name_last_item(std::string("artwork:shape:") + kArtworkShapes[i]);
        tooltip(words.meaning);
        if (picked) rows.ask_for_file(with_shape(before, shape));
    }
    ImGui::EndCombo();
}

void draw_paint(ArtworkRows& rows) {
    Studio& studio = rows.studio();
    ArtworkPanelState& state = studio.panels.of<ArtworkPanelState>();
    const Artwork& before = rows.before();
    const Words use = words_of(before.use);
    std::string meaning = "What it is painted with.";
    if (before.shape == ArtworkShape::picture && before.use != PictureUse::cover) {
        meaning = fmt::format("The paint that \"{}\" changes.", use.label);
    }
    const std::string shown = before.paint.empty() ? kOwnPaint : before.paint;
    if (!begin_list("Paint", "paint", shown, meaning, ImGuiComboFlags_HeightLarge)) return;
    if (ImGui::IsWindowAppearing()) {
        state.search.clear();
        focus_next_field("##search");
    }
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::InputTextWithHint("##search", "Name, family or colour", &state.search);
    name_last_item("artwork:paint-search");
    Artwork other = before;
    other.paint.clear();
    const bool picked = swatch_row(studio, nullptr, kOwnPaint, before.paint.empty());
    rows.offer(other, picked, "paint:own", "The paint that the part wears below.");
    ImGui::Separator();
    draw_paint_list(
        studio, state.search, "artwork:paint", before.paint, [&](const Material& paint, bool one) {
            other.paint = paint.name;
            rows.offer(other, one, "paint:" + paint.name, paint.provenance);
        });
    ImGui::EndCombo();
}

void draw_picture(ArtworkRows& rows) {
    const Artwork& before = rows.before();
    const std::filesystem::path file(before.picture);
    row_label("File");
    const float width = ImGui::CalcItemWidth();
    const auto lines =
        fitted_lines(file.filename().string(), width - 2.0f * ImGui::GetStyle().FramePadding.x, 1);
    const std::string label = (lines.empty() ? "Choose…" : lines.front()) + "##file";
    if (ImGui::Button(label.c_str(), {width, 0.0f})) rows.ask_for_file(before);
    name_last_item("artwork:file");
    tooltip(before.picture + "\nClick to choose another: PNG, JPEG, TIFF or EXR.");
    const Words now = words_of(before.use);
    if (begin_list("Says", "use", now.label, now.meaning)) {
        for (std::size_t i = 0; i < kPictureUses.size(); ++i) {
            const Artwork other = with_use(before, static_cast<PictureUse>(i));
            const Words words = words_of(other.use);
            const bool picked = ImGui::Selectable(words.label.c_str(), other.use == before.use);
            rows.offer(other, picked, std::string("use:") + kPictureUses[i], words.meaning);
        }
        ImGui::EndCombo();
    }
    row_label("");
    Artwork other = before;
    if (ImGui::Checkbox("Again and again", &other.repeat)) rows.keep(other);
    name_last_item("artwork:repeat");
    tooltip("Repeats the picture in both directions.");
}

struct ProductFacts {
    double extent_mm = 0.0;
    bool has_uvs = false;  ///< texture coordinates that differ
};

/// Looked up once a product: a scan has a million points.
const ProductFacts& facts_of(const std::shared_ptr<const Product>& product) {
    static std::weak_ptr<const Product> known;
    static ProductFacts facts;
    if (known.lock() == product) return facts;
    known = product;
    const Bounds bounds = bounds_of(product->mesh);
    const auto& uvs = product->mesh.uvs;
    facts.extent_mm = glm::distance(bounds.low, bounds.high);
    facts.has_uvs =
        std::any_of(uvs.begin(), uvs.end(), [&](const glm::vec2& uv) { return uv != uvs.front(); });
    return facts;
}

void draw_measures(ArtworkRows& rows, Artwork& edited) {
    const ShapeFields fields = fields_of(edited.shape);
    const double extent = facts_of(rows.studio().product).extent_mm;
    if (fields.size && !edited.place.by_uv) {
        row_label(fields.picture ? "Width" : "Size");
        const double most = std::clamp(4.0 * extent, 100.0, 1e5);
        readable_slider("##size", edited.size_mm, 0.1, most, "mm", true);
        rows.after_item(
            "size",
            fmt::format(
                "{} From 0.1 mm to {:.4g} mm; Ctrl+click to type.", fields.size_meaning, most));
    }
    if (is_relief(edited)) {
        row_label("Depth");
        number_slider("##depth", edited.depth, -10.0, 10.0, "%.2f");
        rows.after_item("depth",
                        "How much steeper its slopes are than the picture says, from -10 to 10; "
                        "below 0 bumps are dents.");
    }
    if (fields.share) {
        row_label("Covered");
        double percent = 100.0 * edited.share;
        number_slider("##share", percent, 0.0, 100.0, "%.0f%%");
        if (last_item_is_held()) edited.share = percent / 100.0;
        rows.after_item("share",
                        edited.shape == ArtworkShape::dots
                            ? "A dot's diameter, of the way to the next."
                            : "How wide a stripe is, of the way to the next.");
    }
    if (fields.softness) {
        row_label("Soft edge");
        const double most = std::clamp(extent, 10.0, 1e5);
        if (edited.softness_mm <= 0.0) {
            ratio_slider("##softness", edited.softness_mm, 0.0, most, "sharp");
        } else {
            readable_slider("##softness", edited.softness_mm, 0.0, most, "mm", true);
        }
        rows.after_item("softness", "How wide the change from one paint to the other is.");
    }
}

/// A product file that cannot be read any more was told when the session opened.
std::string front_of(const Studio& studio) {
    try {
        return front_of_product(studio.session.document().product);
    } catch (const FileError&) {
        return "";
    }
}

void draw_sides(ArtworkRows& rows) {
    const Artwork& before = rows.before();
    const auto now = side_of(before.place);
    const auto sides = named_sides(front_of(rows.studio()));
    for (const NamedSide& side : sides) {
        if (&side != &sides.front()) place_in_row(button_width(side.label));
        Artwork other = before;
        other.place = from_side(before.place, side.side);
        const bool same = now == side.side;
        const bool picked = chip(side.label, same);
        rows.offer(
            same ? before : other, picked && !same, std::string("side:") + side.name, side.meaning);
    }
}

void draw_direction(ArtworkRows& rows, ArtworkPlace& place) {
    Angles angles = angles_of(place);
    row_label("Azimuth");
    number_slider("##azimuth", angles.azimuth_deg, -180.0, 180.0, "%.1f°");
    if (last_item_is_held()) place = from_angles(place, angles);
    rows.after_item("azimuth",
                    "From where it is projected, as the lights have it: 0° is behind the product "
                    "(-z), 90° on its right (+x).");
    row_label("Elevation");
    // Straight above and below the azimuth would be lost.
    angles.elevation_deg = std::clamp(angles.elevation_deg, -89.9, 89.9);
    number_slider("##elevation", angles.elevation_deg, -89.9, 89.9, "%.1f°");
    if (last_item_is_held()) place = from_angles(place, angles);
    rows.after_item("elevation", "0° is from the horizon, 90° from straight above.");
    row_label("Turn");
    double turn = turn_deg_of(place);
    number_slider("##turn", turn, -180.0, 180.0, "%.1f°");
    if (last_item_is_held()) place = with_turn(place, turn);
    rows.after_item("turn", "Counter-clockwise, as it is seen from there; 0° is upright.");
}

void draw_place_button(ArtworkRows& rows) {
    Studio& studio = rows.studio();
    ArtworkPanelState& state = studio.panels.of<ArtworkPanelState>();
    const float width = ImGui::GetContentRegionAvail().x;
    if (toggle_button("Place it by a click", state.placing, width)) {
        const bool wanted = !state.placing;
        stop_placing(studio);
        state.placing = wanted;
        // The other two views show no surface that could be clicked.
        if (wanted && studio.view != StageView::eye) studio.view = StageView::preview;
    }
    name_last_item("artwork:place");
    tooltip(
        "It follows the pointer over the product; a click leaves it there, facing the surface. "
        "Esc takes it back.");
}

void draw_place(ArtworkRows& rows, Artwork& edited) {
    const Artwork& before = rows.before();
    heading("Place");
    if (before.shape == ArtworkShape::picture) {
        Artwork other = before;
        const bool possible = before.place.by_uv || facts_of(rows.studio().product).has_uvs;
        begin_disabled(!possible);
        if (ImGui::Checkbox("Along the texture coordinates", &other.place.by_uv)) rows.keep(other);
        name_last_item("artwork:by-uv");
        tooltip(possible ? "Where the product's file has unwrapped its surface: the picture fills "
                           "u and v from 0 to 1."
                         : "The product's file has no texture coordinates.");
        end_disabled();
        if (before.place.by_uv) return;
    }
    draw_place_button(rows);
    draw_sides(rows);
    draw_direction(rows, edited.place);
    vector_row(
        "x, y, z (mm)",
        "artwork:centre",
        edited.place.centre_mm,
        std::max(1e-3f, 0.002f * static_cast<float>(facts_of(rows.studio().product).extent_mm)),
        nullptr,
        "Its middle, in the product's frame: y is up. Drag, or Ctrl+click to type.",
        [&] { rows.after_item(); });
    row_label("");
    Artwork other = before;
    if (ImGui::Checkbox("On both sides", &other.place.through)) rows.keep(other);
    name_last_item("artwork:through");
    tooltip("Surfaces that face away wear it as well: the other side of the product.");
}

}  // namespace

void draw_artwork_fields(Studio& studio, std::size_t at) {
    ArtworkPanelState& state = studio.panels.of<ArtworkPanelState>();
    Artwork& edited = state.held.start(shown_artwork(studio)[at]);
    ArtworkRows rows(studio, at, edited);
    draw_name(rows);
    if (const std::string why = why_not_seen(studio, at); !why.empty()) {
        warning_text(why);
        name_last_item("artwork:not-seen");
    }
    draw_part(rows);
    draw_shape(rows);
    if (!is_relief(rows.before())) draw_paint(rows);
    if (rows.before().shape == ArtworkShape::picture) draw_picture(rows);
    draw_measures(rows, edited);
    draw_place(rows, edited);
    state.held.finish();
}

}  // namespace livery
