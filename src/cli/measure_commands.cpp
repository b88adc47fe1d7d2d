// livery measure brdf
// livery measure environment
// livery measure profile
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "cli/command.h"
#include "core/angles.h"
#include "jobs/environment/environment_measurement.h"
#include "jobs/sphere_measurement.h"
#include "jobs/spot/spot_measurement.h"

namespace livery {

namespace {

Option captures_option(std::string* folder) {
    return {"--captures",
            "DIR",
            "photographs with their manifest.json (docs/measuring.md)",
            folder,
            true};
}

Option camera_to_xyz_option(std::string* file) {
    return {"--camera-to-xyz",
            "FILE",
            "matrix of linear camera RGB to XYZ (default: as the manifest says, else Rec.709)",
            file};
}

Outcome outcome_of(Json figures,
                   std::string text,
                   const std::vector<std::string>& notes,
                   const std::string& file) {
    Outcome outcome;
    outcome.figures = std::move(figures);
    outcome.figures["file"] = file;
    outcome.text = std::move(text);
    tell_notes(notes, outcome);
    return outcome;
}

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
        {"--out", "FILE", "measured reflectance, .csv", &arguments->out, true},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        const std::string& out = arguments->out;
        const SphereMeasurement report =
            measure_sphere({arguments->captures, arguments->camera_to_xyz, out}, progress);
        return outcome_of(figures_of(report), text_of(report, out), report.notes, out);
    };
    return command;
}

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
         &arguments->reflectance},
        camera_to_xyz_option(&arguments->camera_to_xyz),
        {"--width", "N", "of the map, twice its height (default: 1024)", &arguments->width},
        {"--scale",
         "X",
         "of the map for a file unit a second (default 0: white that faces where it is brightest "
         "gets luminance 1)",
         &arguments->scale},
        {"--mask",
         "FILE",
         "what was seen of each direction, how finely, and what is clipped, .exr",
         &arguments->mask},
        {"--out", "FILE", "latitude-longitude map, .exr", &arguments->out, true},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        const std::string& out = arguments->out;
        const EnvironmentMeasurement report = measure_environment(request_of(*arguments), progress);
        Outcome outcome = outcome_of(figures_of(report), text_of(report, out), report.notes, out);
        if (!arguments->mask.empty()) outcome.figures["mask"] = arguments->mask;
        return outcome;
    };
    return command;
}

namespace {

Json figures_of(const MeasuredChannel& one) {
    const SpotProfile& profile = one.profile;
    return {{"channel", one.channel},
            {"file", one.file.string()},
            {"rings", profile.samples.size()},
            {"from_mm", profile.samples.front().r_mm},
            {"to_mm", profile.samples.back().r_mm},
            {"ends_in", profile.ends_in_noise ? "noise" : "the picture's edge"},
            {"clipped_rings", profile.clipped_rings},
            {"doubtful_rings", profile.doubtful_rings},
            {"spot_mm", profile.spot_mm},
            {"half_energy_radius_mm", profile.half_energy_radius_mm},
            {"total_reflectance", profile.total_reflectance},
            {"fit_command", one.fit_command}};
}

Json figures_of(const SpotMeasurement& report) {
    Json channels = Json::array();
    for (const MeasuredChannel& one : report.channels) channels.push_back(figures_of(one));
    return {{"channels", channels},
            {"fit_command", report.fit_command},
            {"photographs", report.photographs},
            {"incidence_deg", kDegreesPerRadian * report.incidence_rad},
            {"view_deg", kDegreesPerRadian * report.view_rad},
            {"best_view_deg", kDegreesPerRadian * report.best_view_rad},
            {"off_mirror_deg", kDegreesPerRadian * report.off_mirror_rad},
            {"reach_mm", report.reach_mm},
            {"pixel_mm", report.pixel_mm},
            {"shift_mm", report.shift_mm}};
}

std::string text_of(const SpotMeasurement& report) {
    std::string text = fmt::format(
        "{} photographs; light {:.1f} degrees from the normal, seen from {:.1f}, {:.1f} from its "
        "mirror image; pixels of {:.3g} mm, the picture's edge {:.3g} mm away\n",
        report.photographs,
        kDegreesPerRadian * report.incidence_rad,
        kDegreesPerRadian * report.view_rad,
        kDegreesPerRadian * report.off_mirror_rad,
        report.pixel_mm,
        report.reach_mm);
    std::string next;
    for (const MeasuredChannel& one : report.channels) {
        const SpotProfile& profile = one.profile;
        text += fmt::format(
            "{}: {} rings from {:.3g} to {:.3g} mm (the end: {}); the spot is {:.3g} mm wide; "
            "{:.1f}% of what enters comes back, half of it within {:.3g} mm; wrote {}\n",
            one.channel,
            profile.samples.size(),
            profile.samples.front().r_mm,
            profile.samples.back().r_mm,
            profile.ends_in_noise ? "noise" : "the picture's edge",
            profile.spot_mm,
            100.0 * profile.total_reflectance,
            profile.half_energy_radius_mm,
            one.file.string());
        next += "    " + one.fit_command + "\n";
    }
    return text + "next:\n" +
           (report.fit_command.empty() ? next : "    " + report.fit_command + "\n");
}

}  // namespace

Command measure_profile_command() {
    struct Arguments {
        std::string captures, out;
        double eta = 1.5;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "measure profile";
    command.summary =
        "photographs of a spot of light on a translucent sample -> its radial profile";
    command.example = "livery measure profile --captures spot --eta 1.5 --out marble.csv";
    command.options = {
        captures_option(&arguments->captures),
        {"--eta",
         "N",
         "the sample's index of refraction over that of air (default 1.5)",
         &arguments->eta},
        {"--out",
         "FILE",
         "marble.csv: becomes marble-red.csv, marble-green.csv and marble-blue.csv",
         &arguments->out,
         true},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        const SpotMeasurement report =
            measure_profile({arguments->captures, arguments->eta, arguments->out}, progress);
        Outcome outcome;
        outcome.figures = figures_of(report);
        outcome.text = text_of(report);
        tell_notes(report.notes, outcome);
        return outcome;
    };
    return command;
}

}  // namespace livery
