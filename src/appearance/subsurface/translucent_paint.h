// A translucent material as a paint of a part: what it looks like where its light leaves at once.
#pragma once

#include <glm/vec3.hpp>

#include "appearance/material.h"
#include "appearance/subsurface/translucent_material.h"

namespace livery {

/// A paint of ReflectanceModel::translucent: the medium under a surface of that slope parameter,
/// smooth unless it is told otherwise.
inline constexpr double kSmoothAlpha = 0.02;
Material translucent_paint(const TranslucentMaterial& medium, double alpha = kSmoothAlpha);

/// How much of the light that enters a half space of it leaves again, in linear Rec.709: exact
/// totals for light along the normal (exact_totals.h), worked out once for each medium.
glm::dvec3 entering_albedo(const TranslucentMaterial& medium);

/// The reflectance of the boundary along the normal.
double boundary_f0(double eta);

/// An opaque paint (ReflectanceModel::ggx) that returns as much where the light arrives: the
/// boundary over a diffuse layer of entering_albedo(). Others as they are. Throws
/// std::invalid_argument for a translucent paint without its medium.
Material albedo_paint(Material paint);

/// What the medium is on a mock-up of which a millimetre is `product_scale` of the product's.
TranslucentMaterial on_mock_up(TranslucentMaterial medium, double product_scale);

}  // namespace livery
