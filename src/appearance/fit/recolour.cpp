#include "appearance/fit/recolour.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "appearance/bsdf.h"
#include "appearance/directions.h"
#include "appearance/model_table.h"
#include "appearance/paint_figures.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/spectrum.h"

namespace livery {

namespace {

constexpr const char* kBegin = " [colour asked for: ";

std::string lab_text(const glm::dvec3& lab) {
    return fmt::format("lab:{:.1f},{:.1f},{:.1f}", lab.x, lab.y, lab.z);
}

}  // namespace

std::string text_of(const ColourRecord& record) {
    return fmt::format("{}{}; came out: {}; CIEDE2000 {:.2f}]",
                       kBegin,
                       lab_text(record.asked_lab10),
                       lab_text(record.came_lab10),
                       record.de00);
}

std::optional<ColourRecord> colour_record(const std::string& provenance) {
    const auto begin = provenance.rfind(kBegin);
    if (begin == std::string::npos) return std::nullopt;
    ColourRecord record;
    glm::dvec3 &asked = record.asked_lab10, &came = record.came_lab10;
    int length = 0;
    const int read = std::sscanf(
        provenance.c_str() + begin,
        " [colour asked for: lab:%lf,%lf,%lf; came out: lab:%lf,%lf,%lf; CIEDE2000 %lf]%n",
        &asked.x,
        &asked.y,
        &asked.z,
        &came.x,
        &came.y,
        &came.z,
        &record.de00,
        &length);
    const bool whole =
        read == 7 && begin + static_cast<std::size_t>(length) == provenance.size() && length > 0;
    return whole ? std::optional(record) : std::nullopt;
}

std::string without_colour_record(const std::string& provenance) {
    if (!colour_record(provenance)) return provenance;
    return provenance.substr(0, provenance.rfind(kBegin));
}

namespace {

/// Above it a Fresnel reflectance is a metal's or a flake's, with a colour of its own; below, a
/// binder's.
constexpr double kBinderReflectance = 0.12;
/// What a channel without pigment starts from.
constexpr double kTrace = 1e-4;
constexpr double kLargestTint = 1e5;
constexpr int kSweeps = 6, kHalvings = 60;

using Parameters = f64::BsdfParameters;

/// The parameters that give a paint its colour.
std::vector<const ParameterInfo*> pigments_of(const ModelInfo& model, Parameters p) {
    std::vector<const ParameterInfo*> pigments;
    for (const char* name : model.parameters) {
        const ParameterInfo& info = parameter_info(name);
        if (info.kind != ParameterKind::colour || info.name == std::string("coat_transmittance")) {
            continue;
        }
        const auto numbers = info.in_f64(p);
        const double largest = std::max({*numbers[0], *numbers[1], *numbers[2]});
        const bool own_colour =
            name == std::string("diffuse") || model.has("coat_f0") || largest > kBinderReflectance;
        if (own_colour) pigments.push_back(&info);
    }
    return pigments;
}

/// A finish with one factor a channel on all of its pigments.
class Tinted {
  public:
    explicit Tinted(const Material& finish)
        : model_(model_info(finish.model)),
          start_(parameters_of_f64(finish)),
          pigments_(pigments_of(model_, start_)) {}

    const std::vector<const ParameterInfo*>& pigments() const { return pigments_; }
    Parameters with(const glm::dvec3& tint) const {
        Parameters p = start_;
        for (const ParameterInfo* info : pigments_) {
            const auto numbers = info->in_f64(p);
            const double floor = info->name == std::string("diffuse") ? kTrace : 0.0;
            for (int c = 0; c < 3; ++c) {
                double& value = *numbers[static_cast<std::size_t>(c)];
                value = std::clamp(tint[c] * std::max(value, floor), 0.0, 1.0);
            }
        }
        return p;
    }
    /// Straight above the panel in light at 45 degrees: share of a white diffuser's, working space.
    glm::dvec3 face(const glm::dvec3& tint) const {
        const glm::dvec3 wi = direction_from_angles(0.25 * std::numbers::pi, 0.0);
        return std::numbers::pi * model_.f64.eval(with(tint), wi, {0.0, 0.0, 1.0});
    }

  private:
    const ModelInfo& model_;
    Parameters start_;
    std::vector<const ParameterInfo*> pigments_;
};

/// The tint under which each channel is lightest at 45 degrees. Not the strongest: flakes that
/// throw back everything near the mirror direction leave nothing to the pigment below.
glm::dvec3 lightest_tint(const Tinted& paint) {
    constexpr int kSteps = 240;
    glm::dvec3 best_tint(1.0), best(-1.0);
    for (int k = 0; k <= kSteps; ++k) {
        const double tint = std::pow(kLargestTint, 2.0 * k / kSteps - 1.0);
        const glm::dvec3 face = paint.face(glm::dvec3(tint));
        for (int c = 0; c < 3; ++c) {
            if (face[c] <= best[c]) continue;
            best[c] = face[c];
            best_tint[c] = tint;
        }
    }
    return best_tint;
}

/// Each channel by itself, several times over, for the interface's share couples them.
glm::dvec3 tint_for(const Tinted& paint, const glm::dvec3& lightest, const glm::dvec3& wanted) {
    glm::dvec3 tint(1.0);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (int c = 0; c < 3; ++c) {
            double low = -std::log(kLargestTint), high = std::log(lightest[c]);
            for (int k = 0; k < kHalvings; ++k) {
                const double middle = 0.5 * (low + high);
                tint[c] = std::exp(middle);
                (paint.face(tint)[c] < wanted[c] ? low : high) = middle;
            }
        }
    }
    return tint;
}

Material material_with(Material material, const Tinted& paint, const glm::dvec3& tint) {
    Parameters p = paint.with(tint);
    for (const ParameterInfo* info : paint.pigments()) {
        const auto from = info->in_f64(p);
        const glm::dvec3 rec709 = rec709_from_working() * glm::dvec3(*from[0], *from[1], *from[2]);
        const auto to = info->in_material(material);
        for (int c = 0; c < 3; ++c) *to[static_cast<std::size_t>(c)] = rec709[c];
    }
    return material;
}

std::string why_not(const Tinted& paint,
                    const glm::dvec3& lightest_tint,
                    const glm::dvec3& wanted,
                    const std::string& finish) {
    const glm::dvec3 lightest = paint.face(lightest_tint);
    const glm::dvec3 darkest = paint.face(glm::dvec3(1.0 / kLargestTint));
    const auto is_beyond = [&](const auto& outside) {
        return outside(0) || outside(1) || outside(2);
    };
    if (is_beyond([&](int c) { return wanted[c] > lightest[c]; })) {
        return fmt::format(
            "too light for the finish of '{}', which reaches L* {:.1f} at 45 degrees",
            finish,
            lab10_from_xyz10(xyz10_from_xyz(xyz_from_working() * lightest)).x);
    }
    if (is_beyond([&](int c) { return wanted[c] < 0.0; })) {
        return "more saturated than any surface that Livery can compute with";
    }
    return fmt::format(
        "too dark or too saturated for the finish of '{}', which throws back L* "
        "{:.1f} at 45 degrees without any pigment",
        finish,
        lab10_from_xyz10(xyz10_from_xyz(xyz_from_working() * darkest)).x);
}

}  // namespace

Recoloured with_colour(const Material& finish, glm::dvec3 lab10) {
    check_argument(std::isfinite(lab10.x + lab10.y + lab10.z),
                   "with_colour: the colour is not a finite number");
    check_argument(finish.model != ReflectanceModel::measured,
                   fmt::format("'{}' is measured reflectance: it has no colour to change; fit a "
                               "model to it, and change that",
                               finish.name));
    check_argument(finish.model != ReflectanceModel::translucent,
                   fmt::format("'{}' is translucent: its colour follows from its medium; change "
                               "sigma_a_per_mm in its file",
                               finish.name));
    const Tinted paint(finish);
    const glm::dvec3 wanted = working_from_xyz() * xyz_from_xyz10(xyz10_from_lab10(lab10));
    Recoloured result;
    const glm::dvec3 lightest = lightest_tint(paint);
    result.material = material_with(finish, paint, tint_for(paint, lightest, wanted));
    result.material.file.clear();
    const glm::dvec3 came = five_angle_lab(result.material)[kFaceAngle];
    result.de00 = ciede2000(lab10, came);
    result.material.provenance = fmt::format("designed: the finish of '{}'", finish.name) +
                                 text_of(ColourRecord{lab10, came, result.de00});
    result.reached = result.de00 <= kColourReached;
    if (!result.reached) result.why_not = why_not(paint, lightest, wanted, finish.name);
    return result;
}

Material with_model(const Material& paint, ReflectanceModel model) {
    Material changed = paint;
    changed.model = model;
    const auto has_colour = [](ReflectanceModel one) {
        return one != ReflectanceModel::measured && one != ReflectanceModel::translucent;
    };
    if (!has_colour(paint.model) || !has_colour(model)) return changed;
    const auto asked = colour_record(paint.provenance);
    Material made =
        with_colour(changed, asked ? asked->asked_lab10 : five_angle_lab(paint)[kFaceAngle])
            .material;
    if (!asked) made.provenance = paint.provenance;
    return made;
}

}  // namespace livery
