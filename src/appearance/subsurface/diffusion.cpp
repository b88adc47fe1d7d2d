#include "appearance/subsurface/diffusion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "appearance/subsurface/scattering_medium.h"
#include "core/mutation.h"

namespace livery {

namespace {

constexpr int kModes = 40;
constexpr double kModesFrom = 0.2;  // of the period
constexpr int kMostPairs = 12;

/// e^{-sigma d}/d and z (1 + sigma d) e^{-sigma d}/d^3.
struct Point {
    double fluence, flux;
};
Point point(double sigma, double z, double r) {
    const double d2 = r * r + z * z;
    if (!(d2 > 0.0)) return {0.0, 0.0};
    const double d = std::sqrt(d2);
    const double fluence = std::exp(-sigma * d) / d;
    return {fluence, fluence * z * (1.0 + sigma * d) / d2};
}

/// sinh(sigma x)/sinh(sigma l) for 0 <= x <= l, x/l where nothing is absorbed.
double sinh_ratio(double sigma, double x, double l) {
    if (sigma * l < 1e-9) return x / l;
    return std::exp(-sigma * (l - x)) * std::expm1(-2.0 * sigma * x) / std::expm1(-2.0 * sigma * l);
}

}  // namespace

Diffusion classical_diffusion(const ScatteringMedium& medium) {
    const FresnelMoments moments = fresnel_moments(medium.eta);
    Diffusion d;
    d.coefficient_mm = 1.0 / (3.0 * medium.sigma_t_prime());
    d.sigma_tr_per_mm = std::sqrt(medium.sigma_a_per_mm / d.coefficient_mm);
    d.extrapolation_mm =
        2.0 * d.coefficient_mm * (1.0 + 2.0 * moments.c1) / (1.0 - 2.0 * moments.c1);
    return d;
}

Diffusion improved_diffusion(const ScatteringMedium& medium) {
    const FresnelMoments moments = fresnel_moments(medium.eta);
    const double all = medium.sigma_t_prime();
    Diffusion d;
    d.coefficient_mm = (medium.sigma_a_per_mm + all) / (3.0 * all * all);  // 2 sigma_a + sigma_s'
    d.sigma_tr_per_mm = std::sqrt(medium.sigma_a_per_mm / d.coefficient_mm);
    d.extrapolation_mm =
        2.0 * d.coefficient_mm * (1.0 + 3.0 * moments.c2) / (1.0 - 2.0 * moments.c1);
    d.fluence_share = 0.25 * (1.0 - 2.0 * moments.c1);
    d.flux_share = 0.5 * (1.0 - 3.0 * moments.c2);
    return d;
}

PointSources::PointSources(const Diffusion& diffusion,
                           std::optional<double> thickness_mm,
                           std::vector<double> depths_mm)
    : diffusion_(diffusion),
      thickness_(thickness_mm),
      period_(thickness_mm.value_or(0.0) + 2.0 * diffusion.extrapolation_mm),
      depths_(std::move(depths_mm)) {
    if (!thickness_) return;
    const double zb = diffusion_.extrapolation_mm;
    for (int n = 1; n <= kModes; ++n) {
        const double wave = n * std::numbers::pi / period_;
        mode_exit_.push_back(
            (diffusion_.fluence_share / diffusion_.coefficient_mm * std::sin(wave * zb) +
             diffusion_.flux_share * wave * std::cos(wave * zb)) /
            (std::numbers::pi * period_));
    }
    for (const double depth : depths_) {
        for (int n = 1; n <= kModes; ++n) {
            mode_source_.push_back(std::sin(n * std::numbers::pi / period_ * (depth + zb)));
        }
    }
}

double PointSources::decay_per_mm() const {
    const double across = thickness_ ? std::numbers::pi / period_ : 0.0;
    return std::hypot(diffusion_.sigma_tr_per_mm, across);
}

Exitance PointSources::half_space(double depth, double radius) const {
    const double sigma = diffusion_.sigma_tr_per_mm;
    const double zb = diffusion_.extrapolation_mm;
    const Point real = point(sigma, depth, radius);
    const Point image = point(sigma, depth + 2.0 * zb, radius);
    const double fluence = (real.fluence - image.fluence) / diffusion_.coefficient_mm;
    return {LIVERY_MUTATED(dipole,
                           (diffusion_.fluence_share * fluence +
                            diffusion_.flux_share * (real.flux + image.flux)) /
                               (4.0 * std::numbers::pi)),
            0.0};
}

Exitance PointSources::images(double depth, double radius) const {
    const double sigma = diffusion_.sigma_tr_per_mm;
    const double zb = diffusion_.extrapolation_mm;
    const double thickness = *thickness_;
    const double f = diffusion_.fluence_share / diffusion_.coefficient_mm;
    const double e = diffusion_.flux_share;
    Exitance sum;
    const auto add = [&](double z, double sign) {
        const Point top = point(sigma, z, radius);
        const Point bottom = point(sigma, thickness - z, radius);
        sum.reflected += sign * (f * top.fluence + e * top.flux);
        sum.transmitted += sign * (f * bottom.fluence + e * bottom.flux);
    };
    add(depth, 1.0);
    add(-depth - 2.0 * zb, -1.0);
    for (int pair = 1; pair <= kMostPairs; ++pair) {
        const Exitance before = sum;
        for (const double side : {1.0, -1.0}) {
            const double shift = side * 2.0 * pair * period_;
            add(shift + depth, 1.0);
            add(shift - depth - 2.0 * zb, -1.0);
        }
        if (2.0 * pair * period_ * sigma > 40.0) break;
        if (pair < kMostPairs) continue;
        // Without absorption the pairs that are left fall off like the cube.
        const double left =
            0.5 * (kMostPairs - 1.0) * std::exp(-2.0 * kMostPairs * period_ * sigma);
        sum.reflected += left * (sum.reflected - before.reflected);
        sum.transmitted += left * (sum.transmitted - before.transmitted);
    }
    return {std::max(sum.reflected, 0.0) / (4.0 * std::numbers::pi),
            std::max(sum.transmitted, 0.0) / (4.0 * std::numbers::pi)};
}

void PointSources::at(double radius, std::vector<Exitance>& out) const {
    out.resize(depths_.size());
    if (!thickness_ || radius < kModesFrom * period_) {
        for (std::size_t k = 0; k < depths_.size(); ++k) {
            out[k] = thickness_ ? images(depths_[k], radius) : half_space(depths_[k], radius);
        }
        return;
    }
    double weights[kModes];
    int modes = 0;
    while (modes < kModes) {
        const double wave = (modes + 1) * std::numbers::pi / period_;
        const double x = std::hypot(diffusion_.sigma_tr_per_mm, wave) * radius;
        if (modes > 0 && wave * radius > std::numbers::pi / period_ * radius + 25.0) break;
        weights[modes] =
            x < 700.0 ? mode_exit_[static_cast<std::size_t>(modes)] * std::cyl_bessel_k(0.0, x)
                      : 0.0;
        ++modes;
    }
    for (std::size_t k = 0; k < depths_.size(); ++k) {
        const double* source = mode_source_.data() + k * kModes;
        double odd = 0.0, even = 0.0;
        for (int n = 0; n < modes; n += 2) odd += weights[n] * source[n];
        for (int n = 1; n < modes; n += 2) even += weights[n] * source[n];
        out[k] = {std::max(odd + even, 0.0), std::max(odd - even, 0.0)};
    }
}

Exitance PointSources::total(std::size_t index) const {
    const double sigma = diffusion_.sigma_tr_per_mm;
    const double zb = diffusion_.extrapolation_mm;
    const double depth = depths_[index];
    const double f = diffusion_.fluence_share / diffusion_.coefficient_mm;
    const double e = diffusion_.flux_share;
    if (!thickness_) {
        // The plane integral of e^{-sigma d}/d is 2 pi e^{-sigma |z|}/sigma.
        const double near = std::exp(-sigma * depth), far = std::exp(-sigma * (depth + 2.0 * zb));
        const double apart = 2.0 * zb * sigma;
        const double slope = apart > 1e-12 ? -std::expm1(-apart) / sigma : 2.0 * zb;
        return {0.5 * f * near * slope + 0.5 * e * (near + far), 0.0};
    }
    // The one-dimensional problem: sinh(s (L - z - zb)) sinh(s zb)/(s sinh(s L)) is the fluence
    // at the top, and its slope cosh(s zb) in the place of sinh(s zb)/s the flux.
    const double fluence = sigma * zb > 1e-9 ? std::sinh(sigma * zb) / sigma : zb;
    const double flux = std::cosh(sigma * zb);
    const double top = sinh_ratio(sigma, period_ - depth - zb, period_);
    const double bottom = sinh_ratio(sigma, depth + zb, period_);
    return {top * (f * fluence + e * flux), bottom * (f * fluence + e * flux)};
}

}  // namespace livery
