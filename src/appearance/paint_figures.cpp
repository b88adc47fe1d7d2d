#include "appearance/paint_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "appearance/directions.h"
#include "appearance/gloss_optics.h"
#include "appearance/model_table.h"
#include "appearance/paint_bsdf.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/spectrum.h"
#include "core/ten_degree.h"

namespace livery {

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
