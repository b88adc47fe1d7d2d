#include "evaluation/report/chart_frame.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace livery {

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
