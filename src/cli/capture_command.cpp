// livery capture

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "calibration/preflight.h"
#include "calibration/settings.h"
#include "capture/camera.h"
#include "cli/capture_options.h"
#include "cli/capture_report.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/monitor_projector.h"
#include "core/error.h"
#include "core/paths.h"
#include "gl/window.h"
#include "jobs/calibrate/bench_calibration.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/calibrate/staged_calibration.h"
#include "jobs/capture_bench.h"
#include "jobs/watched_captures.h"
#include "projection/desktop_watch.h"
#include "projection/projector_screen.h"
#include "scene/library.h"

namespace livery {

namespace {

struct CaptureArguments {
    std::string camera, monitor, product, pose, camera_to_xyz, out, calibration, places = "gray";
    std::vector<std::string> again;
    double every_s = 0.0;
    std::string redo, effort = "normal";
    DataSheets sheets{0.0, 0.5, 0.0, 0.0, 0.0};
    bool list = false, preflight_only = false, without_preflight = false, anew = false,
         fit_response = false, check = false;
};

Json json_of(const std::vector<SignalWarning>& warnings) {
    Json list = Json::array();
    for (const SignalWarning& warning : warnings)
        list.push_back({{"what", warning.what},
                        {"cause", warning.cause},
                        {"fix", warning.fix},
                        {"severity", name_of(warning.severity)}});
    return list;
}

/// "Bad     ...", with what helps below. Whether a capture makes sense.
bool tell_signal(const std::vector<SignalWarning>& warnings, Outcome& outcome) {
    using Severity = SignalWarning::Severity;
    outcome.figures["signal"] = json_of(warnings);
    bool fit = true;
    for (const SignalWarning& warning : warnings) {
        const char* grade = warning.severity == Severity::error     ? "Bad"
                            : warning.severity == Severity::warning ? "Usable"
                                                                    : "Note";
        say(fmt::format("{:<8}{}\n        {} {}", grade, warning.what, warning.cause, warning.fix));
        fit = fit && warning.severity != Severity::error;
    }
    return fit;
}

/// "HDMI-1, EPSON PJ, 1280x720", and what of it is not plain.
std::string words_of(const Monitor& monitor) {
    std::string words = fmt::format("{}, {}x{}", monitor.name, monitor.width, monitor.height);
    if (monitor.mode_px.x > 0 && monitor.mode_px != glm::ivec2(monitor.width, monitor.height))
        words += fmt::format(" on {}x{} pixels", monitor.mode_px.x, monitor.mode_px.y);
    if (monitor.wayland && monitor.wayland->scale != 1.0)
        words += fmt::format(", scale {:.0f}%", 100.0 * monitor.wayland->scale);
    return words;
}

Json json_of(const Monitor& monitor, const std::vector<SignalWarning>& warnings) {
    Json json = {{"monitor", monitor.number},
                 {"name", monitor.name},
                 {"width", monitor.width},
                 {"height", monitor.height},
                 {"id", monitor.id},
                 {"maker", monitor.identity.maker},
                 {"product", monitor.identity.product},
                 {"serial", monitor.identity.serial},
                 {"signal", json_of(warnings)}};
    if (monitor.mode_px.x > 0) json["mode"] = {monitor.mode_px.x, monitor.mode_px.y};
    if (monitor.wayland) {
        json["scale"] = monitor.wayland->scale;
        json["transform"] = monitor.wayland->transform;
    }
    return json;
}

Outcome listed() {
    Outcome outcome;
    outcome.figures = {{"cameras", Json::array()}, {"monitors", Json::array()}};
    for (const ListedCamera& camera : list_cameras()) {
        outcome.figures["cameras"].push_back({{"camera", camera.choice},
                                              {"name", camera.name},
                                              {"problem", camera.problem},
                                              {"fix", camera.fix}});
        outcome.text += fmt::format("--camera {:<24} {}\n", camera.choice, camera.name);
        if (!camera.problem.empty())
            outcome.text += fmt::format("    {}: {}\n", camera.problem, camera.fix);
    }
    try {
        const WindowSystem window_system;
        DesktopWatch desktop(is_xwayland());
        for (const Monitor& monitor : list_monitors(&desktop)) {
            const auto warnings = check_signal(monitor, {0, 0}, desktop);
            outcome.figures["monitors"].push_back(json_of(monitor, warnings));
            outcome.text += fmt::format("--monitor {:<23} {}\n", monitor.number, words_of(monitor));
            for (const SignalWarning& warning : warnings) {
                const auto words =
                    fmt::format("    {} {} {}\n", warning.what, warning.cause, warning.fix);
                // What holds for every monitor is told once.
                if (outcome.text.find(words) == std::string::npos) outcome.text += words;
            }
        }
    } catch (const std::runtime_error&) {
        outcome.text +=
            "no display, so no monitors: only a simulated bench has its own projector\n";
    }
    return outcome;
}

/// What a run needs besides ports.
struct CaptureCommandRun {
    CaptureArguments arguments;
    StagedCalibration staged;
    Outcome outcome;

    CalibrationSettings& request() { return staged.settings; }

    void refuse(const Refused& refused) {
        report_refusal(refused, outcome);
        if (!arguments.out.empty())
            outcome.text += "What was photographed is kept in " + arguments.out +
                            "; the same command goes on with it.\n";
    }
};

/// The preflight's lines as they come; whether a capture makes sense.
bool look_before(CaptureCommandRun& run, const BenchPorts& ports, const Progress& progress) {
    run.outcome.figures["preflight"] = Json::array();
    bool fit = true;
    preflight(ports,
              {run.request().width, run.request().height, mockup_of(run.request())},
              progress,
              [&](const GradedFigure& figure) {
                  run.outcome.figures["preflight"].push_back(json_of(figure));
                  say(line_of(figure));
                  fit = fit && figure.grade != Grade::bad;
              });
    return fit;
}

/// Pictures are taken again by the roles that a recording has them under. How many it has.
int take_again(Recording& recording, const std::string& role) {
    const auto showings = recording.showings();
    int found = 0;
    for (std::size_t k = 0; k < showings.size(); ++k) {
        const auto& photographs = showings[k].photographs;
        if (photographs.empty() || photographs.back().of != role) continue;
        recording.take_again(k);
        ++found;
    }
    return found;
}

/// Opens what there is of the run, so that a role that nobody photographed is told before anything
/// is shown.
void check_again(const CaptureCommandRun& run) {
    for (const std::string& role : run.arguments.again) {
        int found = 0;
        for (const auto stage : {CalibrationStage::geometry, CalibrationStage::colour}) {
            const auto folder = folder_of(run.staged, stage);
            if (!std::filesystem::exists(folder / "recording.json")) continue;
            Recording recording(folder, run.staged.settings.made_with);
            found += take_again(recording, role);
        }
        if (found == 0)
            throw std::invalid_argument(
                fmt::format("--again: found \"{}\", expected a picture of the capture", role));
    }
}

/// Recordings of its stages that lie there.
bool has_photographs(const StagedCalibration& run) {
    return std::filesystem::exists(folder_of(run, CalibrationStage::geometry) / "recording.json") ||
           std::filesystem::exists(folder_of(run, CalibrationStage::colour) / "recording.json");
}

Outcome fit_response(CaptureCommandRun run,
                     Camera& camera,
                     const BenchPorts& ports,
                     const Progress& progress) {
    try {
        const CameraCurve curve =
            fit_camera_curve(camera, ports, run.request().width, run.request().height, progress);
        run.outcome.figures = {{"response", curve.file.string()}, {"residual", curve.residual}};
        run.outcome.text = fmt::format(
            "The curve of {} is in {}; with it, photographs of one light differ by {:.2f} %.\n",
            camera.name(),
            curve.file.string(),
            100.0 * curve.residual);
    } catch (const Refused& refused) {
        run.refuse(refused);
    }
    return run.outcome;
}

Outcome capture_with_camera(CaptureCommandRun run,
                            const CameraChoice& choice,
                            const Progress& progress) {
    if (traits_of(choice).is_simulated && !run.arguments.monitor.empty())
        throw std::invalid_argument(
            "--monitor: found with a simulated bench, which has a projector of its own");
    CaptureBench bench = open_capture_bench(choice, run.request().product, progress);
    std::unique_ptr<MonitorProjector> projector;
    std::string shown_on = "its own projector";
    bool signal_is_fit = true;
    if (bench.show) {
        CalibrationSettings asked = settings_of(bench.simulated->description(), bench.product);
        asked.camera_to_xyz = run.request().camera_to_xyz;
        asked.shots = run.request().shots;
        asked.places = run.request().places;
        if (run.request().projector) asked.projector = run.request().projector;
        run.request() = std::move(asked);
    } else {
        if (run.arguments.monitor.empty())
            throw std::invalid_argument(
                "--monitor: found none, expected the projector's (livery capture --list)");
        projector = std::make_unique<MonitorProjector>(run.arguments.monitor);
        const Monitor& monitor = projector->monitor();
        run.request().width = monitor.width;
        run.request().height = monitor.height;
        shown_on = projector->words();
        if (run.request().projector)
            check_projector(
                *run.request().projector, run.arguments.pose, monitor.width, monitor.height);
        signal_is_fit = tell_signal(projector->signal_warnings(), run.outcome);
        bench.show = projector->port(progress);
    }
    run.request().made_with = bench.name + ", " + shown_on;
    for (const std::string& warning : bench.camera->state().warnings) say("warning: " + warning);
    BenchPorts ports;
    ports.show = bench.show;
    ports.photograph = patient(*bench.camera, progress, say_wait);
    ports.measure_xyz = bench.measure_xyz;

    if (run.arguments.fit_response)
        return fit_response(std::move(run), *bench.camera, ports, progress);
    if (bench.curve) say("8-bit numbers are read with " + bench.curve->string());

    run.staged.folder = run.arguments.out;
    if (!run.arguments.preflight_only) {
        make_output_folder(run.arguments.out);
        if (run.arguments.anew) {
            forget(run.staged, CalibrationStage::geometry);
            forget(run.staged, CalibrationStage::colour);
        }
        if (!run.arguments.redo.empty())
            forget(run.staged,
                   run.arguments.redo == "geometry" ? CalibrationStage::geometry
                                                    : CalibrationStage::colour);
        check_again(run);
    }
    const bool goes_on = !run.arguments.preflight_only && has_photographs(run.staged);
    if (!run.arguments.without_preflight && !goes_on) {
        const bool fit = look_before(run, ports, progress) && signal_is_fit;
        if (run.arguments.preflight_only || !fit) {
            run.outcome.exit_code = fit ? 0 : 1;
            run.outcome.text = fit ? "The bench is fit for a capture.\n"
                                   : "The bench is not fit for a capture: see what is Bad above. "
                                     "--no-preflight captures all the same.\n";
            return run.outcome;
        }
    }
    int taken = 0, answered = 0;
    const auto meet = [&](Recording& recording) {
        for (const std::string& role : run.arguments.again) take_again(recording, role);
        recording.tell([&](std::size_t, const Photograph&) {
            taken = recording.taken();
            answered = recording.answered();
        });
    };
    int geometry_taken = 0, geometry_answered = 0;
    try {
        if (finds_room(run.request())) {
            find_geometry(run.staged, ports, meet, progress.part(0.0, 0.4));
            geometry_taken = std::exchange(taken, 0);
            geometry_answered = std::exchange(answered, 0);
        }
        find_colours(run.staged, ports, meet, progress.part(0.4, 0.95));
        report_calibration(run.staged, run.arguments.calibration, run.outcome);
        if (run.arguments.check) {
            check_colours(run.staged, ports, progress.part(0.95, 1.0));
            report_check(*run.staged.check, run.outcome);
        }
    } catch (const Refused& refused) {
        run.refuse(refused);
    }
    taken += geometry_taken;
    answered += geometry_answered;
    run.outcome.figures["folder"] = run.arguments.out;
    run.outcome.figures["photographs_taken"] = taken;
    run.outcome.figures["photographs_kept_from_before"] = answered;
    run.outcome.figures["simulated"] = bench.simulated != nullptr;
    run.outcome.text += fmt::format(
        "{} photographs taken, {} kept from before, in {}\n", taken, answered, run.arguments.out);
    return run.outcome;
}

/// Shows each picture for some seconds, for somebody with a camera.
void show_all(MonitorProjector& projector,
              const std::vector<Pattern>& patterns,
              double every_s,
              const Progress& progress) {
    const ShowPicture show = projector.port(progress);
    for (std::size_t k = 0; k < patterns.size(); ++k) {
        show(patterns[k].drive);
        say(fmt::format("shoot {} of {}: {}", k + 1, patterns.size(), patterns[k].role));
        for (double waited_s = 0.0; waited_s < every_s; waited_s += 0.02) {
            progress.check_stop();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    }
    show(Image8(patterns[0].drive.width, patterns[0].drive.height, 3));
}

Outcome capture_by_hand(CaptureCommandRun run,
                        const CameraChoice& choice,
                        const Progress& progress) {
    if (run.arguments.monitor.empty())
        throw std::invalid_argument(
            "--monitor: found none, expected the projector's (livery capture --list)");
    MonitorProjector projector(run.arguments.monitor);
    run.request().width = projector.monitor().width;
    run.request().height = projector.monitor().height;
    run.request().made_with = "photographs in " + choice.what;
    const CalibrationSettings& settings = run.request();
    std::vector<Pattern> patterns =
        place_patterns(settings.places, settings.width, settings.height);
    for (Pattern& pattern : colour_patterns(settings.width, settings.height, 0, 255))
        patterns.push_back(std::move(pattern));
    std::vector<std::string> roles;
    for (const Pattern& pattern : patterns) roles.push_back(pattern.role);
    WatchedCaptures watched(choice.what, roles);
    const auto before = watched.look_at_what_is_there(std::move(patterns));
    if (!before.words.empty()) say(before.words);
    tell_signal(projector.signal_warnings(), run.outcome);
    if (!before.still_to_shoot.empty())
        show_all(projector, before.still_to_shoot, run.arguments.every_s, progress);
    say(fmt::format("copy the {} photographs to {}", roles.size(), choice.what));
    try {
        run.staged.made = calibrate_through_ports(
            watched.ports(progress, [](const WatchedState& state) { say(text_of(state)); }),
            run.request(),
            progress);
        report_calibration(run.staged, run.arguments.calibration, run.outcome);
    } catch (const Refused& refused) {
        run.refuse(refused);
    }
    return run.outcome;
}

}  // namespace

Command capture_command() {
    const auto arguments = std::make_shared<CaptureArguments>();
    Command command;
    command.name = "capture";
    command.summary = "show the patterns, photograph them with a camera, and calibrate";
    command.example = "livery capture --camera video:0 --monitor 2 --out captures";
    command.options = {
        {"--list", "", "name the cameras and monitors that there are", &arguments->list},
        {"--camera",
         "CAMERA",
         "bench[:NAME], tethered[:PORT], video:NUMBER|FILE|ADDRESS, or folder:DIR for any other "
         "camera",
         &arguments->camera},
        {"--monitor", "N", "the projector's number or name", &arguments->monitor},
        {"--out",
         "DIR",
         "photographs, as a captures folder; a capture that was stopped goes on",
         &arguments->out},
        {"--calibration", "DIR", "write the calibration there", &arguments->calibration},
        {"--preflight", "", "only find out whether the bench is fit", &arguments->preflight_only},
        {"--no-preflight", "", "capture without looking first", &arguments->without_preflight},
        {"--product", "FILE|NAME", "the mock-up, with --pose", &arguments->product},
        {"--pose",
         "FILE",
         "the projector's camera file: the mock-up alone is lit, and hidden pixels are predicted",
         &arguments->pose},
        {"--camera-to-xyz",
         "FILE",
         "matrix or measured primaries (default: camera RGB is linear Rec.709)",
         &arguments->camera_to_xyz},
        {"--again",
         "ROLE...",
         "take these pictures of the capture in --out again",
         &arguments->again},
        {"--fit-response",
         "",
         "find the curve of a camera that gives no RAW, and keep it",
         &arguments->fit_response},
        {"--anew", "", "take all of the capture in --out again", &arguments->anew},
        {"--redo",
         "STAGE",
         "take this stage of the capture in --out again, and what follows from it",
         &arguments->redo,
         false,
         {"geometry", "colour"}},
        {"--effort",
         "LEVEL",
         "one, two or four photographs of each colour (default normal)",
         &arguments->effort,
         false,
         {"quick", "normal", "best"}},
        {"--check",
         "",
         "show corrected colours afterwards, and photograph them",
         &arguments->check},
        places_option(arguments->places),
        {"--every",
         "S",
         "with folder: seconds that each picture is shown (default 5)",
         &arguments->every_s},
    };
    add_data_sheet_options(command.options, arguments->sheets);
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        if (arguments->list) return listed();
        if (arguments->camera.empty())
            throw std::invalid_argument(
                "--camera: found none, expected one (livery capture --list)");
        const CameraChoice choice = parse_camera_choice(arguments->camera);
        const bool by_hand = traits_of(choice).is_by_hand;
        if (arguments->out.empty() && !arguments->preflight_only && !by_hand &&
            !arguments->fit_response)
            throw std::invalid_argument("--out: found none, expected a folder for the photographs");
        const bool has_sheets = is_any_given(arguments->sheets);
        if (has_sheets) check_whole(arguments->sheets);
        const bool finds = has_sheets || traits_of(choice).is_simulated;
        if (!arguments->pose.empty() && arguments->product.empty() && !finds)
            throw std::invalid_argument("--pose: found without --product, the mock-up");
        if (!arguments->product.empty() && arguments->pose.empty() && !finds)
            throw std::invalid_argument(
                "--product: found without --pose, the projector's camera file, or the data sheets "
                "(--throw-ratio, --focal-mm, --sensor-width-mm, --lens-distance-mm)");
        CaptureCommandRun run;
        run.arguments = *arguments;
        run.request().places = parse_places(arguments->places);
        if (run.arguments.every_s <= 0.0) run.arguments.every_s = 5.0;
        if (!arguments->product.empty()) run.request().product = find_product(arguments->product);
        if (!arguments->pose.empty()) run.request().projector = read_camera_file(arguments->pose);
        if (has_sheets) run.request().data_sheets = arguments->sheets;
        run.request().shots = arguments->effort == "quick"  ? 1
                              : arguments->effort == "best" ? 4
                                                            : 2;
        if (!arguments->camera_to_xyz.empty())
            run.request().camera_to_xyz = read_camera_to_xyz(arguments->camera_to_xyz);
        return by_hand ? capture_by_hand(std::move(run), choice, progress)
                       : capture_with_camera(std::move(run), choice, progress);
    };
    return command;
}

}  // namespace livery
