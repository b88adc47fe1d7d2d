#include "calibration/colour/levels_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

#include "calibration/captures/capture_check.h"
#include "calibration/colour/colour_report.h"
#include "core/error.h"
#include "core/statistics.h"
#include "core/worst_error.h"

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

namespace {

constexpr int kCheckedCell_px = 24;  // projector pixels; one bright block at least in most
constexpr double kBrightN = 0.15;
/// A photograph of another picture follows the levels not at all; one of the right picture by more
/// than nine tenths even in a bright room.
constexpr double kFollows = 0.7;

/// Over this it is named; under it hardly tells itself from what blur takes from the blocks.
constexpr double kOtherExposure = 0.02;

/// Exposure of gray-levels over bright-gray's, as its white blocks tell. A share f of the light of
/// each place comes from the places around it, by lens or room. In bright-gray all of them are
/// white; here their mean is m. A black block then shows b = f m, a white one 1 - f + f m of white:
/// both together, white + b (1 / m - 1) is 1 at any f. (The curve has had b taken off.)
struct Exposure {
    double over_bright = 1.0;
    double doubt = 0.0;  ///< f is not the same for both kinds of block: half of what it explains
    double off() const { return worse_of(0.0, std::abs(over_bright - 1.0) - doubt); }
};
Exposure exposure_of(const Pattern& levels,
                     std::size_t channel,
                     const LevelCurve& curve,
                     double black_block) {
    double sum = 0.0;
    for (std::size_t i = channel; i < levels.drive.values.size(); i += 3)
        sum += static_cast<double>(curve.n[levels.drive.values[i]]);
    const double mean = sum / static_cast<double>(levels.drive.pixel_count()) / curve.n[255];
    return {curve.n[255] + black_block / mean, 0.5 * std::abs(black_block) * (1.0 / mean - 1.0)};
}

}  // namespace

LevelsVerdict check_levels(const LevelsSamples& seen,
                           const ScatteredLight& scattered,
                           const std::array<LevelCurve, 3>& curves) {
    const auto& [samples, mixing, usable, levels, centre] = seen;
    const int columns = samples.width / kCheckedCell_px + 1,
              rows = samples.height / kCheckedCell_px + 1;
    std::vector<std::vector<float>> ratios(static_cast<std::size_t>(columns) *
                                           static_cast<std::size_t>(rows));
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    for (std::size_t i = 0; i < samples.pixels.size(); ++i) {
        const std::uint32_t p = samples.pixels[i];
        if (!usable[i] || !centre[p]) continue;
        const glm::vec3 value = (mixing.unmixing[i] * samples.pictures[kLevels].colour[i] -
                                 mixing.dark[i] - scattered.separated[i]) /
                                mixing.span[i];
        const std::uint8_t* const drive = levels.drive.values.data() + 3 * std::size_t{p};
        const double x = drive[1] / 255.0 * (drive[1] / 255.0), y = static_cast<double>(value.y);
        if (!std::isfinite(y)) continue;
        n += 1.0;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
        syy += y * y;
        const double expected = curves[1].n[drive[1]];
        if (expected < kBrightN) continue;
        const int cx = static_cast<int>(p) % samples.width / kCheckedCell_px,
                  cy = static_cast<int>(p) / samples.width / kCheckedCell_px;
        ratios[static_cast<std::size_t>(cy) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(cx)]
            .push_back(static_cast<float>(y / expected));
    }
    const double follows =
        (n * sxy - sx * sy) / std::sqrt(std::max((n * sxx - sx * sx) * (n * syy - sy * sy), 1e-30));
    if (n > 0.0 && !(follows > kFollows))
        throw Refused("the photograph of gray-levels does not show its pattern",
                      "check that it shows the gray-levels picture that manifest.json names, not "
                      "another, mirrored or late one, and that its exposure is that of the others");

    ImageF ratio(columns, rows, 1, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t k = 0; k < ratios.size(); ++k)
        if (ratios[k].size() >= 4) ratio.values[k] = median(ratios[k]);
    // Pieces of 3 x 3 would be eighty pixels: here two neighbours along each axis are enough.
    std::vector<float> known;
    for (const float value : ratio.values)
        if (std::isfinite(value)) known.push_back(value);
    const float typical = median(known);
    double off = 0.0;
    std::vector<float> there;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const auto is_off = [&](int u, int v) {
                return u >= 0 && v >= 0 && u < columns && v < rows &&
                       std::isfinite(ratio.at(u, v)) &&
                       std::abs(ratio.at(u, v) - typical) > 0.15f * typical;
            };
            if (!is_off(x, y)) continue;
            const int beside =
                is_off(x - 1, y) + is_off(x + 1, y) + is_off(x, y - 1) + is_off(x, y + 1);
            if (beside < 2) continue;
            off += 1.0;
            there.push_back(ratio.at(x, y) / typical);
        }
    const double share = off / std::max(1.0, static_cast<double>(known.size()));
    if (share > 0.03) {
        const auto there_ratio = static_cast<double>(median(there));
        throw Refused(
            "gray-levels: " + percent(share) + " of the mock-up is " + times_of(there_ratio) +
                " than the other photographs say: a shadow, a reflection or somebody in the light",
            "keep out of the light of the projector and of the camera's view, and repeat that "
            "photograph");
    }

    LevelsVerdict verdict;
    Exposure exposure;
    for (std::size_t k = 0; k < 3; ++k) {
        const Exposure here =
            exposure_of(levels, k, curves[k], scattered.of_span[static_cast<int>(k)]);
        if (!(here.off() <= exposure.off())) exposure = here;
    }
    if (exposure.off() > kOtherExposure)
        verdict.warnings.push_back(
            "gray-levels is " + times_of(exposure.over_bright) +
            " than bright-gray says: it had another exposure, or the lamp another brightness; its "
            "white blocks are taken for white; photograph all pictures at one exposure");
    else
        verdict.unexplained = exposure.off();
    return verdict;
}

}  // namespace livery
