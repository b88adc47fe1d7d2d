// Light that scatters once, by a beam that enters along the normal and an exit past Fresnel's
// boundary. What a boundary throws back after the scattering counts as scattered more often.
#pragma once

#include "appearance/subsurface/exact_totals.h"

namespace livery {

/// Per mm^2 at the distance from the beam, above 0, and per unit power that enters:
///   sigma_s/r int e^{-sigma_t r (cot t + 1/sin t)} p(-cos t) cos t (1 - F) dt
/// over the angles t that get out of the boundary, and for a slab what the beam's mirror image at
/// the bottom adds.
double single_scattering_reflectance(const ScatteringMedium& medium, double radius_mm);
/// The same out of a slab's bottom; 0 for a half space.
double single_scattering_transmittance(const ScatteringMedium& medium, double radius_mm);
/// Both over the whole plane.
DiffuseTotals single_scattering_totals(const ScatteringMedium& medium);

/// The same of layers, each with its own phase function.
double single_scattering_reflectance(const ScatteringStack& stack, double radius_mm);
double single_scattering_transmittance(const ScatteringStack& stack, double radius_mm);
DiffuseTotals single_scattering_totals(const ScatteringStack& stack);

}  // namespace livery
