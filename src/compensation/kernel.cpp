#include "compensation/kernel.h"

#include <vector>

#include "core/mutation.h"

// One source, inlined into a wrapper for each instruction set. Contraction is off everywhere, so
// the wrappers differ in speed only.
#define LIVERY_ALWAYS_INLINE inline __attribute__((always_inline))

namespace livery::kernel {
namespace {

/// N of equation 9 for one separated channel, not clipped.
LIVERY_ALWAYS_INLINE void separate_channel(const Job& job,
                                           std::size_t channel,
                                           const Wanted& wanted,
                                           float* __restrict n) {
    const float* __restrict a_r = job.coefficients[3 * channel];
    const float* __restrict a_g = job.coefficients[3 * channel + 1];
    const float* __restrict a_b = job.coefficients[3 * channel + 2];
    const float* __restrict offset = job.coefficients[9 + channel];
    const float* __restrict r = wanted.r.data();
    const float* __restrict g = wanted.g.data();
    const float* __restrict b = wanted.b.data();
    const std::size_t count = job.count;
    for (std::size_t i = 0; i < count; ++i) {
        n[i] = a_r[i] * r[i] + a_g[i] * g[i] + a_b[i] * b[i] + offset[i];
    }
}

/// All ones where the colour is covered and N finite, else zero. Infinity less itself is NaN: one
/// comparison of the sum rejects NaN, Inf and overflow.
LIVERY_ALWAYS_INLINE void find_usable(const Job& job,
                                      const Wanted& wanted,
                                      const Separated& n,
                                      std::uint32_t* __restrict usable) {
    const float* __restrict coverage = wanted.coverage.data();
    const float* __restrict r = n.r.data();
    const float* __restrict g = n.g.data();
    const float* __restrict b = n.b.data();
    const std::size_t count = job.count;
    for (std::size_t i = 0; i < count; ++i) {
        const float sum = r[i] + g[i] + b[i];
        const std::uint32_t finite = sum - sum == 0.0f ? ~0u : 0u;
        const std::uint32_t covered = coverage[i] >= 0.5f ? ~0u : 0u;
        usable[i] = finite & covered;
    }
}

LIVERY_ALWAYS_INLINE void separate_body(const Job& job, const Wanted& wanted, Separated* n) {
    separate_channel(job, 0, wanted, n->r.data());
    separate_channel(job, 1, wanted, n->g.data());
    separate_channel(job, 2, wanted, n->b.data());
    find_usable(job, wanted, *n, n->usable.data());
}

/// rho, dither and the cut to a whole level, moved to the channel's byte of `packed`.
LIVERY_ALWAYS_INLINE void add_levels(const Job& job,
                                     std::size_t channel,
                                     const float* __restrict n,
                                     std::uint32_t* __restrict packed) {
    const float* __restrict curve = job.curves[channel].drive_from_n;
    const std::int32_t last = job.curves[channel].count - 1;
    const float scale = static_cast<float>(last);
    const std::uint32_t row = job.dither_of_row;
    const std::uint32_t* __restrict pixels = job.pixels;
    const std::size_t count = job.count;
    const auto shift = static_cast<unsigned>(8 * channel);
    for (std::size_t i = 0; i < count; ++i) {
        // The comparisons in this order turn NaN into 0 before it becomes an index.
        float at = n[i] > 0.0f ? n[i] : 0.0f;
        at = (at < 1.0f ? at : 1.0f) * scale;
        std::int32_t cell = static_cast<std::int32_t>(at);
        cell = cell < last ? cell : last - 1;
        const float f = at - static_cast<float>(cell);
        const float low = curve[cell], high = curve[cell + 1];
        const float drive = LIVERY_MUTATED(compensation_drive, low + f * (high - low));
        const std::uint32_t phase = pixels[i] * dither::kPerColumn + row;
        const auto level = static_cast<std::int32_t>(drive + dither::threshold(phase));
        packed[i] |= static_cast<std::uint32_t>(level < 255 ? level : 255) << shift;
    }
}

LIVERY_ALWAYS_INLINE void count(const Job& job, const Separated& n, Counts* counts) {
    const float* __restrict r = n.r.data();
    const float* __restrict g = n.g.data();
    const float* __restrict b = n.b.data();
    const std::uint32_t* __restrict usable = n.usable.data();
    std::uint32_t finite = 0, high = 0, low = 0, out = 0;
    constexpr float kHigh = 1.0f + kGamutTolerance, kLow = -kGamutTolerance;
    for (std::size_t i = 0; i < job.count; ++i) {
        const std::uint32_t is_high =
            (r[i] > kHigh ? 1u : 0u) | (g[i] > kHigh ? 1u : 0u) | (b[i] > kHigh ? 1u : 0u);
        const std::uint32_t is_low =
            (r[i] < kLow ? 1u : 0u) | (g[i] < kLow ? 1u : 0u) | (b[i] < kLow ? 1u : 0u);
        finite += usable[i] & 1u;
        high += usable[i] & is_high;
        low += usable[i] & is_low;
        out += usable[i] & (is_high | is_low);
    }
    counts->finite += finite;
    counts->high += high;
    counts->low += low;
    counts->out += out;
}

LIVERY_ALWAYS_INLINE void block_body(const Job& job,
                                     const Wanted& wanted,
                                     std::uint32_t* packed,
                                     Counts* counts) {
    Separated n;
    separate_body(job, wanted, &n);
    for (std::size_t i = 0; i < job.count; ++i) packed[i] = 0;
    add_levels(job, 0, n.r.data(), packed);
    add_levels(job, 1, n.g.data(), packed);
    add_levels(job, 2, n.b.data(), packed);
    const std::uint32_t* __restrict usable = n.usable.data();
    std::uint32_t* __restrict out = packed;
    for (std::size_t i = 0; i < job.count; ++i) out[i] &= usable[i];
    if (counts) count(job, n, counts);
}

#define LIVERY_KERNEL(suffix, attribute)                                                   \
    attribute void block_##suffix(                                                         \
        const Job& job, const Wanted& wanted, std::uint32_t* packed, Counts* counts) {     \
        block_body(job, wanted, packed, counts);                                           \
    }                                                                                      \
    attribute void separate_##suffix(const Job& job, const Wanted& wanted, Separated* n) { \
        separate_body(job, wanted, n);                                                     \
    }

LIVERY_KERNEL(baseline, )
#if defined(__x86_64__)
// 512-bit vectors gain nothing here: the loop waits for memory.
LIVERY_KERNEL(avx2, __attribute__((target("avx2"))))
#endif
#undef LIVERY_KERNEL

std::vector<Functions> find_available() {
    std::vector<Functions> list;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) {
        list.push_back({"avx2", block_avx2, separate_avx2, map_gamut_avx2});
    }
#endif
    list.push_back({"baseline", block_baseline, separate_baseline, map_gamut_baseline});
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
