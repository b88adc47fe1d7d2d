// livery calibrate compare, livery calibrate drift
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "cli/capture_report.h"
#include "cli/command.h"
#include "cli/opened_bench.h"
#include "core/error.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/calibrate/calibration_origin.h"
#include "jobs/calibrate/calibration_versions.h"
#include "scene/library.h"
#include "scene/mockup_mask.h"

namespace livery {

namespace {

View projector_of_calibration(const std::filesystem::path& folder) {
    const auto view = projector_view_of(folder);
    if (!view)
        throw FileError(folder / "projector.json",
                        "",
                        "nothing",
                        "the projector's camera file, beside its calibration");
    return *view;
}

/// "Good", or with what is wrong; a script sees 1 where it is bad.
void conclude(const std::vector<GradedFigure>& figures, Outcome& outcome) {
    for (const GradedFigure& figure : figures) outcome.text += line_of(figure) + "\n";
    outcome.figures["figures"] = json_of(figures);
    outcome.figures["grade"] = to_string(grade_of(figures).grade);
    if (grade_of(figures).grade == Grade::bad) outcome.exit_code = 1;
}

}  // namespace

Command calibrate_compare_command() {
    struct Arguments {
        std::vector<std::string> folders;
        std::string product = "car";
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "calibrate compare";
    command.summary = "two calibrations -> how far what they show is apart";
    command.example = "livery calibrate compare monday tuesday --product car";
    command.options = {
        {"folders", "OLDER NEWER", "two calibrations' folders", &arguments->folders, true, {}},
        {"--product", "FILE|NAME", "the mock-up (default car)", &arguments->product, false, {}},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        if (arguments->folders.size() != 2)
            throw std::invalid_argument(fmt::format("found {} folders, expected two calibrations",
                                                    arguments->folders.size()));
        const std::filesystem::path older = arguments->folders[0], newer = arguments->folders[1];
        progress.update(0.0, "reading");
        const auto product = find_product(arguments->product);
        const ColourCalibration then = read_calibration(older), now = read_calibration(newer);
        const View projector_then = projector_of_calibration(older);
        const auto own = projector_view_of(newer);
        const View projector_now = own.value_or(projector_then);
        progress.update(0.3, "comparing");
        Outcome outcome;
        try {
            const CalibrationDifference difference =
                compare_calibrations(then, projector_then, now, projector_now, product->mesh);
            outcome.figures = {{"de00_median", difference.de00.median},
                               {"de00_p95", difference.de00.p95},
                               {"compared", difference.de00.pixels},
                               {"moved_median_px", difference.moved_px.median},
                               {"moved_p95_px", difference.moved_px.p95},
                               {"brightness", difference.brightness},
                               {"valid_then", difference.valid_then},
                               {"valid_now", difference.valid_now}};
            if (!own)
                outcome.text = fmt::format(
                    "{} does not say where its projector stands: taken to "
                    "stand as that of {}\n",
                    newer.string(),
                    older.string());
            conclude(grade_figures(difference), outcome);
        } catch (const Refused& refused) {
            report_refusal(refused, outcome);
        }
        return outcome;
    };
    return command;
}

Command calibrate_drift_command() {
    struct Arguments {
        std::string calibration, camera, monitor, product = "car";
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "calibrate drift";
    command.summary = "two photographs -> whether a calibration still holds";
    command.example = "livery calibrate drift --calibration calibration --camera bench";
    command.options = {
        {"--calibration", "DIR", "made by livery capture", &arguments->calibration, true, {}},
        {"--camera", "CAMERA", "as livery capture has it", &arguments->camera, true, {}},
        {"--monitor", "N", "the projector's number or name", &arguments->monitor, false, {}},
        {"--product", "FILE|NAME", "the mock-up (default car)", &arguments->product, false, {}},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        const std::filesystem::path folder = arguments->calibration;
        const auto product = find_product(arguments->product);
        const auto origin = read_origin(folder);
        if (!origin || !origin->ends)
            throw FileError(folder / "origin.json",
                            "ends",
                            "nothing",
                            "a calibration that livery capture or the window made");
        const Image8 mockup = mockup_mask(product->mesh, projector_of_calibration(folder));
        const OpenedBench opened =
            open_bench(arguments->camera, arguments->monitor, product, progress);
        Outcome outcome;
        for (const std::string& change : what_changed(*origin, *product, opened.projector_words()))
            outcome.text += "changed: " + change + "\n";
        try {
            const Drift drift = look_for_drift(opened.ports, *origin->ends, mockup, progress);
            outcome.figures = {
                {"shift_median_px", drift.shift_median_px},
                {"shift_p95_px", drift.shift_p95_px},
                {"blocks", drift.blocks},
                {"lost", drift.lost},
                {"light_ratio", {drift.light_ratio.x, drift.light_ratio.y, drift.light_ratio.z}},
                {"room_light", drift.room_light}};
            conclude(grade_figures(drift), outcome);
        } catch (const Refused& refused) {
            report_refusal(refused, outcome);
        }
        return outcome;
    };
    return command;
}

}  // namespace livery
