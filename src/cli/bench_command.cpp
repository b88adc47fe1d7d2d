// livery bench

#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "core/paths.h"
#include "session/speed_bench.h"

namespace livery {

namespace {

Json json_of(const SpeedBenchResult& result) {
    Json effects = Json::array();
    for (const BenchEffect& effect : result.effects) {
        Json levels = Json::array();
        for (const BenchLevel& level : effect.levels) {
            levels.push_back(
                {{"name", level.name},
                 {"ms", level.ms},
                 {"fastest_ms", level.fastest_ms},
                 {"repeats", level.repeats},
                 {"p95_ms", level.p95_ms ? Json(*level.p95_ms) : Json(nullptr)},
                 {"longest_ms", level.longest_ms ? Json(*level.longest_ms) : Json(nullptr)},
                 {"work_items", level.work_items},
                 {"error", level.error ? Json(*level.error) : Json(nullptr)},
                 {"unit", level.error ? Json(level.unit) : Json(nullptr)}});
        }
        effects.push_back({{"name", effect.name}, {"levels", levels}});
    }
    return {{"suite", "speed"},
            {"renderer", result.renderer},
            {"threads", result.threads},
            {"covered_fraction", result.covered_fraction},
            {"effects", effects}};
}

std::string text_of(const SpeedBenchResult& result) {
    std::string text =
        fmt::format("{}, {} threads; mock-up on {:.1f}% of 1280x800; median (fastest) ms\n",
                    result.renderer,
                    result.threads,
                    100.0 * result.covered_fraction);
    for (const BenchEffect& effect : result.effects) {
        text += effect.name + "\n";
        for (const BenchLevel& level : effect.levels) {
            text += fmt::format("  {:<22}{:10.2f} ({:.2f}), {} runs\n",
                                level.name,
                                level.ms,
                                level.fastest_ms,
                                level.repeats);
            if (level.p95_ms && level.longest_ms) {
                text += fmt::format("  {:<22}{:10.2f} 95th percentile, {:.2f} longest\n",
                                    "",
                                    *level.p95_ms,
                                    *level.longest_ms);
            }
            if (level.error) {
                text += fmt::format("  {:<22}{:10.4f} {}\n", "", *level.error, level.unit);
            }
        }
    }
    return text;
}

}  // namespace

Command bench_command() {
    struct Arguments {
        std::string out, suite = "speed";
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "bench";
    command.summary = "time every stage on this machine; livery plan predicts from it";
    command.example = "livery bench --suite speed --out bench";
    command.options = {
        {"--out", "DIR", "also write bench.json there", &arguments->out, false, {}},
        {"--suite", "NAME", "speed (default speed)", &arguments->suite, false, {"speed"}},
    };
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        const auto kept = bench_file();  // asked for before the work: it needs a home folder
        const SpeedBenchResult result = run_speed_bench(common.gl_device(), progress);
        write_pass_costs(kept, result.renderer, result.pass_costs);
        Outcome outcome;
        outcome.figures = json_of(result);
        outcome.text = text_of(result);
        if (!arguments->out.empty()) {
            make_output_folder(arguments->out);
            write_json_file(std::filesystem::path(arguments->out) / "bench.json", outcome.figures);
        }
        return outcome;
    };
    return command;
}

}  // namespace livery
