#include "compensation/kernel.h"

#include <vector>

#include "compensation/dither.h"

// One source, inlined into a wrapper for each instruction set. Contraction is off everywhere, so
// the wrappers differ in speed only.
#define LIVERY_ALWAYS_INLINE inline __attribute__((always_inline))

namespace livery::kernel {
namespace {

struct Pixel {
    float r, g, b;
    bool usable;
};

LIVERY_ALWAYS_INLINE Pixel separated(const std::array<const float*, 12>& c,
                                     const Wanted& wanted,
                                     std::size_t i) {
    const float r = wanted.r[i], g = wanted.g[i], b = wanted.b[i];
    Pixel n;
    n.r = c[0][i] * r + c[1][i] * g + c[2][i] * b + c[9][i];
    n.g = c[3][i] * r + c[4][i] * g + c[5][i] * b + c[10][i];
    n.b = c[6][i] * r + c[7][i] * g + c[8][i] * b + c[11][i];
    // Infinity less itself is NaN: one comparison of the sums rejects NaN, Inf and overflow.
    const float sum = n.r + n.g + n.b;
    n.usable = (sum - sum == 0.0f) & (wanted.coverage[i] >= 0.5f);
    return n;
}

/// The comparisons in this order turn NaN into 0 before it becomes an index.
LIVERY_ALWAYS_INLINE float clipped(float n) {
    n = n > 0.0f ? n : 0.0f;
    return n < 1.0f ? n : 1.0f;
}

LIVERY_ALWAYS_INLINE std::uint32_t level(const float* curve,
                                         std::int32_t last,
                                         float n,
                                         std::uint32_t phase) {
    const float scaled = clipped(n) * static_cast<float>(last);
    std::int32_t i = static_cast<std::int32_t>(scaled);
    i = i < last ? i : last - 1;
    const float f = scaled - static_cast<float>(i);
    const float drive = curve[i] + f * (curve[i + 1] - curve[i]);
    const auto whole = static_cast<std::int32_t>(drive + dither::threshold(phase));
    return static_cast<std::uint32_t>(whole < 255 ? whole : 255);
}

LIVERY_ALWAYS_INLINE void block_body(const Job& job, const Wanted& wanted, std::uint32_t* packed) {
    const std::array<const float*, 12> c = job.coefficients;
    const float* const curve_r = job.curves[0].drive_from_n;
    const float* const curve_g = job.curves[1].drive_from_n;
    const float* const curve_b = job.curves[2].drive_from_n;
    const std::int32_t last_r = job.curves[0].count - 1;
    const std::int32_t last_g = job.curves[1].count - 1;
    const std::int32_t last_b = job.curves[2].count - 1;
    const std::uint32_t row_r = job.dither_of_row[0];
    const std::uint32_t row_g = job.dither_of_row[1];
    const std::uint32_t row_b = job.dither_of_row[2];
    const std::uint32_t* const pixels = job.pixels;
    const std::size_t count = job.count;
#pragma GCC ivdep
    for (std::size_t i = 0; i < count; ++i) {
        const Pixel n = separated(c, wanted, i);
        const std::uint32_t column = pixels[i] * dither::kPerColumn;
        const std::uint32_t rgb = level(curve_r, last_r, n.r, column + row_r) |
                                  level(curve_g, last_g, n.g, column + row_g) << 8u |
                                  level(curve_b, last_b, n.b, column + row_b) << 16u;
        packed[i] = n.usable ? rgb : 0u;
    }
}

LIVERY_ALWAYS_INLINE void count_body(const Job& job, const Wanted& wanted, Counts* counts) {
    const std::array<const float*, 12> c = job.coefficients;
    std::int32_t finite = 0, high = 0, low = 0, out = 0;
    for (std::size_t i = 0; i < job.count; ++i) {
        const Pixel n = separated(c, wanted, i);
        const bool is_high = (n.r > 1.0f + kGamutTolerance) | (n.g > 1.0f + kGamutTolerance) |
                             (n.b > 1.0f + kGamutTolerance);
        const bool is_low =
            (n.r < -kGamutTolerance) | (n.g < -kGamutTolerance) | (n.b < -kGamutTolerance);
        finite += n.usable ? 1 : 0;
        high += (n.usable & is_high) ? 1 : 0;
        low += (n.usable & is_low) ? 1 : 0;
        out += (n.usable & (is_high | is_low)) ? 1 : 0;
    }
    counts->finite += finite;
    counts->high += high;
    counts->low += low;
    counts->out += out;
}

LIVERY_ALWAYS_INLINE void separate_body(const Job& job, const Wanted& wanted, Separated* out) {
    const std::array<const float*, 12> c = job.coefficients;
    for (std::size_t i = 0; i < job.count; ++i) {
        const Pixel n = separated(c, wanted, i);
        out->r[i] = n.usable ? n.r : 0.0f;
        out->g[i] = n.usable ? n.g : 0.0f;
        out->b[i] = n.usable ? n.b : 0.0f;
        out->usable[i] = n.usable ? 1 : 0;
    }
}

#define LIVERY_KERNEL(suffix, attribute)                                                         \
    attribute void block_##suffix(const Job& job, const Wanted& wanted, std::uint32_t* packed) { \
        block_body(job, wanted, packed);                                                         \
    }                                                                                            \
    attribute void count_##suffix(const Job& job, const Wanted& wanted, Counts* counts) {        \
        count_body(job, wanted, counts);                                                         \
    }                                                                                            \
    attribute void separate_##suffix(const Job& job, const Wanted& wanted, Separated* n) {       \
        separate_body(job, wanted, n);                                                           \
    }

LIVERY_KERNEL(baseline, )
#if defined(__x86_64__)
LIVERY_KERNEL(avx2, __attribute__((target("avx2"))))
LIVERY_KERNEL(avx512, __attribute__((target("avx512f,avx512dq,avx512bw,avx512vl"))))
#endif
#undef LIVERY_KERNEL

std::vector<Functions> find_available() {
    std::vector<Functions> list;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl")) {
        list.push_back({"avx512", block_avx512, count_avx512, separate_avx512});
    }
    if (__builtin_cpu_supports("avx2")) {
        list.push_back({"avx2", block_avx2, count_avx2, separate_avx2});
    }
#endif
    list.push_back({"baseline", block_baseline, count_baseline, separate_baseline});
    return list;
}

const std::vector<Functions>& all() {
    static const std::vector<Functions> list = find_available();
    return list;
}

}  // namespace

const Functions& best() { return all().front(); }

std::size_t available_count() { return all().size(); }

const Functions& available(std::size_t index) { return all().at(index); }

}  // namespace livery::kernel
