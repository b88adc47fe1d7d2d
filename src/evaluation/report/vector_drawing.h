// A drawing as marks, without knowing who writes it: what a report's charts are made of, and what
// they have in common, rows with labels and axes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace livery {

using DrawingColour = std::uint32_t;  ///< 0xRRGGBB, sRGB

// Of contrast 4.5 or more on white, and each a grey of its own on a printer that has no colours.
inline constexpr DrawingColour kInkColour = 0x1d2430, kSoftInkColour = 0x545d6b,
                               kGridColour = 0xd9dee5, kPaperColour = 0xffffff;
inline constexpr DrawingColour kStrongColour = 0x123a63, kMiddleColour = 0x7fb0d8,
                               kFaintColour = 0xe6eef6, kWarmColour = 0xa4480f;

struct DrawingPoint {
    double x = 0.0, y = 0.0;  ///< typographic points, y goes down
};

struct DrawnLine {
    DrawingPoint from, to;
    DrawingColour colour = kInkColour;
    double width = 1.0;
    double dash = 0.0;  ///< length of dashes and gaps; 0: none
};

struct DrawnShape {
    std::vector<DrawingPoint> points;  ///< closed
    std::optional<DrawingColour> fill = {}, stroke = {};
    double width = 1.0;
};

struct DrawnDot {
    DrawingPoint centre;
    double radius = 3.0;
    std::optional<DrawingColour> fill = {}, stroke = {};
    double width = 1.2;
};

enum class TextAnchor { start, middle, end };

/// One line; `at` is on its baseline.
struct DrawnText {
    DrawingPoint at;
    std::string text;
    double size = 9.0;
    TextAnchor anchor = TextAnchor::start;
    DrawingColour colour = kInkColour;
    bool bold = false;
};

struct VectorDrawing {
    double width = 482.0, height = 0.0;  ///< the text's width on A4
    std::vector<std::variant<DrawnLine, DrawnShape, DrawnDot, DrawnText>> marks = {};

    template <typename Mark>
    void add(Mark mark) {
        marks.emplace_back(std::move(mark));
    }
};

DrawnShape drawn_box(double left, double top, double width, double height);
/// Slanted lines that fill a box, as on a map.
void hatch(VectorDrawing& drawing,
           double left,
           double top,
           double width,
           double height,
           DrawingColour colour);

/// How wide a line of a sans serif of that size is at most, in whatever such font is at hand:
/// nothing is measured, so that a file is the same on every machine.
double estimated_width(std::string_view text, double size, bool bold = false);

/// The text in lines of at most `width`, broken at spaces or, where there are none, anywhere; the
/// last of `most_lines` ends with "…" where more is left.
std::vector<std::string> wrapped(std::string_view text,
                                 double size,
                                 double width,
                                 std::size_t most_lines);

inline constexpr double kFigureSize = 8.5;  ///< of a chart's figures, in points

/// A value's place between two ends; logarithmic where it says so.
struct ChartAxis {
    double low = 0.0, high = 1.0, left = 0.0, right = 1.0;
    bool logarithmic = false;
    double at(double value) const;
};

/// Each design has a row of its own, in an order and under labels that are the same in all charts
/// and tables.
struct ChartRows {
    std::vector<int> order;           ///< designs, first row first
    std::vector<std::string> labels;  ///< of each design
    std::vector<std::string> keys;    ///< of each design, a few letters
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
