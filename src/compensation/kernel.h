// The inner loops of compensate(), compiled for several instruction sets and chosen at run time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace livery::dither {

inline constexpr std::uint32_t kPerColumn = 3242174889u;  ///< 2^32 / 1.32471795724...
inline constexpr std::uint32_t kPerRow = 2447445414u;     ///< 2^32 / 1.32471795724...^2

/// In [0, 1): what is added before cutting to whole levels.
inline float threshold(std::uint32_t phase) {
    return static_cast<float>(static_cast<std::int32_t>(phase >> 8u)) * 0x1p-24f;
}

}  // namespace livery::dither

namespace livery {
struct NonAdditive;
}

namespace livery::kernel {

inline constexpr std::size_t kBlock = 512;

/// Wanted colours of up to kBlock pixels, one plane a channel.
struct Wanted {
    alignas(64) std::array<float, kBlock> r, g, b, coverage;
};

struct Curve {
    const float* drive_from_n = nullptr;
    std::int32_t count = 0;
};

/// What a block of pixels of one row needs.
struct Job {
    std::array<const float*, 12> coefficients;  ///< at the block's first pixel
    const std::uint32_t* pixels = nullptr;
    std::size_t count = 0;
    std::array<Curve, 3> curves;
    std::uint32_t dither_of_row;  ///< phase of column 0 less the row's pixel index
};

struct Counts {
    std::int64_t finite = 0, high = 0, low = 0, out = 0;
};

/// N this far outside [0, 1] counts as out of gamut; nearer is rounding.
inline constexpr float kGamutTolerance = 1e-5f;

/// Levels as 0x00bbggrr; `counts` may be null.
using BlockFunction = void (*)(const Job& job,
                               const Wanted& wanted,
                               std::uint32_t* packed_rgb,
                               Counts* counts);

/// N of equation 9, not clipped; `usable` is all ones where there is a covered, finite colour.
struct Separated {
    alignas(64) std::array<float, kBlock> r, g, b;
    alignas(64) std::array<std::uint32_t, kBlock> usable;
};
using SeparateFunction = void (*)(const Job& job, const Wanted& wanted, Separated* n);

/// What a block needs of a GamutBoundary, each at the block's first pixel.
struct GamutJob {
    std::array<const float*, 12> boundary;
    const float* darkest = nullptr;
    const float* brightest = nullptr;
    const float* own_darkest = nullptr;
    const float* own_brightest = nullptr;
    const NonAdditive* table = nullptr;  ///< null: the projector is additive
};

/// Moves those of the block's colours that lie beyond a knee or outside the pixel's gamut; false
/// when there is none.
using MapGamutFunction = bool (*)(const Job& job, const GamutJob& gamut, Wanted* wanted);
bool map_gamut_baseline(const Job& job, const GamutJob& gamut, Wanted* wanted);
bool map_gamut_avx2(const Job& job, const GamutJob& gamut, Wanted* wanted);  ///< x86-64 only

struct Functions {
    const char* instruction_set;
    BlockFunction block;
    SeparateFunction separate;
    MapGamutFunction map_gamut;
};

/// The best that this processor has, first; "baseline" is always the last. All give the same bits.
const Functions& best();
std::size_t available_count();
const Functions& available(std::size_t index);

}  // namespace livery::kernel
