#include "compensation/lit_pixels.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "core/error.h"
#include "core/mutation.h"
#include "core/parallel.h"

namespace livery {
namespace {

constexpr int kReach = kSurroundings_px;

PixelStatus status_at(const Image8& status, std::size_t pixel) {
    return static_cast<PixelStatus>(status.values[pixel]);
}

int weight_at(int distance) { return kReach + 1 - std::abs(distance); }

/// Weights of a line's surroundings that lie within the picture.
int weight_inside(int place, int size) {
    int sum = 0;
    for (int d = std::max(-kReach, -place); d <= std::min(kReach, size - 1 - place); ++d) {
        sum += weight_at(d);
    }
    return sum;
}

/// Weighted count of the known pixels to the left and right of each.
std::vector<std::uint8_t> known_along_rows(const Image8& status) {
    std::vector<std::uint8_t> sums(status.pixel_count());
    const auto width = static_cast<std::size_t>(status.width);
    parallel_for(
        static_cast<std::size_t>(status.height), 64, [&](std::size_t begin, std::size_t end) {
            std::vector<std::uint8_t> known(width + 2 * kReach);
            for (std::size_t y = begin; y < end; ++y) {
                for (std::size_t x = 0; x < width; ++x) {
                    known[x + kReach] = is_valid(status_at(status, y * width + x)) ? 1 : 0;
                }
                for (std::size_t x = 0; x < width; ++x) {
                    int sum = 0;
                    for (int d = -kReach; d <= kReach; ++d) {
                        sum += weight_at(d) * known[x + static_cast<std::size_t>(d + kReach)];
                    }
                    sums[y * width + x] = static_cast<std::uint8_t>(sum);
                }
            }
        });
    return sums;
}

}  // namespace

LitPixels lit_pixels(const Image8& status) {
    const std::vector<std::uint8_t> along_rows = known_along_rows(status);
    std::vector<float> light(status.pixel_count(), 0.0f);
    const auto width = static_cast<std::size_t>(status.width);
    std::vector<int> inside_columns(width);
    for (int x = 0; x < status.width; ++x) {
        inside_columns[static_cast<std::size_t>(x)] = weight_inside(x, status.width);
    }
    parallel_for(
        static_cast<std::size_t>(status.height), 64, [&](std::size_t begin, std::size_t end) {
            std::vector<int> sums(width);
            for (std::size_t row = begin; row < end; ++row) {
                const auto y = static_cast<int>(row);
                const int inside = weight_inside(y, status.height);
                std::fill(sums.begin(), sums.end(), 0);
                for (int d = std::max(-kReach, -y); d <= std::min(kReach, status.height - 1 - y);
                     ++d) {
                    const std::uint8_t* from = &along_rows[static_cast<std::size_t>(y + d) * width];
                    for (std::size_t x = 0; x < width; ++x) sums[x] += weight_at(d) * from[x];
                }
                // The picture's own border is none: what lies outside counts neither way.
                for (std::size_t x = 0; x < width; ++x) {
                    const double known = static_cast<double>(sums[x]) /
                                         static_cast<double>(inside * inside_columns[x]);
                    light[row * width + x] = static_cast<float>(
                        std::min(1.0, LIVERY_MUTATED(border_light, known / kKnownEnough)));
                }
            }
        });
    LitPixels lit;
    for (std::size_t pixel = 0; pixel < light.size(); ++pixel) {
        if (light[pixel] == 0.0f) continue;
        lit.pixels.push_back(static_cast<std::uint32_t>(pixel));
        lit.light.push_back(light[pixel]);
    }
    return lit;
}

namespace {

PixelCorrection own_correction(const ColourCalibration& c, std::size_t pixel) {
    PixelCorrection own;
    bool sound = true;
    for (std::size_t k = 0; k < 9; ++k) {
        own.unmixing[k] = c.unmixing.values[9 * pixel + k];
        sound = sound && std::isfinite(own.unmixing[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        own.dark[k] = c.dark.values[3 * pixel + k];
        own.span[k] = c.span.values[3 * pixel + k];
        sound =
            sound && std::isfinite(own.dark[k]) && std::isfinite(own.span[k]) && own.span[k] > 0.0f;
    }
    if (sound) return own;
    const auto width = static_cast<std::size_t>(c.width);
    throw std::invalid_argument(
        "calibration pixel (" + std::to_string(pixel % width) + ", " +
        std::to_string(pixel / width) + ") is marked valid, but its span is (" +
        std::to_string(own.span[0]) + ", " + std::to_string(own.span[1]) + ", " +
        std::to_string(own.span[2]) + ") or a number of it is not finite");
}

}  // namespace

PixelCorrection correction_of(const ColourCalibration& c, std::size_t pixel) {
    if (is_valid(status_at(c.status, pixel))) return own_correction(c, pixel);
    const auto width = static_cast<std::size_t>(c.width);
    const auto x = static_cast<int>(pixel % width), y = static_cast<int>(pixel / width);
    PixelCorrection mean;
    float weights = 0.0f;
    for (int v = std::max(0, y - kReach); v <= std::min(c.height - 1, y + kReach); ++v) {
        for (int u = std::max(0, x - kReach); u <= std::min(c.width - 1, x + kReach); ++u) {
            const auto there = static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u);
            if (!is_valid(status_at(c.status, there))) continue;
            const PixelCorrection one = own_correction(c, there);
            const auto squared = static_cast<float>((u - x) * (u - x) + (v - y) * (v - y));
            const float weight = 1.0f / (squared * squared);
            for (std::size_t k = 0; k < 9; ++k) mean.unmixing[k] += weight * one.unmixing[k];
            for (std::size_t k = 0; k < 3; ++k) {
                mean.dark[k] += weight * one.dark[k];
                mean.span[k] += weight * one.span[k];
            }
            weights += weight;
        }
    }
    check_argument(weights > 0.0f, "no valid pixel around an unknown one");
    for (float& value : mean.unmixing) value /= weights;
    for (std::size_t k = 0; k < 3; ++k) {
        mean.dark[k] /= weights;
        mean.span[k] /= weights;
    }
    return mean;
}

PixelShares pixel_shares(const ColourCalibration& c, const Image8& counted) {
    check_argument(counted.empty() || (counted.width == c.width && counted.height == c.height &&
                                       counted.channels == 1),
                   fmt::format("pixel_shares: a mask of {}x{} with {} channels, the calibration "
                               "has {}x{}",
                               counted.width,
                               counted.height,
                               counted.channels,
                               c.width,
                               c.height));
    const LitPixels lit = lit_pixels(c.status);
    PixelShares shares;
    double whole = 0.0;
    std::size_t next = 0;
    for (std::size_t pixel = 0; pixel < c.status.pixel_count(); ++pixel) {
        const bool is_lit = next < lit.pixels.size() && lit.pixels[next] == pixel;
        const float light = is_lit ? lit.light[next++] : 0.0f;
        const PixelStatus status = status_at(c.status, pixel);
        if (counted.empty() ? status == PixelStatus::unlit : counted.values[pixel] == 0) continue;
        double& share = light == 0.0f                      ? shares.black
                        : light < 1.0f                     ? shares.faded
                        : status == PixelStatus::predicted ? shares.predicted
                        : is_valid(status)                 ? shares.measured
                                                           : shares.interpolated;
        share += 1.0;
        whole += 1.0;
    }
    if (whole == 0.0) return shares;
    for (double* share : {&shares.measured,
                          &shares.predicted,
                          &shares.interpolated,
                          &shares.faded,
                          &shares.black}) {
        *share /= whole;
    }
    return shares;
}

std::string text_of(const PixelShares& shares) {
    return fmt::format(
        "{:.1f}% measured, {:.1f}% predicted, {:.1f}% interpolated, {:.1f}% faded, {:.1f}% black",
        100.0 * shares.measured,
        100.0 * shares.predicted,
        100.0 * shares.interpolated,
        100.0 * shares.faded,
        100.0 * shares.black);
}

}  // namespace livery
