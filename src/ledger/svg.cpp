#include "ledger/svg.h"

#include <cmath>

#include <fmt/format.h>

namespace livery {

namespace {

constexpr double kWidth = 1000.0, kHeight = 620.0, kTitleLeft = 28.0;
constexpr const char* kSoft = "#66707f";

/// 10 000 as 10k, 2 000 000 as 2M.
std::string short_number(double value) {
    if (value >= 1e6) return fmt::format("{:g}M", value / 1e6);
    if (value >= 1e3) return fmt::format("{:g}k", value / 1e3);
    return fmt::format("{:g}", value);
}

}  // namespace

double LogAxis::at(double value) const {
    return begin_px + (end_px - begin_px) * std::log(value / low) / std::log(high / low);
}

std::vector<LogTick> ticks_of(const LogAxis& axis) {
    std::vector<LogTick> ticks;
    for (double decade = std::pow(10.0, std::floor(std::log10(axis.low))); decade <= axis.high;
         decade *= 10.0) {
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double value = decade * digit;
            if (value < 0.999 * axis.low || value > 1.001 * axis.high) continue;
            ticks.push_back({value, digit == 1.0});
        }
    }
    return ticks;
}

std::string svg_text(double x, double y, std::string_view words, std::string_view attributes) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, attributes, words);
}

std::string svg_line(double x1, double y1, double x2, double y2, std::string_view attributes) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n",
                       x1,
                       y1,
                       x2,
                       y2,
                       attributes);
}

std::string svg_begin(std::string_view title, std::string_view subtitle) {
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\" "
        "font-family=\"Inter, 'Helvetica Neue', Arial, sans-serif\" fill=\"{2}\">\n"
        "<style>.minor{{stroke:#eceff3}}.major{{stroke:#d5dae1}}.tick{{font-size:12.5px;fill:{3}}}"
        ".name{{font-size:13.5px;fill:{3}}}.soft{{fill:{3}}}</style>\n"
        "<rect width=\"{0}\" height=\"{1}\" rx=\"10\" fill=\"#ffffff\"/>\n",
        kWidth,
        kHeight,
        kInk,
        kSoft);
    svg += svg_text(kTitleLeft, 38.0, title, "font-size=\"21\" font-weight=\"700\"");
    return svg + svg_text(kTitleLeft, 62.0, subtitle, "font-size=\"14\" class=\"soft\"");
}

std::string svg_end() { return "</svg>\n"; }

std::string svg_grid(const LogAxis& x,
                     const LogAxis& y,
                     std::string_view x_name,
                     std::string_view y_name) {
    std::string svg;
    const double left = x.begin_px, right = x.end_px, bottom = y.begin_px, top = y.end_px;
    for (const auto& [value, decade] : ticks_of(x)) {
        const double at = x.at(value);
        svg += svg_line(at, top, at, bottom, decade ? "class=\"major\"" : "class=\"minor\"");
        svg += svg_text(
            at, bottom + 22.0, short_number(value), "class=\"tick\" text-anchor=\"middle\"");
    }
    for (const auto& [value, decade] : ticks_of(y)) {
        const double at = y.at(value);
        svg += svg_line(left, at, right, at, decade ? "class=\"major\"" : "class=\"minor\"");
        svg += svg_text(left - 10.0,
                        at + 4.5,
                        fmt::format("{:g}", value),
                        "class=\"tick\" text-anchor=\"end\"");
    }
    svg += svg_text(
        0.5 * (left + right), bottom + 50.0, x_name, "class=\"name\" text-anchor=\"middle\"");
    return svg + svg_text(kTitleLeft, top - 14.0, y_name, "class=\"name\"");
}

}  // namespace livery
