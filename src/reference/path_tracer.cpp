#include "reference/path_tracer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
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
#include "reference/sobol.h"

namespace livery {

namespace {

/// 97.5% quantiles of Student's t for 1 to 15 degrees of freedom.
constexpr std::array<double, PixelEstimate::kBatches - 1> kStudent{12.706,
                                                                   4.303,
                                                                   3.182,
                                                                   2.776,
                                                                   2.571,
                                                                   2.447,
                                                                   2.365,
                                                                   2.306,
                                                                   2.262,
                                                                   2.228,
                                                                   2.201,
                                                                   2.179,
                                                                   2.160,
                                                                   2.145,
                                                                   2.131};

void join_pairs(PixelEstimate& estimate) {
    constexpr std::uint32_t half = PixelEstimate::kBatches / 2;
    for (std::uint32_t b = 0; b < half; ++b) {
        estimate.batch_covered[b] =
            estimate.batch_covered[2 * b] + estimate.batch_covered[2 * b + 1];
        estimate.batch_luminance[b] =
            estimate.batch_luminance[2 * b] + estimate.batch_luminance[2 * b + 1];
    }
    for (std::uint32_t b = half; b < PixelEstimate::kBatches; ++b) {
        estimate.batch_covered[b] = 0;
        estimate.batch_luminance[b] = 0.0f;
    }
    estimate.batch_length *= 2;
}

}  // namespace

void PixelEstimate::add(const glm::dvec3* value, double luminance) {
    if (traced == kBatches * batch_length) join_pairs(*this);
    const std::uint32_t batch = traced / batch_length;
    ++traced;
    if (!value) return;
    ++covered;
    colour_sum += *value;
    ++batch_covered[batch];
    batch_luminance[batch] += static_cast<float>(luminance);
}

EstimateError error_of(const PixelEstimate& estimate) {
    double sum = 0.0, weight = 0.0;
    for (std::uint32_t b = 0; b < PixelEstimate::kBatches; ++b) {
        sum += static_cast<double>(estimate.batch_luminance[b]);
        weight += estimate.batch_covered[b];
    }
    const double mean = sum / weight;
    // A ratio's scatter: batches at a silhouette hold different numbers of samples.
    double squares = 0.0;
    int batches = 0;
    for (std::uint32_t b = 0; b < PixelEstimate::kBatches; ++b) {
        if (estimate.batch_covered[b] == 0) continue;
        const double off =
            static_cast<double>(estimate.batch_luminance[b]) - mean * estimate.batch_covered[b];
        squares += off * off;
        ++batches;
    }
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    if (batches < 2) return {kInfinite, kInfinite};
    EstimateError error;
    error.standard_error = std::sqrt(squares * batches / (batches - 1.0)) / weight;
    error.half_width = error.standard_error * kStudent[static_cast<std::size_t>(batches - 2)];
    return error;
}

namespace {

std::optional<Ray> primary_ray(const View& view, const glm::dvec2& pixel) {
    try {
        return ray_through(view, pixel);
    } catch (const std::invalid_argument&) {
        return std::nullopt;  // a corner that the lens reaches from no direction
    }
}

/// A well-mixed seed (the finaliser of SplitMix64, Steele et al. 2014, over each number in turn).
std::uint32_t mixed(std::uint64_t seed, std::uint64_t pixel) {
    std::uint64_t z = 0;
    for (const std::uint64_t number : {seed, pixel}) {
        z += number + 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30u)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27u)) * 0x94d049bb133111ebu;
        z ^= z >> 31u;
    }
    return static_cast<std::uint32_t>(z >> 32u);
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
    check_argument(std::isfinite(options.error) && options.error >= 0.0,
                   fmt::format("trace_reference: an error of {}", options.error));
}

/// Luminance below which an error is counted as of this.
constexpr double kDarkest = 0.02;

glm::dvec3 luminance_weights() { return glm::transpose(xyz_from_working())[1]; }

bool is_resolved(const PixelEstimate& estimate, double error) {
    if (estimate.covered == 0) return true;
    const double luminance = glm::dot(luminance_weights(), estimate.colour_sum) / estimate.covered;
    // What is no number stays so.
    if (!std::isfinite(luminance)) return true;
    // Of what the picture shows, which a silhouette covers in part: none of it where it is less of
    // the pixel than that.
    const double coverage = static_cast<double>(estimate.covered) / estimate.traced;
    return coverage <= error ||
           coverage * error_of(estimate).half_width <= error * std::max(luminance, kDarkest);
}

/// Fewer say too little of what a rare path may carry.
constexpr int kFewestSamples = 32;

/// Where a pixel's error is looked at: often enough to stop in time, at lengths of whole nets.
bool looks_at(int done) {
    int step = kFewestSamples / 2;
    while (8 * step <= done) step *= 2;
    return done >= kFewestSamples && done % step == 0;
}

/// Those of `active` that are not resolved, and those that have such a neighbour: a pixel that by
/// chance never met what its neighbours meet goes on with them.
std::vector<std::uint32_t> still_active(const std::vector<std::uint32_t>& active,
                                        const std::vector<PixelEstimate>& estimates,
                                        const View& view,
                                        double error) {
    std::vector<std::uint8_t> unresolved(estimates.size(), 0);
    for (const std::uint32_t pixel : active) {
        unresolved[pixel] = is_resolved(estimates[pixel], error) ? 0 : 1;
    }
    const auto width = static_cast<std::uint32_t>(view.width);
    const auto height = static_cast<std::uint32_t>(view.height);
    std::vector<std::uint32_t> left;
    for (const std::uint32_t pixel : active) {
        const std::uint32_t x = pixel % width, y = pixel / width;
        bool any = false;
        for (std::uint32_t v = y > 0 ? y - 1 : 0; v <= std::min(y + 1, height - 1); ++v) {
            for (std::uint32_t u = x > 0 ? x - 1 : 0; u <= std::min(x + 1, width - 1); ++u) {
                any = any || unresolved[v * width + u] != 0;
            }
        }
        if (any) left.push_back(pixel);
    }
    return left;
}

ReferenceResult picture_of(const std::vector<PixelEstimate>& estimates,
                           const View& view,
                           double error) {
    ReferenceResult result;
    result.radiance_working = ImageF(view.width, view.height, 4);
    result.standard_error = ImageF(view.width, view.height, 1);
    result.confidence = ImageF(view.width, view.height, 1);
    result.samples = ImageF(view.width, view.height, 1);
    double covered_pixels = 0.0, unresolved = 0.0;
    for (std::size_t i = 0; i < estimates.size(); ++i) {
        const PixelEstimate& estimate = estimates[i];
        result.samples.values[i] = static_cast<float>(estimate.traced);
        result.samples_per_pixel =
            std::max(result.samples_per_pixel, static_cast<int>(estimate.traced));
        if (estimate.covered == 0) continue;
        const double n = estimate.covered;
        for (int c = 0; c < 3; ++c) {
            result.radiance_working.values[4 * i + static_cast<std::size_t>(c)] =
                static_cast<float>(estimate.colour_sum[c] / n);
        }
        result.radiance_working.values[4 * i + 3] = static_cast<float>(n / estimate.traced);
        const EstimateError off = error_of(estimate);
        result.standard_error.values[i] = static_cast<float>(off.standard_error);
        result.confidence.values[i] = static_cast<float>(off.half_width);
        result.mean_samples += estimate.traced;
        if (error > 0.0 && !is_resolved(estimate, error)) unresolved += 1.0;
        covered_pixels += 1.0;
    }
    if (covered_pixels > 0.0) {
        result.mean_samples /= covered_pixels;
        result.unresolved_fraction = unresolved / covered_pixels;
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
    const glm::vec3 eye(options.shade_for_eye ? scene.eye_in_world_mm : centre_in_world(view));
    const double exposure = std::exp2(scene.exposure_ev);
    const glm::dvec3 weights = luminance_weights();
    const auto width = static_cast<std::size_t>(view.width);

    std::vector<PixelEstimate> estimates(width * static_cast<std::size_t>(view.height));
    const auto add_sample = [&](std::uint32_t pixel, int k) {
        PixelEstimate& estimate = estimates[pixel];
        // Numbers of its own for each pixel and sample: the order of work does not matter.
        const PathNumbers numbers(mixed(options.seed, pixel), static_cast<std::uint32_t>(k));
        const glm::vec2 in_pixel = numbers.at(0).pair(PathNumbers::place);
        const auto lens_ray =
            primary_ray(view, glm::dvec2(pixel % width, pixel / width) + glm::dvec2(in_pixel));
        if (!lens_ray) return estimate.add(nullptr, 0.0);
        TraceRay ray;
        ray.origin = glm::vec3(lens_ray->origin);
        ray.direction = glm::vec3(lens_ray->direction);
        const Hit hit = paths.tracer().closest(ray);
        if (!hit.valid()) return estimate.add(nullptr, 0.0);
        const SurfacePoint point = paths.surface_at(hit, ray.direction);
        const glm::vec3 wo = glm::normalize(eye - point.position_mm);
        const glm::dvec3 value = exposure * glm::dvec3(paths.radiance(point, wo, numbers));
        estimate.add(&value, glm::dot(weights, value));
    };

    std::vector<std::uint32_t> active(estimates.size());
    std::iota(active.begin(), active.end(), 0u);
    int done = 0;
    while (done < options.samples_per_pixel && !active.empty()) {
        if (options.seconds > 0.0 && done > 0 && elapsed_s() >= options.seconds) break;
        parallel_for(active.size(), 256, [&](std::size_t begin, std::size_t end) {
            progress.check_stop();
            for (std::size_t i = begin; i < end; ++i) add_sample(active[i], done);
        });
        ++done;
        if (options.error > 0.0 && looks_at(done)) {
            active = still_active(active, estimates, view, options.error);
        }
        double fraction = static_cast<double>(done) / options.samples_per_pixel;
        if (options.seconds > 0.0) fraction = std::max(fraction, elapsed_s() / options.seconds);
        if (options.error > 0.0) {
            fraction = std::max(
                fraction,
                1.0 - static_cast<double>(active.size()) / static_cast<double>(estimates.size()));
        }
        progress.update(std::min(fraction, 1.0), "tracing light paths");
    }

    ReferenceResult result = picture_of(estimates, view, options.error);
    result.seconds = elapsed_s();
    return result;
}

}  // namespace livery
