#include "compensation/compensate.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <string>

#if defined(__SSE2__)
#include <emmintrin.h>
#include <xmmintrin.h>
#endif

#include "compensation/drive_table.h"
#include "compensation/gamut.h"
#include "compensation/kernel.h"
#include "core/error.h"
#include "core/parallel.h"

namespace livery {
namespace {

/// Interleaved colours of scattered pixels into planes.
void gather(const ImageF& wanted,
            const std::uint32_t* pixels,
            std::size_t count,
            kernel::Wanted* out) {
    const float* values = wanted.values.data();
    std::size_t i = 0;
    if (wanted.channels == 4) {
#if defined(__SSE2__)
        for (; i + 4 <= count; i += 4) {
            __m128 a = _mm_loadu_ps(values + 4 * static_cast<std::size_t>(pixels[i]));
            __m128 b = _mm_loadu_ps(values + 4 * static_cast<std::size_t>(pixels[i + 1]));
            __m128 c = _mm_loadu_ps(values + 4 * static_cast<std::size_t>(pixels[i + 2]));
            __m128 d = _mm_loadu_ps(values + 4 * static_cast<std::size_t>(pixels[i + 3]));
            _MM_TRANSPOSE4_PS(a, b, c, d);
            _mm_store_ps(&out->r[i], a);
            _mm_store_ps(&out->g[i], b);
            _mm_store_ps(&out->b[i], c);
            _mm_store_ps(&out->coverage[i], d);
        }
#endif
        for (; i < count; ++i) {
            const float* p = values + 4 * static_cast<std::size_t>(pixels[i]);
            out->r[i] = p[0];
            out->g[i] = p[1];
            out->b[i] = p[2];
            out->coverage[i] = p[3];
        }
        return;
    }
    for (; i < count; ++i) {
        const float* p = values + 3 * static_cast<std::size_t>(pixels[i]);
        out->r[i] = p[0];
        out->g[i] = p[1];
        out->b[i] = p[2];
        out->coverage[i] = 1.0f;
    }
}

/// Three bytes a pixel, written as four: the fourth is black and lies on a later pixel, which is
/// either written later or black anyway. Only the last pixel must not: what follows it may be
/// another thread's, or not the picture's.
void scatter(const std::uint32_t* packed,
             const std::uint32_t* pixels,
             std::size_t count,
             Image8* drive) {
    std::uint8_t* values = drive->values.data();
    for (std::size_t i = 0; i + 1 < count; ++i) {
        std::memcpy(values + 3 * static_cast<std::size_t>(pixels[i]), &packed[i], 4);
    }
    std::memcpy(values + 3 * static_cast<std::size_t>(pixels[count - 1]), &packed[count - 1], 3);
}

/// A non-additive projector's block: N by the fast loop, drives pixel by pixel from the table.
void block_from_table(const kernel::Functions& functions,
                      const CompensationTable& table,
                      const kernel::Job& job,
                      const kernel::Wanted& wanted,
                      std::uint32_t* packed,
                      kernel::Counts* counts) {
    kernel::Separated n;
    functions.separate(job, wanted, &n);
    for (std::size_t i = 0; i < job.count; ++i) {
        packed[i] = 0;
        if (n.usable[i] == 0) continue;
        glm::vec3 residual;
        const glm::vec3 drive =
            drive_of_n(table.non_additive, glm::vec3(n.r[i], n.g[i], n.b[i]), &residual);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t phase = job.pixels[i] * dither::kPerColumn + job.dither_of_row;
            const auto level =
                static_cast<int>(drive[static_cast<int>(k)] + dither::threshold(phase));
            packed[i] |= static_cast<std::uint32_t>(std::min(level, 255)) << (8 * k);
        }
        if (counts) {
            const bool high = std::min({residual.x, residual.y, residual.z}) < -kReachableN;
            const bool low = std::max({residual.x, residual.y, residual.z}) > kReachableN;
            ++counts->finite;
            counts->high += high ? 1 : 0;
            counts->low += low ? 1 : 0;
            counts->out += (high || low) ? 1 : 0;
        }
    }
}

double fraction(std::int64_t part, std::int64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

}  // namespace

float dither_of(std::uint32_t x, std::uint32_t y) {
    return dither::threshold(x * dither::kPerColumn + y * dither::kPerRow) - 0.5f;
}

namespace {

/// What blocks share.
struct FrameCorrection {
    const kernel::Functions& functions;
    const CompensationTable& table;
    const ImageF& wanted;
    Image8* drive;
    bool counted;
};

/// So many pixels of the table from `begin` on; `dither_of_row` is left to say.
kernel::Job job_of(const CompensationTable& table, std::size_t begin, std::size_t count) {
    kernel::Job job;
    job.pixels = table.pixels.data() + begin;
    job.count = count;
    for (std::size_t plane = 0; plane < 12; ++plane) {
        job.coefficients[plane] = table.coefficients.data() + plane * table.pixels.size() + begin;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        job.curves[k] = {table.drive_from_n[k].data(),
                         static_cast<std::int32_t>(table.drive_from_n[k].size())};
    }
    return job;
}

/// The table's pixels from `begin` to `end`.
kernel::Counts compensate_range(const FrameCorrection& frame, std::size_t begin, std::size_t end) {
    const CompensationTable& table = frame.table;
    const auto width = static_cast<std::uint32_t>(table.width);
    kernel::Wanted colours;
    alignas(64) std::array<std::uint32_t, kernel::kBlock> packed;
    kernel::Counts counts;
    while (begin < end) {
        // A block stays in one row, where the dither is linear in the pixel's index.
        const std::uint32_t row = table.pixels[begin] / width;
        const std::uint32_t* first = table.pixels.data() + begin;
        const std::size_t most = std::min(kernel::kBlock, end - begin);
        const auto count = static_cast<std::size_t>(
            std::lower_bound(first, first + most, (row + 1) * width) - first);
        kernel::Job job = job_of(table, begin, count);
        job.dither_of_row = row * dither::kPerRow - row * width * dither::kPerColumn;
        gather(frame.wanted, first, job.count, &colours);
        kernel::Counts* const counted = frame.counted ? &counts : nullptr;
        const auto correct = [&](kernel::Counts* counts_of) {
            if (table.non_additive.grid > 0) {
                block_from_table(frame.functions, table, job, colours, packed.data(), counts_of);
            } else {
                frame.functions.block(job, colours, packed.data(), counts_of);
            }
        };
        correct(counted);
        // What is counted is what was wanted; few blocks hold a colour that has to move.
        if (!table.gamut.coefficients.empty() &&
            frame.functions.map_gamut(job, gamut_job(table, begin), &colours)) {
            correct(nullptr);
        }
        scatter(packed.data(), first, job.count, frame.drive);
        begin += job.count;
    }
    return counts;
}

constexpr std::size_t kPixelsAtOnce = 1024;

}  // namespace

std::size_t count_covered(const ImageF& wanted) {
    if (wanted.channels != 4) return wanted.pixel_count();
    std::size_t covered = 0;
    for (std::size_t i = 3; i < wanted.values.size(); i += 4) {
        covered += wanted.values[i] >= 0.5f ? 1u : 0u;
    }
    return covered;
}

namespace {

void check_wanted(const CompensationTable& table, const ImageF& wanted) {
    check_argument(wanted.width == table.width && wanted.height == table.height &&
                       (wanted.channels == 3 || wanted.channels == 4) &&
                       wanted.values.size() ==
                           wanted.pixel_count() * static_cast<std::size_t>(wanted.channels),
                   "wanted picture of " + std::to_string(wanted.width) + "x" +
                       std::to_string(wanted.height) + " with " + std::to_string(wanted.channels) +
                       " channels, the calibration has " + std::to_string(table.width) + "x" +
                       std::to_string(table.height) + " and wants 3 or 4");
}

}  // namespace

ImageF map_gamut(const kernel::Functions& functions,
                 const CompensationTable& table,
                 const ImageF& wanted) {
    check_wanted(table, wanted);
    ImageF mapped = wanted;
    if (table.gamut.coefficients.empty()) return mapped;
    const std::size_t total = table.pixels.size();
    const auto channels = static_cast<std::size_t>(wanted.channels);
    kernel::Wanted colours;
    for (std::size_t begin = 0; begin < total; begin += kernel::kBlock) {
        const kernel::Job job = job_of(table, begin, std::min(kernel::kBlock, total - begin));
        gather(wanted, job.pixels, job.count, &colours);
        if (!functions.map_gamut(job, gamut_job(table, begin), &colours)) continue;
        for (std::size_t i = 0; i < job.count; ++i) {
            float* colour = &mapped.values[channels * job.pixels[i]];
            colour[0] = colours.r[i];
            colour[1] = colours.g[i];
            colour[2] = colours.b[i];
        }
    }
    return mapped;
}

ImageF exact_drive(const CompensationTable& table, const ImageF& wanted) {
    const kernel::Functions& functions = kernel::best();
    const ImageF mapped = map_gamut(functions, table, wanted);
    ImageF drive(table.width, table.height, 3);
    const std::size_t total = table.pixels.size();
    kernel::Wanted colours;
    kernel::Separated n;
    for (std::size_t begin = 0; begin < total; begin += kernel::kBlock) {
        const kernel::Job job = job_of(table, begin, std::min(kernel::kBlock, total - begin));
        gather(mapped, job.pixels, job.count, &colours);
        functions.separate(job, colours, &n);
        for (std::size_t i = 0; i < job.count; ++i) {
            if (n.usable[i] == 0) continue;
            const glm::vec3 its_n(n.r[i], n.g[i], n.b[i]);
            glm::vec3 exact, residual;
            if (table.non_additive.grid > 0) {
                exact = drive_of_n(table.non_additive, its_n, &residual);
            } else {
                for (int c = 0; c < 3; ++c) {
                    exact[c] = look_up(table.drive_from_n[static_cast<std::size_t>(c)], its_n[c]);
                }
            }
            std::memcpy(&drive.values[3 * std::size_t{job.pixels[i]}], &exact.x, 3 * sizeof(float));
        }
    }
    return drive;
}

CompensationStats stats_of(const kernel::Counts& counts, std::size_t covered_pixels) {
    const auto covered = static_cast<std::int64_t>(covered_pixels);
    CompensationStats stats;
    stats.out_of_gamut_fraction = fraction(counts.out, counts.finite);
    stats.invalid_fraction = fraction(covered - counts.finite, covered);
    stats.clipped_high_fraction = fraction(counts.high, counts.finite);
    stats.clipped_low_fraction = fraction(counts.low, counts.finite);
    return stats;
}

void compensate_with(const kernel::Functions& functions,
                     const CompensationTable& table,
                     const ImageF& wanted,
                     std::size_t covered_pixels,
                     Image8* drive,
                     CompensationStats* stats) {
    check_wanted(table, wanted);
    if (drive->width != table.width || drive->height != table.height || drive->channels != 3) {
        *drive = Image8(table.width, table.height, 3);
    }
    const FrameCorrection frame{functions, table, wanted, drive, stats != nullptr};
    std::mutex mutex;
    kernel::Counts counts;
    parallel_for(table.pixels.size(), kPixelsAtOnce, [&](std::size_t begin, std::size_t end) {
        const kernel::Counts some = compensate_range(frame, begin, end);
        const std::scoped_lock lock(mutex);
        counts.finite += some.finite;
        counts.high += some.high;
        counts.low += some.low;
        counts.out += some.out;
    });
    if (stats) *stats = stats_of(counts, covered_pixels);
}

void compensate_again(const CompensationTable& table,
                      const ImageF& wanted_working,
                      std::size_t covered_pixels,
                      Image8* drive,
                      CompensationStats* stats) {
    compensate_with(kernel::best(), table, wanted_working, covered_pixels, drive, stats);
}

void compensate_into(const CompensationTable& table,
                     const ImageF& wanted_working,
                     Image8* drive,
                     CompensationStats* stats) {
    std::fill(drive->values.begin(), drive->values.end(), std::uint8_t{0});
    compensate_again(
        table, wanted_working, stats ? count_covered(wanted_working) : 0, drive, stats);
}

Image8 compensate(const CompensationTable& table,
                  const ImageF& wanted_working,
                  CompensationStats* stats) {
    Image8 drive;
    compensate_into(table, wanted_working, &drive, stats);
    return drive;
}

}  // namespace livery
