// How far each model's profile is from Monte Carlo's, medium by medium.
#pragma once

#include <string>
#include <vector>

#include "appearance/subsurface/monte_carlo.h"
#include "appearance/subsurface/subsurface_profile.h"

namespace livery {

struct ModelError {
    SubsurfaceModel model = SubsurfaceModel::dipole;
    /// Sum of |model - Monte Carlo| times area over the sum of Monte Carlo times area, both
    /// averaged over rings that reach from the beam to where next to nothing is left.
    double reflectance_l1 = 0.0, transmittance_l1 = 0.0;
    double reflectance_bias = 0.0;  ///< of the total, by the exact one
    double rms_ln = 0.0;            ///< of the logarithm, from 1 to 10 mean free paths
    bool was_negative = false;
};

struct MediumErrors {
    std::string name;
    bool is_slab = false;
    double noise_l1 = 0.0;  ///< what of each L1 Monte Carlo's own standard errors amount to
    std::vector<ModelError> models;
};

struct NamedStack {
    std::string name;
    ScatteringStack stack;
};
/// Layers of all kinds, of which the other table there speaks.
const std::vector<NamedStack>& compared_stacks();

MediumErrors model_errors(const NamedStack& stack,
                          const MonteCarloSettings& settings,
                          const Progress& progress = {});

struct NamedMedium {
    std::string name;
    ScatteringMedium medium;
};
/// Media of all kinds of which the table in docs/subsurface.md speaks.
const std::vector<NamedMedium>& compared_media();

MediumErrors model_errors(const NamedMedium& medium,
                          const MonteCarloSettings& settings,
                          const Progress& progress = {});

/// A Markdown table.
std::string markdown_of(const std::vector<MediumErrors>& media);

}  // namespace livery
