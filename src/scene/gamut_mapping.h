// What becomes of colours that the mock-up cannot show.
#pragma once

#include <stdexcept>
#include <string>

namespace livery {

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
