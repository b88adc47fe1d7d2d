#include "radiance/subsurface/subsurface_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "appearance/subsurface/exact_totals.h"
#include "appearance/subsurface/scattering_medium.h"
#include "appearance/subsurface/subsurface_profile.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"
#include "core/parallel.h"

namespace livery {

namespace {

constexpr double kShare = 0.997;
/// In mean free paths, from where on light has scattered often, and where all has.
constexpr double kOftenFrom = 4.0, kOften = 12.0;
/// Of the thinnest bodies whose total is tabulated; thinner ones give back in proportion.
constexpr double kShortestThin = 0.05;
constexpr std::size_t kSamples = 160;
/// Of which the profile is asked for one in three, and the others lie between.
constexpr std::size_t kApart = 3;
static_assert((kSamples - 1) % kApart == 0);
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

Samples no_samples(double reach_mm) {
    Samples samples;
    samples.first = std::log(kInnermost * reach_mm);
    samples.step = std::log(1.0 / kInnermost) / (kSamples - 1);
    samples.value.resize(kSamples);
    return samples;
}

/// Fills in what lies between every kApart-th one: by Catmull and Rom's cubic of the logarithm, in
/// which a profile hardly bends, or along a line where one of them is 0.
void fill_between(std::vector<double>& values) {
    const std::size_t last = values.size() - 1;
    for (std::size_t from = 0; from < last; from += kApart) {
        const double p0 = values[from >= kApart ? from - kApart : from], p1 = values[from];
        const double p2 = values[from + kApart], p3 = values[std::min(from + 2 * kApart, last)];
        for (std::size_t k = 1; k < kApart; ++k) {
            const double t = static_cast<double>(k) / kApart;
            if (!(std::min({p0, p1, p2, p3}) > 0.0)) {
                values[from + k] = (1.0 - t) * p1 + t * p2;
                continue;
            }
            const double a = std::log(p1), b = std::log(p2);
            const double begin = from >= kApart ? 0.5 * (b - std::log(p0)) : b - a;
            const double end = from + kApart < last ? 0.5 * (std::log(p3) - a) : b - a;
            const double u = 1.0 - t;
            values[from + k] = std::exp(u * u * ((1.0 + 2.0 * t) * a + t * begin) +
                                        t * t * ((1.0 + 2.0 * u) * b - u * end));
        }
    }
}

/// `profile(r)` at those radii, a number or several.
template <std::size_t Count, typename Profile>
std::array<Samples, Count> samples_of(const Profile& profile, double reach_mm) {
    std::array<Samples, Count> samples;
    samples.fill(no_samples(reach_mm));
    parallel_for(kSamples / kApart + 1, 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin * kApart; k < end * kApart; k += kApart) {
            const std::array<double, Count> values = profile(samples[0].radius(k));
            for (std::size_t n = 0; n < Count; ++n) samples[n].value[k] = values[n];
        }
    });
    for (Samples& one : samples) fill_between(one.value);
    return samples;
}

/// How much of light has scattered often on so many mean free paths, from 0 to 1.
double scattered_often(double paths) {
    const double x = std::clamp((paths - kOftenFrom) / (kOften - kOftenFrom), 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
}

/// Single scattering and beam diffusion, of which the part near the beam is scaled so that all add
/// up to the exact total: where light has scattered often diffusion is right as it is (within the
/// noise of Monte Carlo, where the scaled one is 4% too dark).
Samples profile_samples(const ScatteringMedium& medium, double reach_mm) {
    const SubsurfaceProfile scaled =
        subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, medium);
    if (!(medium.sigma_s_prime() > 0.0)) return no_samples(reach_mm);
    const SubsurfaceProfile diffusion = subsurface_profile(SubsurfaceModel::beam_diffusion, medium);
    return samples_of<1>(
        [&](double r) {
            const double often = scattered_often(r * medium.sigma_t_prime());
            double sum = 0.0;
            if (often < 1.0) sum += (1.0 - often) * scaled.reflectance(r);
            if (often > 0.0) sum += often * diffusion.reflectance(r);
            return std::array{sum};
        },
        reach_mm)[0];
}

/// Of numbers at the samples' radii, the means over the disc that a node stands for: sums over
/// nodes of a kernel that is narrower than they are apart would miss it between them, or take its
/// peak for as wide as they are.
std::vector<double> over_nodes(const Samples& samples,
                               const std::vector<double>& values,
                               double near_mm) {
    const double disc_mm = near_mm / kNearCells / std::sqrt(std::numbers::pi);
    std::vector<double> means(kSamples);
    for (std::size_t k = 0; k < kSamples; ++k) {
        means[k] = mean_over_disc(
            samples.radius(k), disc_mm, [&](double r) { return samples.at(values, r); });
    }
    return means;
}

/// The profile times `weight`.
template <typename Weight>
std::vector<double> weighed(const Samples& samples, const Weight& weight) {
    std::vector<double> values(kSamples);
    for (std::size_t k = 0; k < kSamples; ++k) {
        values[k] = samples.value[k] * weight(samples.radius(k));
    }
    return values;
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
    const Samples places = no_samples(reach_mm);
    std::array<std::vector<double>, 3> far_of, through_of;
    glm::dvec3 near(0.0), total(0.0), passed(0.0);
    for (int c = 0; c < 3; ++c) {
        ScatteringMedium medium = medium_of(material, c);
        medium.thickness_mm = static_cast<double>(thickness_mm);
        const SubsurfaceProfile profile =
            subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, medium);
        const auto channel = static_cast<std::size_t>(c);
        const auto [reflected, through] = samples_of<2>(
            [&](double r) {
                const DiffuseTotals at = profile.at(r);
                return std::array{at.reflectance, at.transmittance};
            },
            reach_mm);
        near[c] = reflected.within([&](double r) { return near_part(r, near_mm); }).back();
        total[c] = profile.totals.reflectance;
        passed[c] = profile.totals.transmittance;
        const auto far = [&](double r) { return 1.0 - near_part(r, near_mm); };
        far_of[channel] = over_nodes(reflected, weighed(reflected, far), near_mm);
        through_of[channel] = over_nodes(through, through.value, near_mm);
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
            far[c] = places.at(far_of[channel], r);
            by[c] = places.at(through_of[channel], r);
        }
        slab.far_per_mm2.emplace_back(working * far);
        slab.through_per_mm2.emplace_back(working * by);
    }
    return slab;
}

/// The mean chord of a convex body with that curvature, in a channel's mean free paths.
double paths_across(double extinction_per_mm, float curvature_per_mm) {
    if (!(curvature_per_mm > 0.0f)) return std::numeric_limits<double>::infinity();
    return 4.0 / 3.0 * extinction_per_mm / static_cast<double>(curvature_per_mm);
}

void add_thin_totals(const TranslucentMaterial& material,
                     float most_bent_per_mm,
                     SubsurfaceKernel& kernel) {
    if (!(most_bent_per_mm > 0.0f)) return;
    double fewest = kOften;
    for (int c = 0; c < 3; ++c) {
        if (!(kernel.extinction_per_mm[c] > 0.0)) continue;
        fewest = std::min(fewest, paths_across(kernel.extinction_per_mm[c], most_bent_per_mm));
    }
    if (fewest >= kOften) return;
    const double halvings = std::log2(kOften / std::max(fewest, kShortestThin));
    kernel.thin_totals.resize(static_cast<std::size_t>(std::ceil(halvings)) + 1);
    parallel_for(3 * kernel.thin_totals.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const int channel = static_cast<int>(k % 3);
            ScatteringMedium medium = deep(material, channel);
            if (!(medium.sigma_s_prime() > 0.0)) continue;
            medium.thickness_mm =
                kOften * std::exp2(-static_cast<double>(k / 3)) / kernel.extinction_per_mm[channel];
            const DiffuseTotals slab = exact_totals(medium);
            kernel.thin_totals[k / 3][channel] = slab.reflectance + slab.transmittance;
        }
    });
}

/// Of a body so many mean free paths across.
double thin_total(const SubsurfaceKernel& kernel, int channel, double paths) {
    const std::vector<glm::dvec3>& totals = kernel.thin_totals;
    if (totals.empty() || paths >= kOften) return kernel.albedo[channel];
    const double last = static_cast<double>(totals.size() - 1);
    const double halvings = std::log2(kOften / std::max(paths, 1e-300));
    if (halvings >= last) return totals.back()[channel] * std::exp2(last - halvings);
    const auto below = static_cast<std::size_t>(std::max(halvings, 0.0));
    const double share = std::max(halvings, 0.0) - static_cast<double>(below);
    return glm::mix(totals[below][channel], totals[below + 1][channel], share);
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
        const double paths = paths_across(kernel.extinction_per_mm[c], curvature_per_mm);
        total[c] = glm::mix(thin_total(kernel, c, paths),
                            std::clamp(1.0 - lost, 0.0, 1.0),
                            kernel.diffuses[c] * scattered_often(paths));
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
                                   std::span<const float> slabs_mm,
                                   float most_bent_per_mm) {
    SubsurfaceKernel kernel;
    kernel.reach_mm = reach_mm;
    kernel.near_mm = std::min(near_mm, reach_mm);
    const glm::dmat3& working = working_from_rec709();
    kernel.albedo = entering_albedo(material);
    kernel.total = glm::vec3(working * kernel.albedo);
    if (!(reach_mm > 0.0f)) return kernel;
    const auto reach = static_cast<double>(reach_mm), near = static_cast<double>(kernel.near_mm);
    std::array<Samples, 3> samples;
    std::array<std::vector<double>, 3> far_of, bent_of;
    glm::dvec3 far_share(0.0), bent_share(0.0);
    for (int c = 0; c < 3; ++c) {
        const ScatteringMedium medium = deep(material, c);
        const auto channel = static_cast<std::size_t>(c);
        if (medium.sigma_s_prime() > 0.0) {
            const double all = kernel.extinction_per_mm[c] = medium.sigma_t_prime();
            const double diffusion =
                (2.0 * medium.sigma_a_per_mm + medium.sigma_s_prime()) / (3.0 * all * all);
            const FresnelMoments moments = fresnel_moments(medium.eta);
            const double a = (1.0 + 3.0 * moments.c2) / (1.0 - 2.0 * moments.c1);
            kernel.decay_per_mm[c] = std::sqrt(medium.sigma_a_per_mm / diffusion);
            kernel.inward[c] = 2.0 * a * diffusion * kernel.decay_per_mm[c];
            kernel.diffuses[c] = scattered_often(1.0 / (1.0 - medium.albedo_prime()));
        }
        const Samples& own = samples[channel] = profile_samples(medium, reach);
        const auto far = [&](double r) { return 1.0 - near_part(r, near); };
        const auto bent = [&](double r) { return far(r) * bent_part(r, kernel.decay_per_mm[c]); };
        far_share[c] = own.within(far).back();
        bent_share[c] = own.within(bent).back();
        far_of[channel] = over_nodes(own, weighed(own, far), near);
        bent_of[channel] = over_nodes(own, weighed(own, bent), near);
    }
    add_thin_totals(material, most_bent_per_mm, kernel);
    // What is far is as it is, what is near the rest of the exact total
    kernel.near_share = glm::vec3(working * (kernel.albedo - far_share));
    kernel.bent_share = glm::vec3(working * bent_share);
    for (std::size_t code = 0; code < kDistanceSteps; ++code) {
        const double r = distance_of(code, reach), close = distance_of(code, near);
        glm::dvec3 far(0.0), bent(0.0), by_near(0.0);
        for (int c = 0; c < 3; ++c) {
            const auto channel = static_cast<std::size_t>(c);
            const Samples& own = samples[channel];
            far[c] = own.at(far_of[channel], r);
            bent[c] = own.at(bent_of[channel], r);
            by_near[c] = own.at(own.value, close) * near_part(close, near);
        }
        kernel.far_per_mm2.emplace_back(working * far);
        kernel.bent_per_mm2.emplace_back(working * bent);
        kernel.near_per_mm2.emplace_back(working * by_near);
    }
    kernel.slabs.resize(slabs_mm.size());
    parallel_for(slabs_mm.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            kernel.slabs[k] = slab_kernel(material, slabs_mm[k], reach, near);
        }
    });
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
    for (int c = 0; c < 3; ++c) {
        const double paths = paths_across(kernel.extinction_per_mm[c], curvature_per_mm);
        shares.anywhere += static_cast<float>(std::exp(-paths) / 3.0);
    }
    shares.near = (1.0f - shares.anywhere) * (total - shares.far);
    shares.far = total - shares.near;
    return shares;
}

}  // namespace livery
