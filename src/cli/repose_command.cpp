// livery calibrate repose
#include <memory>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "capture/captures_folder.h"
#include "capture/patterns_folder.h"
#include "cli/capture_report.h"
#include "cli/command.h"
#include "cli/opened_bench.h"
#include "core/error.h"
#include "jobs/calibrate/reposed_calibration.h"
#include "scene/library.h"

namespace livery {

namespace {

struct ReposeArguments {
    std::string calibration, camera, monitor, captures, patterns, out, product = "car";
};

void check_ways(const ReposeArguments& arguments) {
    const int ways =
        !arguments.camera.empty() + !arguments.captures.empty() + !arguments.patterns.empty();
    if (ways != 1)
        throw std::invalid_argument(
            "expected one of --camera, --captures (the two photographs) and --patterns (writes "
            "the two pictures)");
    if (arguments.patterns.empty() && arguments.out.empty())
        throw std::invalid_argument("--out: found none, expected a folder for the calibration");
}

Outcome write_pictures(const StripeCode& code,
                       const std::string& folder,
                       const Progress& progress) {
    std::vector<PatternFile> files;
    for (const bool inverse : {false, true})
        files.push_back({stripe_role(inverse), stripe_picture(code, inverse), {}});
    write_patterns_folder(folder, code.width, code.height, files, progress);
    Outcome outcome;
    outcome.figures = {{"folder", folder}, {"patterns", Json::array()}};
    for (const PatternFile& file : files) outcome.figures["patterns"].push_back(file.role);
    outcome.text = fmt::format(
        "2 pictures in {}: photograph each as the calibration was, put the photographs beside "
        "manifest.json and name them there; then --captures {}\n",
        folder,
        folder);
    return outcome;
}

void report_found(const ReposedCalibration& reposed, const std::string& out, Outcome& outcome) {
    const Repose& found = reposed.found;
    constexpr double kDegrees = 180.0 / std::numbers::pi;
    const auto three = [](const glm::dvec3& v) { return Json{v.x, v.y, v.z}; };
    const auto graded = grade_figures(found);
    outcome.figures["moved_mm"] = found.moved_mm;
    outcome.figures["turned_degrees"] = found.turned_rad * kDegrees;
    outcome.figures["shift_error_mm"] = three(found.shift_error_mm);
    outcome.figures["turn_error_degrees"] = three(kDegrees * found.turn_error_rad);
    outcome.figures["median_px"] = found.median_px;
    outcome.figures["agree_share"] = found.agree_share;
    outcome.figures["borders"] = found.on_product;
    outcome.figures["around"] = {{"places", found.around.places},
                                 {"still_share", found.around.still_share}};
    outcome.figures["valid_fraction"] = reposed.calibration.valid_fraction;
    outcome.figures["predicted_fraction"] = reposed.calibration.predicted_fraction;
    outcome.figures["warnings"] = found.warnings;
    outcome.figures["drift_can_be_told"] = reposed.origin.ends.has_value();
    outcome.figures["calibration"] = {
        {"id", reposed.calibration.id}, {"folder", out}, {"made_of", reposed.origin.reposed_from}};
    outcome.figures["figures"] = json_of(graded);
    outcome.figures["grade"] = to_string(grade_of(graded).grade);
    for (const GradedFigure& figure : graded) outcome.text += line_of(figure) + "\n";
    for (const std::string& warning : found.warnings) outcome.text += "warning: " + warning + "\n";
    if (!reposed.origin.ends)
        outcome.text +=
            "warning: from photographs that were taken before, a look for drift has nothing to "
            "compare with until the colours are photographed again\n";
    outcome.text += fmt::format("calibration {} in {}, made of {}\n",
                                reposed.calibration.id,
                                out,
                                reposed.origin.reposed_from);
}

}  // namespace

Command calibrate_repose_command() {
    const auto arguments = std::make_shared<ReposeArguments>();
    Command command;
    command.name = "calibrate repose";
    command.summary = "two photographs -> a calibration whose mock-up was bumped, fitting again";
    command.example = "livery calibrate repose --calibration monday --camera bench --out tuesday";
    command.options = {
        {"--calibration",
         "DIR",
         "made by livery capture or the window",
         &arguments->calibration,
         true,
         {}},
        {"--camera", "CAMERA", "as livery capture has it", &arguments->camera, false, {}},
        {"--monitor", "N", "the projector's number or name", &arguments->monitor, false, {}},
        {"--captures",
         "DIR",
         "the two photographs, taken before, with manifest.json",
         &arguments->captures,
         false,
         {}},
        {"--patterns", "DIR", "write the two pictures to show", &arguments->patterns, false, {}},
        {"--out", "DIR", "write the calibration there", &arguments->out, false, {}},
        {"--product", "FILE|NAME", "the mock-up (default car)", &arguments->product, false, {}},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        check_ways(*arguments);
        const std::filesystem::path folder = arguments->calibration;
        progress.update(0.0, "reading");
        const auto product = find_product(arguments->product);
        const auto origin = read_origin(folder);
        if (!origin)
            throw FileError(folder / "origin.json",
                            "",
                            "nothing",
                            "a calibration that livery capture or the window made");
        Outcome outcome;
        try {
            const StripeCode code = stripes_for(*origin, *product);
            if (!arguments->patterns.empty())
                return write_pictures(code, arguments->patterns, progress);
            const ColourCalibration calibration = read_calibration(folder);
            std::optional<OpenedBench> opened;
            BenchPorts ports;
            if (arguments->captures.empty()) {
                opened = open_bench(arguments->camera, arguments->monitor, product, progress);
                ports = opened->ports;
            } else {
                ports = ports_of(read_captures_folder(arguments->captures, PhotographUse::places));
            }
            const ReposedCalibration reposed =
                repose_through_ports(ports, calibration, *origin, *product, progress);
            write_reposed(arguments->out, reposed);
            report_found(reposed, arguments->out, outcome);
        } catch (const Refused& refused) {
            report_refusal(refused, outcome);
        }
        return outcome;
    };
    return command;
}

}  // namespace livery
