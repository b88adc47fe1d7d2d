#include "mesh/length_unit.h"

#include <array>

#include <fmt/format.h>

namespace livery {

namespace {

constexpr std::array kUnits{LengthUnit::mm, LengthUnit::cm, LengthUnit::m, LengthUnit::in};
/// Longest sides of products: from a key fob to a van.
constexpr double kSmallestProduct_mm = 50.0, kLargestProduct_mm = 6000.0;
/// Numbers whose largest extent is below this are metres: nobody scans a product of 20 mm.
constexpr double kMetresBelow = 20.0;

bool is_product(double size_mm) {
    return size_mm >= kSmallestProduct_mm && size_mm <= kLargestProduct_mm;
}

std::string size_text(double size_mm) {
    return size_mm < 1000.0 ? fmt::format("{:.3g} mm", size_mm)
                            : fmt::format("{:.3g} m", size_mm / 1000.0);
}

}  // namespace

const char* to_string(LengthUnit unit) {
    constexpr std::array names{"mm", "cm", "m", "in"};
    return names[static_cast<std::size_t>(unit)];
}

double mm_per(LengthUnit unit) {
    constexpr std::array sizes{1.0, 10.0, 1000.0, 25.4};
    return sizes[static_cast<std::size_t>(unit)];
}

std::optional<LengthUnit> parse_length_unit(std::string_view text) {
    for (const LengthUnit unit : kUnits) {
        if (text == to_string(unit)) return unit;
    }
    return std::nullopt;
}

UnitGuess guess_unit(double longest_side) {
    UnitGuess guess;
    guess.unit = longest_side < kMetresBelow ? LengthUnit::m : LengthUnit::mm;
    const double size_mm = longest_side * mm_per(guess.unit);
    guess.why = fmt::format("the file states no unit; its longest side of {:.4g} is taken as {}",
                            longest_side,
                            size_text(size_mm));
    std::string others;
    for (const LengthUnit unit : kUnits) {
        const double other_mm = longest_side * mm_per(unit);
        if (unit == guess.unit || !is_product(other_mm)) continue;
        others += fmt::format(
            "{}{} ({})", others.empty() ? "" : ", ", size_text(other_mm), to_string(unit));
    }
    if (!others.empty()) {
        guess.why += fmt::format(", but this is ambiguous: it could be {}; --unit decides", others);
    } else if (!is_product(size_mm)) {
        guess.why += ", an unusual size for a product; --unit decides";
    }
    return guess;
}

}  // namespace livery
