#include "calibration/colour/response.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "core/error.h"
#include "core/mutation.h"
#include "core/statistics.h"
#include "core/worst_error.h"

namespace livery {
namespace {

constexpr int kDriveLevels = 256;
constexpr std::size_t kKnownScatter = 8;  // samples whose scatter says how sure their mean is

constexpr int kOrder = 3;  // of the differences; also how many polynomials they do not see
constexpr std::array<double, kOrder + 1> kDifference{-1.0, 3.0, -3.0, 1.0};

using Levels = std::array<double, kDriveLevels>;

struct SmoothFit {
    Levels x{};
    /// Minus twice the logarithm of the restricted likelihood, but for a constant.
    double unlikeliness = std::numeric_limits<double>::infinity();
};

/// Solves (W + strength D'D) x = W y for third differences D, a band of seven, by Cholesky; how
/// likely the strength is, with the noise's unit unknown, is the restricted likelihood of Patterson
/// and Thompson (Biometrika 58, 1971, "Recovery of inter-block information").
SmoothFit solve_smooth(const Levels& y, const Levels& weight, double strength, double sampled) {
    // Lower band by rows: band[i][j] is the entry (i, i - j).
    std::array<std::array<double, kOrder + 1>, kDriveLevels> band{};
    const auto index = [](int i) { return static_cast<std::size_t>(i); };
    for (int i = 0; i < kDriveLevels; ++i) band[index(i)][0] = weight[index(i)];
    for (int row = 0; row + kOrder < kDriveLevels; ++row)
        for (int a = 0; a <= kOrder; ++a)
            for (int b = 0; b <= a; ++b)
                band[index(row + a)][index(a - b)] +=
                    strength * kDifference[index(a)] * kDifference[index(b)];
    double log_determinant = 0.0;
    for (int i = 0; i < kDriveLevels; ++i) {
        auto& row = band[index(i)];
        for (int j = std::min(kOrder, i); j >= 0; --j) {
            double sum = row[index(j)];
            const auto& other = band[index(i - j)];
            for (int k = j + 1; k <= std::min(kOrder, i); ++k)
                sum -= row[index(k)] * other[index(k - j)];
            row[index(j)] = j == 0 ? std::sqrt(std::max(sum, 1e-300)) : sum / other[0];
        }
        log_determinant += 2.0 * std::log(row[0]);
    }
    SmoothFit fit;
    Levels& x = fit.x;
    for (int i = 0; i < kDriveLevels; ++i) {
        double sum = weight[index(i)] * y[index(i)];
        for (int k = 1; k <= std::min(kOrder, i); ++k)
            sum -= band[index(i)][index(k)] * x[index(i - k)];
        x[index(i)] = sum / band[index(i)][0];
    }
    for (int i = kDriveLevels - 1; i >= 0; --i) {
        double sum = x[index(i)];
        for (int k = 1; k <= kOrder && i + k < kDriveLevels; ++k)
            sum -= band[index(i + k)][index(k)] * x[index(i + k)];
        x[index(i)] = sum / band[index(i)][0];
    }

    double misfit = 0.0;
    for (std::size_t i = 0; i < kDriveLevels; ++i)
        misfit += weight[i] * (x[i] - y[i]) * (x[i] - y[i]);
    for (int row = 0; row + kOrder < kDriveLevels; ++row) {
        double bend = 0.0;
        for (int a = 0; a <= kOrder; ++a) bend += kDifference[index(a)] * x[index(row + a)];
        misfit += strength * bend * bend;
    }
    fit.unlikeliness = (sampled - kOrder) * std::log(std::max(misfit, 1e-300)) + log_determinant -
                       (kDriveLevels - kOrder) * std::log(strength);
    return fit;
}

/// The likeliest of all strengths; the least, which passes through the samples, where there are
/// too few of them to tell.
Levels fit_smooth(const Levels& y, const Levels& weight) {
    constexpr double kLow = -2.0, kHigh = 9.0, kStep = 0.125;  // powers of ten
    constexpr double kToTell = 2.0 * kOrder;
    std::vector<double> known;
    for (const double w : weight)
        if (w > 0.0) known.push_back(w);
    const auto sampled = static_cast<double>(known.size());
    const double usual = median(known);
    SmoothFit best;
    for (double power = kLow; power <= kHigh; power += kStep) {
        SmoothFit fit = solve_smooth(y, weight, usual * std::pow(10.0, power), sampled);
        if (fit.unlikeliness < best.unlikeliness) best = fit;
        if (sampled < kToTell) break;
    }
    return best.x;
}

double largest_fall(std::span<const double> values) {
    double highest = -std::numeric_limits<double>::infinity(), fall = 0.0;
    for (const double value : values) {
        fall = worse_of(fall, highest - value);
        highest = std::max(highest, value);
    }
    return fall;
}

/// One block's mean, with the mean weight of its samples.
struct BlockMean {
    std::size_t level;
    double weight = 0.0, n = 0.0, count = 0.0;
};

/// Replaces each level's inverse variance by what the blocks' scatter says. Samples' weights are
/// inverse variances but for one factor, which dark blocks tell; bright ones differ by a share of N
/// too, that of their light which went elsewhere. Both are told from all levels together: one holds
/// a few blocks only, and all of those may lie badly.
void weigh_by_blocks(const std::vector<BlockMean>& blocks, LevelCurve& curve) {
    constexpr double kDark = 0.1, kBright = 0.3;  // of N
    constexpr double kMedianOfSquares = 0.455;    // of a standard normal's
    std::array<std::vector<const BlockMean*>, 256> of_level;
    for (const BlockMean& block : blocks) of_level[block.level].push_back(&block);
    std::vector<double> dark, bright;
    for (std::size_t level = 0; level < 256; ++level) {
        const auto count = static_cast<double>(of_level[level].size());
        if (count < 2.0) continue;
        const double n = curve.n[level];
        for (const BlockMean* block : of_level[level]) {
            const double off2 = (block->n - n) * (block->n - n) * count / (count - 1.0);
            if (n < kDark) dark.push_back(block->weight * off2);
            if (n > kBright) bright.push_back(off2 / (n * n));
        }
    }
    if (dark.size() < 16 || bright.size() < 16) return;
    const double factor = median(dark) / kMedianOfSquares;
    const double relative2 = median(bright) / kMedianOfSquares;
    for (std::size_t level = 0; level < 256; ++level) {
        if (of_level[level].empty()) continue;
        double sum = 0.0, sum2 = 0.0;
        for (const BlockMean* block : of_level[level]) {
            sum += block->weight;
            sum2 += block->weight * block->weight;
        }
        const double n = curve.n[level];
        const double variance = factor / sum + relative2 * n * n * sum2 / (sum * sum);
        curve.weight[level] = std::min(curve.weight[level], 1.0 / (variance + 1e-12));
    }
}

}  // namespace

std::vector<double> isotonic_regression(std::span<const double> values,
                                        std::span<const double> weights) {
    check_argument(values.size() == weights.size(), "values and weights differ in count");
    struct Pool {
        double mean, weight;
        std::size_t count;
    };
    std::vector<Pool> pools;
    for (std::size_t i = 0; i < values.size(); ++i) {
        check_argument(weights[i] > 0.0 && std::isfinite(values[i]),
                       "isotonic regression needs finite values and positive weights");
        Pool pool{values[i], weights[i], 1};
        while (!pools.empty() && pools.back().mean >= pool.mean) {
            const Pool& last = pools.back();
            const double weight = last.weight + pool.weight;
            pool = {(last.mean * last.weight + pool.mean * pool.weight) / weight,
                    weight,
                    last.count + pool.count};
            pools.pop_back();
        }
        pools.push_back(pool);
    }
    std::vector<double> fit;
    fit.reserve(values.size());
    for (const Pool& pool : pools) fit.insert(fit.end(), pool.count, pool.mean);
    return fit;
}

LevelCurve level_means(std::span<const ResponseSample> samples) {
    std::array<std::vector<ResponseSample>, 256> of_level;
    for (const ResponseSample& sample : samples)
        if (std::isfinite(sample.n) && sample.weight > 0.0f)
            of_level[sample.drive].push_back(sample);

    LevelCurve curve;
    std::array<double, 256> scatter{}, share{};  // of the samples; of it, what the mean keeps
    std::vector<BlockMean> blocks;
    std::vector<double> well_known;
    for (std::size_t level = 0; level < 256; ++level) {
        const auto& here = of_level[level];
        if (here.empty()) continue;
        std::vector<float> values;
        for (const ResponseSample& s : here) values.push_back(s.n);
        const float centre = median(values);
        for (float& value : values) value = std::abs(value - centre);
        const double reach = 5.0 * 1.4826 * static_cast<double>(median(values)) + 1e-7;
        double sum = 0.0, weight = 0.0, weight2 = 0.0;
        for (const ResponseSample& s : here)
            if (std::abs(s.n - centre) <= reach) {
                sum += static_cast<double>(s.weight) * s.n;
                weight += s.weight;
                weight2 += static_cast<double>(s.weight) * s.weight;
            }
        const double mean = sum / weight;
        std::map<std::uint32_t, BlockMean> of_block;
        for (const ResponseSample& s : here)
            if (s.block != 0 && std::abs(s.n - centre) <= reach) {
                BlockMean& block = of_block.try_emplace(s.block, BlockMean{level}).first->second;
                block.n += static_cast<double>(s.weight) * s.n;
                block.weight += s.weight;
                block.count += 1.0;
            }
        for (auto& [number, block] : of_block) {
            block.n /= block.weight;
            block.weight /= block.count;
            blocks.push_back(block);
        }
        double spread = 0.0;
        for (const ResponseSample& s : here)
            if (std::abs(s.n - centre) <= reach)
                spread += static_cast<double>(s.weight) * (s.n - mean) * (s.n - mean);
        curve.n[level] = mean;
        scatter[level] = spread / weight;
        share[level] = weight2 / (weight * weight);
        if (here.size() >= kKnownScatter) well_known.push_back(scatter[level]);
    }
    // Variance of the weighted mean from the samples' own scatter. That of a few says nothing (of
    // one it is zero): theirs is at least what other levels have. The floor (one part in 100000)
    // keeps a level of equal samples from outweighing all others.
    const double usual = median(well_known);
    for (std::size_t level = 0; level < 256; ++level) {
        const auto& here = of_level[level];
        if (here.empty()) continue;
        const double least = here.size() < kKnownScatter ? usual : 0.0;
        const double few = here.size() < 4 ? 4.0 : 1.0;
        curve.weight[level] = 1.0 / (few * std::max(scatter[level], least) * share[level] + 1e-10);
    }
    weigh_by_blocks(blocks, curve);
    return curve;
}

LevelCurve smooth_levels(const LevelCurve& measured) {
    constexpr int kRounds = 8;
    constexpr double kHuber = 2.0;         // deviations from which a level counts less
    constexpr double kDeviation = 1.4826;  // of a normal's median
    std::vector<double> known;
    for (const double weight : measured.weight)
        if (weight > 0.0) known.push_back(weight);
    check_argument(known.size() >= 2, "a response needs samples of at least two drives");

    // What lies off the curve by more than most, as blocks in corners that others light do, is
    // neither followed nor taken for noise that all levels have.
    LevelCurve smooth = measured;
    Levels weight = measured.weight;
    for (int round = 0; round < kRounds; ++round) {
        smooth.n = fit_smooth(measured.n, weight);
        const auto off = [&](std::size_t i) {
            return std::sqrt(measured.weight[i]) * std::abs(measured.n[i] - smooth.n[i]);
        };
        std::vector<double> all;
        for (std::size_t i = 0; i < kDriveLevels; ++i)
            if (measured.weight[i] > 0.0) all.push_back(off(i));
        const double reach = kHuber * std::max(1.0, kDeviation * median(all));
        for (std::size_t i = 0; i < kDriveLevels; ++i)
            weight[i] = measured.weight[i] * (off(i) > reach ? reach / off(i) : 1.0);
    }
    // Bridged drives count too from here on.
    const double mean_weight =
        std::accumulate(known.begin(), known.end(), 0.0) / static_cast<double>(known.size());
    for (double& w : smooth.weight) w = std::max(w, 1e-3 * mean_weight);
    return smooth;
}

ResponseCurve invert_levels(const LevelCurve& levels, int dark_drive, int bright_drive) {
    check_argument(dark_drive >= 0 && dark_drive < bright_drive && bright_drive < kDriveLevels,
                   "drives " + std::to_string(dark_drive) + ", " + std::to_string(bright_drive) +
                       " are not 0 <= s < t <= 255");
    ResponseCurve curve;
    curve.largest_violation = largest_fall(levels.n);
    std::vector<double> n = isotonic_regression(levels.n, levels.weight);

    const double first = n[static_cast<std::size_t>(dark_drive)];
    const double span = n[static_cast<std::size_t>(bright_drive)] - first;
    if (!(span > 0.0))
        throw Refused(
            "the photographed grey levels do not get brighter with the projector's drive",
            "check that the gray-levels photograph shows the gray-levels picture, and that "
            "the projector is not in a mode that inverts or flattens grey");
    for (double& value : n) value = LIVERY_MUTATED(response_fit, (value - first) / span);

    curve.drive_from_n.resize(kResponseSize);
    int above = dark_drive + 1;
    for (std::size_t i = 0; i < kResponseSize; ++i) {
        const double at = static_cast<double>(i) / static_cast<double>(kResponseSize - 1);
        while (above < bright_drive && n[static_cast<std::size_t>(above)] < at) ++above;
        const double low = n[static_cast<std::size_t>(above - 1)],
                     up = n[static_cast<std::size_t>(above)];
        const double fraction = up > low ? std::clamp((at - low) / (up - low), 0.0, 1.0) : 0.5;
        curve.drive_from_n[i] = static_cast<float>(above - 1 + fraction);
    }
    curve.drive_from_n.front() = static_cast<float>(dark_drive);
    curve.drive_from_n.back() = static_cast<float>(bright_drive);
    // A plateau's middle may lie over the next sample by rounding only.
    for (std::size_t i = 1; i < kResponseSize; ++i)
        curve.drive_from_n[i] = std::max(curve.drive_from_n[i], curve.drive_from_n[i - 1]);
    return curve;
}

double nadaraya_watson(std::span<const double> n,
                       std::span<const double> drive,
                       std::span<const double> weight,
                       double bandwidth,
                       double at) {
    double sum = 0.0, total = 0.0;
    for (std::size_t i = 0; i < n.size(); ++i) {
        const double z = (at - n[i]) / bandwidth;
        const double kernel = weight[i] * std::exp(-0.5 * z * z);
        sum += kernel * drive[i];
        total += kernel;
    }
    return total > 0.0 ? sum / total : std::numeric_limits<double>::quiet_NaN();
}

ResponseCurve kernel_response(std::span<const ResponseSample> samples,
                              double bandwidth,
                              double n_first,
                              double n_last) {
    check_argument(bandwidth > 0.0 && n_last > n_first,
                   "kernel response: empty range or bandwidth");
    // Samples gathered in cells far narrower than the kernel, each at its mean
    const double cell = bandwidth / 64.0;
    const double from = n_first - 8.0 * bandwidth, to = n_last + 8.0 * bandwidth;
    struct Cell {
        double n = 0.0, drive = 0.0, count = 0.0;
    };
    std::vector<Cell> cells(static_cast<std::size_t>((to - from) / cell) + 1);
    for (const ResponseSample& sample : samples) {
        if (!std::isfinite(sample.n) || sample.n < from || sample.n >= to) continue;
        Cell& c = cells[static_cast<std::size_t>((sample.n - from) / cell)];
        c.n += sample.n;
        c.drive += sample.drive;
        c.count += 1.0;
    }
    std::vector<double> n, drive, count;
    for (const Cell& c : cells)
        if (c.count > 0.0) {
            n.push_back(c.n / c.count);
            drive.push_back(c.drive / c.count);
            count.push_back(c.count);
        }
    if (n.size() < 2)
        throw Refused("no valid pixel of the gray-levels photograph gives a usable grey level",
                      "check the exposure and that the picture had arrived before its photograph");

    std::vector<double> rho(kResponseSize);
    for (std::size_t i = 0; i < kResponseSize; ++i) {
        const double at = n_first + (n_last - n_first) * static_cast<double>(i) /
                                        static_cast<double>(kResponseSize - 1);
        // Beyond eight bandwidths a sample adds less than 1e-14 of its weight.
        auto low = std::lower_bound(n.begin(), n.end(), at - 8.0 * bandwidth) - n.begin();
        auto high = std::upper_bound(n.begin(), n.end(), at + 8.0 * bandwidth) - n.begin();
        if (low == high) {  // a gap wider than the kernel: its nearer end
            if (high == static_cast<std::ptrdiff_t>(n.size()) ||
                (low > 0 &&
                 at - n[static_cast<std::size_t>(low - 1)] < n[static_cast<std::size_t>(low)] - at))
                --low;
            else
                ++high;
        }
        const auto part = [&](const std::vector<double>& all) {
            return std::span<const double>(all).subspan(static_cast<std::size_t>(low),
                                                        static_cast<std::size_t>(high - low));
        };
        double value = nadaraya_watson(part(n), part(drive), part(count), bandwidth, at);
        if (std::isnan(value)) value = drive[static_cast<std::size_t>(low)];
        rho[i] = value;
    }
    ResponseCurve curve;
    curve.largest_violation = largest_fall(rho) / 255.0;
    const std::vector<double> ones(kResponseSize, 1.0);
    for (const double value : isotonic_regression(rho, ones))
        curve.drive_from_n.push_back(static_cast<float>(std::clamp(value, 0.0, 255.0)));
    return curve;
}

}  // namespace livery
