// livery photograph

#include <memory>

#include <fmt/format.h>

#include "appearance/material_library.h"
#include "appearance/subsurface/translucent_material.h"
#include "cli/command.h"
#include "jobs/simulated_captures.h"

namespace livery {

namespace {

struct PhotographArguments {
    std::string bench = "default", patterns, sphere, ball, spot, out, size;
    double exposure_s = 0.0;
    int views = 0;
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

Outcome photograph_ball(const PhotographArguments& arguments,
                        const CommonOptions& common,
                        const Progress& progress) {
    constexpr int kMostViews = 3;
    if (arguments.exposure_s != 0.0) {
        throw std::invalid_argument(
            "--exposure-s: found with --ball, whose photographs are bracketed; leave it out");
    }
    const int views = arguments.views == 0 ? 2 : arguments.views;
    if (views < 1 || views > kMostViews) {
        throw std::invalid_argument(
            fmt::format("--views: found {}, expected 1 to {}", views, kMostViews));
    }
    const glm::ivec2 size =
        parse_size("--size", arguments.size.empty() ? "1024x1024" : arguments.size);
    if (size.x != size.y) {
        throw std::invalid_argument("--size: found \"" + arguments.size +
                                    "\", expected a square with --ball");
    }
    const Environment environment = load_environment({arguments.ball, 0.0, 1.0}, ".");
    SimulatedBallRequest request;
    request.stand = usual_mirror_ball_stand(read_bench_file(arguments.bench).camera, size.x, views);
    request.light_from = light_of(environment);
    request.out = arguments.out;
    request.seed = static_cast<std::uint64_t>(common.seed);
    const SimulatedBall taken = photograph_ball(request, progress);
    Outcome outcome;
    outcome.figures = {{"photographs", taken.photographs},
                       {"cameras", taken.cameras},
                       {"environment", environment.file.string()},
                       {"folder", arguments.out},
                       {"simulated", true}};
    outcome.text = fmt::format("{} simulated photographs of a mirror ball from {} places in {}\n",
                               taken.photographs,
                               taken.cameras,
                               arguments.out);
    return outcome;
}

Outcome photograph_spot(const PhotographArguments& arguments,
                        const CommonOptions& common,
                        const Progress& progress) {
    if (arguments.exposure_s != 0.0) {
        throw std::invalid_argument(
            "--exposure-s: found with --spot, whose photographs are bracketed; leave it out");
    }
    const glm::ivec2 size =
        parse_size("--size", arguments.size.empty() ? "1024x1024" : arguments.size);
    if (size.x != size.y) {
        throw std::invalid_argument("--size: found \"" + arguments.size +
                                    "\", expected a square with --spot");
    }
    const TranslucentMaterial material = read_translucent_material(arguments.spot);
    SimulatedSpotRequest request;
    request.stand =
        usual_spot_stand(read_bench_file(arguments.bench).camera,
                         {medium_of(material, 0), medium_of(material, 1), medium_of(material, 2)},
                         size.x);
    request.out = arguments.out;
    request.seed = request.stand.seed = static_cast<std::uint64_t>(common.seed);
    const SimulatedSpot taken = photograph_spot(request, progress);
    Outcome outcome;
    outcome.figures = {{"photographs", taken.photographs},
                       {"material", material.name},
                       {"eta", material.eta},
                       {"folder", arguments.out},
                       {"simulated", true}};
    outcome.text = fmt::format(
        "{} simulated photographs of a spot of light on {} (index {}) and on white in {}\n",
        taken.photographs,
        material.name,
        material.eta,
        arguments.out);
    return outcome;
}

using PhotographAction = Outcome (*)(const PhotographArguments&,
                                     const CommonOptions&,
                                     const Progress&);

/// By what was named to be photographed.
PhotographAction chosen(const PhotographArguments& arguments) {
    const int named = (arguments.patterns.empty() ? 0 : 1) + (arguments.sphere.empty() ? 0 : 1) +
                      (arguments.ball.empty() ? 0 : 1) + (arguments.spot.empty() ? 0 : 1);
    if (named == 0) {
        throw std::invalid_argument(
            "photograph: found none of --patterns, --sphere, --ball and --spot, expected one of "
            "them");
    }
    if (named > 1) {
        throw std::invalid_argument(
            "photograph: found more than one of --patterns, --sphere, --ball and --spot, expected "
            "one "
            "of them");
    }
    if (arguments.views != 0 && arguments.ball.empty()) {
        throw std::invalid_argument("--views: found without --ball; leave it out");
    }
    if (!arguments.spot.empty()) return &photograph_spot;
    if (!arguments.ball.empty()) return &photograph_ball;
    if (!arguments.sphere.empty()) return &photograph_sphere;
    return &photograph_patterns;
}

}  // namespace

Command photograph_command() {
    const auto arguments = std::make_shared<PhotographArguments>();
    Command command;
    command.name = "photograph";
    command.summary =
        "photograph patterns, a painted sphere, a mirror ball or a spot of light on the simulated "
        "bench";
    command.example = "livery photograph --patterns patterns --out captures";
    command.options = {
        {"--bench",
         "FILE",
         "a bench file or a shipped bench's name (default: default)",
         &arguments->bench},
        {"--patterns", "DIR", "patterns with their manifest.json", &arguments->patterns},
        {"--sphere",
         "FILE|NAME",
         "instead of patterns: a sphere of that paint, as livery measure brdf takes it",
         &arguments->sphere},
        {"--ball",
         "FILE|NAME",
         "instead of patterns: a mirror ball in that environment, as livery measure environment "
         "takes it",
         &arguments->ball},
        {"--spot",
         "FILE|NAME",
         "instead of patterns: a spot of light on that translucent material, as livery measure "
         "profile takes it",
         &arguments->spot},
        {"--views", "N", "with --ball: from so many sides, 1 to 3 (default: 2)", &arguments->views},
        {"--out", "DIR", "captures folder", &arguments->out, true},
        {"--size",
         "WxH",
         "projector resolution (default: as the bench file says); with --sphere, --ball "
         "and --spot the picture's (default: 512x512, 1024x1024, 1024x1024)",
         &arguments->size},
        {"--exposure-s",
         "S",
         "exposure in seconds (default 0: as the bench meters)",
         &arguments->exposure_s},
    };
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        return chosen(*arguments)(*arguments, common, progress);
    };
    return command;
}

}  // namespace livery
