#include "evaluation/report/vector_drawing.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/utf8.h"

namespace livery {

namespace {

/// In ems; generous, since another font may stand in for Inter.
double em_width(char32_t point) {
    if (point < 0x80) {
        constexpr std::string_view narrow = "iljItf.,:;'|!()[] /-r";
        constexpr std::string_view wide = "mwMW@%&QOGD";
        const char c = static_cast<char>(point);
        if (narrow.find(c) != std::string_view::npos) return 0.40;
        if (wide.find(c) != std::string_view::npos) return 0.93;
        if (c >= 'A' && c <= 'Z') return 0.73;
        return 0.64;
    }
    // Combining marks stand over the letter before.
    if (point >= 0x300 && point < 0x370) return 0.0;
    return point < 0x590 ? 0.75 : 1.05;
}

std::vector<char32_t> points_of(std::string_view text) {
    std::vector<char32_t> points;
    while (!text.empty()) {
        const auto point = take_code_point(text);
        if (point) {
            points.push_back(*point);
        } else {
            text.remove_prefix(1);
            points.push_back(0xfffd);
        }
    }
    return points;
}

double width_of(const std::vector<char32_t>& points, double size, bool bold) {
    double ems = 0.0;
    for (const char32_t point : points) ems += em_width(point);
    return ems * size * (bold ? 1.06 : 1.0);
}

std::string text_of(const std::vector<char32_t>& points) {
    std::string text;
    for (const char32_t point : points) append_code_point(text, point);
    return text;
}

}  // namespace

DrawnShape drawn_box(double left, double top, double width, double height) {
    const double right = left + width, bottom = top + height;
    return {{{left, top}, {right, top}, {right, bottom}, {left, bottom}}};
}

void hatch(VectorDrawing& drawing,
           double left,
           double top,
           double width,
           double height,
           DrawingColour colour) {
    constexpr double spacing = 4.0;
    // Each line rises to the right by 45 degrees; what stands out of the box is left away.
    for (double start = spacing; start < width + height; start += spacing) {
        const double x1 = std::max(0.0, start - height), x2 = std::min(width, start);
        if (x2 - x1 < 0.2) continue;
        drawing.add(DrawnLine{
            {left + x1, top + (start - x1)}, {left + x2, top + (start - x2)}, colour, 0.9});
    }
}

double estimated_width(std::string_view text, double size, bool bold) {
    return width_of(points_of(text), size, bold);
}

std::vector<std::string> wrapped(std::string_view text,
                                 double size,
                                 double width,
                                 std::size_t most_lines) {
    std::vector<std::string> lines;
    std::vector<char32_t> rest = points_of(text);
    while (!rest.empty()) {
        std::size_t fit = 0, space = 0;
        double used = 0.0;
        while (fit < rest.size() && used + em_width(rest[fit]) * size <= width) {
            used += em_width(rest[fit]) * size;
            if (rest[fit] == U' ') space = fit;
            ++fit;
        }
        fit = std::max<std::size_t>(fit, 1);
        if (fit < rest.size() && lines.size() + 1 == most_lines) {
            std::vector<char32_t> last(rest.begin(),
                                       rest.begin() + static_cast<std::ptrdiff_t>(fit));
            const double dots = em_width(U'…') * size;
            while (last.size() > 1 && width_of(last, size, false) + dots > width) last.pop_back();
            while (last.size() > 1 && last.back() == U' ') last.pop_back();
            last.push_back(U'…');
            lines.push_back(text_of(last));
            return lines;
        }
        const std::size_t end = fit == rest.size() ? fit : space > 0 ? space : fit;
        lines.push_back(text_of({rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(end)}));
        std::size_t next = end;
        while (next < rest.size() && rest[next] == U' ') ++next;
        rest.erase(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(next));
    }
    return lines;
}

namespace {

constexpr double kLabelSize = 9.0, kTickSize = 8.0, kAxisHeight = 34.0;

}  // namespace

double ChartAxis::at(double value) const {
    const double part =
        logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return left + (right - left) * part;
}

ChartFrame begin_rows(VectorDrawing& drawing,
                      const ChartRows& rows,
                      double top,
                      double right_margin) {
    constexpr double widest = 132.0, gap = 10.0;
    const std::size_t count = rows.order.size();
    const bool close = count > 10;
    double label_width = 30.0;
    for (const std::string& label : rows.labels) {
        label_width = std::max(label_width, estimated_width(label, kLabelSize));
    }
    label_width = std::min(label_width, widest);
    ChartFrame frame;
    frame.left = label_width + gap;
    frame.right = drawing.width - right_margin;
    frame.top = top;
    frame.row_height = close ? 17.0 : 28.0;
    frame.rows = static_cast<double>(count);
    for (std::size_t row = 0; row < count; ++row) {
        const auto lines = wrapped(rows.labels[static_cast<std::size_t>(rows.order[row])],
                                   kLabelSize,
                                   label_width,
                                   close ? 1 : 2);
        constexpr double line_height = 11.0;
        double y =
            frame.middle(row) + 3.2 - 0.5 * line_height * (static_cast<double>(lines.size()) - 1.0);
        for (const std::string& line : lines) {
            drawing.add(DrawnText{{0.0, y}, line, kLabelSize});
            y += line_height;
        }
    }
    drawing.height = frame.bottom() + kAxisHeight;
    return frame;
}

std::vector<ChartTick> linear_ticks(double low, double high, int most, bool whole) {
    const double span = std::max(high - low, 1e-9);
    double step = std::pow(10.0, std::floor(std::log10(span / most)));
    for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
        if (span / (step * factor) <= most) {
            step *= factor;
            break;
        }
    }
    if (whole) step = std::max(step, 1.0);
    std::vector<ChartTick> ticks;
    for (double value = std::ceil(low / step - 1e-9) * step; value <= high + 1e-9 * span;
         value += step) {
        // Never "-0".
        const double tick = std::abs(value) < 1e-9 * span ? 0.0 : value;
        ticks.push_back({tick, fmt::format("{:g}", tick)});
    }
    return ticks;
}

void draw_axis(VectorDrawing& drawing,
               const ChartFrame& frame,
               const ChartAxis& axis,
               const std::vector<ChartTick>& ticks,
               const std::string& name) {
    for (const ChartTick& tick : ticks) {
        const double x = axis.at(tick.value);
        drawing.add(DrawnLine{{x, frame.top}, {x, frame.bottom()}, kGridColour, 0.7});
        drawing.add(DrawnText{
            {x, frame.bottom() + 12.0}, tick.label, kTickSize, TextAnchor::middle, kSoftInkColour});
    }
    drawing.add(DrawnLine{
        {frame.left, frame.bottom()}, {frame.right, frame.bottom()}, kSoftInkColour, 0.7});
    drawing.add(DrawnText{{0.5 * (frame.left + frame.right), frame.bottom() + 26.0},
                          name,
                          kTickSize,
                          TextAnchor::middle,
                          kSoftInkColour});
}

double legend_entry(VectorDrawing& drawing,
                    double x,
                    double y,
                    const std::string& name,
                    DrawingColour fill,
                    bool hatched) {
    constexpr double side = 9.0, text_size = 8.5;
    DrawnShape patch = drawn_box(x, y - side + 1.0, side, side);
    if (hatched) {
        patch.fill = kPaperColour;
        drawing.add(patch);
        hatch(drawing, x, y - side + 1.0, side, side, fill);
        patch.fill.reset();
        patch.stroke = fill;
        patch.width = 0.8;
    } else {
        patch.fill = fill;
    }
    drawing.add(patch);
    drawing.add(DrawnText{{x + side + 5.0, y}, name, text_size});
    return x + side + 5.0 + estimated_width(name, text_size) + 12.0;
}

}  // namespace livery
