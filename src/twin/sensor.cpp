#include "twin/sensor.h"

#include <algorithm>
#include <cmath>

#include <glm/vec2.hpp>

#include "core/colour.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "core/paths.h"
#include "core/random.h"
#include "core/spectrum.h"
#include "twin/spectra.h"

namespace livery {

namespace {

constexpr double kFullScale14 = 16383.0;

/// The standard normal's quantile function, by Newton steps of limited length.
double normal_quantile(double p) {
    // From the logistic approximation.
    double x = std::log(p / (1.0 - p)) / 1.702;
    for (int step = 0; step < 40; ++step) {
        const double error = 0.5 * std::erfc(-x / std::sqrt(2.0)) - p;
        const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * 3.14159265358979323846);
        const double change = std::clamp(error / density, -0.5, 0.5);
        x -= change;
        if (std::abs(change) < 1e-12) break;
    }
    return x;
}

/// Equally likely values of a standard normal: noise for six million samples a photograph.
const std::vector<float>& normal_table() {
    static const std::vector<float> table = [] {
        std::vector<float> values(1u << 16u);
        for (std::size_t k = 0; k < values.size(); ++k) {
            values[k] = static_cast<float>(normal_quantile((static_cast<double>(k) + 0.5) /
                                                           static_cast<double>(values.size())));
        }
        return values;
    }();
    return table;
}

std::vector<double> gaussian_weights(double sigma) {
    const int reach = static_cast<int>(std::ceil(3.0 * sigma));
    std::vector<double> weights;
    double sum = 0.0;
    for (int k = -reach; k <= reach; ++k) {
        weights.push_back(std::exp(-0.5 * k * k / (sigma * sigma)));
        sum += weights.back();
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

/// Blurs the columns and swaps the axes; outside the picture is dark. Applied twice: both axes.
ImageF blurred_transposed(const ImageF& from, const std::vector<double>& weights) {
    ImageF to(from.height, from.width, from.channels);
    const int reach = static_cast<int>(weights.size() / 2);
    parallel_for(static_cast<std::size_t>(from.width), 4, [&](std::size_t begin, std::size_t end) {
        for (int x = static_cast<int>(begin); x < static_cast<int>(end); ++x) {
            for (int y = 0; y < from.height; ++y) {
                for (int c = 0; c < from.channels; ++c) {
                    double sum = 0.0;
                    for (int k = std::max(-reach, -y); k <= std::min(reach, from.height - 1 - y);
                         ++k) {
                        sum += weights[static_cast<std::size_t>(k + reach)] * from.at(x, y + k, c);
                    }
                    to.at(y, x, c) = static_cast<float>(sum);
                }
            }
        }
    });
    return to;
}

/// Three channels between pixels, the border held.
void sample(const ImageF& image, double x, double y, float* out) {
    const double cx = std::clamp(x - 0.5, 0.0, image.width - 1.0);
    const double cy = std::clamp(y - 0.5, 0.0, image.height - 1.0);
    const int x0 = std::min(static_cast<int>(cx), image.width - 2);
    const int y0 = std::min(static_cast<int>(cy), image.height - 2);
    const auto u = static_cast<float>(cx - x0), v = static_cast<float>(cy - y0);
    const float* a = image.pixel(x0, y0);
    const float* b = image.pixel(x0, y0 + 1);
    for (int c = 0; c < 3; ++c) {
        out[c] = (1.0f - v) * ((1.0f - u) * a[c] + u * a[3 + c]) +
                 v * ((1.0f - u) * b[c] + u * b[3 + c]);
    }
}

/// `by(x)`: how far, of each column.
template <typename By>
ImageF displaced(const ImageF& light, const By& by) {
    ImageF result(light.width, light.height, 3);
    parallel_for(
        static_cast<std::size_t>(light.height), 16, [&](std::size_t begin, std::size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                for (int x = 0; x < light.width; ++x) {
                    const glm::dvec2 here = by(x);
                    sample(light, x + 0.5 - here.x, y + 0.5 - here.y, result.pixel(x, y));
                }
            }
        });
    return result;
}

}  // namespace

double saturates_at(const CameraDescription& camera) {
    return camera.encoding == CameraEncoding::srgb8 ? 255.0 : kFullScale14;
}

double black_level(const CameraDescription& camera) {
    return camera.encoding == CameraEncoding::srgb8 ? 0.0 : camera.black_level_units;
}

ImageF shifted(const ImageF& light, double shift_px) {
    // Between 60% and 100% of the shift, along (0.8, 0.6).
    return displaced(light, [&](int x) {
        return shift_px * (0.6 + 0.4 * (x + 0.5) / light.width) * glm::dvec2(0.8, 0.6);
    });
}

ImageF moved(const ImageF& light, double right_px, double down_px) {
    return displaced(light, [&](int) { return glm::dvec2(right_px, down_px); });
}

ImageF with_flare(const ImageF& light, double flare, double radius_of_width) {
    // The scattered light varies over hundreds of pixels: it is computed on one pixel in 16 x 16.
    constexpr int kStep = 16;
    ImageF coarse((light.width + kStep - 1) / kStep, (light.height + kStep - 1) / kStep, 3);
    parallel_for(
        static_cast<std::size_t>(coarse.height), 1, [&](std::size_t begin, std::size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                for (int x = 0; x < coarse.width; ++x) {
                    double sum[3] = {};
                    for (int v = y * kStep; v < std::min((y + 1) * kStep, light.height); ++v) {
                        for (int u = x * kStep; u < std::min((x + 1) * kStep, light.width); ++u) {
                            for (int c = 0; c < 3; ++c) sum[c] += light.at(u, v, c);
                        }
                    }
                    for (int c = 0; c < 3; ++c) {
                        coarse.at(x, y, c) = static_cast<float>(sum[c] / (kStep * kStep));
                    }
                }
            }
        });
    const auto weights = gaussian_weights(radius_of_width * light.width / kStep);
    const ImageF wide = blurred_transposed(blurred_transposed(coarse, weights), weights);
    ImageF result(light.width, light.height, 3);
    const auto kept = static_cast<float>(1.0 - flare);
    const auto spread = LIVERY_MUTATED(twin_flare, static_cast<float>(flare));
    parallel_for(
        static_cast<std::size_t>(light.height), 16, [&](std::size_t begin, std::size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                for (int x = 0; x < light.width; ++x) {
                    float scattered[3];
                    sample(wide, (x + 0.5) / kStep, (y + 0.5) / kStep, scattered);
                    for (int c = 0; c < 3; ++c) {
                        result.at(x, y, c) = kept * light.at(x, y, c) + spread * scattered[c];
                    }
                }
            }
        });
    return result;
}

ImageF develop(const CameraDescription& camera,
               const ImageF& units_per_s,
               double exposure_s,
               std::uint64_t seed,
               std::uint32_t photograph) {
    ImageF file(units_per_s.width, units_per_s.height, 3);
    const bool raw = camera.encoding == CameraEncoding::raw14;
    const auto black = static_cast<float>(camera.black_level_units);
    const auto full = static_cast<float>(kFullScale14);
    const auto exposure = static_cast<float>(exposure_s);
    const auto read2 = static_cast<float>(camera.read_noise_units * camera.read_noise_units);
    const float shot = camera.electrons_per_unit > 0.0
                           ? static_cast<float>(1.0 / camera.electrons_per_unit)
                           : 0.0f;
    const bool noisy = shot > 0.0f || read2 > 0.0f;
    const auto& normal = normal_table();
    std::vector<float> curve;  // 8 bit: the file's value for each 14-bit one
    for (int k = 0; !raw && k <= static_cast<int>(kFullScale14); ++k) {
        const double linear =
            std::max(0.0, k - camera.black_level_units) / (kFullScale14 - camera.black_level_units);
        curve.push_back(static_cast<float>(std::round(255.0 * srgb_encode(linear))));
    }
    const auto seed_low = static_cast<std::uint32_t>(seed),
               seed_high = static_cast<std::uint32_t>(seed >> 32u);
    const std::uint32_t series = hash_3d(seed_low, seed_high, photograph);
    parallel_for(
        static_cast<std::size_t>(file.height), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t y = begin; y < end; ++y) {
                for (std::size_t x = 0; x < static_cast<std::size_t>(file.width); ++x) {
                    const std::size_t first = 3 * (y * static_cast<std::size_t>(file.width) + x);
                    std::uint32_t bits[2] = {};
                    if (noisy) {
                        bits[0] = hash_3d(
                            static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), series);
                        bits[1] = hash_3d(bits[0], series, static_cast<std::uint32_t>(y));
                    }
                    const std::uint32_t index[3] = {
                        bits[0] & 0xffffu, bits[0] >> 16u, bits[1] & 0xffffu};
                    for (std::size_t c = 0; c < 3; ++c) {
                        float value = units_per_s.values[first + c] * exposure;
                        // Photons arrive at random (variance = mean, in electrons), reading adds
                        // its own.
                        if (noisy) {
                            value += LIVERY_MUTATED(twin_noise, std::sqrt(value * shot + read2)) *
                                     normal[index[c]];
                        }
                        value = std::clamp(std::round(value + black), 0.0f, full);
                        file.values[first + c] =
                            raw ? value : curve[static_cast<std::size_t>(value)];
                    }
                }
            }
        });
    return file;
}

ChartPhotograph photograph_chart_under_daylight(const CameraDescription& camera) {
    const SpectrumTable patches =
        read_spectra_csv(shipped_path("calibration/spectra/colorchecker.csv"));
    const Spectrum& daylight = illuminant_d65();
    ChartPhotograph chart;
    for (const Spectrum& reflectance : patches.columns) {
        glm::dvec3 rgb(0.0);
        for (std::size_t k = 0; k < reflectance.size(); ++k) {
            const double light = daylight[k] * reflectance[k];
            for (int c = 0; c < 3; ++c) {
                rgb[c] += light * camera.sensitivities[static_cast<std::size_t>(c)][k];
            }
        }
        chart.camera_rgb.push_back(rgb);
        chart.xyz.push_back(xyz_from_reflectance(reflectance, daylight));
    }
    return chart;
}

}  // namespace livery
