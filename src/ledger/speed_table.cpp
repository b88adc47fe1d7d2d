#include "ledger/speed_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace livery {
namespace {

std::string size_of(const SweepPoint& point) {
    return fmt::format("{}x{}", point.width, point.height);
}

std::string thousands(double value) { return fmt::format("{:.0f}k", value / 1000.0); }

const SweepPoint* point_of(const std::vector<SweepPoint>& sweep,
                           const SweepPoint& like,
                           int threads) {
    const auto found = std::find_if(sweep.begin(), sweep.end(), [&](const SweepPoint& point) {
        return point.width == like.width && point.height == like.height &&
               point.pixels == like.pixels && point.threads == threads;
    });
    return found == sweep.end() ? nullptr : &*found;
}

/// What the fits say, a line a stage.
std::string laws(const std::vector<SweepPoint>& sweep, bool markdown) {
    std::string text =
        markdown
            ? "| stage | threads | slope of the fit | R² | dearest pixel over cheapest |\n"
              "| --- | --- | --- | --- | --- |\n"
            : "ms against the mock-up's pixels, both logarithmic: threads, slope of the fit, R2, "
              "dearest pixel over cheapest\n";
    for (const SwapStage stage : kSwapStages) {
        for (const int threads : threads_of(sweep)) {
            const PowerLaw law = fit_power_law(sweep, stage, threads);
            text += fmt::format("{}{:<30} | {} | {:.2f} | {:.3f} | {:.2f}{}\n",
                                markdown ? "| " : "  ",
                                to_string(stage),
                                threads,
                                law.slope,
                                law.r2,
                                law.spread,
                                markdown ? " |" : "");
        }
    }
    return text;
}

std::string sweep_table(const std::vector<SweepPoint>& sweep) {
    const std::vector<int> threads = threads_of(sweep);
    const int all = threads.back();
    std::string text = fmt::format(
        "| projector | mock-up | its pixels | shading | mixing | correction | swap, {} threads | "
        "swap, one | ns a pixel |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        all);
    for (const SweepPoint& point : sweep) {
        if (point.threads != all) continue;
        const SweepPoint* one = point_of(sweep, point, threads.front());
        const double ms = point.of(SwapStage::whole).ms;
        text += fmt::format(
            "| {} | {:.0f}% | {} | {:.2f} | {:.2f} | {:.2f} | **{:.2f}** ({:.2f}) | {:.2f} | "
            "{:.1f} |\n",
            size_of(point),
            100.0 * point.coverage,
            thousands(point.pixels),
            point.of(SwapStage::shading).ms,
            point.of(SwapStage::mixing).ms,
            point.of(SwapStage::correction).ms,
            ms,
            point.of(SwapStage::whole).fastest_ms,
            one->of(SwapStage::whole).ms,
            1e6 * ms / point.pixels);
    }
    return text;
}

std::string milliseconds(double ms) {
    return ms >= 1000.0 ? fmt::format("{:.2f} s", ms / 1000.0) : fmt::format("{:.1f}", ms);
}

std::string effects_table(const std::vector<LedgerEffect>& effects) {
    std::string text =
        "| stage | of | median (fastest) ms | 95% | longest | runs |\n| --- | --- | --- | --- | "
        "--- | --- |\n";
    for (const LedgerEffect& effect : effects) {
        for (const LedgerLevel& level : effect.levels) {
            const auto optional = [](const std::optional<double>& ms) {
                return ms ? milliseconds(*ms) : std::string();
            };
            const std::string error =
                level.error ? fmt::format(", error {:.4f}", *level.error) : std::string();
            text += fmt::format("| {} | {} | {} ({}) | {} | {} | {} |\n",
                                effect.name,
                                level.name + error,
                                milliseconds(level.ms),
                                milliseconds(level.fastest_ms),
                                optional(level.p95_ms),
                                optional(level.longest_ms),
                                level.repeats);
        }
    }
    return text;
}

}  // namespace

std::string text_of(const SpeedLedger& result) {
    std::string text =
        fmt::format("{}, {} threads; mock-up on {:.1f}% of 1280x800; median (fastest) ms\n",
                    result.renderer,
                    result.threads,
                    100.0 * result.covered_fraction);
    for (const LedgerEffect& effect : result.effects) {
        text += effect.name + "\n";
        for (const LedgerLevel& level : effect.levels) {
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
    text += "paint swap to projector input\n";
    for (const SweepPoint& point : result.sweep) {
        const SweepTime& whole = point.of(SwapStage::whole);
        text += fmt::format("  {:<10}{:5.1f}% {} threads {:10.2f} ({:.2f}), {:.1f} ns a pixel\n",
                            size_of(point),
                            100.0 * point.coverage,
                            point.threads,
                            whole.ms,
                            whole.fastest_ms,
                            1e6 * whole.ms / point.pixels);
    }
    return text + laws(result.sweep, false);
}

std::string markdown_of(const SpeedLedger& result) {
    return fmt::format(
        "Measured by `livery bench` on {} threads; OpenGL: {}. Times are medians in "
        "milliseconds, the fastest in brackets. Load of the machine when it began: {:.1f}.\n\n"
        "### Paint swap to projector input\n\n{}\n{}\n### Every stage\n\n{}",
        result.threads,
        result.renderer,
        result.load_before,
        sweep_table(result.sweep),
        laws(result.sweep, true),
        effects_table(result.effects));
}

}  // namespace livery
