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

constexpr double kShare = 0.997;
constexpr std::size_t kSamples = 160;
/// Of the reach: what lies within is told by its mean over the disc.
constexpr double kInnermost = 1e-4;

double distance_of(std::size_t code, double reach_mm) {
    const double part = static_cast<double>(code) / (kDistanceSteps - 1);
    return part * part * reach_mm;
}

/// Of the profile that counts as near: 1 at the beam, and 0 from `near_mm` on, without a bend.
double near_part(double r, double near_mm) {
    const double x = r / near_mm;
    return x < 1.0 ? (1.0 - x * x) * (1.0 - x * x) : 0.0;
}

/// By how much a ball of radius 1/k gives back more at a chord of r than a plane does at that
/// distance, over k, for small k. In diffusion theory what leaves far from the beam is the normal
/// derivative there of a field that is given where it enters: over the degrees l of a ball's
/// harmonics sqrt(s^2 + w^2) - k/2 - (k/2) s^2/(s^2 + w^2), w = (l + 1/2) k, where a plane has the
/// root alone. The middle term stays at the beam, the last is K_0:
///   (s r)^3 K_0(s r) e^{s r} / (2 s (1 + s r)),  s the decay.
/// Within 5% of the exact series up to chords of .8 radii and radii of 3/s (10% of the addition up
/// to .4 radii where the ball is smaller than 1/s).
double bent_part(double r, double decay_per_mm) {
    const double y = decay_per_mm * r;
    if (!(y > 1e-6)) return 0.0;
    const double k0 = y < 300.0 ? std::exp(y) * std::cyl_bessel_k(0.0, y)
                                : std::sqrt(std::numbers::pi / (2.0 * y));
    return y * y * y * k0 / (2.0 * decay_per_mm * (1.0 + y));
}

/// One channel's profile at radii in even steps of the logarithm.
struct Samples {
    double first = 0.0, step = 1.0;  ///< of ln r
    std::vector<double> value;

    double radius(std::size_t k) const { return std::exp(first + step * static_cast<double>(k)); }
    double at(const std::vector<double>& of, double r) const {
        const double x =
            std::clamp((std::log(std::max(r, 1e-300)) - first) / step, 0.0, 1.0 * (kSamples - 1));
        const auto below = std::min(static_cast<std::size_t>(x), kSamples - 2);
        const double share = x - static_cast<double>(below);
        return (1.0 - share) * of[below] + share * of[below + 1];
    }
    /// Integral over the disc up to each radius of the profile times `weight`.
    template <typename Weight>
    std::vector<double> within(const Weight& weight) const {
        const auto ring = [&](std::size_t k) {
            const double r = radius(k);
            return 2.0 * std::numbers::pi * r * r * value[k] * weight(r);
        };
        // As 1/r within
        std::vector<double> sum{ring(0)};
        for (std::size_t k = 1; k < kSamples; ++k) {
            sum.push_back(sum.back() + 0.5 * step * (ring(k - 1) + ring(k)));
        }
        return sum;
    }
};

/// `profile(r)` at those radii.
template <typename Profile>
Samples samples_of(const Profile& profile, double reach_mm) {
    Samples samples;
    samples.first = std::log(kInnermost * reach_mm);
    samples.step = std::log(1.0 / kInnermost) / (kSamples - 1);
    samples.value.resize(kSamples);
    parallel_for(kSamples, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            samples.value[k] = profile(samples.radius(k));
        }
    });
    return samples;
}

/// Single scattering and beam diffusion, of which the part near the beam is scaled so that all add
/// up to the exact total: where light has scattered often diffusion is right as it is (within the
/// noise of Monte Carlo, where the scaled one is 4% too dark).
Samples profile_samples(const ScatteringMedium& medium, double reach_mm) {
    constexpr double kOftenFrom = 4.0, kOften = 12.0;  // mean free paths
    const SubsurfaceProfile scaled =
        subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, medium);
    if (!(medium.sigma_s_prime() > 0.0)) {
        return samples_of([](double) { return 0.0; }, reach_mm);
    }
    const SubsurfaceProfile diffusion = subsurface_profile(SubsurfaceModel::beam_diffusion, medium);
    return samples_of(
        [&](double r) {
            const double x = std::clamp(
                (r * medium.sigma_t_prime() - kOftenFrom) / (kOften - kOftenFrom), 0.0, 1.0);
            const double often = x * x * (3.0 - 2.0 * x);
            return (1.0 - often) * scaled.reflectance(r) + often * diffusion.reflectance(r);
        },
        reach_mm);
}

ScatteringMedium deep(const TranslucentMaterial& material, int channel) {
    ScatteringMedium medium = medium_of(material, channel);
    medium.thickness_mm.reset();
    return medium;
}

/// What goes on into a body of that curvature, over what does into a plane.
double share_inward(double decay_per_mm, double curvature_per_mm) {
    const double bent = curvature_per_mm / decay_per_mm;  // 1/x
    if (bent <= 0.0) return 1.0 - bent;
    const double x = 1.0 / bent;
    return x < 1e-2 ? x / 3.0 : 1.0 / std::tanh(x) - bent;
}

SlabKernel slab_kernel(const TranslucentMaterial& material,
                       float thickness_mm,
                       double reach_mm,
                       double near_mm) {
    SlabKernel slab;
    slab.thickness_mm = thickness_mm;
    std::array<Samples, 3> reflected, through;
    glm::dvec3 near(0.0), total(0.0), passed(0.0);
    for (int c = 0; c < 3; ++c) {
        ScatteringMedium medium = medium_of(material, c);
        medium.thickness_mm = static_cast<double>(thickness_mm);
        const SubsurfaceProfile profile =
            subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, medium);
        const auto channel = static_cast<std::size_t>(c);
        reflected[channel] = samples_of([&](double r) { return profile.reflectance(r); }, reach_mm);
        through[channel] = samples_of([&](double r) { return profile.transmittance(r); }, reach_mm);
        near[c] = reflected[channel].within([&](double r) { return near_part(r, near_mm); }).back();
        total[c] = profile.totals.reflectance;
        passed[c] = profile.totals.transmittance;
    }
    const glm::dmat3& working = working_from_rec709();
    slab.near_share = glm::vec3(working * near);
    slab.far_share = glm::vec3(working * glm::max(total - near, glm::dvec3(0.0)));
    slab.through_share = glm::vec3(working * passed);
    for (std::size_t code = 0; code < kDistanceSteps; ++code) {
        const double r = distance_of(code, reach_mm);
        glm::dvec3 far, by;
        for (int c = 0; c < 3; ++c) {
            const auto channel = static_cast<std::size_t>(c);
            far[c] =
                reflected[channel].at(reflected[channel].value, r) * (1.0 - near_part(r, near_mm));
            by[c] = through[channel].at(through[channel].value, r);
        }
        slab.far_per_mm2.emplace_back(working * far);
        slab.through_per_mm2.emplace_back(working * by);
    }
    return slab;
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

float kernel_reach_mm(const TranslucentMaterial& material, std::optional<float> sheet_mm) {
    double reach = 0.0;
    for (int c = 0; c < 3; ++c) {
        ScatteringMedium medium = deep(material, c);
        if (sheet_mm) medium.thickness_mm = static_cast<double>(*sheet_mm);
        const SubsurfaceProfile profile =
            subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, medium);
        reach = std::max(reach, energy_radius_mm(profile, medium, kShare));
    }
    // What comes through goes that much farther on its way
    return static_cast<float>(reach) + sheet_mm.value_or(0.0f);
}

SubsurfaceKernel subsurface_kernel(const TranslucentMaterial& material,
                                   float reach_mm,
                                   float near_mm,
                                   std::span<const float> slabs_mm) {
    SubsurfaceKernel kernel;
    kernel.reach_mm = reach_mm;
    kernel.near_mm = std::min(near_mm, reach_mm);
    const glm::dmat3& working = working_from_rec709();
    kernel.albedo = entering_albedo(material);
    kernel.total = glm::vec3(working * kernel.albedo);
    if (!(reach_mm > 0.0f)) return kernel;
    const auto reach = static_cast<double>(reach_mm), near = static_cast<double>(kernel.near_mm);
    std::array<Samples, 3> samples;
    glm::dvec3 far_share(0.0), bent_share(0.0);
    for (int c = 0; c < 3; ++c) {
        const ScatteringMedium medium = deep(material, c);
        const auto channel = static_cast<std::size_t>(c);
        if (medium.sigma_s_prime() > 0.0) {
            const double all = medium.sigma_t_prime();
            const double diffusion =
                (2.0 * medium.sigma_a_per_mm + medium.sigma_s_prime()) / (3.0 * all * all);
            const FresnelMoments moments = fresnel_moments(medium.eta);
            const double a = (1.0 + 3.0 * moments.c2) / (1.0 - 2.0 * moments.c1);
            kernel.decay_per_mm[c] = std::sqrt(medium.sigma_a_per_mm / diffusion);
            kernel.inward[c] = 2.0 * a * diffusion * kernel.decay_per_mm[c];
        }
        samples[channel] = profile_samples(medium, reach);
        far_share[c] =
            samples[channel].within([&](double r) { return 1.0 - near_part(r, near); }).back();
        bent_share[c] =
            samples[channel]
                .within([&](double r) {
                    return (1.0 - near_part(r, near)) * bent_part(r, kernel.decay_per_mm[c]);
                })
                .back();
    }
    // What is far is as it is, what is near the rest of the exact total
    kernel.near_share = glm::vec3(working * (kernel.albedo - far_share));
    kernel.bent_share = glm::vec3(working * bent_share);
    for (std::size_t code = 0; code < kDistanceSteps; ++code) {
        const double r = distance_of(code, reach), close = distance_of(code, near);
        glm::dvec3 far(0.0), bent(0.0), by_near(0.0);
        for (int c = 0; c < 3; ++c) {
            const auto channel = static_cast<std::size_t>(c);
            const Samples& own = samples[channel];
            far[c] = own.at(own.value, r) * (1.0 - near_part(r, near));
            bent[c] = far[c] * bent_part(r, kernel.decay_per_mm[c]);
            by_near[c] = own.at(own.value, close) * near_part(close, near);
        }
        kernel.far_per_mm2.emplace_back(working * far);
        kernel.bent_per_mm2.emplace_back(working * bent);
        kernel.near_per_mm2.emplace_back(working * by_near);
    }
    for (const float thickness : slabs_mm) {
        kernel.slabs.push_back(slab_kernel(material, thickness, reach, near));
    }
    return kernel;
}

BentShares shares_at(const SubsurfaceKernel& kernel, float curvature_per_mm) {
    const glm::vec3 total = total_at(kernel, curvature_per_mm);
    const glm::vec3 more = total - kernel.total;
    BentShares shares;
    shares.bend_per_mm = curvature_per_mm;
    // In a body smaller than the decay the series ends before its first term is spent
    for (int c = 0; c < 3; ++c) {
        if (!(kernel.bent_share[c] > 0.0f)) continue;
        const float most = std::abs(more[c]) / kernel.bent_share[c];
        shares.bend_per_mm = std::clamp(shares.bend_per_mm, -most, most);
    }
    shares.far = glm::max(kernel.total - kernel.near_share + shares.bend_per_mm * kernel.bent_share,
                          glm::vec3(0.0f));
    shares.far = glm::min(shares.far, total);
    shares.near = total - shares.far;
    return shares;
}

}  // namespace livery
