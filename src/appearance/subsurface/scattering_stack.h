// Translucent layers upon one another, with one index of refraction over all of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "appearance/subsurface/scattering_medium.h"

namespace livery {

/// From the top, where the light enters. All but the last have a thickness. Air lies outside;
/// inside nothing mirrors, since the indices are the same.
struct ScatteringStack {
    std::vector<ScatteringMedium> layers;

    double eta() const { return layers.front().eta; }
    /// The last layer ends.
    bool is_slab() const { return layers.back().thickness_mm.has_value(); }
    /// Some layer scatters.
    bool scatters() const;
    /// Of light that goes straight through all layers: sigma_t times the thickness, summed;
    /// infinite for a half space that meets anything.
    double depth() const;
    /// The shortest of all layers; infinite where nothing is met.
    double mean_free_path_mm() const;
};

/// Throws std::invalid_argument: no layers or more than 100, a layer that check_medium() refuses
/// (by its number from 1), one without a thickness that is not the last, different indices.
void check_stack(const ScatteringStack& stack);

/// Neighbours of equal coefficients as one layer.
ScatteringStack merged(const ScatteringStack& stack);

UnscatteredLight unscattered_light(const ScatteringStack& stack);
double least_radius_mm(const ScatteringStack& stack);

/// A file as docs/files.md describes it. Throws FileError (missing, malformed, a field unknown or
/// out of range, a stack that check_stack() refuses).
ScatteringStack read_scattering_stack(const std::filesystem::path& file);
ScatteringStack parse_scattering_stack(const std::string& text, const std::filesystem::path& file);

}  // namespace livery
