// A scattering medium as options: by its coefficients, or by a material and one of its channels.
#pragma once

#include <string>
#include <vector>

#include "appearance/subsurface/scattering_medium.h"
#include "cli/command.h"

namespace livery {

/// As they were typed; empty: not given.
struct MediumArguments {
    std::string sigma_a, sigma_s, g, eta, thickness_mm, material, channel = "green";
};

std::vector<Option> medium_options(MediumArguments& arguments);
/// Throws std::invalid_argument that names the option, and FileError.
ScatteringMedium medium_from(const MediumArguments& arguments);

/// A single number of an option, or nothing for an empty text.
std::optional<double> parse_number(const std::string& option, const std::string& text);

}  // namespace livery
