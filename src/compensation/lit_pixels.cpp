#include "compensation/lit_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "compensation/drive_table.h"
#include "core/error.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "core/pictures/picture_means.h"
#include "core/statistics.h"

namespace livery {

namespace {

/// Where a rising curve of drives over equal steps of [0, 1] has a drive.
float place_of(const std::vector<float>& drive_from, float drive) {
    const auto above = std::lower_bound(drive_from.begin(), drive_from.end(), drive);
    if (above == drive_from.begin()) return 0.0f;
    if (above == drive_from.end()) return 1.0f;
    const auto i = static_cast<std::size_t>(above - drive_from.begin());
    const float share = (drive - drive_from[i - 1]) / (drive_from[i] - drive_from[i - 1]);
    return (static_cast<float>(i - 1) + share) / static_cast<float>(drive_from.size() - 1);
}

const std::vector<float>& curve_of(const CompensationTable& table, std::size_t channel) {
    return table.non_additive.grid == 0 ? table.drive_from_n[channel]
                                        : table.non_additive.rho[channel];
}

/// `places(pixel)` are the curves' for its three drives.
template <typename T, typename Places>
ImageF shown_of(const CompensationTable& table, const Image<T>& drive, const Places& places) {
    check_argument(
        drive.width == table.width && drive.height == table.height && drive.channels >= 3,
        "the projector input is " + std::to_string(drive.width) + "x" +
            std::to_string(drive.height) + " with " + std::to_string(drive.channels) +
            " channels, the calibration is of " + std::to_string(table.width) + "x" +
            std::to_string(table.height));
    const bool additive = table.non_additive.grid == 0;
    ImageF shown(table.width, table.height, 4);
    const std::size_t count = table.pixels.size();
    parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t pixel = table.pixels[i];
            glm::vec3 n = places(&drive.values[pixel * static_cast<std::size_t>(drive.channels)]);
            if (!additive) n = n_at_linear(table.non_additive, n, nullptr);
            // light N = light (A rgb + b), row by row: what a faded pixel lacks is seen
            n *= table.light[i];
            glm::dmat3 a;
            glm::dvec3 b;
            for (std::size_t row = 0; row < 3; ++row) {
                const auto r = static_cast<int>(row);
                for (std::size_t column = 0; column < 3; ++column) {
                    a[static_cast<int>(column)][r] =
                        static_cast<double>(table.coefficients[(3 * row + column) * count + i]);
                }
                b[r] = static_cast<double>(table.coefficients[(9 + row) * count + i]);
            }
            if (!(std::abs(glm::determinant(a)) > 0.0)) continue;
            const glm::dvec3 rgb = glm::inverse(a) * (glm::dvec3(n) - b);
            float* to = &shown.values[4 * pixel];
            for (int c = 0; c < 3; ++c) to[c] = static_cast<float>(rgb[c]);
            to[3] = 1.0f;
        }
    });
    return shown;
}

}  // namespace

ImageF shown_by(const CompensationTable& table, const Image8& drive) {
    std::array<std::array<float, 256>, 3> places{};
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t level = 0; level < 256; ++level) {
            places[c][level] = place_of(curve_of(table, c), static_cast<float>(level));
        }
    }
    return shown_of(table, drive, [&](const std::uint8_t* levels) {
        return glm::vec3(places[0][levels[0]], places[1][levels[1]], places[2][levels[2]]);
    });
}

ImageF shown_by(const CompensationTable& table, const ImageF& drive) {
    return shown_of(table, drive, [&](const float* levels) {
        return glm::vec3(place_of(curve_of(table, 0), levels[0]),
                         place_of(curve_of(table, 1), levels[1]),
                         place_of(curve_of(table, 2), levels[2]));
    });
}

PictureReach reach_of(const CompensationTable& table, const ImageF& wanted, const Image8& drive) {
    check_argument(
        wanted.channels == 4 && wanted.width == table.width && wanted.height == table.height,
        "a wanted picture: R, G, B and coverage of the calibration's size");
    const std::vector<float> apart = colour_differences(shown_by(table, drive), wanted);
    PictureReach reach;
    reach.pixels = apart.size();
    if (apart.empty()) return reach;
    const auto within = std::count_if(
        apart.begin(), apart.end(), [](float one) { return one < static_cast<float>(kAsWanted); });
    reach.reachable_fraction = static_cast<double>(within) / static_cast<double>(apart.size());
    reach.de00_median = static_cast<double>(median(apart));
    reach.de00_p95 = static_cast<double>(quantile(apart, 0.95));
    return reach;
}

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
