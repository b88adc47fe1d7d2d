#include "ledger/speed_plot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "ledger/svg.h"

namespace livery {
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
