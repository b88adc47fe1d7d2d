#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "ledger/accuracy/accuracy.h"
#include "ledger/svg.h"

namespace livery {

namespace {

constexpr double kLeft = 78.0, kRight = 760.0, kTop = 96.0, kBottom = 548.0;

struct Mark {
    const AccuracyLevel* level;
    double x = 0.0, y = 0.0;
    bool on_front = false;  ///< nothing is as quick and as near
};

std::vector<Mark> marks_of(const std::vector<AccuracyLevel>& levels,
                           const LogAxis& x,
                           const LogAxis& y) {
    std::vector<Mark> marks;
    const std::vector<bool> on_front = front_of(levels);
    for (std::size_t k = 0; k < levels.size(); ++k) {
        marks.push_back({&levels[k], x.at(levels[k].solve_ms), y.at(levels[k].p95), on_front[k]});
    }
    return marks;
}

std::string front_line(std::vector<Mark> marks) {
    std::erase_if(marks, [](const Mark& mark) { return !mark.on_front; });
    std::sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.x < b.x; });
    std::string path;
    for (const Mark& mark : marks) {
        path += fmt::format("{}{:.1f} {:.1f} ", path.empty() ? "M" : "L", mark.x, mark.y);
    }
    return "<path d=\"" + path +
           "\" fill=\"none\" stroke=\"#1f6f5c\" stroke-width=\"2\" stroke-linejoin=\"round\"/>\n";
}

bool is_quality(const AccuracyLevel& level) { return level.effect == kQualityRows; }

std::string label_of(const AccuracyLevel& level) {
    return is_quality(level) ? level.level : level.effect + ": " + level.level;
}

std::string dot_of(const Mark& mark) {
    const bool quality = is_quality(*mark.level);
    return fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\" stroke=\"#ffffff\"/>\n",
        mark.x,
        mark.y,
        quality ? 6.5 : 4.5,
        quality         ? "#b3261e"
        : mark.on_front ? "#1f6f5c"
                        : "#7a8494");
}

/// Beside their marks as far as none lies over another, nor below the picture; orders the marks.
std::vector<double> label_places(std::vector<Mark>& marks) {
    constexpr double kLine = 15.0;
    std::sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.y < b.y; });
    std::vector<double> places;
    for (const Mark& mark : marks) {
        places.push_back(places.empty() ? mark.y : std::max(mark.y, places.back() + kLine));
    }
    double lowest = kBottom + kLine;
    for (std::size_t k = places.size(); k-- > 0; lowest = places[k] - kLine) {
        places[k] = std::min(places[k], lowest);
    }
    return places;
}

}  // namespace

std::string plot_of(const AccuracyLedger& ledger) {
    const std::vector<AccuracyLevel> levels = levels_of(ledger);
    std::string svg = svg_begin(
        "What accuracy costs",
        fmt::format("One level of one effect lowered, all others at their dearest, and the three "
                    "qualities; {}, {} threads, 640x400",
                    ledger.renderer,
                    ledger.threads));
    if (levels.empty()) return svg + svg_end();
    const auto [quickest, slowest] =
        std::minmax_element(levels.begin(), levels.end(), [](const auto& a, const auto& b) {
            return a.solve_ms < b.solve_ms;
        });
    const auto [nearest, farthest] = std::minmax_element(
        levels.begin(), levels.end(), [](const auto& a, const auto& b) { return a.p95 < b.p95; });
    const LogAxis x{0.8 * std::max(quickest->solve_ms, 1.0),
                    1.3 * std::max(slowest->solve_ms, 2.0),
                    kLeft,
                    kRight};
    const LogAxis y{
        0.8 * std::max(nearest->p95, 0.01), 1.3 * std::max(farthest->p95, 0.02), kBottom, kTop};
    svg += svg_grid(
        x, y, "milliseconds that a new light takes", "CIEDE2000, worst 95th percentile of a scene");
    std::vector<Mark> marks = marks_of(levels, x, y);
    svg += front_line(marks);
    for (const Mark& mark : marks) svg += dot_of(mark);
    // Labels of the front, of qualities and of what is left out altogether
    std::erase_if(marks, [](const Mark& mark) {
        return !is_quality(*mark.level) && !mark.on_front && mark.level->index != 0;
    });
    const std::vector<double> places = label_places(marks);
    for (std::size_t k = 0; k < marks.size(); ++k) {
        svg += svg_text(kRight + 18.0,
                        places[k] + 4.0,
                        label_of(*marks[k].level),
                        is_quality(*marks[k].level) ? "font-size=\"12\" font-weight=\"600\""
                                                    : "font-size=\"12\"");
        svg += svg_line(marks[k].x + 7.0,
                        marks[k].y,
                        kRight + 14.0,
                        places[k],
                        "stroke=\"#c4cad3\" stroke-width=\"0.7\"");
    }
    return svg + svg_end();
}

}  // namespace livery
