// livery calibrate color

#include <memory>
#include <optional>

#include <fmt/format.h>

#include "capture/captures_folder.h"
#include "cli/capture_options.h"
#include "cli/command.h"
#include "cli/render/frame_options.h"
#include "compensation/lit_pixels.h"
#include "core/error.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/captured_calibration.h"
#include "scene/library.h"

namespace livery {

namespace {

Json figures_of(const ColourCalibration& calibration) {
    Json response = Json::object();
    const char* names[] = {"red", "green", "blue"};
    for (std::size_t k = 0; k < 3; ++k) {
        const ResponseCurve& curve = calibration.response[k];
        Json samples = Json::array();
        const std::size_t count = curve.drive_from_n.size();
        for (std::size_t i = 0; i < 17 && count > 1; ++i) {
            samples.push_back(curve.drive_from_n[i * (count - 1) / 16]);
        }
        response[names[k]] = {{"drive_at_n_0_to_1", samples},
                              {"largest_violation", curve.largest_violation}};
    }
    return {{"valid_fraction", calibration.valid_fraction},
            {"additivity_error", calibration.additivity_error},
            {"condition_p99", calibration.condition_p99},
            {"response", response},
            {"refused", Json::array()},
            {"id", calibration.id},
            {"mode", calibration.mode},
            {"additive", calibration.table.grid == 0},
            {"camera_to_xyz", calibration.xyz_origin},
            {"ambient_fraction", calibration.ambient_fraction},
            {"mixing_spread", calibration.mixing_spread},
            {"predicted_fraction", calibration.predicted_fraction},
            {"prediction_error_median", calibration.prediction_error_median},
            {"prediction_error_p95", calibration.prediction_error_p95},
            {"pixel_fractions", json_of(pixel_shares(calibration, {}))},
            {"warnings", calibration.warnings}};
}

}  // namespace

Command calibrate_color_command() {
    struct Arguments {
        std::string captures, patterns, map, camera_to_xyz, camera, product, unit, out,
            mode = "robust";
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "calibrate color";
    command.summary = "colour photographs -> compensation";
    command.example = "livery calibrate color --captures captures --out calibration";
    command.options = {
        {"--captures", "DIR", "photographs with manifest.json", &arguments->captures, true},
        patterns_option(arguments->patterns),
        {"--map",
         "FILE",
         "projector pixel -> camera pixel, .exr (default: decoded from the same folder)",
         &arguments->map},
        {"--camera-to-xyz",
         "FILE",
         "matrix or measured primaries (default: camera RGB is linear Rec.709)",
         &arguments->camera_to_xyz},
        {"--camera",
         "FILE",
         "camera file of the projector, kept in the folder for render and the desktop",
         &arguments->camera},
        {"--product",
         "FILE|NAME",
         "the mock-up, with --camera: what the photographs do not see is predicted",
         &arguments->product},
        unit_option(arguments->unit),
        {"--out", "DIR", "calibration folder", &arguments->out, true},
        {"--mode",
         "MODE",
         "paper or robust (default robust)",
         &arguments->mode,
         false,
         {"paper", "robust"}},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        CalibrationPhotographs taken{arguments->captures, arguments->patterns, std::nullopt};
        if (!arguments->map.empty()) taken.map = arguments->map;
        CalibrationSettings settings;
        if (!arguments->camera_to_xyz.empty())
            settings.camera_to_xyz = read_camera_to_xyz(arguments->camera_to_xyz);
        settings.mode = arguments->mode == "paper" ? ColourMode::paper : ColourMode::robust;
        std::optional<View> projector;
        if (!arguments->camera.empty()) {
            projector = read_camera_file(arguments->camera);
            const CapturesFolder folder =
                read_captures_folder(taken.folder, PhotographUse::light, taken.patterns_manifest);
            check_projector(
                *projector, arguments->camera, folder.projector_width, folder.projector_height);
        }
        if (!arguments->product.empty()) {
            if (!projector) {
                throw std::invalid_argument(
                    "--product: found no --camera, expected the projector's camera file, as "
                    "calibrate register writes it");
            }
            settings.product = find_product(arguments->product, parse_unit(arguments->unit));
            settings.projector = projector;
        }
        Outcome outcome;
        try {
            const ColourCalibration calibration = calibrate_from_folder(taken, settings, progress);
            if (projector) {
                write_setup(arguments->out, calibration, *projector);
                if (settings.product) {
                    write_origin(arguments->out,
                                 origin_for(*settings.product, calibration.made_with));
                }
            } else {
                write_calibration(arguments->out, calibration);
            }
            outcome.figures = figures_of(calibration);
            outcome.text = fmt::format(
                "calibration {}: {:.1f}% of the lit pixels valid, additivity error {:.2f}%, "
                "condition {:.2f}; camera colours: {}; wrote {}\n",
                calibration.id,
                100.0 * calibration.valid_fraction,
                100.0 * calibration.additivity_error,
                calibration.condition_p99,
                calibration.xyz_origin,
                arguments->out);
            if (calibration.predicted_fraction > 0.0) {
                outcome.text += fmt::format(
                    "{:.1f}% of the valid pixels are predicted, to {:.1f}% of their light in the "
                    "median\n",
                    100.0 * calibration.predicted_fraction,
                    100.0 * calibration.prediction_error_median);
            }
            outcome.text +=
                "projected: " + text_of(pixel_shares(calibration, {})) + " of the lit pixels\n";
            for (const auto& warning : calibration.warnings)
                outcome.text += "warning: " + warning + "\n";
            if (arguments->camera_to_xyz.empty())
                outcome.text +=
                    "without --camera-to-xyz the camera's red, green and blue count as Rec.709's: "
                    "RAW photographs then turn every paint pink or green\n";
        } catch (const Refused& refused) {
            outcome.figures = {{"valid_fraction", nullptr},
                               {"additivity_error", nullptr},
                               {"condition_p99", nullptr},
                               {"response", nullptr}};
            report_refusal(refused, outcome);
        }
        return outcome;
    };
    return command;
}

}  // namespace livery
