#include "core/grade.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace livery {

std::string to_string(Grade grade) {
    switch (grade) {
        case Grade::good:
            return "Good";
        case Grade::usable:
            return "Usable";
        case Grade::bad:
            return "Bad";
    }
    throw std::invalid_argument("unknown grade");
}

Grade grade_of(double value, double good, double usable) {
    if (!std::isfinite(value)) return Grade::bad;
    const double sign = good > usable ? -1.0 : 1.0;
    if (sign * value < sign * good) return Grade::good;
    return sign * value < sign * usable ? Grade::usable : Grade::bad;
}

GradedFigure graded_share(std::string name,
                          double value,
                          double good,
                          double usable,
                          std::string meaning,
                          std::string fix) {
    const char* word = good > usable ? "over" : "under";
    return {std::move(name),
            fmt::format("{:.1f} %", 100.0 * value),
            fmt::format("good {0} {1:g} %, usable {0} {2:g} %", word, 100.0 * good, 100.0 * usable),
            std::move(meaning),
            std::move(fix),
            grade_of(value, good, usable)};
}

OverallGrade grade_of(const std::vector<GradedFigure>& figures) {
    const auto worst = std::max_element(
        figures.begin(), figures.end(), [](const GradedFigure& a, const GradedFigure& b) {
            return a.grade < b.grade;
        });
    if (worst == figures.end() || worst->grade == Grade::good) {
        return {Grade::good, "every figure is within its good range", ""};
    }
    return {worst->grade,
            fmt::format("{} {} ({})", worst->name, worst->value, worst->scale),
            worst->fix};
}

}  // namespace livery
