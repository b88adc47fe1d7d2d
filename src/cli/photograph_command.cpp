// livery photograph

#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "session/simulated_captures.h"

namespace livery {

Command photograph_command() {
    struct Arguments {
        std::string bench = "default", patterns, out, size;
        double exposure_s = 0.0;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "photograph";
    command.summary = "photograph a patterns folder on the simulated bench";
    command.example = "livery photograph --patterns patterns --out captures";
    command.options = {
        {"--bench",
         "FILE",
         "a bench file or a shipped bench's name (default: default)",
         &arguments->bench,
         false,
         {}},
        {"--patterns", "DIR", "patterns with their manifest.json", &arguments->patterns, true, {}},
        {"--out", "DIR", "captures folder", &arguments->out, true, {}},
        {"--size",
         "WxH",
         "projector resolution (default: as the bench file says)",
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
        if (arguments->exposure_s < 0.0) {
            throw std::invalid_argument("--exposure-s: found a negative number, expected seconds");
        }
        std::error_code error;
        if (std::filesystem::equivalent(arguments->patterns, arguments->out, error)) {
            throw std::invalid_argument(
                "--out: found the folder of --patterns, expected another: its manifest.json would "
                "be overwritten");
        }
        SimulatedCapturesRequest request;
        request.bench = read_bench_file(arguments->bench);
        if (!arguments->size.empty()) {
            const PixelSize size = parse_size("--size", arguments->size);
            View& projector = request.bench.projector.view;
            projector = resized(projector, size.width, size.height);
        }
        request.bench.seed = static_cast<std::uint64_t>(common.seed);
        request.patterns = arguments->patterns;
        request.out = arguments->out;
        request.exposure_s = arguments->exposure_s;
        const SimulatedCaptures taken = photograph_patterns(request, progress);
        Outcome outcome;
        outcome.figures = {{"photographs", taken.photographs},
                           {"exposure_s", taken.exposure_s},
                           {"folder", arguments->out},
                           {"simulated", true}};
        outcome.text = fmt::format("{} simulated photographs at {:.4g} s in {}\n",
                                   taken.photographs,
                                   taken.exposure_s,
                                   arguments->out);
        return outcome;
    };
    return command;
}

}  // namespace livery
