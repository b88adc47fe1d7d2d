#include "cli/reflectance_options.h"

#include <numbers>

#include <fmt/format.h>

#include "appearance/material_library.h"
#include "appearance/measured/measured_grid.h"
#include "appearance/measured/measured_paint.h"

namespace livery {

AnyReflectance find_reflectance(const std::string& name_or_file) {
    if (is_measured_file(name_or_file)) return read_measured_file(name_or_file);
    Material material = find_material(name_or_file);
    if (material.model == ReflectanceModel::measured) {
        return read_measured_file(material.measured->file);
    }
    return material;
}

std::string name_of(const AnyReflectance& reflectance) {
    if (const auto* material = std::get_if<Material>(&reflectance)) return material->name;
    return std::get<MeasuredReflectance>(reflectance).file.filename().string();
}

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
         true,
         {}},
        {"--precision",
         "KIND",
         "f32 or f64 on the processor, gpu in OpenGL (default f64)",
         &arguments.precision,
         false,
         {"f32", "f64", "gpu"}},
        {"--round-inputs",
         "",
         "round directions and parameters to float for f64 too, as the others do",
         &arguments.round_inputs,
         false,
         {}},
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

}  // namespace livery
