// livery measure environment

#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/measured_captures.h"
#include "core/angles.h"
#include "jobs/environment/environment_measurement.h"

namespace livery {

namespace {

Json figures_of(const EnvironmentView& view) {
    Json figures = {{"photographs", view.photographs},
                    {"covered_share", view.coverage.covered},
                    {"coarse_share", view.coverage.coarse}};
    if (view.ball) {
        figures["sphere"] = {{"centre_mm", json_from(view.ball->centre_mm)},
                             {"diameter_mm", view.ball->diameter_mm}};
        figures["hidden_deg"] = kDegreesPerRadian * view.hidden_rad;
    }
    if (view.outline) {
        figures["outline"] = {{"rms_px", view.outline->rms_px},
                              {"seen_fraction", view.outline->seen_fraction}};
    }
    if (view.correction_mm) figures["correction_mm"] = *view.correction_mm;
    return figures;
}

Json figures_of(const EnvironmentMeasurement& report) {
    Json views = Json::array(), clipped = Json::array();
    for (const EnvironmentView& view : report.views) views.push_back(figures_of(view));
    for (const ClippedLamp& lamp : report.clipped) {
        clipped.push_back({{"direction", json_from(lamp.direction)},
                           {"solid_angle_sr", lamp.solid_angle_sr},
                           {"luminance_at_least", lamp.luminance},
                           {"irradiance_share_at_least", lamp.irradiance_share},
                           {"texels", lamp.texels}});
    }
    Json figures = {{"size", {report.map.radiance.width, report.map.radiance.height}},
                    {"covered_share", report.coverage.covered},
                    {"coarse_share", report.coverage.coarse},
                    {"filled_share", report.filled},
                    {"dynamic_range_stops", report.dynamic_range_stops},
                    {"saturated_directions", report.saturated_texels},
                    {"clipped", clipped},
                    {"scale", report.scale},
                    {"mean_luminance", report.mean_luminance},
                    {"camera_colours", report.camera_colours},
                    {"views", views}};
    if (report.views.front().ball) {
        figures["ball_reflectance"] = json_from(report.reflectance);
    } else {
        figures["marks_residual_deg"] = kDegreesPerRadian * report.marks_residual_rad;
    }
    return figures;
}

std::string text_of(const EnvironmentMeasurement& report, const std::string& out) {
    std::string text;
    for (std::size_t k = 0; k < report.views.size(); ++k) {
        const EnvironmentView& view = report.views[k];
        text += fmt::format("view {}: {} photographs", k + 1, view.photographs);
        if (view.ball) {
            text += fmt::format("; a ball of {:.1f} mm at {:.1f},{:.1f},{:.1f}",
                                view.ball->diameter_mm,
                                view.ball->centre_mm.x,
                                view.ball->centre_mm.y,
                                view.ball->centre_mm.z);
        }
        if (view.outline) {
            text += fmt::format("; outline: seen over {:.0f}%, off by {:.2f} px",
                                100.0 * view.outline->seen_fraction,
                                view.outline->rms_px);
        }
        text += fmt::format("; covers {:.1f}% of all directions\n", 100.0 * view.coverage.covered);
    }
    return text + fmt::format(
                      "covered {:.1f}% of all directions, {:.1f}% coarsely, {:.1f}% filled from "
                      "their surroundings\n"
                      "{:.1f} stops between dark and bright; {} clipped texels in {} lights; "
                      "camera colours: {}\n"
                      "wrote {} ({}x{}; a file unit a second is {:.4g})\n",
                      100.0 * report.coverage.covered,
                      100.0 * report.coverage.coarse,
                      100.0 * report.filled,
                      report.dynamic_range_stops,
                      report.saturated_texels,
                      report.clipped.size(),
                      report.camera_colours,
                      out,
                      report.map.radiance.width,
                      report.map.radiance.height,
                      report.scale);
}

struct Arguments {
    std::string captures, camera_to_xyz, out, mask, reflectance;
    int width = 1024;
    double scale = 0.0;
};

EnvironmentRequest request_of(const Arguments& arguments) {
    EnvironmentRequest request;
    request.captures = arguments.captures;
    request.camera_to_xyz = arguments.camera_to_xyz;
    request.out = arguments.out;
    request.mask = arguments.mask;
    request.width = arguments.width;
    if (arguments.scale != 0.0) request.scale = arguments.scale;
    if (!arguments.reflectance.empty()) {
        const auto rgb = parse_numbers("--ball-reflectance", arguments.reflectance, 3);
        request.reflectance = glm::dvec3(rgb[0], rgb[1], rgb[2]);
    }
    return request;
}

}  // namespace

Command measure_environment_command() {
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "measure environment";
    command.summary = "photographs of a mirror ball or a panorama -> a map of the light all around";
    command.example = "livery measure environment --captures ball --out room.exr";
    command.options = {
        captures_option(&arguments->captures),
        {"--ball-reflectance",
         "R,G,B",
         "the ball's, at normal incidence (default: as the manifest says, else 1,1,1)",
         &arguments->reflectance,
         false,
         {}},
        camera_to_xyz_option(&arguments->camera_to_xyz),
        {"--width",
         "N",
         "of the map, twice its height (default: 1024)",
         &arguments->width,
         false,
         {}},
        {"--scale",
         "X",
         "of the map for a file unit a second (default 0: white that faces where it is brightest "
         "gets luminance 1)",
         &arguments->scale,
         false,
         {}},
        {"--mask",
         "FILE",
         "what was seen of each direction, how finely, and what is clipped, .exr",
         &arguments->mask,
         false,
         {}},
        {"--out", "FILE", "latitude-longitude map, .exr", &arguments->out, true, {}},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        const EnvironmentMeasurement report = measure_environment(request_of(*arguments), progress);
        Outcome outcome;
        outcome.figures = figures_of(report);
        outcome.figures["file"] = arguments->out;
        if (!arguments->mask.empty()) outcome.figures["mask"] = arguments->mask;
        outcome.text = text_of(report, arguments->out);
        tell_notes(report.notes, outcome);
        return outcome;
    };
    return command;
}

}  // namespace livery
