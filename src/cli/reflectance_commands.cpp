// livery brdf
// livery albedo
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "appearance/material_library.h"
#include "appearance/measured/measured_grid.h"
#include "appearance/measured/measured_paint.h"
#include "cli/command.h"
#include "core/colour.h"
#include "core/paths.h"
#include "ledger/reflectance_values.h"

namespace livery {

namespace {

struct ReflectanceArguments {
    std::string material, precision = "f64";
    bool round_inputs = false;
};

/// A paint, or a measured one by its file.
using AnyReflectance = std::variant<Material, MeasuredReflectance>;

AnyReflectance find_reflectance(const std::string& name_or_file) {
    if (is_measured_file(name_or_file)) return read_measured_file(name_or_file);
    Material material = find_material(name_or_file);
    if (is_measured(material)) return read_measured_file(material.measured->file);
    return material;
}

/// The paint's name, or the file's.
std::string name_of(const AnyReflectance& reflectance) {
    if (const auto* material = std::get_if<Material>(&reflectance)) return material->name;
    return std::get<MeasuredReflectance>(reflectance).file.filename().string();
}

/// What about the measurement limits the answer, for a person and for scripts: format, samples,
/// masked, and of the grid what it loses. Nothing for a paint.
void tell_measurement(const AnyReflectance& reflectance,
                      const ReflectanceSettings& settings,
                      Outcome& outcome) {
    const auto* measured = std::get_if<MeasuredReflectance>(&reflectance);
    if (!measured) return;
    const MeasuredCoverage coverage = coverage_of(*measured);
    const auto degrees = [](double rad) { return rad * 180.0 / std::numbers::pi; };
    Json json = {{"format", name_of(measured->format)},
                 {"samples", coverage.samples},
                 {"masked", coverage.masked},
                 {"largest_theta_i", coverage.largest_theta_i},
                 {"largest_theta_o", coverage.largest_theta_o},
                 {"covered_fraction", coverage.fraction}};
    outcome.text += fmt::format(
        "measured: {}, {} of them ({} left out as negative), theta_i to {:.1f} and theta_o to "
        "{:.1f} "
        "degrees, {:.0f}% of all pairs of directions; beyond, the nearest is taken\n",
        name_of(measured->format),
        coverage.samples,
        coverage.masked,
        degrees(coverage.largest_theta_i),
        degrees(coverage.largest_theta_o),
        100.0 * coverage.fraction);
    if (settings.precision != Precision::f64) {
        const ReflectanceDifference lost = resampling_error(resampled(*measured), *measured);
        json["resampling"] = {{"relative_median", lost.relative_median},
                              {"relative_p95", lost.relative_p95},
                              {"de00_mean", lost.de00_mean},
                              {"de00_p95", lost.de00_p95}};
        outcome.text += fmt::format(
            "the grid that is drawn: off by {:.2f}% (median) and {:.2f}% (95%), CIEDE2000 on a lit "
            "sphere {:.2f} (mean) and {:.2f} (95%)\n",
            100.0 * lost.relative_median,
            100.0 * lost.relative_p95,
            lost.de00_mean,
            lost.de00_p95);
    }
    outcome.figures["measured"] = json;
}

std::vector<Option> reflectance_options(ReflectanceArguments& arguments) {
    return {
        {"--material",
         "FILE|NAME",
         "material file, measured file, or a paint of the library by its name",
         &arguments.material,
         true},
        {"--precision",
         "KIND",
         "f32 or f64 on the processor, gpu in OpenGL (default f64)",
         &arguments.precision,
         false,
         {"f32", "f64", "gpu"}},
        {"--round-inputs",
         "",
         "round directions and parameters to float for f64 too, as the others do",
         &arguments.round_inputs},
    };
}

ReflectanceSettings reflectance_settings(const ReflectanceArguments& arguments,
                                         const CommonOptions& common) {
    ReflectanceSettings settings;
    settings.precision = arguments.precision == "f32"   ? Precision::f32
                         : arguments.precision == "gpu" ? Precision::gpu
                                                        : Precision::f64;
    settings.gl = common.gl_device();
    settings.round_inputs = arguments.round_inputs;
    return settings;
}

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
          true},
         {"--out",
          "FILE",
          "CSV with the columns r,g,b: linear signed Rec.709 under D65",
          &arguments->out,
          true},
         {"--spectral",
          "",
          "one column a wavelength in nm instead: measured spectra alone, in f64",
          &arguments->spectral}});
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
                               &arguments->mu});
    command.options.push_back({"--phi",
                               "RAD",
                               "azimuth from the tangent, for brushed paints (default 0)",
                               &arguments->phi_rad});
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
