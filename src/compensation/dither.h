// The dither's constants, shared by the kernels. An additive lattice (Roberts' R2 sequence): any
// few neighbouring pixels hold evenly spread thresholds, and it is exact in 32-bit integers. The
// three channels share a pixel's threshold: what cutting to whole levels adds is then mostly
// lightness, to which the eye is far less sensitive in dark paints than to chroma.
#pragma once

#include <array>
#include <cstdint>

namespace livery::dither {

inline constexpr std::uint32_t kPerColumn = 3242174889u;  ///< 2^32 / 1.32471795724...
inline constexpr std::uint32_t kPerRow = 2447445414u;     ///< 2^32 / 1.32471795724...^2

/// In [0, 1): what is added before cutting to whole levels.
inline float threshold(std::uint32_t phase) {
    return static_cast<float>(static_cast<std::int32_t>(phase >> 8u)) * 0x1p-24f;
}

}  // namespace livery::dither
