// A drawing as marks, without knowing who writes it: what a report's charts are made of.
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

}  // namespace livery
