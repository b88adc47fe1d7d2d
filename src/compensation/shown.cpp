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
#include "core/pictures/colour_differences.h"
#include "core/statistics.h"

namespace livery {
namespace {

/// Of each of the 256 drives, where a rising curve of drives over equal steps of [0, 1] has it.
std::array<float, 256> places_of_drives(const std::vector<float>& drive_from) {
    std::array<float, 256> places{};
    for (std::size_t drive = 0; drive < places.size(); ++drive) {
        const auto wanted = static_cast<float>(drive);
        const auto above = std::lower_bound(drive_from.begin(), drive_from.end(), wanted);
        if (above == drive_from.begin()) continue;
        if (above == drive_from.end()) {
            places[drive] = 1.0f;
            continue;
        }
        const auto i = static_cast<std::size_t>(above - drive_from.begin());
        const float share = (wanted - drive_from[i - 1]) / (drive_from[i] - drive_from[i - 1]);
        places[drive] =
            (static_cast<float>(i - 1) + share) / static_cast<float>(drive_from.size() - 1);
    }
    return places;
}

}  // namespace

ImageF shown_by(const CompensationTable& table, const Image8& drive) {
    check_argument(
        drive.width == table.width && drive.height == table.height && drive.channels >= 3,
        "the projector input is " + std::to_string(drive.width) + "x" +
            std::to_string(drive.height) + " with " + std::to_string(drive.channels) +
            " channels, the calibration is of " + std::to_string(table.width) + "x" +
            std::to_string(table.height));
    const bool additive = table.non_additive.grid == 0;
    std::array<std::array<float, 256>, 3> places;
    for (std::size_t c = 0; c < 3; ++c) {
        places[c] = places_of_drives(additive ? table.drive_from_n[c] : table.non_additive.rho[c]);
    }
    ImageF shown(table.width, table.height, 4);
    const std::size_t count = table.pixels.size();
    parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t pixel = table.pixels[i];
            const std::uint8_t* levels =
                &drive.values[pixel * static_cast<std::size_t>(drive.channels)];
            glm::vec3 n;
            for (int c = 0; c < 3; ++c) n[c] = places[static_cast<std::size_t>(c)][levels[c]];
            if (!additive) n = n_at_linear(table.non_additive, n, nullptr);
            // N = A rgb + b, row by row
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
