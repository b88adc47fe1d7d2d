// livery measure brdf

#include <memory>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "cli/command.h"
#include "cli/measured_captures.h"
#include "jobs/sphere_measurement.h"

namespace livery {

namespace {

Json figures_of(const SphereMeasurement& report) {
    const SphereReflectance& measured = report.reflectance;
    const Sphere& sphere = report.outline.sphere;
    const Sphere& manifest = report.manifest_sphere;
    return {{"coverage", measured.coverage},
            {"residual", measured.residual},
            {"residual_median", measured.residual_median},
            {"samples", report.samples},
            {"photographs", report.photographs},
            {"white_photographs", report.white_photographs},
            {"lamps", report.lamps},
            {"pixels", measured.pixels},
            {"saturated", measured.saturated},
            {"dark", measured.dark},
            {"sphere",
             {{"centre_mm", json_from(sphere.centre_mm)}, {"diameter_mm", sphere.diameter_mm}}},
            {"correction",
             {{"centre_mm", json_from(sphere.centre_mm - manifest.centre_mm)},
              {"diameter_mm", sphere.diameter_mm - manifest.diameter_mm}}},
            {"outline",
             {{"rms_px", report.outline.rms_px}, {"seen_fraction", report.outline.seen_fraction}}},
            {"white_rms", report.white_rms},
            {"lamp_spread", report.lamp_spread},
            {"camera_colours", report.camera_colours}};
}

std::string text_of(const SphereMeasurement& report, const std::string& out) {
    const SphereReflectance& measured = report.reflectance;
    const Sphere& sphere = report.outline.sphere;
    return fmt::format(
        "{} photographs under {} lamps, {} of white; camera colours: {}\n"
        "outline: seen over {:.0f}%, off by {:.2f} px; the centre moved by {:.2f} mm, the diameter "
        "is {:.2f} mm (the manifest: {:.2f})\n"
        "white sphere: {:.1f}% from a matte one\n"
        "{} pixels used; left out: {} saturated, {} too dark\n"
        "coverage {:.1f}% of the directions up to 80 degrees; several looks at the same differ by "
        "{:.1f}% (median), {:.1f}% (root mean square)\n"
        "wrote {} ({} samples)\n",
        report.photographs,
        report.lamps,
        report.white_photographs,
        report.camera_colours,
        100.0 * report.outline.seen_fraction,
        report.outline.rms_px,
        glm::distance(sphere.centre_mm, report.manifest_sphere.centre_mm),
        sphere.diameter_mm,
        report.manifest_sphere.diameter_mm,
        100.0 * report.white_rms,
        measured.pixels,
        measured.saturated,
        measured.dark,
        100.0 * measured.coverage,
        100.0 * measured.residual_median,
        100.0 * measured.residual,
        out,
        report.samples);
}

}  // namespace

Command measure_brdf_command() {
    struct Arguments {
        std::string captures, camera_to_xyz, out;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "measure brdf";
    command.summary =
        "photographs of a painted sphere, one light at a time -> measured reflectance";
    command.example = "livery measure brdf --captures sphere --out garnet.csv";
    command.options = {
        captures_option(&arguments->captures),
        camera_to_xyz_option(&arguments->camera_to_xyz),
        {"--out", "FILE", "measured reflectance, .csv", &arguments->out, true, {}},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        const SphereMeasurement report = measure_sphere(
            {arguments->captures, arguments->camera_to_xyz, arguments->out}, progress);
        Outcome outcome;
        outcome.figures = figures_of(report);
        outcome.figures["file"] = arguments->out;
        outcome.text = text_of(report, arguments->out);
        tell_notes(report.notes, outcome);
        return outcome;
    };
    return command;
}

}  // namespace livery
