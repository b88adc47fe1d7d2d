// livery brdf

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/reflectance_options.h"
#include "core/colour.h"
#include "core/paths.h"

namespace livery {

namespace {

struct BrdfTable {
    fmt::memory_buffer text;
    std::size_t invalid = 0;  ///< rows that are no reflectance
};

BrdfTable colours_of(const AnyReflectance& reflectance,
                     std::span<const DirectionPair> pairs,
                     const ReflectanceSettings& settings,
                     const Progress& progress) {
    const auto values = std::visit(
        [&](const auto& any) { return reflectance_values(any, pairs, settings, progress); },
        reflectance);
    // A saturated measured colour lies outside the working space too.
    const bool measured = std::holds_alternative<MeasuredReflectance>(reflectance);
    BrdfTable table;
    fmt::format_to(std::back_inserter(table.text), "r,g,b\n");
    for (const glm::dvec3& working : values) {
        const bool finite =
            std::isfinite(working.x) && std::isfinite(working.y) && std::isfinite(working.z);
        const double lowest = measured ? (xyz_from_working() * working).y
                                       : std::min({working.x, working.y, working.z});
        if (!finite || lowest < 0.0) ++table.invalid;
        const glm::dvec3 rgb = rec709_from_working() * working;
        fmt::format_to(std::back_inserter(table.text), "{},{},{}\n", rgb.x, rgb.y, rgb.z);
    }
    return table;
}

BrdfTable spectra_of(const AnyReflectance& reflectance,
                     std::span<const DirectionPair> pairs,
                     const ReflectanceSettings& settings,
                     const Progress& progress) {
    const auto* measured = std::get_if<MeasuredReflectance>(&reflectance);
    if (!measured || !measured->is_spectral()) {
        throw std::invalid_argument(fmt::format(
            "--spectral: {} has colours and no wavelengths, expected a measured file with a "
            "column a wavelength",
            name_of(reflectance)));
    }
    if (settings.precision != Precision::f64) {
        throw std::invalid_argument("--spectral: expected --precision f64; shaders know colours");
    }
    BrdfTable table;
    const auto out = std::back_inserter(table.text);
    fmt::format_to(out, "{}\n", fmt::join(measured->samples.wavelengths_nm, ","));
    for (const DirectionPair& pair : pairs) {
        progress.check_stop();
        const auto spectrum = evaluate_spectrum(*measured, pair.wi, pair.wo);
        const bool valid = std::all_of(spectrum.begin(), spectrum.end(), [](double value) {
            return std::isfinite(value) && value >= 0.0;
        });
        if (!valid) ++table.invalid;
        fmt::format_to(out, "{}\n", fmt::join(spectrum, ","));
    }
    return table;
}

}  // namespace

Command brdf_command() {
    struct Arguments : ReflectanceArguments {
        std::string in, out;
        bool spectral = false;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "brdf";
    command.summary = "reflectance of a paint for given directions, per steradian, no cosine";
    command.example = "livery brdf --material \"solid red\" --in dirs.csv --out values.csv";
    command.options = reflectance_options(*arguments);
    command.options.insert(
        command.options.begin() + 1,
        {{"--in",
          "FILE",
          "CSV with the columns theta_i,phi_i,theta_o,phi_o in radians",
          &arguments->in,
          true,
          {}},
         {"--out",
          "FILE",
          "CSV with the columns r,g,b: linear signed Rec.709 under D65",
          &arguments->out,
          true,
          {}},
         {"--spectral",
          "",
          "one column a wavelength in nm instead: measured spectra alone, in f64",
          &arguments->spectral,
          false,
          {}}});
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        const AnyReflectance reflectance = find_reflectance(arguments->material);
        const auto settings = reflectance_settings(*arguments, common);
        const auto pairs = read_directions_csv(arguments->in);
        const BrdfTable table = arguments->spectral
                                    ? spectra_of(reflectance, pairs, settings, progress)
                                    : colours_of(reflectance, pairs, settings, progress);
        progress.check_stop();
        write_text_file(arguments->out, {table.text.data(), table.text.size()});
        Outcome outcome;
        outcome.figures = {{"count", pairs.size()},
                           {"invalid", table.invalid},
                           {"material", name_of(reflectance)},
                           {"precision", arguments->precision},
                           {"space", arguments->spectral ? "spectral" : "linear Rec.709, D65"},
                           {"file", arguments->out}};
        outcome.text = fmt::format("{}: {} values, {} of them not finite or negative; wrote {}\n",
                                   name_of(reflectance),
                                   pairs.size(),
                                   table.invalid,
                                   arguments->out);
        tell_measurement(reflectance, settings, outcome);
        if (const auto* measured = std::get_if<MeasuredReflectance>(&reflectance)) {
            outcome.figures["unmeasured"] =
                std::count_if(pairs.begin(), pairs.end(), [&](const DirectionPair& pair) {
                    return pair.wi.z > 0.0 && pair.wo.z > 0.0 &&
                           !is_measured(*measured, pair.wi, pair.wo);
                });
        }
        return outcome;
    };
    return command;
}

}  // namespace livery
