#include "calibration/correspondence/camera_bins.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/vec2.hpp>

#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {

Image8 without_strays(const CameraToProjector& decoded, double reach) {
    constexpr int kLeastAgreeing = 2;  // of eight; a corner pixel of a panel keeps three
    const int width = decoded.decoded.width, height = decoded.decoded.height;
    Image8 kept = decoded.decoded;
    parallel_for(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < width; ++x) {
                if (!decoded.decoded.at(x, y)) continue;
                const float* const own = decoded.projector_px.pixel(x, y);
                int agreeing = 0;
                for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
                    for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
                        if ((u == x && v == y) || !decoded.decoded.at(u, v)) continue;
                        const float* const other = decoded.projector_px.pixel(u, v);
                        agreeing += std::abs(static_cast<double>(own[0] - other[0])) <= reach &&
                                    std::abs(static_cast<double>(own[1] - other[1])) <= reach;
                    }
                if (agreeing < kLeastAgreeing) kept.at(x, y) = 0;
            }
    });
    return kept;
}

Bins gather(const CameraToProjector& decoded, const Image8& kept, int width, int height) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const auto place_of = [&](std::size_t i) {
        const auto x = static_cast<std::size_t>(decoded.projector_px.values[2 * i]);
        const auto y = static_cast<std::size_t>(decoded.projector_px.values[2 * i + 1]);
        return y * static_cast<std::size_t>(width) + x;
    };

    // Counting sort of the camera pixels by projector pixel
    std::vector<std::uint32_t> first(pixels + 1, 0);
    std::size_t total = 0;
    for (std::size_t i = 0; i < kept.values.size(); ++i)
        if (kept.values[i]) {
            ++first[place_of(i) + 1];
            ++total;
        }
    std::size_t hit = 0;
    for (std::size_t p = 0; p < pixels; ++p) {
        hit += first[p + 1] > 0;
        first[p + 1] += first[p];
    }
    std::vector<std::uint32_t> order(total), next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < kept.values.size(); ++i)
        if (kept.values[i]) order[next[place_of(i)]++] = static_cast<std::uint32_t>(i);

    Bins result;
    result.width = width;
    result.height = height;
    result.bins.resize(pixels);

    // Scale: how densely the camera samples, from bins with neighbours on all sides. Where few
    // pixels are hit at all, the camera is coarser than the projector, and the share tells.
    std::size_t inner = 0, inner_samples = 0;
    for (int y = 2; y + 2 < height; ++y)
        for (int x = 2; x + 2 < width; ++x) {
            const std::size_t p = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(x);
            const auto row = static_cast<std::size_t>(width);
            const std::size_t around = first[p - row + 2] - first[p - row - 1];
            const std::size_t middle = first[p + 2] - first[p - 1];
            const std::size_t below = first[p + row + 2] - first[p + row - 1];
            if (around == 0 || middle == 0 || below == 0) continue;
            inner += 9;
            inner_samples += around + middle + below;
        }
    const double density =
        inner > 0 ? static_cast<double>(inner_samples) / static_cast<double>(inner)
                  : static_cast<double>(total) / static_cast<double>(std::max<std::size_t>(hit, 1));
    result.camera_px_per_pixel = std::sqrt(std::max(density, 0.01));

    // Mean of each bin without strays
    const auto camera_width = static_cast<std::uint32_t>(decoded.decoded.width);
    const auto reach = static_cast<float>(1.5 * result.camera_px_per_pixel + 1.0);
    const auto is_fine = [&](std::uint32_t i) {
        return !decoded.sigma_px.empty() && decoded.sigma_px.values[2 * i] < kWholePixelError;
    };
    parallel_for(pixels, 4096, [&](std::size_t begin, std::size_t end) {
        std::vector<float> xs, ys;
        for (std::size_t p = begin; p < end; ++p) {
            if (first[p] == first[p + 1]) continue;
            xs.clear();
            ys.clear();
            bool any_fine = false;
            for (std::uint32_t k = first[p]; k < first[p + 1]; ++k) {
                xs.push_back(static_cast<float>(order[k] % camera_width) + 0.5f);
                ys.push_back(static_cast<float>(order[k] / camera_width) + 0.5f);
                any_fine = any_fine || is_fine(order[k]);
            }
            const bool few = xs.size() < 3;
            const float centre_x = few ? xs[0] : median(xs);
            const float centre_y = few ? ys[0] : median(ys);
            const glm::vec2 middle(static_cast<float>(p % static_cast<std::size_t>(width)) + 0.5f,
                                   static_cast<float>(p / static_cast<std::size_t>(width)) + 0.5f);
            Bin& bin = result.bins[p];
            for (const bool fine : {true, false}) {
                for (std::size_t k = 0; k < xs.size(); ++k) {
                    const std::uint32_t i = order[first[p] + k];
                    if ((any_fine && is_fine(i) != fine) || std::abs(xs[k] - centre_x) > reach ||
                        std::abs(ys[k] - centre_y) > reach)
                        continue;
                    bin.count += 1.0f;
                    bin.x += xs[k];
                    bin.y += ys[k];
                    bin.u += decoded.projector_px.values[2 * i] - middle.x;
                    bin.v += decoded.projector_px.values[2 * i + 1] - middle.y;
                }
                if (bin.count > 0.0f) break;
            }
            for (float* sum : {&bin.x, &bin.y, &bin.u, &bin.v}) *sum /= bin.count;
        }
    });
    return result;
}

}  // namespace livery
