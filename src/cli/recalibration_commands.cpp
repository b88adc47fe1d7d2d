// livery calibrate nudge
// livery calibrate repose
// livery calibrate compare, livery calibrate drift
#include <memory>
#include <numbers>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "capture/camera.h"
#include "capture/captures_folder.h"
#include "capture/patterns_folder.h"
#include "cli/capture_report.h"
#include "cli/command.h"
#include "cli/monitor_projector.h"
#include "core/bench_ports.h"
#include "core/error.h"
#include "jobs/calibrate/calibration_check.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/calibrate/reposed_calibration.h"
#include "jobs/capture_bench.h"
#include "scene/library.h"
#include "scene/mockup_mask.h"
#include "scene/mockup_pose.h"

namespace livery {

namespace {

/// The ports live as long as it does.
struct OpenedBench {
    CaptureBench bench;
    std::unique_ptr<MonitorProjector> projector;  ///< null: the simulated bench's own
    BenchPorts ports;                             ///< to show and to photograph
    std::string projector_words() const { return projector ? projector->words() : ""; }
};

/// `camera` as livery capture has it, `monitor` empty for a simulated bench. Throws
/// std::invalid_argument for a folder and without a monitor, and as open_capture_bench().
OpenedBench open_bench(const std::string& camera,
                       const std::string& monitor,
                       std::shared_ptr<const Product> product,
                       const Progress& progress) {
    const CameraChoice choice = parse_camera_choice(camera);
    if (traits_of(choice).is_by_hand)
        throw std::invalid_argument("--camera: found a folder, expected a camera");
    OpenedBench opened;
    opened.bench = open_capture_bench(choice, std::move(product), progress);
    opened.ports.show = opened.bench.show;
    if (!opened.ports.show) {
        if (monitor.empty())
            throw std::invalid_argument(
                "--monitor: found none, expected the projector's (livery capture --list)");
        opened.projector = std::make_unique<MonitorProjector>(monitor);
        opened.ports.show = opened.projector->port(progress);
    }
    opened.ports.photograph = patient(*opened.bench.camera, progress, say_wait);
    return opened;
}

}  // namespace

Command calibrate_nudge_command() {
    struct Arguments {
        std::string calibration, product = "car", out;
        Nudge by;
    };
    const auto arguments = std::make_shared<Arguments>();
    Nudge& by = arguments->by;
    Command command;
    command.name = "calibrate nudge";
    command.summary = "a calibration -> another whose mock-up stands a little elsewhere";
    command.example =
        "livery calibrate nudge --calibration calibration --right -1.5 --down 2 --out nudged";
    command.options = {
        {"--calibration", "DIR", "with its projector.json", &arguments->calibration, true},
        {"--product", "FILE|NAME", "the mock-up (default car)", &arguments->product},
        {"--right", "PX", "the lines move to the right, projector pixels", &by.right_px},
        {"--down", "PX", "they move down", &by.down_px},
        {"--nearer", "PX", "they grow, at the mock-up's rim", &by.nearer_px},
        {"--yaw", "PX", "the mock-up's front turns to the right", &by.yaw_px},
        {"--pitch", "PX", "its front turns down", &by.pitch_px},
        {"--roll", "PX", "it turns clockwise", &by.roll_px},
        {"--out", "DIR", "the new calibration's folder", &arguments->out, true},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        const std::filesystem::path from = arguments->calibration;
        const auto before = projector_view_of(from);
        if (!before)
            throw FileError(from / "projector.json", "", "nothing", "the projector's camera file");
        progress.update(0.0, "reading the mock-up");
        const auto product = find_product(arguments->product);
        const Bounds bounds = bounds_of(product->mesh);
        const View after = nudged(*before, bounds, arguments->by);
        progress.update(0.5, "writing");
        Outcome outcome;
        const std::string id = write_nudged(from, arguments->out, after, bounds);
        const MockupMotion motion = motion_between(*before, after, bounds);
        outcome.figures = {{"id", id},
                           {"moved_mm", {motion.moved_mm.x, motion.moved_mm.y, motion.moved_mm.z}},
                           {"moved_px", {motion.moved_px.x, motion.moved_px.y}},
                           {"turned_deg", motion.turned_deg}};
        outcome.text =
            fmt::format("{}: calibration {} in {}\n", in_words(motion), id, arguments->out);
        return outcome;
    };
    return command;
}

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
         true},
        {"--camera", "CAMERA", "as livery capture has it", &arguments->camera},
        {"--monitor", "N", "the projector's number or name", &arguments->monitor},
        {"--captures",
         "DIR",
         "the two photographs, taken before, with manifest.json",
         &arguments->captures},
        {"--patterns", "DIR", "write the two pictures to show", &arguments->patterns},
        {"--out", "DIR", "write the calibration there", &arguments->out},
        {"--product", "FILE|NAME", "the mock-up (default car)", &arguments->product},
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
        {"folders", "OLDER NEWER", "two calibrations' folders", &arguments->folders, true},
        {"--product", "FILE|NAME", "the mock-up (default car)", &arguments->product},
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
        {"--calibration", "DIR", "made by livery capture", &arguments->calibration, true},
        {"--camera", "CAMERA", "as livery capture has it", &arguments->camera, true},
        {"--monitor", "N", "the projector's number or name", &arguments->monitor},
        {"--product", "FILE|NAME", "the mock-up (default car)", &arguments->product},
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
