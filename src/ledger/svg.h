// Plots with logarithmic axes as SVG.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace livery {

inline constexpr const char* kInk = "#1d2430";

/// From `low` to `high` along the picture.
struct LogAxis {
    double low, high, begin_px, end_px;
    double at(double value) const;
};

/// Where an axis has a line: at 1, 2 and 5 of every decade.
struct LogTick {
    double value = 0.0;
    bool decade = false;  ///< a power of 10
};
std::vector<LogTick> ticks_of(const LogAxis& axis);

std::string svg_text(double x, double y, std::string_view words, std::string_view attributes);
std::string svg_line(double x1, double y1, double x2, double y2, std::string_view attributes);

/// White ground, a title and what it is of; classes minor, major, tick, name and soft.
std::string svg_begin(std::string_view title, std::string_view subtitle);
std::string svg_end();

/// Lines at every tick, and what the axes are.
std::string svg_grid(const LogAxis& x,
                     const LogAxis& y,
                     std::string_view x_name,
                     std::string_view y_name);

}  // namespace livery
