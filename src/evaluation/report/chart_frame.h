// What the charts have in common: rows with labels, and axes.
#pragma once

#include <string>
#include <vector>

#include "evaluation/report/vote_charts.h"

namespace livery {

inline constexpr double kFigureSize = 8.5;  ///< of a chart's figures, in points

/// A value's place between two ends; logarithmic where it says so.
struct ChartAxis {
    double low = 0.0, high = 1.0, left = 0.0, right = 1.0;
    bool logarithmic = false;
    double at(double value) const;
};

/// Rows of labels at the left of a drawing; the rest is the plot.
struct ChartFrame {
    double left = 0.0, right = 0.0, top = 0.0, row_height = 0.0;
    double bottom() const { return top + row_height * rows; }
    double middle(std::size_t row) const {
        return top + row_height * (static_cast<double>(row) + 0.5);
    }
    double rows = 0.0;
};

/// Draws the labels and sets the drawing's height; below the rows is room for an axis, at the right
/// for `right_margin`.
ChartFrame begin_rows(VectorDrawing& drawing,
                      const ChartRows& rows,
                      double top,
                      double right_margin);

struct ChartTick {
    double value = 0.0;
    std::string label;
};
/// 0 or `low` to `high` in steps of 1, 2 or 5 times a power of ten, at most `most` of them.
std::vector<ChartTick> linear_ticks(double low, double high, int most, bool whole);
/// Grid lines over the rows, labels below, and what the axis is of.
void draw_axis(VectorDrawing& drawing,
               const ChartFrame& frame,
               const ChartAxis& axis,
               const std::vector<ChartTick>& ticks,
               const std::string& name);

/// A patch with its name; gives where the next may begin.
double legend_entry(VectorDrawing& drawing,
                    double x,
                    double y,
                    const std::string& name,
                    DrawingColour fill,
                    bool hatched);

}  // namespace livery
