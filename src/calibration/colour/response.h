// One channel's response from samples of (invariant N, drive): the curve rho of equation 8.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scene/colour_calibration.h"

namespace livery {

/// N at each of the 256 drives, and how sure it is.
struct LevelCurve {
    std::array<double, 256> n{};
    std::array<double, 256> weight{};  ///< inverse variance; 0: not sampled
};

struct ResponseSample {
    float n;
    float weight;
    std::uint8_t drive;
    /// Samples of one block err together (what scatters there is common to them); 0: alone.
    std::uint32_t block = 0;
};

/// Least-squares non-decreasing fit by pooling adjacent violators. Weights must be positive.
std::vector<double> isotonic_regression(std::span<const double> values,
                                        std::span<const double> weights);

/// Weighted mean of N per drive without what lies over five deviations from the drive's median. How
/// sure it is follows from the scatter of its samples or, where they lie in blocks, of the blocks.
LevelCurve level_means(std::span<const ResponseSample> samples);

/// A curve with small third differences, as smooth as the samples say (restricted maximum
/// likelihood) and little moved by single ones that lie off by more than their weight says (Huber);
/// drives without samples are bridged. Two samples at least.
LevelCurve smooth_levels(const LevelCurve& measured);

/// Robust rho: `levels` made monotone with 0 at `dark_drive` and 1 at `bright_drive`, turned round
/// as a piecewise-linear curve over N in [0, 1].
ResponseCurve invert_levels(const LevelCurve& levels, int dark_drive, int bright_drive);

/// Nadaraya-Watson with a Gaussian kernel: E[drive | n] at one n. NaN without samples in reach.
double nadaraya_watson(std::span<const double> n,
                       std::span<const double> drive,
                       std::span<const double> weight,
                       double bandwidth,
                       double at);

/// The method's rho over N in [n_first, n_last], mapped to [0, 1] of the curve: Nadaraya-Watson at
/// `bandwidth`, then made non-decreasing where noise made it fall.
ResponseCurve kernel_response(std::span<const ResponseSample> samples,
                              double bandwidth,
                              double n_first,
                              double n_last);

/// Samples a curve holds.
inline constexpr std::size_t kResponseSize = 2048;

}  // namespace livery
