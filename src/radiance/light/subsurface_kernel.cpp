#include "radiance/light/subsurface_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "appearance/subsurface/fresnel_moments.h"
#include "appearance/subsurface/subsurface_profile.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"
#include "core/parallel.h"

namespace livery {

namespace {

constexpr double kShare = 0.99;
constexpr std::size_t kSamples = 160;
/// Of the reach: what lies within is told by its mean over the disc.
constexpr double kInnermost = 1e-4;

double distance_of(std::size_t code, double reach_mm) {
    const double part = static_cast<double>(code) / (kDistanceSteps - 1);
    return part * part * reach_mm;
}

/// One channel's profile at radii in even steps of the logarithm, and its integral up to each.
struct Samples {
    double first = 0.0, step = 1.0;  ///< of ln r
    std::vector<double> value, within;

    double at(const std::vector<double>& of, double r) const {
        const double x =
            std::clamp((std::log(std::max(r, 1e-300)) - first) / step, 0.0, 1.0 * (kSamples - 1));
        const auto below = std::min(static_cast<std::size_t>(x), kSamples - 2);
        const double share = x - static_cast<double>(below);
        return (1.0 - share) * of[below] + share * of[below + 1];
    }
};

Samples samples_of(const SubsurfaceProfile& profile, double reach_mm) {
    Samples samples;
    const double innermost = kInnermost * reach_mm;
    samples.first = std::log(innermost);
    samples.step = std::log(1.0 / kInnermost) / (kSamples - 1);
    const auto radius = [&](std::size_t k) {
        return std::exp(samples.first + samples.step * static_cast<double>(k));
    };
    samples.value.resize(kSamples);
    parallel_for(kSamples, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) samples.value[k] = profile.reflectance(radius(k));
    });
    // As 1/r within
    samples.within.push_back(2.0 * std::numbers::pi * innermost * innermost * samples.value[0]);
    for (std::size_t k = 1; k < kSamples; ++k) {
        const auto ring = [&](std::size_t j) {
            return 2.0 * std::numbers::pi * radius(j) * radius(j) * samples.value[j];
        };
        samples.within.push_back(samples.within.back() +
                                 0.5 * samples.step * (ring(k - 1) + ring(k)));
    }
    return samples;
}

/// What goes on into a body of that curvature, over what does into a plane.
double share_inward(double decay_per_mm, double curvature_per_mm) {
    const double bent = curvature_per_mm / decay_per_mm;  // 1/x
    if (bent <= 0.0) return 1.0 - bent;
    const double x = 1.0 / bent;
    return x < 1e-2 ? x / 3.0 : 1.0 / std::tanh(x) - bent;
}

}  // namespace

glm::vec3 total_at(const SubsurfaceKernel& kernel, float curvature_per_mm) {
    glm::dvec3 total = kernel.albedo;
    for (int c = 0; c < 3; ++c) {
        if (!(kernel.decay_per_mm[c] > 0.0)) continue;
        const double share =
            share_inward(kernel.decay_per_mm[c], static_cast<double>(curvature_per_mm));
        const double inward = kernel.inward[c];
        const double lost = (1.0 - total[c]) * share * (1.0 + inward) / (1.0 + inward * share);
        total[c] = std::clamp(1.0 - lost, 0.0, 1.0);
    }
    return glm::vec3(working_from_rec709() * total);
}

std::uint16_t distance_code(float distance_mm, float reach_mm) {
    const float part = std::sqrt(std::clamp(distance_mm / reach_mm, 0.0f, 1.0f));
    return static_cast<std::uint16_t>(std::lround(part * static_cast<float>(kDistanceSteps - 1)));
}

SubsurfaceKernel subsurface_kernel(const TranslucentMaterial& material) {
    std::array<SubsurfaceProfile, 3> profiles;
    SubsurfaceKernel kernel;
    double reach = 0.0;
    for (int c = 0; c < 3; ++c) {
        ScatteringMedium medium = medium_of(material, c);
        medium.thickness_mm.reset();
        SubsurfaceProfile& profile = profiles[static_cast<std::size_t>(c)];
        profile = subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, medium);
        reach = std::max(reach, energy_radius_mm(profile, medium, kShare));
        if (!(medium.sigma_s_prime() > 0.0)) continue;
        const double all = medium.sigma_t_prime();
        const double diffusion =
            (2.0 * medium.sigma_a_per_mm + medium.sigma_s_prime()) / (3.0 * all * all);
        const FresnelMoments moments = fresnel_moments(medium.eta);
        const double a = (1.0 + 3.0 * moments.c2) / (1.0 - 2.0 * moments.c1);
        kernel.decay_per_mm[c] = std::sqrt(medium.sigma_a_per_mm / diffusion);
        kernel.inward[c] = 2.0 * a * diffusion * kernel.decay_per_mm[c];
    }
    kernel.reach_mm = static_cast<float>(reach);
    const glm::dmat3& working = working_from_rec709();
    kernel.albedo = entering_albedo(material);
    kernel.total = glm::vec3(working * kernel.albedo);
    if (!(reach > 0.0)) return kernel;
    std::array<Samples, 3> samples;
    for (std::size_t c = 0; c < 3; ++c) samples[c] = samples_of(profiles[c], reach);
    for (std::size_t code = 0; code < kDistanceSteps; ++code) {
        const double r = distance_of(code, reach);
        glm::dvec3 value, within;
        for (int c = 0; c < 3; ++c) {
            const Samples& own = samples[static_cast<std::size_t>(c)];
            value[c] = own.at(own.value, r);
            within[c] = own.at(own.within, r);
        }
        kernel.per_mm2.emplace_back(working * value);
        kernel.within.emplace_back(working * within);
    }
    return kernel;
}

}  // namespace livery
