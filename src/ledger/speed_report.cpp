#include "ledger/speed_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "ledger/svg.h"

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
std::string laws(const std::vector<SweepPoint>& sweep) {
    std::string text =
        "| stage | threads | slope of the fit | R² | dearest pixel over cheapest |\n"
        "| --- | --- | --- | --- | --- |\n";
    for (const SwapStage stage : kSwapStages) {
        for (const int threads : threads_of(sweep)) {
            const PowerLaw law = fit_power_law(sweep, stage, threads);
            text += fmt::format("| {} | {} | {:.2f} | {:.3f} | {:.2f} |\n",
                                to_string(stage),
                                threads,
                                law.slope,
                                law.r2,
                                law.spread);
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

std::string markdown_of(const SpeedLedger& result) {
    return fmt::format(
        "Measured by `livery bench` on {} threads; OpenGL: {}. Times are medians in "
        "milliseconds, the fastest in brackets. Load of the machine when it began: {:.1f}.\n\n"
        "### Paint swap to projector input\n\n{}\n{}\n### Every stage\n\n{}",
        result.threads,
        result.renderer,
        result.load_before,
        sweep_table(result.sweep),
        laws(result.sweep),
        effects_table(result.effects));
}

namespace {

constexpr double kPlotLeft = 78.0, kPlotRight = 742.0, kPlotTop = 96.0, kPlotBottom = 548.0;
constexpr double kLabelHeight = 40.0, kRefresh_ms = 1000.0 / 60.0;

struct PlottedSeries {
    SwapStage stage;
    int threads;
    const char* colour;
    bool hollow;  ///< with a broken line
    std::string name;
    PowerLaw law;
    double label_px = 0.0;
};

std::string grid(const LogAxis& x, const LogAxis& y) {
    std::string svg = svg_grid(x, y, "pixels of the mock-up in the projector's picture", "ms");
    if (kRefresh_ms > y.low && kRefresh_ms < y.high) {
        const double at = y.at(kRefresh_ms);
        svg += svg_line(kPlotLeft,
                        at,
                        kPlotRight,
                        at,
                        "stroke=\"#b3261e\" stroke-width=\"1\" stroke-dasharray=\"2 4\"");
        svg += svg_text(
            kPlotLeft + 8.0, at - 6.0, "one refresh at 60 Hz", "font-size=\"12\" fill=\"#b3261e\"");
    }
    return svg;
}

std::string draw(const PlottedSeries& series,
                 const std::vector<SweepPoint>& sweep,
                 const LogAxis& x,
                 const LogAxis& y) {
    double first = x.high, last = x.low;
    std::string marks;
    for (const SweepPoint& point : sweep) {
        if (point.threads != series.threads) continue;
        first = std::min(first, point.pixels);
        last = std::max(last, point.pixels);
        marks += fmt::format(
            "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\" stroke=\"{}\" "
            "stroke-width=\"1.6\"/>\n",
            x.at(point.pixels),
            y.at(std::max(point.of(series.stage).ms, y.low)),
            series.stage == SwapStage::whole ? 4.2 : 3.2,
            series.hollow ? "#ffffff" : series.colour,
            series.colour);
    }
    const auto fitted = [&](double pixels) {
        return series.law.scale * std::pow(pixels, series.law.slope);
    };
    const std::string style =
        fmt::format("stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\"{}",
                    series.colour,
                    series.stage == SwapStage::whole ? 2.0 : 1.4,
                    series.hollow ? " stroke-dasharray=\"1 5\"" : "");
    std::string svg =
        svg_line(x.at(first), y.at(fitted(first)), x.at(last), y.at(fitted(last)), style) + marks;
    const double end = y.at(fitted(last));
    svg += fmt::format(
        "<path d=\"M{:.1f} {:.1f} L{:.1f} {:.1f} L{:.1f} {:.1f}\" fill=\"none\" stroke=\"{}\" "
        "stroke-width=\"0.8\" opacity=\"0.6\"/>\n",
        x.at(last) + 8.0,
        end,
        kPlotRight + 6.0,
        series.label_px,
        kPlotRight + 14.0,
        series.label_px,
        series.colour);
    svg += svg_text(kPlotRight + 20.0,
                    series.label_px - 2.0,
                    series.name,
                    fmt::format("font-size=\"14\" font-weight=\"600\" fill=\"{}\"", series.colour));
    svg += svg_text(kPlotRight + 20.0,
                    series.label_px + 15.0,
                    fmt::format("{:.1f} ns a pixel · slope {:.2f} · R² {:.3f}",
                                series.law.typical_ns,
                                series.law.slope,
                                series.law.r2),
                    "font-size=\"12\" class=\"soft\"");
    return svg;
}

/// Labels beside the ends of their lines, none over another.
void place_labels(std::vector<PlottedSeries>& all, const LogAxis& y, double pixels) {
    for (PlottedSeries& series : all) {
        series.label_px = y.at(series.law.scale * std::pow(pixels, series.law.slope));
    }
    std::sort(all.begin(), all.end(), [](const PlottedSeries& a, const PlottedSeries& b) {
        return a.label_px < b.label_px;
    });
    double free_from = kPlotTop + 6.0;
    for (PlottedSeries& series : all) {
        series.label_px = std::max(series.label_px, free_from);
        free_from = series.label_px + kLabelHeight;
    }
}

}  // namespace

std::string sweep_svg(const std::vector<SweepPoint>& sweep) {
    check_argument(!sweep.empty(), "a plot of no points");
    const std::vector<int> threads = threads_of(sweep);
    const int all_threads = threads.back();
    const auto named = [](SwapStage stage, int count) {
        return fmt::format("{}, {} {}",
                           stage == SwapStage::whole ? "whole swap" : to_string(stage),
                           count,
                           count == 1 ? "thread" : "threads");
    };
    std::vector<PlottedSeries> all;
    const auto add = [&](SwapStage stage, int count, const char* colour, bool hollow) {
        all.push_back({stage,
                       count,
                       colour,
                       hollow,
                       named(stage, count),
                       fit_power_law(sweep, stage, count),
                       0.0});
    };
    if (threads.size() > 1) add(SwapStage::whole, threads.front(), "#7a8494", true);
    add(SwapStage::whole, all_threads, kInk, false);
    add(SwapStage::shading, all_threads, "#0072b2", false);
    add(SwapStage::correction, all_threads, "#d55e00", false);
    add(SwapStage::mixing, all_threads, "#009e73", false);

    LogAxis x{1e12, 0.0, kPlotLeft, kPlotRight - 14.0}, y{1e12, 0.0, kPlotBottom, kPlotTop};
    for (const SweepPoint& point : sweep) {
        x.low = std::min(x.low, point.pixels);
        x.high = std::max(x.high, point.pixels);
        for (const SweepTime& time : point.times) {
            if (time.ms > 0.0) y.low = std::min(y.low, time.ms);
            y.high = std::max(y.high, time.ms);
        }
    }
    x.low /= 1.3;
    x.high *= 1.3;
    y.low /= 1.5;
    y.high *= 1.5;
    place_labels(all, y, x.high / 1.3);

    const auto [smallest, largest] = std::minmax_element(
        sweep.begin(), sweep.end(), [](const SweepPoint& a, const SweepPoint& b) {
            return a.width * a.height < b.width * b.height;
        });
    std::string svg = svg_begin(
        "Paint swap to projector input, against the mock-up's pixels",
        fmt::format(
            "Projectors of {}×{} to {}×{}, the mock-up on 1 to 60% of the picture; each point the "
            "median of {} swaps",
            smallest->width,
            smallest->height,
            largest->width,
            largest->height,
            sweep.front().repeats));
    svg += grid(x, y);
    for (const PlottedSeries& series : all) svg += draw(series, sweep, x, y);
    return svg + svg_end();
}

}  // namespace livery
