// livery bench

#include <memory>
#include <sstream>
#include <tuple>

#include <fmt/format.h>

#include "cli/command.h"
#include "core/error.h"
#include "core/paths.h"
#include "core/text/markup.h"
#include "ledger/accuracy/accuracy.h"
#include "ledger/accuracy/chain.h"
#include "ledger/budget_check.h"
#include "ledger/effect_errors.h"
#include "ledger/geometry_errors.h"
#include "ledger/speed.h"
#include "ledger/speed_report.h"
#include "ledger/stability.h"

namespace livery {

namespace {

/// An effect for each stage and number of threads.
Json json_of(const std::vector<SweepPoint>& sweep) {
    Json effects = Json::array();
    for (const SwapStage stage : kSwapStages) {
        for (const int threads : threads_of(sweep)) {
            Json levels = Json::array();
            for (const SweepPoint& point : sweep) {
                if (point.threads != threads) continue;
                levels.push_back(
                    {{"name",
                      fmt::format(
                          "{}x{}, {:.0f}%", point.width, point.height, 100.0 * point.coverage)},
                     {"ms", point.of(stage).ms},
                     {"fastest_ms", point.of(stage).fastest_ms},
                     {"repeats", point.repeats},
                     {"work_items", point.pixels},
                     {"coverage", point.coverage},
                     {"fragments_shaded", point.fragments_shaded},
                     {"first_frame_ms", point.first_frame_ms},
                     {"ns_a_pixel", 1e6 * point.of(stage).ms / point.pixels},
                     {"error", nullptr},
                     {"unit", nullptr}});
            }
            const PowerLaw law = fit_power_law(sweep, stage, threads);
            effects.push_back({{"name", fmt::format("sweep: {}", to_string(stage))},
                               {"threads", threads},
                               {"slope", law.slope},
                               {"r2", law.r2},
                               {"dearest_over_cheapest_pixel", law.spread},
                               {"levels", levels}});
        }
    }
    return effects;
}

Json json_of(const std::vector<LedgerEffect>& benched) {
    Json effects = Json::array();
    for (const LedgerEffect& effect : benched) {
        Json levels = Json::array();
        for (const LedgerLevel& level : effect.levels) {
            levels.push_back(
                {{"name", level.name},
                 {"ms", level.repeats > 0 ? Json(level.ms) : Json(nullptr)},
                 {"fastest_ms", level.repeats > 0 ? Json(level.fastest_ms) : Json(nullptr)},
                 {"repeats", level.repeats},
                 {"p95_ms", level.p95_ms ? Json(*level.p95_ms) : Json(nullptr)},
                 {"longest_ms", level.longest_ms ? Json(*level.longest_ms) : Json(nullptr)},
                 {"work_items", level.work_items},
                 {"error", level.error ? Json(*level.error) : Json(nullptr)},
                 {"p95", level.error_p95 ? Json(*level.error_p95) : Json(nullptr)},
                 {"p99", level.error_p99 ? Json(*level.error_p99) : Json(nullptr)},
                 {"swap_ms", level.swap_ms ? Json(*level.swap_ms) : Json(nullptr)},
                 {"unit", level.error ? Json(level.unit) : Json(nullptr)},
                 {"against", level.against.empty() ? Json(nullptr) : Json(level.against)},
                 {"missing", level.missing.empty() ? Json(nullptr) : Json(level.missing)}});
        }
        effects.push_back({{"name", effect.name}, {"levels", levels}});
    }
    return effects;
}

Json json_of(const SpeedLedger& result) {
    Json effects = json_of(result.effects);
    for (Json& effect : json_of(result.sweep)) effects.push_back(std::move(effect));
    return {{"suite", "speed"},
            {"renderer", result.renderer},
            {"threads", result.threads},
            {"load_before", result.load_before},
            {"covered_fraction", result.covered_fraction},
            {"effects", effects}};
}

/// "2/8".
std::pair<int, int> parse_shard(const std::string& text) {
    const auto refuse = [&] {
        return std::invalid_argument(
            fmt::format("--shard: found \"{}\", expected I/N with I from 1 to N, as 1/2", text));
    };
    int shard = 0, shards = 0;
    char slash = 0, more = 0;
    std::istringstream words(text);
    if (!(words >> shard >> slash >> shards) || slash != '/' || words >> more) throw refuse();
    if (shards < 1 || shards > 1000 || shard < 1 || shard > shards) throw refuse();
    return {shard, shards};
}

}  // namespace

Command bench_command() {
    struct Arguments {
        std::string out, markdown, references, shard = "1/1", suite = "speed";
        bool quick = false;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "bench";
    command.summary =
        "time every stage on this machine, or measure what accuracy costs in time, how far what is "
        "drawn can be trusted, or what a wrong pose costs";
    command.example = "livery bench --suite speed --out bench";
    command.options = {
        {"--out",
         "DIR",
         "also write bench.json and the plots speed.svg and accuracy.svg there, pass-costs.json, "
         "accuracy.csv, accuracy.json, chain.csv, and effect-errors.json",
         &arguments->out},
        {"--markdown",
         "FILE",
         "also write its tables between the bench's marks in this file",
         &arguments->markdown},
        {"--quick",
         "",
         "some minutes at most: the sweep of two sizes and one quality, a hundredth of the inputs, "
         "the smallest and largest errors; predictions stay. costs: some seconds, in which the "
         "costs that come with the program are scaled to this machine",
         &arguments->quick},
        {"--references",
         "DIR",
         "accuracy: where traced pictures and rows are kept, to go on from and to share between "
         "shards (default: in the user's folder)",
         &arguments->references},
        {"--shard",
         "I/N",
         "accuracy: measure every N-th scene, from the I-th on; runs that share --references add "
         "up",
         &arguments->shard},
        {"--suite",
         "NAME",
         "costs (of passes: what predictions need), speed (those and every other stage), accuracy "
         "(each effect's error beside its time, and the rest of the chain's), "
         "chain (that rest alone), budget (whether predictions and "
         "chosen levels come true), stability (of what is drawn, where it loses most digits), "
         "geometry (what a wrong pose costs) or all (default speed)",
         &arguments->suite,
         false,
         {"costs", "speed", "stability", "accuracy", "chain", "budget", "geometry", "all"}},
    };
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        const auto wanted = [&](const char* suite) {
            return arguments->suite == suite || arguments->suite == "all";
        };
        // What cannot be written is found before the work.
        check_argument(arguments->markdown.empty() ||
                           (arguments->suite != "all" && arguments->suite != "costs"),
                       "--markdown writes one suite's tables: choose one that has some");
        const std::filesystem::path out = arguments->out;
        const auto kept = pass_costs_file();
        if (!out.empty()) make_output_folder(out);
        if (!arguments->markdown.empty()) check_marked_block(arguments->markdown, "bench");
        const auto seed = static_cast<std::uint64_t>(common.seed);
        Outcome outcome;
        std::string markdown, plot;
        if (arguments->suite == "costs") {
            const PassCosts costs = arguments->quick ? measure_machine(common.gl_device(), progress)
                                                     : measure_costs(common.gl_device(), progress);
            write_pass_costs(kept, costs);
            outcome.figures = {{"renderer", costs.renderer},
                               {"threads", costs.threads},
                               {"predicted_from", to_string(costs.origin)}};
            outcome.text =
                arguments->quick
                    ? "The costs that come with the program are scaled to this machine.\n"
                    : fmt::format("{} costs of passes are timed.\n", costs.passes.size());
            if (!out.empty()) write_pass_costs(out / "pass-costs.json", costs);
        }
        if (wanted("speed")) {
            const SpeedLedger result =
                measure_speed(common.gl_device(), arguments->quick, progress);
            if (!arguments->quick) write_pass_costs(kept, costs_of(result));
            outcome.figures = json_of(result);
            markdown = markdown_of(result);
            plot = sweep_svg(result.sweep);
        }
        const auto add = [&](const auto& result) {
            outcome.figures["renderer"] = result.renderer;
            for (Json& effect : json_of(effects_of(result))) {
                outcome.figures["effects"].push_back(std::move(effect));
            }
            markdown += markdown_of(result);
        };
        std::string accuracy_plot, accuracy_csv, chain_csv;
        EffectErrors errors;
        AccuracyLedger accuracy;
        const auto accuracy_options = [&] {
            AccuracyOptions options;
            options.device = common.gl_device();
            options.quick = arguments->quick;
            options.folder = arguments->references.empty()
                                 ? accuracy_folder()
                                 : std::filesystem::path(arguments->references);
            options.seed = seed;
            std::tie(options.shard, options.shards) = parse_shard(arguments->shard);
            return options;
        };
        if (wanted("accuracy")) {
            const AccuracyLedger ledger = measure_accuracy(accuracy_options(), progress);
            add(ledger);
            accuracy_plot = plot_of(ledger);
            errors = errors_of(ledger.rows);
            // Those of one look would take the place of those of all
            if (!arguments->quick) write_effect_errors(effect_errors_file(), errors);
            if (ledger.missing == 0) write_accuracy(accuracy_file(), ledger);
            accuracy = ledger;
            accuracy_csv = csv_of(ledger);
        }
        const bool chain = wanted("accuracy") || arguments->suite == "chain";
        if (chain) {
            const ChainLedger ledger = measure_chain(accuracy_options(), progress);
            add(ledger);
            chain_csv = csv_of(ledger);
        }
        if (wanted("stability")) {
            add(measure_stability(common.gl_device(), arguments->quick, seed, progress));
        }
        if (wanted("budget")) {
            add(check_budget(common.gl_device(), arguments->quick, seed, progress));
        }
        if (wanted("geometry")) {
            add(measure_geometry_errors(common.gl_device(), arguments->quick, seed, progress));
        }
        outcome.figures["suite"] = arguments->suite;
        outcome.text += markdown;
        if (!out.empty()) {
            write_json_file(out / "bench.json", outcome.figures);
            if (wanted("speed")) write_text_file(out / "speed.svg", plot);
            if (wanted("accuracy")) {
                write_text_file(out / "accuracy.svg", accuracy_plot);
                write_text_file(out / "accuracy.csv", accuracy_csv);
                write_effect_errors(out / "effect-errors.json", errors);
                write_accuracy(out / "accuracy.json", accuracy);
            }
            if (chain) write_text_file(out / "chain.csv", chain_csv);
        }
        if (!arguments->markdown.empty())
            replace_marked_block(arguments->markdown, "bench", markdown);
        return outcome;
    };
    return command;
}

}  // namespace livery
