// The figures by which people who make paint know it: colour at five angles, flop, gloss; with a
// glossmeter's optics.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include <glm/vec3.hpp>

#include "appearance/material.h"

namespace livery {

/// Of polished black glass, the standard's 100.
inline constexpr double kGlossStandardIndex = 1.567;

/// Share of unpolarised light that a smooth interface of that index throws back (Fresnel).
double dielectric_reflectance(double cosine, double index);

/// By how much the interface of an index whose reflectance along the normal is `f0` throws back
/// more than Schlick's approximation says, at the cosine between light and half vector.
double fresnel_over_schlick(double f0, double cosine);

/// The eye's angles from the mirror direction toward the light, in the plane of light and normal;
/// light falls in at 45 degrees (ASTM E2194).
inline constexpr std::array kAspecularAngles_deg{15.0, 25.0, 45.0, 75.0, 110.0};
/// L*a*b* at each of them, D65 and 10 degree observer; a white diffuser has 100, 0, 0.
using FiveAngleLab = std::array<glm::dvec3, kAspecularAngles_deg.size()>;
/// Where the face colour stands in it: 45 degrees, straight above the panel.
inline constexpr std::size_t kFaceAngle = 2;

/// Of a formula from its working space values (core/spectrum.h), of measured spectra by
/// integration of what the file holds. With a grain the light comes along it. Throws FileError when
/// a measured paint's file has gone.
FiveAngleLab five_angle_lab(const Material& material);

/// How much lighter the paint is near the mirror direction than away from it (Alman's index):
/// 0 a solid paint, 15 and more a strong effect. None where it is black at 45 degrees.
std::optional<double> flop_index(const FiveAngleLab& lab);

/// Luminance per steradian for light from wi, seen from wo, both above the horizon.
using LuminanceFunction = std::function<double(const glm::dvec3& wi, const glm::dvec3& wo)>;

/// What a glossmeter at that angle from the normal reads, with the apertures of ASTM D523 and ISO
/// 2813: 100 for polished black glass of index 1.567. Throws std::invalid_argument for angles other
/// than 20, 60 and 85 degrees.
double specular_gloss(const LuminanceFunction& luminance, double angle_deg);

/// The same of a paint. Cook-Torrance's and Ashikhmin-Shirley's interfaces have Schlick's Fresnel
/// term, which gives index 1.5 at 60 degrees only 0.07 instead of 0.089; a glossmeter meets the
/// real one, so their lobes count by Fresnel's equations for the index that f0 stands for.
double specular_gloss(const Material& material, double angle_deg);

struct PaintFigures {
    FiveAngleLab lab{};
    std::optional<double> flop;
    double gloss_20 = 0.0, gloss_60 = 0.0;
};
PaintFigures paint_figures(const Material& material);

}  // namespace livery
