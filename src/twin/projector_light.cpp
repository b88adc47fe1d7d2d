#include "twin/projector_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/mutation.h"
#include "core/parallel.h"

namespace livery {

namespace {

/// Blurs the light of all four channels along one axis; the picture's border is held.
void blur(const ImageF& from, ImageF& to, const std::vector<float>& kernel, bool along_x) {
    const int reach = static_cast<int>(kernel.size()) - 1;
    parallel_for(
        static_cast<std::size_t>(from.height), 16, [&](std::size_t begin, std::size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                for (int x = 0; x < from.width; ++x) {
                    float sum[4] = {};
                    for (int k = -reach; k <= reach; ++k) {
                        const int u = along_x ? std::clamp(x + k, 0, from.width - 1) : x;
                        const int v = along_x ? y : std::clamp(y + k, 0, from.height - 1);
                        const float weight = kernel[static_cast<std::size_t>(std::abs(k))];
                        const float* source = from.pixel(u, v);
                        for (int c = 0; c < 4; ++c) sum[c] += weight * source[c];
                    }
                    std::copy_n(sum, 4, to.pixel(x, y));
                }
            }
        });
}

/// Half of a symmetric Gaussian kernel, from its middle outward, with sum 1 over both halves.
std::vector<float> gaussian_kernel(double sigma_px) {
    const int reach = std::max(1, static_cast<int>(std::ceil(3.5 * sigma_px)));
    std::vector<double> weights;
    double sum = 0.0;
    for (int k = 0; k <= reach; ++k) {
        weights.push_back(std::exp(-0.5 * k * k / (sigma_px * sigma_px)));
        sum += (k == 0 ? 1.0 : 2.0) * weights.back();
    }
    std::vector<float> kernel;
    for (const double weight : weights) kernel.push_back(static_cast<float>(weight / sum));
    return kernel;
}

}  // namespace

double channel_light(const ProjectorDescription& projector,
                     int channel,
                     double drive,
                     double field_radius) {
    const double gamma =
        projector.gamma[channel] * (1.0 + projector.gamma_spread * field_radius * field_radius);
    return LIVERY_MUTATED(twin_gamma, (1.0 - projector.s_curve) * std::pow(drive, gamma)) +
           projector.s_curve * drive * drive * (3.0 - 2.0 * drive);
}

ImageF light_from_drive(const ProjectorDescription& projector, const Image8& drive) {
    const View& view = projector.view;
    check_argument(drive.width == view.width && drive.height == view.height && drive.channels == 3,
                   "bench: a picture of " + std::to_string(drive.width) + "x" +
                       std::to_string(drive.height) + "x" + std::to_string(drive.channels) +
                       " shown on a projector of " + std::to_string(view.width) + "x" +
                       std::to_string(view.height) + "x3");

    // One table of all drives for each of a few radii; between two radii the light is interpolated.
    const int rings = projector.gamma_spread == 0.0 ? 1 : 33;
    std::vector<std::array<std::array<float, 256>, 3>> tables(static_cast<std::size_t>(rings));
    for (int r = 0; r < rings; ++r) {
        const double radius = rings == 1 ? 0.0 : std::sqrt(static_cast<double>(r) / (rings - 1));
        for (int c = 0; c < 3; ++c) {
            for (int k = 0; k < 256; ++k) {
                tables[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)]
                      [static_cast<std::size_t>(k)] =
                          static_cast<float>(channel_light(projector, c, k / 255.0, radius));
            }
        }
    }

    ImageF light(view.width, view.height, 4);
    const double half_x = 0.5 * view.width, half_y = 0.5 * view.height;
    const double corner2 = half_x * half_x + half_y * half_y;
    const auto leak = static_cast<float>(projector.leak);
    const auto clear = static_cast<float>(projector.white_segment);
    parallel_for(
        static_cast<std::size_t>(view.height), 16, [&](std::size_t begin, std::size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                for (int x = 0; x < view.width; ++x) {
                    const std::uint8_t* code = drive.pixel(x, y);
                    float* out = light.pixel(x, y);
                    if (rings == 1) {
                        for (std::size_t c = 0; c < 3; ++c) out[c] = tables[0][c][code[c]];
                    } else {
                        const double dx = x + 0.5 - half_x, dy = y + 0.5 - half_y;
                        const double ring = (dx * dx + dy * dy) / corner2 * (rings - 1);
                        const auto low = std::min(static_cast<std::size_t>(ring),
                                                  static_cast<std::size_t>(rings - 2));
                        const auto t = static_cast<float>(ring - static_cast<double>(low));
                        for (std::size_t c = 0; c < 3; ++c) {
                            out[c] = (1.0f - t) * tables[low][c][code[c]] +
                                     t * tables[low + 1][c][code[c]];
                        }
                    }
                    // The clear segment opens as far as the three channels have in common.
                    out[3] = LIVERY_MUTATED(twin_white_segment,
                                            clear * std::min({out[0], out[1], out[2]}));
                    for (int c = 0; c < 3; ++c) out[c] += leak;
                }
            }
        });

    if (projector.defocus_sigma_px > 0.0) {
        const auto kernel = gaussian_kernel(projector.defocus_sigma_px);
        ImageF other(view.width, view.height, 4);
        blur(light, other, kernel, true);
        blur(other, light, kernel, false);
    }
    return light;
}

}  // namespace livery
