#include "studio/paint/translucent_rows.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <imgui.h>

#include "appearance/subsurface/translucent_paint.h"
#include "scene/subsurface_reach.h"
#include "studio/kit/theme.h"
#include "studio/kit/widgets.h"
#include "studio/studio.h"

namespace livery {

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

}  // namespace livery
