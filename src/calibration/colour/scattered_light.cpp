#include "calibration/colour/scattered_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

namespace livery {
namespace {

constexpr int kCell_px = 16;                  // projector pixels: a block of gray-levels
constexpr double kNarrow = 1.3, kWide = 4.0;  // cells, standard deviation
constexpr int kReach = 9;                     // cells
constexpr double kStandsOut = 4.0;            // variances of its noise
constexpr double kPrior_cells = 0.05;         // that the mean of all counts as

struct LightCell {
    glm::dvec3 sum{0.0}, sum2{0.0};
    double count = 0.0;
    glm::dvec3 mean() const { return sum / count; }
    glm::dvec3 noise() const { return (sum2 / count - mean() * mean()) / count; }
};

/// Weighted mean of the cells around one, the variance of its noise and the cells' own scatter.
struct Average {
    glm::dvec3 mean{0.0}, noise{0.0}, scatter{0.0};
};

Average average(const std::vector<LightCell>& cells,
                int columns,
                int rows,
                int x,
                int y,
                double sigma,
                const glm::dvec3& of_all) {
    Average result;
    glm::dvec3 sum = kPrior_cells * of_all, sum2 = kPrior_cells * of_all * of_all, noise(0.0);
    double weight = kPrior_cells;
    for (int v = std::max(0, y - kReach); v <= std::min(rows - 1, y + kReach); ++v)
        for (int u = std::max(0, x - kReach); u <= std::min(columns - 1, x + kReach); ++u) {
            const LightCell& cell = cells[static_cast<std::size_t>(v * columns + u)];
            if (cell.count < 4.0) continue;
            const double away2 = (u - x) * (u - x) + (v - y) * (v - y);
            const double w = std::exp(-0.5 * away2 / (sigma * sigma));
            const glm::dvec3 mean = cell.mean();
            sum += w * mean;
            sum2 += w * mean * mean;
            noise += w * w * cell.noise();
            weight += w;
        }
    result.mean = sum / weight;
    result.noise = noise / (weight * weight);
    result.scatter = glm::max(sum2 / weight - result.mean * result.mean, glm::dvec3(0.0));
    return result;
}

}  // namespace

ScatteredLight scattered_light(const LevelsSamples& seen) {
    const auto& [samples, mixing, usable, levels, centre] = seen;
    const std::size_t count = samples.pixels.size();
    ScatteredLight light{std::vector<glm::vec3>(count, glm::vec3(0.0f)),
                         std::vector<glm::vec3>(count, glm::vec3(0.0f)),
                         glm::dvec3(0.0)};

    // On black blocks
    std::vector<std::size_t> black;
    std::array<std::vector<float>, 3> found;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t p = samples.pixels[i];
        const std::uint8_t* const drive = levels.drive.values.data() + 3 * std::size_t{p};
        if (!usable[i] || !centre[p] || drive[0] != 0 || drive[1] != 0 || drive[2] != 0) continue;
        const glm::vec3 value =
            mixing.unmixing[i] * samples.pictures[kLevels].colour[i] - mixing.dark[i];
        if (!std::isfinite(value.x + value.y + value.z)) continue;
        black.push_back(i);
        for (int c = 0; c < 3; ++c) found[static_cast<std::size_t>(c)].push_back(value[c]);
    }
    if (black.size() < 16) return light;

    // Cells
    const int columns = samples.width / kCell_px + 1, rows = samples.height / kCell_px + 1;
    const auto cell_at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(x);
    };
    std::vector<LightCell> cells(cell_at(columns - 1, rows - 1) + 1);
    LightCell all;
    glm::dvec3 span_sum(0.0);
    for (std::size_t k = 0; k < black.size(); ++k) {
        const glm::dvec3 value(found[0][k], found[1][k], found[2][k]);
        const int p = static_cast<int>(samples.pixels[black[k]]);
        LightCell& cell =
            cells[cell_at(p % samples.width / kCell_px, p / samples.width / kCell_px)];
        cell.sum += value;
        cell.sum2 += value * value;
        cell.count += 1.0;
        all.sum += value;
        all.count += 1.0;
        span_sum += glm::dvec3(mixing.span[black[k]]);
    }
    if (all.count == 0.0) return light;
    const glm::dvec3 mean = all.sum / all.count;
    light.of_span = all.sum / span_sum;

    // Around each cell: the narrow mean as far as it stands out of its noise, else the wide one
    std::vector<glm::vec3> value(cells.size()), variance(cells.size());
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const Average narrow = average(cells, columns, rows, x, y, kNarrow, mean);
            const Average wide = average(cells, columns, rows, x, y, kWide, mean);
            const std::size_t at = cell_at(x, y);
            for (int c = 0; c < 3; ++c) {
                const double apart = narrow.mean[c] - wide.mean[c];
                const double keep = std::max(
                    0.0, 1.0 - kStandsOut * narrow.noise[c] / std::max(apart * apart, 1e-300));
                value[at][c] = static_cast<float>(wide.mean[c] + keep * apart);
                variance[at][c] = static_cast<float>(
                    keep * std::max(narrow.scatter[c] - narrow.noise[c], 0.0) + narrow.noise[c]);
            }
        }
    for (std::size_t i = 0; i < count; ++i) {
        const int p = static_cast<int>(samples.pixels[i]);
        const std::size_t at = cell_at(p % samples.width / kCell_px, p / samples.width / kCell_px);
        light.separated[i] = value[at];
        light.variance[i] = variance[at];
    }
    return light;
}

}  // namespace livery
