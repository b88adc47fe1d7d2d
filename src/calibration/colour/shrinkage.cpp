#include "calibration/colour/shrinkage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace livery {
namespace {

/// A value is moved by this many of its own standard deviations at most: farther off it does not
/// belong to its neighbourhood, as a bright spoke between dark ones whose small variances make up
/// the mean (limited translation, Efron and Morris 1972).
constexpr double kMostSigmas = 3.0;

/// Sums over (2 radius + 1)^2 windows, clipped at the border, in place.
void box_sum(std::vector<float>& plane, int width, int height, int radius) {
    const auto w = static_cast<std::size_t>(width);
    std::vector<double> prefix(static_cast<std::size_t>(std::max(width, height)) + 1, 0.0);
    for (int y = 0; y < height; ++y) {
        float* const row = plane.data() + static_cast<std::size_t>(y) * w;
        for (int x = 0; x < width; ++x)
            prefix[static_cast<std::size_t>(x) + 1] =
                prefix[static_cast<std::size_t>(x)] + static_cast<double>(row[x]);
        for (int x = 0; x < width; ++x)
            row[x] = static_cast<float>(
                prefix[static_cast<std::size_t>(std::min(width, x + radius + 1))] -
                prefix[static_cast<std::size_t>(std::max(0, x - radius))]);
    }
    // Columns by running sums over whole rows, so that memory is read in order
    std::vector<double> sum(w, 0.0);
    std::vector<float> result(plane.size());
    const auto row_at = [&](int y) { return plane.data() + static_cast<std::size_t>(y) * w; };
    for (int y = 0; y < std::min(radius, height); ++y)
        for (std::size_t x = 0; x < w; ++x) sum[x] += static_cast<double>(row_at(y)[x]);
    for (int y = 0; y < height; ++y) {
        if (y + radius < height)
            for (std::size_t x = 0; x < w; ++x)
                sum[x] += static_cast<double>(row_at(y + radius)[x]);
        if (y - radius - 1 >= 0)
            for (std::size_t x = 0; x < w; ++x)
                sum[x] -= static_cast<double>(row_at(y - radius - 1)[x]);
        float* const out = result.data() + static_cast<std::size_t>(y) * w;
        for (std::size_t x = 0; x < w; ++x) out[x] = static_cast<float>(sum[x]);
    }
    plane.swap(result);
}

}  // namespace

SampleGrid::SampleGrid(int picture_width, const std::vector<std::uint32_t>& pixels) {
    if (pixels.empty()) return;
    int right = 0, bottom = 0;
    left = top = std::numeric_limits<int>::max();
    for (const std::uint32_t pixel : pixels) {
        const int x = static_cast<int>(pixel) % picture_width,
                  y = static_cast<int>(pixel) / picture_width;
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
    }
    width = right - left + 1;
    height = bottom - top + 1;
    sample_at.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), -1);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const int x = static_cast<int>(pixels[i]) % picture_width - left;
        const int y = static_cast<int>(pixels[i]) / picture_width - top;
        sample_at[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)] = static_cast<std::int32_t>(i);
    }
}

Shrunk shrink_locally(const SampleGrid& grid,
                      std::span<const float> values,
                      std::span<const float> variances,
                      int radius,
                      bool toward_zero) {
    check_argument(values.size() == variances.size(), "values and variances differ in count");
    Shrunk shrunk{{values.begin(), values.end()}, {variances.begin(), variances.end()}};

    // A common offset and a floor under the variances keep single precision harmless.
    double mean = 0.0, square = 0.0, used = 0.0;
    const auto takes_part = [&](std::size_t i) {
        return std::isfinite(values[i]) && std::isfinite(variances[i]) && variances[i] > 0.0f;
    };
    for (std::size_t i = 0; i < values.size(); ++i)
        if (takes_part(i)) {
            mean += static_cast<double>(values[i]);
            square += static_cast<double>(values[i]) * static_cast<double>(values[i]);
            used += 1.0;
        }
    if (used < 2.0) return shrunk;
    const auto offset = toward_zero ? 0.0f : static_cast<float>(mean / used);
    const double floor = 1e-12 * square / used + 1e-30;

    const std::size_t cells = grid.sample_at.size();
    std::vector<float> count(cells, 0.0f), w(cells, 0.0f), wy(cells, 0.0f), wyy(cells, 0.0f);
    // Weights relative to a typical one, to stay in range
    const double unit = [&] {
        double sum = 0.0;
        for (std::size_t i = 0; i < values.size(); ++i)
            if (takes_part(i)) sum += 1.0 / (static_cast<double>(variances[i]) + floor);
        return sum / used;
    }();
    for (std::size_t k = 0; k < cells; ++k) {
        const std::int32_t i = grid.sample_at[k];
        if (i < 0 || !takes_part(static_cast<std::size_t>(i))) continue;
        const auto at = static_cast<std::size_t>(i);
        const auto weight =
            static_cast<float>(1.0 / ((static_cast<double>(variances[at]) + floor) * unit));
        const float y = values[at] - offset;
        count[k] = 1.0f;
        w[k] = weight;
        wy[k] = weight * y;
        wyy[k] = weight * y * y;
    }
    for (auto* plane : {&count, &w, &wy, &wyy}) box_sum(*plane, grid.width, grid.height, radius);

    for (std::size_t k = 0; k < cells; ++k) {
        const std::int32_t i = grid.sample_at[k];
        if (i < 0 || !takes_part(static_cast<std::size_t>(i))) continue;
        const auto at = static_cast<std::size_t>(i);
        const double n = static_cast<double>(count[k]), weight = static_cast<double>(w[k]);
        if (n < 4.0 || weight <= 0.0) continue;
        const double m = static_cast<double>(wy[k]) / weight;
        const double noise = n / (weight * unit);  // harmonic mean of the variances
        const double scatter =
            std::max(0.0, static_cast<double>(wyy[k]) / weight - m * m) * n / (n - 1.0);
        const double excess = std::max(0.0, scatter - noise);

        // The local mean: two standard errors are what chance gives.
        const double error2 = 1.0 / (weight * unit);
        const double keep_mean =
            toward_zero ? std::max(0.0, 1.0 - 4.0 * error2 / std::max(m * m, 1e-300)) : 1.0;
        const double own = static_cast<double>(variances[at]) + floor;
        const double keep = excess / (excess + own);
        const auto measured = static_cast<double>(values[at] - offset);
        const double shift = keep_mean * m + keep * (measured - m) - measured;
        const double most = kMostSigmas * std::sqrt(own);
        const bool is_limited = std::abs(shift) > most;
        shrunk.value[at] = static_cast<float>(static_cast<double>(offset) + measured +
                                              std::clamp(shift, -most, most));
        shrunk.variance[at] =
            static_cast<float>(is_limited ? own : keep * own + (1.0 - keep) * keep_mean * error2);
    }
    return shrunk;
}

}  // namespace livery
