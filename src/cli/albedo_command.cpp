// livery albedo

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "cli/reflectance_options.h"
#include "core/colour.h"

namespace livery {

namespace {

std::vector<double> parse_mus(const std::string& text) {
    const auto mus = parse_numbers("--mu", text, 0);
    for (const double mu : mus) {
        if (!(mu > 0.0 && mu <= 1.0)) {
            throw std::invalid_argument(
                fmt::format("--mu: found {}, expected cosines to the normal, above 0 up to 1", mu));
        }
    }
    return mus;
}

/// JSON has no word for what is not finite.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json numbers(const glm::dvec3& v) { return {number(v.x), number(v.y), number(v.z)}; }

}  // namespace

Command albedo_command() {
    struct Arguments : ReflectanceArguments {
        std::string mu = "0.05,0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9,1";
        double phi_rad = 0.0;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "albedo";
    command.summary = "share of uniform light that a paint sends along a direction (white furnace)";
    command.example = "livery albedo --material \"solid red\" --mu 0.1,0.5,1";
    command.options = reflectance_options(*arguments);
    command.options.push_back({"--mu",
                               "M1,M2,...",
                               "cosines to the normal, above 0 up to 1 (default 0.05,0.1,0.2,...1)",
                               &arguments->mu,
                               false,
                               {}});
    command.options.push_back({"--phi",
                               "RAD",
                               "azimuth from the tangent, for brushed paints (default 0)",
                               &arguments->phi_rad,
                               false,
                               {}});
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        const auto mus = parse_mus(arguments->mu);
        const AnyReflectance reflectance = find_reflectance(arguments->material);
        const auto settings = reflectance_settings(*arguments, common);
        std::vector<glm::dvec3> directions;
        for (const double mu : mus) {
            const double sine = std::sqrt((1.0 - mu) * (1.0 + mu));
            directions.emplace_back(
                sine * std::cos(arguments->phi_rad), sine * std::sin(arguments->phi_rad), mu);
        }
        const auto albedos = std::visit(
            [&](const auto& any) { return albedo_values(any, directions, settings, progress); },
            reflectance);
        Outcome outcome;
        Json rec709 = Json::array(), working = Json::array();
        double largest = 0.0;
        outcome.text = name_of(reflectance) + ", linear Rec.709:\n";
        for (std::size_t k = 0; k < mus.size(); ++k) {
            const glm::dvec3 value = rec709_from_working() * albedos[k];
            rec709.push_back(numbers(value));
            working.push_back(numbers(albedos[k]));
            largest = std::max({largest, albedos[k].x, albedos[k].y, albedos[k].z});
            outcome.text +=
                fmt::format("  mu {:<8} {:.6f} {:.6f} {:.6f}\n", mus[k], value.x, value.y, value.z);
        }
        outcome.text += fmt::format("largest in the working space: {:.6f}\n", largest);
        outcome.figures = {{"mu", mus},
                           {"albedo", rec709},
                           {"albedo_working", working},
                           {"largest_working", number(largest)},
                           {"phi", arguments->phi_rad},
                           {"material", name_of(reflectance)},
                           {"precision", arguments->precision},
                           {"space", "linear Rec.709, D65"}};
        tell_measurement(reflectance, settings, outcome);
        return outcome;
    };
    return command;
}

}  // namespace livery
