// Photons through a translucent medium: what the models of its profile are compared with.
#pragma once

#include <cstdint>
#include <vector>

#include "appearance/subsurface/scattering_stack.h"
#include "core/progress.h"

namespace livery {

/// Mean of the batches and its standard error.
struct Estimate {
    double value = 0.0, standard_error = 0.0;
};

struct MonteCarloSettings {
    std::uint64_t photons = 1'000'000;
    std::uint64_t seed = 1;
};

/// From `inner_mm` up to `outer_mm` of the beam.
struct ProfileRing {
    double inner_mm = 0.0, outer_mm = 0.0;
};
/// Within 2% of the radius; the disc of the medium's least radius for one within it.
ProfileRing ring_around(const ScatteringMedium& medium, double radius_mm);
ProfileRing ring_around(const ScatteringStack& stack, double radius_mm);

/// Per unit power that enters along the normal at a point. Totals of light that scattered;
/// reflected + transmitted + absorbed and what never scattered add up to 1 within rounding.
struct MonteCarloProfile {
    std::vector<Estimate> rd, rt;  ///< mean over each ring, per mm^2
    Estimate total_reflectance, total_transmittance, absorbed;
    double unscattered_reflectance = 0.0, unscattered_transmittance = 0.0;
    std::uint64_t photons = 0;
};

/// A random walk with weights (as MCML: Wang, Jacques and Zheng 1995): Henyey and Greenstein's
/// phase function, Fresnel's boundaries that split a photon. Rings are scored by what each flight
/// would let out (expected values). The same for the same seed on any number of threads. A photon
/// is dropped as absorbed at a weight of 1e-6, and after 50 000 scatterings shared out by
/// diffusion. Throws std::invalid_argument (medium, rings, under 64 photons), Cancelled.
MonteCarloProfile monte_carlo_profile(const ScatteringMedium& medium,
                                      const std::vector<ProfileRing>& rings,
                                      const MonteCarloSettings& settings,
                                      const Progress& progress = {});
/// The same in layers. What flies off into an endless clear layer counts as absorbed.
MonteCarloProfile monte_carlo_profile(const ScatteringStack& stack,
                                      const std::vector<ProfileRing>& rings,
                                      const MonteCarloSettings& settings,
                                      const Progress& progress = {});

}  // namespace livery
