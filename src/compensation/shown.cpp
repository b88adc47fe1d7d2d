#include "compensation/shown.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "compensation/drive_table.h"
#include "core/error.h"
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

}  // namespace livery
