// The swatch of a translucent paint: a disc of it lit from behind, thin on its left and thick on
// its right.
#pragma once

#include "appearance/material.h"
#include "core/image.h"

namespace livery {

inline constexpr double kThinnestWedge_mm = 0.5, kThickestWedge_mm = 30.0;  ///< of the product

/// sRGB with coverage in a straight alpha, square. From left to right the thickness grows in equal
/// ratios; light of 1 comes from behind and of a third from the front, both even, and what a slab
/// as thick lets through and returns is exact (exact_totals.h). On the processor, some 0.1 s.
/// Throws std::invalid_argument for another paint.
Image8 translucent_swatch(const Material& translucent, int size_px);

}  // namespace livery
