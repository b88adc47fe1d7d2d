#include "studio/paint/paint_rows.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "appearance/bsdf.h"
#include "appearance/measured/measured_paint.h"
#include "appearance/model_table.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/error.h"
#include "scene/effects.h"
#include "studio/paint/paint_panel.h"
#include "studio/users_library.h"

namespace livery {

namespace {

constexpr const char* kWays =
    "The colour under light from 45 degrees, seen from straight above: #b01020, rgb(176, 16, 32), "
    "a name as in CSS (tomato), lab:45,30,-20 or xyz:20.1,15.2,5 (D65, 10 degrees; white has "
    "Y = 100).";

/// Worked out once for each paint and colour.
const Recoloured& recoloured(PaintColourState& state, const Material& paint, glm::dvec3 lab10) {
    std::vector<double> key = reflectance_numbers(paint);
    key.insert(key.end(), {lab10.x, lab10.y, lab10.z});
    if (!state.made || key != state.made_of) {
        state.made = with_colour(paint, lab10);
        state.made->material.name = paint.name;
        state.made_of = std::move(key);
    }
    return *state.made;
}

EditPaint edit_of(const Studio& studio, const Recoloured& made) {
    const PaintPanelState& panel = studio.panels.of<PaintPanelState>();
    return {panel.look, panel.part_name, made.material};
}

void draw_typed(Studio& studio, const Material& paint) {
    PaintColourState& state = studio.panels.of<PaintPanelState>().colour;
    row_label("Colour at 45°");
    const glm::dvec3 face = drawn_face_lab(paint);
    const std::string its_own = fmt::format("lab:{:.1f},{:.1f},{:.1f}", face.x, face.y, face.z);
    if (!state.typing) state.text = its_own;
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::InputText("##colour", &state.text, ImGuiInputTextFlags_AutoSelectAll);
    name_last_item("paint-colour");
    tooltip(kWays);
    const bool edited = ImGui::IsItemDeactivatedAfterEdit();
    state.typing = ImGui::IsItemActive();
    state.edited = (state.typing && state.edited) || ImGui::IsItemEdited();
    // What was put back is no edit, though the text is rounded.
    if ((!(state.typing && state.edited) && !edited) || state.text == its_own) return;
    const auto lab = colour_in(state.text);
    if (!lab) {
        if (edited) {
            tell_warning(studio,
                         fmt::format("\"{}\" is no colour.", state.text),
                         "",
                         "Type one as #b01020, rgb(176, 16, 32), tomato, lab:45,30,-20 or "
                         "xyz:20.1,15.2,5.");
        }
        return;
    }
    const Recoloured& made = recoloured(state, paint, *lab);
    edit_with_last_item(studio, edit_of(studio, made));
    if (!made.reached) warning_text(made.why_not);
}

std::string short_lab_text(const glm::dvec3& lab) {
    return fmt::format("{:.0f}, {:.0f}, {:.0f}", lab.x, lab.y, lab.z);
}

/// As long as the paint is what came of it: a colour that was missed is not forgotten.
void draw_asked_for(const Material& paint) {
    const auto asked = colour_record(paint.provenance);
    if (!asked) return;
    if (asked->de00 <= kColourReached) {
        dim_text(fmt::format("Asked for L*a*b* {}: CIEDE2000 {:.1f} from it.",
                             short_lab_text(asked->asked_lab10),
                             asked->de00));
    } else {
        warning_text(fmt::format(
            "Not the colour that was asked for: L*a*b* {} became {}, CIEDE2000 {:.1f} from it. "
            "This finish comes no nearer.",
            short_lab_text(asked->asked_lab10),
            short_lab_text(asked->came_lab10),
            asked->de00));
    }
    name_last_item("paint-colour-asked");
}

void ask_for_chips(Studio& studio) {
    studio.file_dialog->ask(
        {FileQuestion::Kind::open,
         "Read colour chips",
         "Read",
         {".csv"},
         false,
         {},
         [&studio](const auto& file) {
             PaintColourState& state = studio.panels.of<PaintPanelState>().colour;
             try {
                 state.chips = read_colour_chips(file);
                 state.chips_file = file.filename().string();
             } catch (const FileError& error) {
                 tell_error(studio,
                            "The colour chips were not read.",
                            error.what(),
                            "A chip has a name, and L, a, b or X, Y, Z or hex.");
             }
         }});
}

void draw_chips(Studio& studio, const Material& paint) {
    PaintColourState& state = studio.panels.of<PaintPanelState>().colour;
    row_label("Colour chips");
    ImGui::SetNextItemWidth(-1.0f);
    const std::string shown = state.chips.empty()
                                  ? "none read"
                                  : fmt::format("{} in {}", state.chips.size(), state.chips_file);
    const bool open = ImGui::BeginCombo("##chips", shown.c_str(), ImGuiComboFlags_HeightLarge);
    name_last_item("paint-chips");
    if (!open) {
        tooltip(
            "Gives this finish a colour of your own chart: a CSV with the column name, and "
            "L, a, b or X, Y, Z or hex.");
        return;
    }
    if (named(ImGui::Selectable("Read a file…"), "chip:file")) ask_for_chips(studio);
    ImGui::Separator();
    for (const ColourChip& chip : state.chips) {
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const float side = ImGui::GetTextLineHeight();
        const bool picked = ImGui::Selectable(("      " + chip.name + "##" + chip.name).c_str());
        name_last_item("chip:" + chip.name);
        ImGui::GetWindowDrawList()->AddRectFilled(
            corner, {corner.x + side, corner.y + side}, screen_colour(chip.lab10));
        if (!ImGui::IsItemHovered() && !picked) continue;
        const Recoloured& made = recoloured(state, paint, chip.lab10);
        tooltip(made.reached ? fmt::format("CIEDE2000 {:.2f} from the chip", made.de00)
                             : made.why_not);
        if (picked) {
            commit(studio, edit_of(studio, made));
        } else {
            try_out(studio, edit_of(studio, made));
        }
    }
    ImGui::EndCombo();
}

}  // namespace

void draw_paint_colour_row(Studio& studio, const Material& paint) {
    if (is_measured(paint) || is_translucent(paint)) return;  // their colour is no parameter
    draw_typed(studio, paint);
    if (!studio.panels.of<PaintPanelState>().colour.typing) draw_asked_for(paint);
    draw_chips(studio, paint);
}

namespace {

constexpr double kShortest_mm = 0.01, kLongest_mm = 100.0;
constexpr double kThickestSheet_mm = 20.0;
/// What a typed coefficient may be, per mm.
constexpr double kMost_per_mm = 1000.0;

/// The medium while its rows are drawn: every control hands over what it made of it.
struct MediumEdit {
    Material& edited;
    const MediumRowCalls& calls;
    TranslucentMaterial medium = *edited.medium;

    void after_item(const std::string& name) {
        const glm::dvec3 none(0.0), most(kMost_per_mm);
        medium.sigma_a_per_mm = glm::clamp(medium.sigma_a_per_mm, none, most);
        medium.sigma_s_prime_per_mm = glm::clamp(medium.sigma_s_prime_per_mm, none, most);
        if (!same_medium(medium, *edited.medium)) {
            edited.medium = std::make_shared<const TranslucentMaterial>(medium);
        }
        calls.after_item(name);
    }
};

void draw_length(MediumEdit& edit) {
    const double before = mean_free_path_mm(edit.medium);
    if (!std::isfinite(before)) return;
    edit.calls.label("Mean free path",
                     "How far light goes in it, on the product, before it is turned or absorbed: "
                     "long is clear and soft, short is like paint. The colour stays. Drag, or "
                     "Ctrl+click to type.");
    double path = before;
    readable_slider("##mean-free-path", path, kShortest_mm, kLongest_mm, "mm", true);
    if (path != before && path > 0.0) edit.medium = with_mean_free_path(edit.medium, path);
    edit.after_item("mean-free-path");
}

void draw_colour(MediumEdit& edit) {
    const glm::dvec3 before = entering_albedo(edit.medium);
    edit.calls.label("Albedo colour",
                     "How much of the light that enters comes out again. How far each colour goes "
                     "in it follows: what is absorbed less goes farther. The three numbers are "
                     "linear Rec.709: drag, or Ctrl+click to type.");
    glm::dvec3 colour = before;
    colour_control("param:albedo", colour);
    if (colour != before) {
        const TranslucentMaterial made = with_entering_albedo(edit.medium, colour);
        // What was not touched keeps its coefficients to the last digit
        for (int c = 0; c < 3; ++c) {
            if (colour[c] == before[c]) continue;
            edit.medium.sigma_a_per_mm[c] = made.sigma_a_per_mm[c];
            edit.medium.sigma_s_prime_per_mm[c] = made.sigma_s_prime_per_mm[c];
        }
    }
    edit.after_item("albedo");
}

void draw_thickness(MediumEdit& edit) {
    edit.calls.label("Sheet thickness",
                     "How thick a part is, on the product, of which the mesh has one side alone: "
                     "light comes through it from behind. 0 is deep. A closed part is as thick as "
                     "its mesh. Drag, or Ctrl+click to type.");
    const double before = edit.medium.thickness_mm.value_or(0.0);
    double mm = before;
    readable_slider("##sheet-thickness", mm, 0.0, kThickestSheet_mm, "mm", false);
    if (mm != before) edit.medium.thickness_mm = mm > 0.0 ? std::optional(mm) : std::nullopt;
    edit.after_item("sheet-thickness");
}

void draw_coefficients(MediumEdit& edit) {
    const bool open = ImGui::TreeNode("Coefficients");
    name_last_item("medium:coefficients");
    tooltip("Absorption and scattering of each channel, per millimetre of the product.");
    if (!open) return;
    const auto after = [&] { edit.after_item(""); };
    vector_row("Absorption /mm",
               "param:sigma-a",
               edit.medium.sigma_a_per_mm,
               0.001f,
               "%.4g",
               "sigma_a per mm, in red, green and blue: 0 gives all light back.",
               after);
    vector_row("Scattering /mm",
               "param:sigma-s",
               edit.medium.sigma_s_prime_per_mm,
               0.01f,
               "%.4g",
               "sigma_s' = sigma_s (1 - g) per mm, in red, green and blue.",
               after);
    edit.calls.label(
        "Forward share",
        "g, the mean cosine of a scattering; sigma_s' stays. Hardly seen beyond a mean "
        "free path. Drag, or Ctrl+click to type.");
    readable_slider("##g", edit.medium.g, -0.9, 0.9, "", false);
    edit.after_item("g");
    edit.calls.label("Index",
                     "eta, of refraction: the higher, the more the surface mirrors and keeps "
                     "inside. Drag, or Ctrl+click to type.");
    readable_slider("##eta", edit.medium.eta, 1.0, 2.5, "", false);
    edit.after_item("eta");
    ImGui::TreePop();
}

}  // namespace

std::string reach_in_words(const Material& translucent, double product_scale) {
    const double reach = subsurface_reach_mm(translucent, product_scale);
    if (!(reach > 0.0)) return "Nothing in it scatters: no light comes back.";
    std::string text =
        fmt::format("Nine tenths of the light leave within {:.2g} mm on the mock-up", reach);
    if (reach <= kUnseenReach_mm) text += ": drawn as an opaque paint of that colour";
    return text + ".";
}

void draw_medium_rows(Material& edited, double product_scale, const MediumRowCalls& calls) {
    MediumEdit edit{edited, calls};
    draw_length(edit);
    draw_colour(edit);
    draw_thickness(edit);
    dim_text(reach_in_words(edited, product_scale));
    name_last_item("medium:reach");
    draw_coefficients(edit);
}

namespace {

/// Below 0 lies what sRGB cannot show.
std::string numbers(const glm::dvec3& colour) {
    return fmt::format("{} {} {}",
                       readable_number(std::max(colour.x, 0.0)),
                       readable_number(std::max(colour.y, 0.0)),
                       readable_number(std::max(colour.z, 0.0)));
}

}  // namespace

std::string unit_of(const ParameterInfo& parameter) {
    return std::string_view(parameter.name).ends_with("_nm") ? "nm" : "";
}

std::string summary_of(const Material& material) {
    const ModelInfo& model = model_info(material.model);
    std::string text = model.label;
    if (is_measured(material) && material.measured) {
        text += "\n" + material.measured->file.filename().string();
    }
    for (const char* name : model.parameters) {
        const ParameterInfo& parameter = parameter_info(name);
        const glm::dvec3 value = value_of(parameter, material);
        if (value == value_of(parameter, Material{})) continue;
        const std::string unit = unit_of(parameter);
        std::string shown = readable_number(value.x) + (unit.empty() ? "" : " " + unit);
        if (parameter.kind == ParameterKind::colour) shown = numbers(value);
        if (parameter.kind == ParameterKind::pair && model.anisotropic && value.x != value.y) {
            shown = fmt::format(
                "{} along, {} across", readable_number(value.x), readable_number(value.y));
        }
        text += fmt::format("\n{} {}", parameter.label, shown);
    }
    if (has_glints(material)) text += "\nGlints " + glint_scale_text(material);
    return text;
}

std::optional<std::string> paint_problem(const Material& material) {
    try {
        parameters_of_f64(material);
    } catch (const std::invalid_argument& mistake) {
        return mistake.what();
    }
    return std::nullopt;
}

const Material* library_origin(const std::string& name, const PaintLibrary& library) {
    const auto last = name.find_last_not_of("0123456789");
    if (last == std::string::npos || last + 1 == name.size() || name[last] != ' ') return nullptr;
    return library.find(name.substr(0, last));
}

}  // namespace livery
