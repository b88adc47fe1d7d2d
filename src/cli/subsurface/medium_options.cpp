#include "cli/subsurface/medium_options.h"

#include <fmt/format.h>

#include "appearance/subsurface/translucent_material.h"

namespace livery {

std::vector<Option> medium_options(MediumArguments& arguments) {
    return {
        {"--sigma-a", "A", "absorption, per mm", &arguments.sigma_a},
        {"--sigma-s", "S", "scattering, per mm", &arguments.sigma_s},
        {"--g",
         "G",
         "mean cosine of the phase function, above -1 and below 1 (default 0)",
         &arguments.g},
        {"--eta", "N", "index of refraction over that of air (default 1.5)", &arguments.eta},
        {"--thickness-mm",
         "D",
         "a slab of this thickness in air (default: without end)",
         &arguments.thickness_mm},
        {"--material",
         "FILE|NAME",
         "a translucent material in the place of the coefficients, as marble",
         &arguments.material},
        {"--channel",
         "NAME",
         "of the material: red, green or blue (default green)",
         &arguments.channel,
         false,
         {"red", "green", "blue"}},
    };
}

std::optional<double> parse_number(const std::string& option, const std::string& text) {
    if (text.empty()) return std::nullopt;
    return parse_numbers(option, text, 1)[0];
}

ScatteringMedium medium_from(const MediumArguments& arguments) {
    const auto sigma_a = parse_number("--sigma-a", arguments.sigma_a);
    const auto sigma_s = parse_number("--sigma-s", arguments.sigma_s);
    const auto g = parse_number("--g", arguments.g);
    const auto eta = parse_number("--eta", arguments.eta);
    const auto thickness = parse_number("--thickness-mm", arguments.thickness_mm);
    ScatteringMedium medium;
    if (!arguments.material.empty()) {
        check_argument(!sigma_a && !sigma_s && !g && !eta,
                       "--material: found beside --sigma-a, --sigma-s, --g or --eta, expected one "
                       "or the other");
        const int channel = arguments.channel == "red" ? 0 : arguments.channel == "green" ? 1 : 2;
        medium = medium_of(read_translucent_material(arguments.material), channel);
    } else {
        check_argument(sigma_a.has_value(), "--sigma-a: found none, expected it or --material");
        check_argument(sigma_s.has_value(), "--sigma-s: found none, expected it or --material");
        medium.sigma_a_per_mm = *sigma_a;
        medium.sigma_s_per_mm = *sigma_s;
        medium.g = g.value_or(0.0);
        medium.eta = eta.value_or(1.5);
    }
    if (thickness) medium.thickness_mm = thickness;
    try {
        check_medium(medium);
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("medium: " + std::string(error.what()));
    }
    return medium;
}

}  // namespace livery
