// Normalised diffusion (Christensen and Burley 2015): two exponentials whose integral is the
// albedo.
#pragma once

namespace livery {

/// For a beam along the normal: A (e^{-r/d} + e^{-r/3d})/(8 pi d r), d = (mean free path)/s, with
/// s = 1.85 - A + 7 |A - .8|^3. Fitted without a step of the index at the boundary.
struct NormalizedDiffusion {
    NormalizedDiffusion(double total_reflectance, double mean_free_path_mm);

    double at(double radius_mm) const;  ///< per mm^2, above 0
    double total() const { return albedo; }
    /// Share within the radius.
    double cumulative(double radius_mm) const;

    double albedo, d_mm;
};

}  // namespace livery
