#include "reference/path_tracer.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/colour.h"
#include "core/error.h"
#include "core/parallel.h"
#include "reference/paths.h"

namespace livery {

namespace {

/// Running sums of one pixel, over its covered samples.
struct PixelSum {
    glm::dvec3 colour{0.0};
    double luminance = 0.0;
    double luminance_squared = 0.0;
    int covered = 0;
};

std::optional<Ray> primary_ray(const View& view, const glm::dvec2& pixel) {
    try {
        return ray_through(view, pixel);
    } catch (const std::invalid_argument&) {
        return std::nullopt;  // a corner that the lens reaches from no direction
    }
}

/// Place in the pixel of sample k of n: jittered in a grid as far as n fills one, then anywhere.
glm::dvec2 place_in_pixel(int k, int side, Random& random) {
    const double x = random.uniform(), y = random.uniform();
    if (k >= side * side) return {x, y};
    return {(k % side + x) / side, (k / side + y) / side};
}

/// A well-mixed seed (the finaliser of SplitMix64, Steele et al. 2014, over each number in turn).
std::uint64_t mixed(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample) {
    std::uint64_t z = 0;
    for (const std::uint64_t number : {seed, pixel, sample}) {
        z += number + 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30u)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27u)) * 0x94d049bb133111ebu;
        z ^= z >> 31u;
    }
    return z;
}

void check_options(const View& view, const ReferenceOptions& options) {
    check_argument(view.width > 0 && view.height > 0,
                   fmt::format("trace_reference: a view of {}x{} pixels", view.width, view.height));
    check_argument(options.samples_per_pixel >= 1,
                   fmt::format("trace_reference: {} samples a pixel", options.samples_per_pixel));
    check_argument(options.bounces >= 0,
                   fmt::format("trace_reference: {} bounces", options.bounces));
    check_argument(std::isfinite(options.seconds) && options.seconds >= 0.0,
                   fmt::format("trace_reference: {} seconds", options.seconds));
}

ReferenceResult picture_of(const std::vector<PixelSum>& sums, const View& view, int samples) {
    ReferenceResult result;
    result.samples_per_pixel = samples;
    result.radiance_working = ImageF(view.width, view.height, 4);
    result.standard_error = ImageF(view.width, view.height, 1);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const PixelSum& sum = sums[i];
        if (sum.covered == 0) continue;
        const double n = sum.covered;
        for (std::size_t c = 0; c < 3; ++c) {
            result.radiance_working.values[4 * i + c] =
                static_cast<float>(sum.colour[static_cast<int>(c)] / n);
        }
        result.radiance_working.values[4 * i + 3] = static_cast<float>(n / samples);
        const double mean = sum.luminance / n;
        const double variance =
            std::max(0.0, sum.luminance_squared / n - mean * mean) * n / (n - 1.0);
        result.standard_error.values[i] = n < 2.0 ? std::numeric_limits<float>::infinity()
                                                  : static_cast<float>(std::sqrt(variance / n));
    }
    return result;
}

}  // namespace

ReferenceResult trace_reference(const Scene& scene,
                                const View& view,
                                const ReferenceOptions& options,
                                const Progress& progress) {
    using Clock = std::chrono::steady_clock;
    check_options(view, options);
    check_argument(scene.product != nullptr, "trace_reference: a scene without a product");
    const auto start = Clock::now();
    const auto elapsed_s = [&] {
        return std::chrono::duration<double>(Clock::now() - start).count();
    };

    const PathScene paths(scene, options);
    const glm::dvec3 centre = centre_in_world(view);
    const glm::vec3 eye(options.shade_for_eye ? scene.eye_in_world_mm : centre);
    const double exposure = std::exp2(scene.exposure_ev);
    const glm::dvec3 luminance_weights = glm::transpose(xyz_from_working())[1];
    const int side = static_cast<int>(std::sqrt(options.samples_per_pixel + 0.5));

    std::vector<PixelSum> sums(static_cast<std::size_t>(view.width) *
                               static_cast<std::size_t>(view.height));
    const auto add_sample = [&](std::size_t pixel, int k) {
        // A generator of its own for each pixel and sample: the order of work does not matter.
        Random random(mixed(options.seed, pixel, static_cast<std::uint64_t>(k)));
        const auto width = static_cast<std::size_t>(view.width);
        const glm::dvec2 place =
            glm::dvec2(pixel % width, pixel / width) + place_in_pixel(k, side, random);
        const auto lens_ray = primary_ray(view, place);
        if (!lens_ray) return;
        TraceRay ray;
        ray.origin = glm::vec3(lens_ray->origin);
        ray.direction = glm::vec3(lens_ray->direction);
        const Hit hit = paths.tracer().closest(ray);
        if (!hit.valid()) return;
        const SurfacePoint point = paths.surface_at(hit);
        const glm::vec3 wo = glm::normalize(eye - point.position_mm);
        const glm::dvec3 value =
            exposure * glm::dvec3(paths.radiance(point, ray.direction, wo, random));
        PixelSum& sum = sums[pixel];
        const double luminance = glm::dot(luminance_weights, value);
        sum.colour += value;
        sum.luminance += luminance;
        sum.luminance_squared += luminance * luminance;
        ++sum.covered;
    };

    int done = 0;
    while (done < options.samples_per_pixel) {
        if (options.seconds > 0.0 && done > 0 && elapsed_s() >= options.seconds) break;
        parallel_for(sums.size(), 256, [&](std::size_t begin, std::size_t end) {
            progress.check_stop();
            for (std::size_t pixel = begin; pixel < end; ++pixel) add_sample(pixel, done);
        });
        ++done;
        double fraction = static_cast<double>(done) / options.samples_per_pixel;
        if (options.seconds > 0.0) fraction = std::max(fraction, elapsed_s() / options.seconds);
        progress.update(std::min(fraction, 1.0), "tracing light paths");
    }

    ReferenceResult result = picture_of(sums, view, done);
    result.seconds = elapsed_s();
    return result;
}

}  // namespace livery
