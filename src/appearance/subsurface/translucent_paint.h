// A translucent material as a paint of a part: what it looks like where its light leaves at once.
#pragma once

#include <glm/vec3.hpp>

#include "appearance/material.h"
#include "appearance/subsurface/translucent_material.h"

namespace livery {

/// A paint of ReflectanceModel::translucent: the medium under a surface of that slope parameter,
/// smooth unless it is told otherwise.
Material translucent_paint(const TranslucentMaterial& medium, double alpha = kSmoothAlpha);

/// How much of the light that enters a half space of it leaves again, in linear Rec.709: exact
/// totals for light along the normal (exact_totals.h), worked out once for each medium.
glm::dvec3 entering_albedo(const TranslucentMaterial& medium);

/// What a person edits of a medium: one length, and a colour. The length is 1 over the mean of
/// sigma_t' over the channels, in mm; infinite where nothing is met.
double mean_free_path_mm(const TranslucentMaterial& medium);
/// All of the medium's lengths by one factor, so that that is `mm`: its colour stays. A clear one
/// stays as it is. Throws std::invalid_argument for a length that is not above 0.
TranslucentMaterial with_mean_free_path(TranslucentMaterial medium, double mm);
/// sigma_a and sigma_s' of each channel anew, their sum as it is (1 over the other channels' mean
/// path where it was 0), so that entering_albedo() is `albedo` within 1e-4. What no medium reaches
/// (1 and more, 0 and less) becomes the nearest that one does. Found by secants in the root of what
/// a scattering loses, in which the exact total is nearly exponential.
TranslucentMaterial with_entering_albedo(TranslucentMaterial medium, const glm::dvec3& albedo);

/// The reflectance of the boundary along the normal.
double boundary_f0(double eta);

/// An opaque paint (ReflectanceModel::ggx) that returns as much where the light arrives: the
/// boundary over a diffuse layer of entering_albedo(). Others as they are. Throws
/// std::invalid_argument for a translucent paint without its medium.
Material albedo_paint(Material paint);

/// What the medium is on a mock-up of which a millimetre is `product_scale` of the product's.
TranslucentMaterial on_mock_up(TranslucentMaterial medium, double product_scale);

}  // namespace livery
