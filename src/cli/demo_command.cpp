// livery demo

#include <memory>

#include "cli/command.h"
#include "jobs/demo.h"
#include "jobs/report.h"

namespace livery {

Command demo_command() {
    struct Arguments {
        std::string out = "livery-demo", bench = "default", product = "car", size;
        double design_white = kDesignWhitePercentile;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "demo";
    command.summary =
        "a whole session on the simulated bench: calibrate, render, compensate, project, compare, "
        "report";
    command.example = "livery demo --out demo";
    command.options = {
        {"--out",
         "DIR",
         "where report.html and its pictures go (default livery-demo)",
         &arguments->out},
        {"--bench",
         "FILE",
         "a bench file or a shipped bench's name (default: default)",
         &arguments->bench},
        {"--size",
         "WxH",
         "projector resolution (default: as the bench file says)",
         &arguments->size},
        {"--product",
         "NAME",
         "car, player, or sphere: painted samples beside the projection (default car)",
         &arguments->product,
         false,
         {"car", "player", "sphere"}},
        {"--design-white",
         "PERCENT",
         "percentile of the brightest neutral that becomes 1 (default 20)",
         &arguments->design_white},
    };
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        check_percentile("--design-white", arguments->design_white);
        DemoOptions options;
        options.out = arguments->out;
        options.bench = arguments->bench;
        options.product = arguments->product;
        options.gl_device = common.gl_device();
        options.seed = static_cast<std::uint64_t>(common.seed);
        options.design_white_percentile = arguments->design_white;
        if (!arguments->size.empty()) {
            const glm::ivec2 size = parse_size("--size", arguments->size);
            options.size_px = size;
        }
        const DemoResult result = run_demo(options, progress);
        return Outcome{figures_of(result), summary_of(result), 0};
    };
    return command;
}

}  // namespace livery
