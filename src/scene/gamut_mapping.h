// Which colours the mock-up is to show, and what becomes of those that it cannot.
#pragma once

#include <stdexcept>
#include <string>

namespace livery {

/// Of the brightest neutrals that its pixels can show, the one that is white unless somebody says
/// otherwise: four pixels of five show it.
inline constexpr double kDesignWhitePercentile = 20.0;

/// strict: each channel is cut off, whatever else can be shown is exact. preserve: the hue stays,
/// chroma gives way before lightness, and what lies just inside the gamut makes room.
enum class GamutMapping { strict, preserve };

inline std::string to_string(GamutMapping mapping) {
    return mapping == GamutMapping::preserve ? "preserve" : "strict";
}

/// Throws std::invalid_argument with the names.
inline GamutMapping parse_gamut_mapping(const std::string& text) {
    if (text == "strict") return GamutMapping::strict;
    if (text == "preserve") return GamutMapping::preserve;
    throw std::invalid_argument("gamut mapping \"" + text + "\", expected strict or preserve");
}

}  // namespace livery
