#include "appearance/paint_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include "appearance/directions.h"
#include "appearance/model_table.h"
#include "appearance/paint_bsdf.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/mutation.h"
#include "core/quadrature.h"
#include "core/spectrum.h"

namespace livery {

namespace {

/// Full widths in the plane of incidence and across it.
struct Aperture {
    double along_deg, across_deg;
};
constexpr Aperture kSource{0.75, 2.5};

Aperture receptor_at(double angle_deg) {
    if (angle_deg == 20.0) return {1.8, 3.6};
    if (angle_deg == 60.0) return {4.4, 11.7};
    if (angle_deg == 85.0) return {4.0, 6.0};
    throw std::invalid_argument(
        fmt::format("specular_gloss: {} degrees, expected 20, 60 or 85", angle_deg));
}

/// A rectangle of directions around an axis in the plane of incidence, by its tangents.
class ApertureWindow {
  public:
    ApertureWindow(double angle_rad, Aperture aperture)
        : axis_(std::sin(angle_rad), 0.0, std::cos(angle_rad)),
          along_(std::cos(angle_rad), 0.0, -std::sin(angle_rad)),
          half_(std::tan(0.5 * glm::radians(aperture.along_deg)),
                std::tan(0.5 * glm::radians(aperture.across_deg))) {}

    const glm::dvec2& half() const { return half_; }
    glm::dvec3 direction(const glm::dvec2& at) const {
        return glm::normalize(axis_ + at.x * along_ + glm::dvec3(0.0, at.y, 0.0));
    }
    glm::dvec2 tangents(const glm::dvec3& direction) const {
        return glm::dvec2(glm::dot(direction, along_), direction.y) / glm::dot(direction, axis_);
    }
    /// Solid angle for an area of tangents.
    static double solid_angle(const glm::dvec2& at) {
        return std::pow(1.0 + glm::dot(at, at), -1.5);
    }

  private:
    glm::dvec3 axis_, along_;
    glm::dvec2 half_;
};

/// What the receptor takes of the light from wi: triangles from the mirror direction to each edge,
/// with points ever denser toward that corner and toward the edge's nearest point, so that lobes
/// much narrower and much wider than the window are met alike. Lobes are 1 / cosine times as long
/// as wide; the window is squeezed until they are round.
double received(const LuminanceFunction& luminance,
                const ApertureWindow& receptor,
                const glm::dvec3& wi) {
    static const std::vector<QuadratureNode> along_edge = gauss_legendre(10),
                                             outward = gauss_legendre(24);
    constexpr double kNearest = 1e-4;
    const double steps = std::log1p(1.0 / kNearest);
    const glm::dvec2 squeeze(wi.z, 1.0);
    const glm::dvec2 mirror = receptor.tangents({-wi.x, -wi.y, wi.z});
    const glm::dvec2 half = receptor.half();
    const std::array<glm::dvec2, 5> corners{
        {{-half.x, -half.y}, {half.x, -half.y}, {half.x, half.y}, {-half.x, half.y}, -half}};
    double sum = 0.0;
    for (std::size_t edge = 0; edge < 4; ++edge) {
        const glm::dvec2 a = squeeze * (corners[edge] - mirror);
        const glm::dvec2 b = squeeze * (corners[edge + 1] - mirror);
        const glm::dvec2 along = glm::normalize(b - a);
        const glm::dvec2 foot = a - glm::dot(a, along) * along;
        const double distance = glm::length(foot);
        const double from = std::asinh(glm::dot(a, along) / distance);
        const double to = std::asinh(glm::dot(b, along) / distance);
        for (const QuadratureNode& t : along_edge) {
            const double v = from + t.at * (to - from);
            const glm::dvec2 far = foot + distance * std::sinh(v) * along;
            const double base = t.weight * (to - from) * distance * std::cosh(v);
            for (const QuadratureNode& s : outward) {
                const double reach = kNearest * std::expm1(steps * s.at);
                const glm::dvec2 at = mirror + reach * far / squeeze;
                const glm::dvec3 wo = receptor.direction(at);
                if (!(wo.z > 0.0)) continue;
                const double area = s.weight * steps * (reach + kNearest) * reach * distance *
                                    base / (squeeze.x * squeeze.y);
                sum += area * ApertureWindow::solid_angle(at) * wo.z * luminance(wi, wo);
            }
        }
    }
    return sum;
}

}  // namespace

double dielectric_reflectance(double cosine, double index) {
    const double sine2 = (1.0 - cosine * cosine) / (index * index);
    if (sine2 >= 1.0) return 1.0;
    const double inside = std::sqrt(1.0 - sine2);
    const double s = (cosine - index * inside) / (cosine + index * inside);
    const double p = (inside - index * cosine) / (inside + index * cosine);
    return 0.5 * (s * s + p * p);
}

double fresnel_over_schlick(double f0, double cosine) {
    const double root = std::sqrt(std::clamp(f0, 0.0, 0.9999));
    const double grazing = std::min(50.0 * f0, 1.0);  // as shaders/bsdf/microfacet.glsl has it
    const double schlick = f0 + (grazing - f0) * std::pow(1.0 - cosine, 5.0);
    return schlick > 0.0 ? dielectric_reflectance(cosine, (1.0 + root) / (1.0 - root)) / schlick
                         : 1.0;
}

double specular_gloss(const LuminanceFunction& luminance, double angle_deg) {
    static const std::vector<QuadratureNode> over_source = gauss_legendre(3);
    const ApertureWindow receptor(-glm::radians(angle_deg), receptor_at(angle_deg));
    const ApertureWindow source(glm::radians(angle_deg), kSource);
    double paint = 0.0, standard = 0.0;
    for (const QuadratureNode& x : over_source) {
        for (const QuadratureNode& y : over_source) {
            const glm::dvec2 at = (2.0 * glm::dvec2(x.at, y.at) - 1.0) * source.half();
            const glm::dvec3 wi = source.direction(at);
            if (!(wi.z > 0.0)) continue;
            // Both sides of the plane are alike: one of them counts twice.
            if (at.y < -1e-12) continue;
            const double sides = at.y > 1e-12 ? 2.0 : 1.0;
            const double light =
                sides * x.weight * y.weight * ApertureWindow::solid_angle(at) * wi.z;
            paint += light * received(luminance, receptor, wi);
            standard += light * dielectric_reflectance(wi.z, kGlossStandardIndex);
        }
    }
    return LIVERY_MUTATED(gloss, 100.0 * paint / standard);
}

namespace {

/// Light at 45 degrees and the eye at each of the five angles.
std::array<DirectionPair, kAspecularAngles_deg.size()> five_pairs() {
    std::array<DirectionPair, kAspecularAngles_deg.size()> pairs;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        pairs[k].wi = direction_from_angles(glm::radians(45.0), 0.0);
        const double eye_rad = glm::radians(kAspecularAngles_deg[k] - 45.0);
        pairs[k].wo = {std::sin(eye_rad), 0.0, std::cos(eye_rad)};
    }
    return pairs;
}

FiveAngleLab lab_of_spectra(const MeasuredReflectance& measured) {
    FiveAngleLab lab;
    const auto pairs = five_pairs();
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        Spectrum reflectance = spectrum_from_samples(
            measured.samples.wavelengths_nm, evaluate_spectrum(measured, pairs[k].wi, pairs[k].wo));
        for (double& value : reflectance) value *= std::numbers::pi;
        lab[k] = lab10_from_xyz10(xyz10_from_reflectance(reflectance));
    }
    return lab;
}

/// Models whose interface has Schlick's Fresnel term, as they were published.
bool has_schlick(ReflectanceModel model) {
    return model == ReflectanceModel::cook_torrance ||
           model == ReflectanceModel::cook_torrance_v_cavity ||
           model == ReflectanceModel::ashikhmin_shirley;
}

/// The paint with nothing but its interface.
f64::BsdfParameters interface_alone(const ModelInfo& model, f64::BsdfParameters p) {
    for (const char* name : model.parameters) {
        const ParameterInfo& info = parameter_info(name);
        if (info.kind != ParameterKind::colour || std::string(name) == "f0") continue;
        for (double* number : info.in_f64(p)) *number = 0.0;
    }
    return p;
}

}  // namespace

FiveAngleLab five_angle_lab(const Material& material) {
    if (material.model == ReflectanceModel::measured) {
        check_argument(material.measured != nullptr,
                       fmt::format("paint '{}' is measured, but by no file", material.name));
        // The grid that is drawn has no wavelengths.
        if (const auto measured = read_measured_file(material.measured->file);
            measured.is_spectral()) {
            return lab_of_spectra(measured);
        }
    }
    const ReflectanceFunction value = reflectance_of(material);
    FiveAngleLab lab;
    const auto pairs = five_pairs();
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const glm::dvec3 xyz =
            xyz_from_working() * (std::numbers::pi * value(pairs[k].wi, pairs[k].wo));
        lab[k] = lab10_from_xyz10(xyz10_from_xyz(xyz));
    }
    return lab;
}

std::optional<double> flop_index(const FiveAngleLab& lab) {
    const double face = lab[kFaceAngle].x;
    if (!(face >= 1.0)) return std::nullopt;
    const double fall = std::max(0.0, lab.front().x - lab.back().x);
    return 2.69 * std::pow(fall, 1.11) / std::pow(face, 0.86);
}

double specular_gloss(const Material& material, double angle_deg) {
    const PaintBsdf drawn = bsdf_of(material);
    if (drawn.measured) {
        return specular_gloss(
            [&](const glm::dvec3& wi, const glm::dvec3& wo) {
                return luminance_of_working(evaluate(drawn, glm::vec3(wi), glm::vec3(wo)));
            },
            angle_deg);
    }
    const ModelInfo& model = model_info(material.model);
    const f64::BsdfParameters p = parameters_of_f64(material);
    const bool schlick = has_schlick(material.model);
    const f64::BsdfParameters alone = schlick ? interface_alone(model, p) : p;
    const double f0 = std::clamp(luminance_of_working(p.f0), 0.0, 1.0);
    const auto whole = model.f64.bound(p), mirrored = model.f64.bound(alone);
    return specular_gloss(
        [&](const glm::dvec3& wi, const glm::dvec3& wo) {
            double value = luminance_of_working(whole->eval(wi, wo));
            if (schlick && f0 > 0.0) {
                const double cosine = glm::dot(wi, glm::normalize(wi + wo));
                value += luminance_of_working(mirrored->eval(wi, wo)) *
                         (fresnel_over_schlick(f0, cosine) - 1.0);
            }
            return value;
        },
        angle_deg);
}

PaintFigures paint_figures(const Material& material) {
    PaintFigures figures;
    figures.lab = five_angle_lab(material);
    figures.flop = flop_index(figures.lab);
    figures.gloss_20 = specular_gloss(material, 20.0);
    figures.gloss_60 = specular_gloss(material, 60.0);
    return figures;
}

}  // namespace livery
