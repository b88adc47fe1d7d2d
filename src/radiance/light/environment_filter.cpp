#include "radiance/light/environment_filter.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/common.hpp>

#include "core/mutation.h"
#include "core/parallel.h"
#include "radiance/light/spherical_harmonics.h"

namespace livery {
namespace {

constexpr int kDegree = 255;

/// Mean over the area of each new texel; any size to any size.
ImageF resample(const ImageF& picture, int width, int height) {
    if (picture.width == width && picture.height == height) return picture;
    ImageF result(width, height, 3);
    parallel_for(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
        const double step_x = static_cast<double>(picture.width) / width;
        const double step_y = static_cast<double>(picture.height) / height;
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < width; ++x) {
                const double x0 = x * step_x, x1 = x0 + step_x, y0 = y * step_y, y1 = y0 + step_y;
                double sum[3] = {}, total = 0.0;
                for (int v = static_cast<int>(y0); v < std::min<double>(y1, picture.height); ++v) {
                    const double wy = std::min<double>(v + 1, y1) - std::max<double>(v, y0);
                    for (int u = static_cast<int>(x0); u < std::min<double>(x1, picture.width);
                         ++u) {
                        const double w =
                            wy * (std::min<double>(u + 1, x1) - std::max<double>(u, x0));
                        for (int c = 0; c < 3; ++c) sum[c] += w * picture.at(u, v, c);
                        total += w;
                    }
                }
                for (int c = 0; c < 3; ++c) {
                    result.at(x, y, c) = static_cast<float>(sum[c] / total);
                }
            }
        }
    });
    return result;
}

/// Lambert's cosine, divided by pi (Ramamoorthi and Hanrahan 2001, equation 19).
std::vector<double> cosine_kernel(int degree) {
    std::vector<double> kernel(static_cast<std::size_t>(degree + 1), 0.0);
    kernel[0] = 1.0;
    kernel[1] = LIVERY_MUTATED(cosine_kernel, 2.0 / 3.0);
    double binomial = 0.5;  // l! / (2^l (l/2)!^2)
    for (int l = 2; l <= degree; l += 2) {
        if (l > 2) binomial *= (l - 1.0) / l;
        const double sign = (l / 2) % 2 == 1 ? 1.0 : -1.0;
        kernel[static_cast<std::size_t>(l)] = 2.0 * sign * binomial / ((l + 2.0) * (l - 1.0));
    }
    return kernel;
}

std::vector<double> gaussian_kernel(double sigma_rad, int degree) {
    std::vector<double> kernel;
    for (int l = 0; l <= degree; ++l) {
        kernel.push_back(std::exp(
            LIVERY_MUTATED(gaussian_kernel, -0.5 * l * (l + 1.0) * sigma_rad * sigma_rad)));
        if (kernel.back() < 1e-6) break;
    }
    return kernel;
}

void clamp_to_positive(ImageF& picture) {
    for (float& value : picture.values) value = std::max(value, 0.0f);
}

constexpr int kWideDegree = 63;

/// The map itself, then one picture a kernel: the first `sharp` of 512 columns, the rest of 128.
std::vector<ImageF> layers_of(const ImageF& source,
                              const SphericalHarmonics& harmonics,
                              std::span<const std::vector<double>> kernels,
                              std::size_t sharp) {
    std::vector<ImageF> layers{resample(source, 512, 256)};
    for (ImageF& picture : synthesise_sphere(harmonics, kernels.first(sharp), 512, 256)) {
        layers.push_back(std::move(picture));
    }
    for (ImageF& picture : synthesise_sphere(harmonics, kernels.subspan(sharp), 128, 64)) {
        layers.push_back(std::move(picture));
    }
    for (ImageF& picture : layers) clamp_to_positive(picture);
    return layers;
}

}  // namespace

std::vector<double> ggx_lobe_kernel(double alpha, int degree) {
    // The lobe seen along the normal, K ~ D(theta / 2) G2: equal steps of the half vector's own
    // distribution, tan^2 = alpha^2 u / (1 - u), each weighted by G2.
    constexpr int kSteps = 4096;
    struct Step {
        double cosine, previous, current;  ///< the last two Legendre polynomials, times the weight
    };
    std::vector<Step> steps;
    for (int step = 0; step < kSteps; ++step) {
        const double u = (step + 0.5) / kSteps;
        const double tan2 = LIVERY_MUTATED(ggx_lobe_kernel, alpha * alpha * u / (1.0 - u));
        const double cosine = (1.0 - tan2) / (1.0 + tan2);  // of twice the half vector's angle
        if (cosine <= 0.0) continue;
        const double weight =
            2.0 * cosine /
            (cosine + std::sqrt(alpha * alpha + (1.0 - alpha * alpha) * cosine * cosine));
        steps.push_back({cosine, 0.0, weight});
    }
    std::vector<double> kernel(static_cast<std::size_t>(degree + 1), 0.0);
    for (int l = 0; l <= degree; ++l) {
        const double ahead = (2.0 * l + 1.0) / (l + 1.0), back = l / (l + 1.0);
        double sum = 0.0;
        for (Step& step : steps) {
            sum += step.current;
            const double next = ahead * step.cosine * step.current - back * step.previous;
            step.previous = step.current;
            step.current = next;
        }
        kernel[static_cast<std::size_t>(l)] = sum;
    }
    const double total = kernel[0];
    for (double& value : kernel) value /= total;
    while (kernel.size() > 1 && std::abs(kernel.back()) < 1e-6) kernel.pop_back();
    return kernel;
}

FilteredEnvironment filter_environment(const Environment& environment,
                                       const FilterParts& parts,
                                       const Progress& progress) {
    progress.update(0.0, "filtering the environment");
    const ImageF source = resample(environment.radiance_working, 1024, 512);
    const SphericalHarmonics harmonics =
        analyse_sphere(source, parts.mirrored || parts.gaussians ? kDegree : 127);
    progress.update(0.3, "filtering the environment");

    FilteredEnvironment result;
    if (parts.diffuse || parts.blurred) {
        const std::vector<std::vector<double>> kernels{
            cosine_kernel(48), gaussian_kernel(0.1, 127), gaussian_kernel(0.06, 127)};
        auto pictures = synthesise_sphere(harmonics, kernels, 256, 128);
        for (ImageF& picture : pictures) clamp_to_positive(picture);
        if (parts.diffuse) result.diffuse = std::move(pictures[0]);
        if (parts.blurred) {
            result.blurred = std::move(pictures[1]);
            result.hardly_blurred = std::move(pictures[2]);
        }
    }
    if (parts.mirrored) {
        // Lobes of alpha .11 and more are smooth on 128 columns, which stay in a core's cache
        const auto wide = std::lower_bound(kLayerAlphas.begin() + 1, kLayerAlphas.end(), 0.11f);
        std::vector<std::vector<double>> kernels(kLayerAlphas.size() - 1);
        const auto wide_from = static_cast<std::size_t>(wide - (kLayerAlphas.begin() + 1));
        parallel_for(kernels.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                kernels[k] = ggx_lobe_kernel(static_cast<double>(kLayerAlphas[k + 1]),
                                             k < wide_from ? kDegree : kWideDegree);
            }
        });
        result.mirrored = layers_of(source, harmonics, kernels, wide_from);
    }
    if (parts.gaussians) {
        std::vector<std::vector<double>> kernels;
        std::size_t sharp = 0;
        for (std::size_t k = 0; k + 1 < kGaussianLayers; ++k) {
            const double sigma_rad = static_cast<double>(kFirstGaussian_rad) *
                                     std::pow(2.0, 0.5 * static_cast<double>(k));
            // As wide as two texels of 128 columns
            if (sigma_rad < 0.09) sharp = k + 1;
            kernels.push_back(gaussian_kernel(sigma_rad, k < sharp ? kDegree : kWideDegree));
        }
        result.gaussians = layers_of(source, harmonics, kernels, sharp);
    }
    progress.update(1.0, "filtering the environment");
    return result;
}

glm::vec3 sample_sphere(const ImageF& picture, const glm::dvec2& uv) {
    const double x = uv.x * picture.width - 0.5, y = uv.y * picture.height - 0.5;
    const double x_floor = std::floor(x), y_floor = std::floor(y);
    const auto fx = static_cast<float>(x - x_floor), fy = static_cast<float>(y - y_floor);
    const auto column = [&](double value) {
        const int c = static_cast<int>(value) % picture.width;
        return c < 0 ? c + picture.width : c;
    };
    const auto row = [&](double value) {
        return std::clamp(static_cast<int>(value), 0, picture.height - 1);
    };
    const auto texel = [&](double column_at, double row_at) {
        const float* p = picture.pixel(column(column_at), row(row_at));
        return glm::vec3(p[0], p[1], p[2]);
    };
    return glm::mix(
        glm::mix(texel(x_floor, y_floor), texel(x_floor + 1.0, y_floor), fx),
        glm::mix(texel(x_floor, y_floor + 1.0), texel(x_floor + 1.0, y_floor + 1.0), fx),
        fy);
}

}  // namespace livery
