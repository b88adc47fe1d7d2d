// livery measure profile

#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/measured_captures.h"
#include "core/angles.h"
#include "jobs/spot/spot_measurement.h"

namespace livery {

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
         &arguments->eta,
         false,
         {}},
        {"--out",
         "FILE",
         "marble.csv: becomes marble-red.csv, marble-green.csv and marble-blue.csv",
         &arguments->out,
         true,
         {}},
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
