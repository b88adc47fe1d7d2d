#include "calibration/predict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "calibration/colour/colour_report.h"
#include "core/error.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "core/worst_error.h"

namespace livery {
namespace {

/// Half sides of the square windows in which measured pixels are looked for, one after another.
constexpr std::array kWindows{8, 16, 32, 64};
constexpr std::size_t kNeighbours = 64;  ///< enough for a median with an eighth of their scatter
constexpr std::size_t kTestedPixels = 4000;
/// Tested pixels are predicted as from the middle of a hole of this half side: wider than what the
/// per-pixel fits of places and mixing share.
constexpr int kTestHole = 6;

// The mock-up is neutral when the matrices scatter by noise alone, or by little.
constexpr double kSpreadOfNoise = 3.0, kSmallDeviation = 0.03;

bool is_hidden(PixelStatus status) {
    return status == PixelStatus::unlit || status == PixelStatus::not_decoded ||
           status == PixelStatus::edge || status == PixelStatus::too_dark;
}

void check_geometry(const ColourCalibration& c, const ImageF& geometry) {
    check_argument(
        geometry.width == c.width && geometry.height == c.height && geometry.channels == 1,
        "predict_hidden: geometry of " + std::to_string(geometry.width) + "x" +
            std::to_string(geometry.height) + " with " + std::to_string(geometry.channels) +
            " channels for a calibration of " + std::to_string(c.width) + "x" +
            std::to_string(c.height));
    for (const float value : geometry.values) {
        check_argument(std::isfinite(value) && value >= 0.0f,
                       "predict_hidden: geometry of " + std::to_string(value));
    }
}

glm::vec3 vec3_at(const ImageF& plane, std::size_t pixel) {
    const float* const v = plane.values.data() + 3 * pixel;
    return {v[0], v[1], v[2]};
}

std::array<float, 9> pooled_unmixing(const ColourCalibration& c,
                                     const std::vector<std::uint32_t>& measured) {
    std::array<float, 9> pooled{};
    std::vector<float> values(measured.size());
    for (std::size_t k = 0; k < 9; ++k) {
        for (std::size_t i = 0; i < measured.size(); ++i) {
            values[i] = c.unmixing.values[9 * static_cast<std::size_t>(measured[i]) + k];
        }
        pooled[k] = median(values);
    }
    return pooled;
}

/// 90th percentile of the largest deviation from the pooled matrix, over its largest element.
double unmixing_deviation(const ColourCalibration& c,
                          const std::vector<std::uint32_t>& measured,
                          const std::array<float, 9>& pooled) {
    float largest = 0.0f;
    for (const float value : pooled) largest = worse_of(largest, std::abs(value));
    std::vector<float> deviations;
    deviations.reserve(measured.size());
    for (const std::uint32_t pixel : measured) {
        float worst = 0.0f;
        for (std::size_t k = 0; k < 9; ++k) {
            const float value = c.unmixing.values[9 * static_cast<std::size_t>(pixel) + k];
            worst = worse_of(worst, std::abs(value - pooled[k]));
        }
        deviations.push_back(worst / largest);
    }
    return static_cast<double>(quantile(std::move(deviations), 0.9));
}

/// What the measured pixels around a place say.
struct Local {
    glm::vec3 span_over_geometry;
    glm::vec3 dark;
};

class MeasuredPixels {
  public:
    MeasuredPixels(const ColourCalibration& calibration,
                   const ImageF& geometry,
                   const std::vector<std::uint32_t>& pixels)
        : calibration_(calibration),
          geometry_(geometry),
          used_(calibration.width, calibration.height, 1) {
        for (const std::uint32_t pixel : pixels) used_.values[pixel] = 1;
        everywhere_ = medians(pixels);
    }

    /// Medians over the smallest window that holds enough pixels, without those nearer than `hole`;
    /// over all pixels where no window does.
    Local around(int x, int y, int hole) const {
        std::vector<std::uint32_t> found;
        for (const int reach : kWindows) {
            found.clear();
            for (int v = std::max(0, y - reach); v <= std::min(used_.height - 1, y + reach); ++v) {
                for (int u = std::max(0, x - reach); u <= std::min(used_.width - 1, x + reach);
                     ++u) {
                    if (!used_.at(u, v)) continue;
                    if (std::max(std::abs(u - x), std::abs(v - y)) <= hole) continue;
                    found.push_back(static_cast<std::uint32_t>(v * used_.width + u));
                }
            }
            if (found.size() >= kNeighbours) return medians(found);
        }
        return everywhere_;
    }

  private:
    Local medians(const std::vector<std::uint32_t>& pixels) const {
        Local result{};
        std::vector<float> ratios(pixels.size()), darks(pixels.size());
        for (int k = 0; k < 3; ++k) {
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                ratios[i] = vec3_at(calibration_.span, pixels[i])[k] / geometry_.values[pixels[i]];
                darks[i] = vec3_at(calibration_.dark, pixels[i])[k];
            }
            result.span_over_geometry[k] = median(ratios);
            result.dark[k] = median(darks);
        }
        return result;
    }

    const ColourCalibration& calibration_;
    const ImageF& geometry_;
    Image8 used_;  ///< 1 where measured
    Local everywhere_{};
};

/// Relative error of each tested pixel's predicted span, the mean of its channels.
std::vector<float> leave_out_errors(const ColourCalibration& c,
                                    const ImageF& geometry,
                                    const std::vector<std::uint32_t>& measured,
                                    const MeasuredPixels& pixels) {
    const std::size_t count = std::min(kTestedPixels, measured.size());
    std::vector<float> errors(count);
    parallel_for(count, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t pixel = measured[i * measured.size() / count];
            const int x = static_cast<int>(pixel) % c.width, y = static_cast<int>(pixel) / c.width;
            const glm::vec3 predicted =
                pixels.around(x, y, kTestHole).span_over_geometry * geometry.values[pixel];
            const glm::vec3 error = predicted / vec3_at(c.span, pixel) - 1.0f;
            errors[i] = (std::abs(error.x) + std::abs(error.y) + std::abs(error.z)) / 3.0f;
        }
    });
    return errors;
}

}  // namespace

ColourCalibration predict_hidden(ColourCalibration c, const ImageF& geometry) {
    check_geometry(c, geometry);
    const auto refuse = [&c](const std::string& why) {
        c.warnings.push_back("pixels hidden from the camera are not predicted and stay black: " +
                             why);
        return std::move(c);
    };

    // The measured pixels whose geometry is certain enough
    std::vector<float> on_mesh;
    for (std::size_t p = 0; p < geometry.values.size(); ++p) {
        if (static_cast<PixelStatus>(c.status.values[p]) == PixelStatus::measured &&
            geometry.values[p] > 0.0f) {
            on_mesh.push_back(geometry.values[p]);
        }
    }
    const float least = static_cast<float>(kGrazingShare) * quantile(std::move(on_mesh), 0.999);
    std::vector<std::uint32_t> measured, hidden;
    for (std::size_t p = 0; p < geometry.values.size(); ++p) {
        if (geometry.values[p] <= 0.0f || geometry.values[p] < least) continue;
        const auto status = static_cast<PixelStatus>(c.status.values[p]);
        if (status == PixelStatus::measured) measured.push_back(static_cast<std::uint32_t>(p));
        if (is_hidden(status)) hidden.push_back(static_cast<std::uint32_t>(p));
    }
    if (measured.size() < kNeighbours) {
        return refuse("only " + std::to_string(measured.size()) +
                      " measured pixels lie on the mesh; check the projector's pose and lens");
    }

    // One matrix for all, which only a neutral surface has
    const auto unmixing = pooled_unmixing(c, measured);
    const double deviation = unmixing_deviation(c, measured, unmixing);
    if (c.mixing_spread > kSpreadOfNoise && deviation > kSmallDeviation) {
        return refuse("the mock-up is not neutral (its mixing varies by " + percent(deviation) +
                      "), so what is not seen may have any colour; paint it one matt grey, or move "
                      "the camera nearer to the projector");
    }

    // The same prediction where the answer is known
    const MeasuredPixels pixels(c, geometry, measured);
    const auto errors = leave_out_errors(c, geometry, measured, pixels);
    c.prediction_error_median = static_cast<double>(median(errors));
    c.prediction_error_p95 = static_cast<double>(quantile(errors, 0.95));
    if (!(c.prediction_error_median <= kPredictionLimit)) {
        return refuse(
            "from the pose, the measured pixels would be predicted with a median error "
            "of " +
            percent(c.prediction_error_median) +
            "; check that pose, lens and mesh are those of this mock-up");
    }

    // Predicted planes; the places stay unknown
    std::vector<Local> local(hidden.size());
    parallel_for(hidden.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto pixel = static_cast<int>(hidden[i]);
            local[i] = pixels.around(pixel % c.width, pixel / c.width, 0);
        }
    });
    for (std::size_t i = 0; i < hidden.size(); ++i) {
        const std::size_t p = hidden[i];
        std::copy(unmixing.begin(),
                  unmixing.end(),
                  c.unmixing.values.begin() + static_cast<std::ptrdiff_t>(9 * p));
        for (std::size_t k = 0; k < 3; ++k) {
            const auto channel = static_cast<int>(k);
            c.span.values[3 * p + k] = LIVERY_MUTATED(
                predicted_span, local[i].span_over_geometry[channel] * geometry.values[p]);
            c.dark.values[3 * p + k] = local[i].dark[channel];
        }
        c.camera_px.values[2 * p] = c.camera_px.values[2 * p + 1] =
            std::numeric_limits<float>::quiet_NaN();
        c.status.values[p] = static_cast<std::uint8_t>(PixelStatus::predicted);
    }
    const auto valid = std::count_if(c.status.values.begin(), c.status.values.end(), [](auto s) {
        return is_valid(static_cast<PixelStatus>(s));
    });
    c.predicted_fraction = static_cast<double>(hidden.size()) / static_cast<double>(valid);
    return c;
}

}  // namespace livery
