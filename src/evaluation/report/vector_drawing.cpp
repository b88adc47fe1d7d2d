#include "evaluation/report/vector_drawing.h"

#include <algorithm>

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

}  // namespace livery
