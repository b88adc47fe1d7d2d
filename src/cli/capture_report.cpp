#include "cli/capture_report.h"

#include <fmt/format.h>

#include "cli/render/frame_options.h"
#include "compensation/lit_pixels.h"
#include "jobs/calibrate/calibration_folder.h"

namespace livery {

Json json_of(const GradedFigure& figure) {
    return {{"name", figure.name},
            {"value", figure.value},
            {"grade", to_string(figure.grade)},
            {"scale", figure.scale},
            {"meaning", figure.meaning},
            {"fix", figure.fix}};
}

std::string line_of(const GradedFigure& figure) {
    std::string line =
        fmt::format("{:<6}  {:<26} {}", to_string(figure.grade), figure.name, figure.value);
    if (!figure.scale.empty()) line += fmt::format(" ({})", figure.scale);
    if (figure.grade != Grade::good)
        line += fmt::format("\n        {} {}", figure.meaning, figure.fix);
    return line;
}

Json json_of(const std::vector<GradedFigure>& figures) {
    Json all = Json::array();
    for (const GradedFigure& figure : figures) all.push_back(json_of(figure));
    return all;
}

void report_calibration(const StagedCalibration& run, const std::string& folder, Outcome& outcome) {
    const CalibrationResult& made = *run.made;
    const ColourCalibration& calibration = made.calibration;
    Json& figures = outcome.figures;
    const CaptureSeconds captured = made.all_captured();
    if (made.room) {
        const RoomGeometry& room = made.room->geometry;
        figures["room"] = {{"median_px", room.median_px},
                           {"rms_px", room.rms_px},
                           {"rms_mm", room.rms_mm},
                           {"inliers", room.inliers},
                           {"correspondences", room.correspondences},
                           {"agreement", room.agreement},
                           {"pair_median_px", room.pair_median_px},
                           {"warnings", room.warnings},
                           {"figures", json_of(grade_figures(room))}};
        for (const GradedFigure& figure : grade_figures(room))
            outcome.text += line_of(figure) + "\n";
        for (const std::string& warning : room.warnings)
            outcome.text += "warning: " + warning + "\n";
    }
    figures["valid_fraction"] = calibration.valid_fraction;
    figures["additivity_error"] = calibration.additivity_error;
    figures["condition_p99"] = calibration.condition_p99;
    figures["pixel_fractions"] = json_of(pixel_shares(calibration, {}));
    figures["warnings"] = calibration.warnings;
    figures["capture_seconds"] = captured.all;
    figures["camera_seconds"] = captured.camera;
    figures["projector_seconds"] = captured.projector;
    figures["latency_photographs"] = made.latency_photographs;
    outcome.text += fmt::format(
        "captured in {:.1f} s, of which {:.1f} s the camera's and {:.1f} s the projector's: "
        "{:.1f}% of the lit pixels valid, additivity error {:.2f}%, "
        "condition {:.2f}\n",
        captured.all,
        captured.camera,
        captured.projector,
        100.0 * calibration.valid_fraction,
        100.0 * calibration.additivity_error,
        calibration.condition_p99);
    for (const std::string& warning : calibration.warnings)
        outcome.text += "warning: " + warning + "\n";
    if (folder.empty()) return;
    if (made.projector) {
        write_setup(folder, calibration, *made.projector);
    } else {
        write_calibration(folder, calibration);
    }
    write_origin(folder, origin_of(made, run.settings));
    figures["calibration"] = {{"id", calibration.id}, {"folder", folder}};
    outcome.text += fmt::format("calibration {} in {}\n", calibration.id, folder);
}

void report_check(const CalibrationCheck& check, Outcome& outcome) {
    Json colours = Json::array();
    for (const CheckedColour& colour : check.colours) {
        colours.push_back({{"role", colour.role},
                           {"name", colour.name},
                           {"de00_median", colour.de00.median},
                           {"de00_p95", colour.de00.p95}});
        outcome.text += fmt::format("check: {:<12} CIEDE2000 {:.2f} / {:.2f}\n",
                                    colour.name,
                                    colour.de00.median,
                                    colour.de00.p95);
    }
    const auto graded = grade_figures(check);
    outcome.figures["check"] = {{"colours", colours},
                                {"de00_median", check.de00.median},
                                {"de00_p95", check.de00.p95},
                                {"figures", json_of(graded)}};
    for (const GradedFigure& figure : graded) outcome.text += line_of(figure) + "\n";
    if (grade_of(graded).grade == Grade::bad) outcome.exit_code = 1;
}

}  // namespace livery
