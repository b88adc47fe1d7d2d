// livery photograph

#include <memory>

#include <fmt/format.h>

#include "appearance/material_library.h"
#include "cli/command.h"
#include "jobs/simulated_captures.h"
#include "jobs/simulated_sphere.h"

namespace livery {

namespace {

struct PhotographArguments {
    std::string bench = "default", patterns, sphere, out, size;
    double exposure_s = 0.0;
};

Outcome photograph_patterns(const PhotographArguments& arguments,
                            const CommonOptions& common,
                            const Progress& progress) {
    if (arguments.exposure_s < 0.0) {
        throw std::invalid_argument("--exposure-s: found a negative number, expected seconds");
    }
    std::error_code error;
    if (std::filesystem::equivalent(arguments.patterns, arguments.out, error)) {
        throw std::invalid_argument(
            "--out: found the folder of --patterns, expected another: its manifest.json would "
            "be overwritten");
    }
    SimulatedCapturesRequest request;
    request.bench = read_bench_file(arguments.bench);
    if (!arguments.size.empty()) {
        const glm::ivec2 size = parse_size("--size", arguments.size);
        View& projector = request.bench.projector.view;
        projector = resized(projector, size.x, size.y);
    }
    request.bench.seed = static_cast<std::uint64_t>(common.seed);
    request.patterns = arguments.patterns;
    request.out = arguments.out;
    request.exposure_s = arguments.exposure_s;
    const SimulatedCaptures taken = photograph_patterns(request, progress);
    Outcome outcome;
    outcome.figures = {{"photographs", taken.photographs},
                       {"exposure_s", taken.exposure_s},
                       {"folder", arguments.out},
                       {"simulated", true}};
    outcome.text = fmt::format("{} simulated photographs at {:.4g} s in {}\n",
                               taken.photographs,
                               taken.exposure_s,
                               arguments.out);
    return outcome;
}

Outcome photograph_sphere(const PhotographArguments& arguments,
                          const CommonOptions& common,
                          const Progress& progress) {
    if (arguments.exposure_s != 0.0) {
        throw std::invalid_argument(
            "--exposure-s: found with --sphere, whose photographs are bracketed; leave it out");
    }
    const glm::ivec2 size =
        parse_size("--size", arguments.size.empty() ? "512x512" : arguments.size);
    SimulatedSphereRequest request;
    request.stand = usual_sphere_stand(read_bench_file(arguments.bench).camera, size.x, size.y);
    request.paint = find_material(arguments.sphere);
    request.out = arguments.out;
    request.seed = static_cast<std::uint64_t>(common.seed);
    const SimulatedSphere taken = photograph_sphere(request, progress);
    Outcome outcome;
    outcome.figures = {{"photographs", taken.photographs},
                       {"lamps", taken.lamps},
                       {"paint", request.paint.name},
                       {"folder", arguments.out},
                       {"simulated", true}};
    outcome.text = fmt::format(
        "{} simulated photographs of a sphere of {} under {} lamps, and of white, in {}\n",
        taken.photographs,
        request.paint.name,
        taken.lamps,
        arguments.out);
    return outcome;
}

}  // namespace

Command photograph_command() {
    const auto arguments = std::make_shared<PhotographArguments>();
    Command command;
    command.name = "photograph";
    command.summary = "photograph a patterns folder, or a painted sphere, on the simulated bench";
    command.example = "livery photograph --patterns patterns --out captures";
    command.options = {
        {"--bench",
         "FILE",
         "a bench file or a shipped bench's name (default: default)",
         &arguments->bench,
         false,
         {}},
        {"--patterns", "DIR", "patterns with their manifest.json", &arguments->patterns, false, {}},
        {"--sphere",
         "FILE|NAME",
         "instead of patterns: a sphere of that paint, as livery measure brdf takes it",
         &arguments->sphere,
         false,
         {}},
        {"--out", "DIR", "captures folder", &arguments->out, true, {}},
        {"--size",
         "WxH",
         "projector resolution (default: as the bench file says); with --sphere the picture's "
         "(default: 512x512)",
         &arguments->size,
         false,
         {}},
        {"--exposure-s",
         "S",
         "exposure in seconds (default 0: as the bench meters)",
         &arguments->exposure_s,
         false,
         {}},
    };
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        if (arguments->patterns.empty() == arguments->sphere.empty()) {
            throw std::invalid_argument(arguments->patterns.empty()
                                            ? "photograph: found neither --patterns nor --sphere, "
                                              "expected one of them"
                                            : "photograph: found --patterns and --sphere, expected "
                                              "one of them");
        }
        return arguments->sphere.empty() ? photograph_patterns(*arguments, common, progress)
                                         : photograph_sphere(*arguments, common, progress);
    };
    return command;
}

}  // namespace livery
