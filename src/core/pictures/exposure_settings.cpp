#include "core/pictures/exposure_settings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace livery {

namespace {

/// The same number as a ratio and as a decimal of two digits.
constexpr double kRounding = 0.01;

bool differ(double a, double b) {
    return a > 0.0 && b > 0.0 && std::abs(a - b) > kRounding * std::max(a, b);
}

double log2_ratio(double a, double b) { return a > 0.0 && b > 0.0 ? std::log2(a / b) : 0.0; }

}  // namespace

bool are_exposed_otherwise(const ExposureSettings& a, const ExposureSettings& b) {
    return differ(a.time_s, b.time_s) || differ(a.f_number, b.f_number) || differ(a.iso, b.iso);
}

double stops_over(const ExposureSettings& a, const ExposureSettings& b) {
    return log2_ratio(a.time_s, b.time_s) + log2_ratio(a.iso, b.iso) -
           2.0 * log2_ratio(a.f_number, b.f_number);
}

std::string text_of(const ExposureSettings& settings) {
    std::string text;
    const auto add = [&](const std::string& value) { text += (text.empty() ? "" : ", ") + value; };
    // As dials have it: from 0.3 s on in seconds
    if (settings.time_s >= 0.3) add(fmt::format("{:.3g} s", settings.time_s));
    if (settings.time_s > 0.0 && settings.time_s < 0.3)
        add(fmt::format("1/{:.0f} s", 1.0 / settings.time_s));
    if (settings.f_number > 0.0) add(fmt::format("f/{:.3g}", settings.f_number));
    if (settings.iso > 0.0) add(fmt::format("ISO {:.0f}", settings.iso));
    return text;
}

}  // namespace livery
