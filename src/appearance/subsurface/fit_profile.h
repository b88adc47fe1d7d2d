// Scattering parameters found for a measured profile.
#pragma once

#include <string>
#include <vector>

#include "appearance/subsurface/radial_profile.h"
#include "appearance/subsurface/subsurface_profile.h"
#include "core/progress.h"

namespace livery {

/// What is known of the sample beforehand.
struct ProfileFitOptions {
    SubsurfaceModel model = SubsurfaceModel::scaled_beam_diffusion;
    double eta = 1.5;
    double g = 0.0;  ///< stated: no profile tells it beyond a mean free path
    std::optional<double> thickness_mm;
    /// Diameter of the spot that was projected, of the disc that holds half of it; 0: not known.
    double spot_mm = 0.0;
};

struct FittedParameter {
    double value = 0.0;
    double relative_standard_error = 0.0;
};

struct ProfileFit {
    FittedParameter sigma_a_per_mm, sigma_s_prime_per_mm;
    double correlation = 0.0;  ///< of the two, of their logarithms
    double g = 0.0, eta = 1.5;
    /// Root of the mean square of ln(model/measured) over the window.
    double error = 0.0;
    /// The same of ln(model/best model) for the medium found: what the choice of the model costs.
    double model_error = 0.0;
    double from_mm = 0.0, to_mm = 0.0;  ///< the window
    std::size_t used = 0, not_positive = 0;
    double half_energy_radius_mm = 0.0;
    /// What the profile tells only badly, for a person.
    std::vector<std::string> warnings;

    ScatteringMedium medium(std::optional<double> thickness_mm) const;
};

/// Throws Refused for a spot wider than a third of the radius that holds half the light.
void refuse_wide_spot(double spot_mm, double half_energy_radius_mm);

/// Least squares of the logarithm, each sample by the share of ln r that it stands for (so that it
/// does not matter how densely far radii were sampled), over a window that follows the parameters:
/// from 1.5 mean free paths (1 for sources along the beam) to 3/sigma_tr, at least five further.
/// The profile must be absolute: per unit power that enters. Throws std::invalid_argument (options
/// out of range), Refused (too few samples in the window, a spot wider than a third of the radius
/// that holds half the light, parameters that the profile does not tell, a model that does not
/// fit), Cancelled.
ProfileFit fit_profile(const std::vector<ProfileSample>& samples,
                       const ProfileFitOptions& options,
                       const Progress& progress = {});

}  // namespace livery
