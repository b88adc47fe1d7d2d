#include "appearance/subsurface/single_scattering.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "appearance/subsurface/fresnel_moments.h"
#include "core/mutation.h"
#include "core/quadrature.h"

namespace livery {

namespace {

/// Henyey and Greenstein's phase function, per steradian.
double phase(double g, double cosine) {
    const double apart = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g) * (1.0 + g) / (4.0 * std::numbers::pi * apart * std::sqrt(apart));
}

/// Of the beam on its way down and, mirrored at a slab's bottom, up: its power at the top, or at
/// the bottom, after all passes.
struct Beams {
    double down = 1.0, up = 0.0;
};

Beams beams_of(const ScatteringMedium& medium) {
    if (!medium.thickness_mm) return {};
    const double mirrored = inner_reflectance(medium.eta, 1.0);
    const double once = std::exp(-medium.sigma_t() * *medium.thickness_mm);
    const double down = 1.0 / (1.0 - mirrored * mirrored * once * once);
    return {down, down * mirrored * once};
}

/// Angles in panels that grow fourfold, from a forward peak's width on; in the last F leaves 1 like
/// a root at `high`.
template <typename Function>
double integrate_angles(double low, double high, double peak, const Function& f) {
    static const auto nodes = gauss_legendre(24);
    double sum = 0.0;
    double from = low;
    double width = std::max(std::min(0.05, peak), 0.75 * low);
    while (high - from > 4.0 * width) {
        sum += integrate(nodes, from, from + width, f);
        from += width;
        width *= 4.0;
    }
    const double span = high - from;
    for (const QuadratureNode& t : nodes) {
        sum += 2.0 * t.at * t.weight * span * f(high - span * t.at * t.at);
    }
    return sum;
}

/// Out of a boundary at which the beam arrives with `arriving` (and leaves with `leaving`) after
/// paths of `sigma_t` times the depth: cosines of scattering are those of the beam that flies
/// away from the boundary (-) and toward it (+).
struct Exit {
    double away = 0.0, toward = 0.0;  ///< power of each beam at this boundary
};

double exitance(const ScatteringMedium& medium, double r, Exit beams) {
    const double sigma_t = medium.sigma_t();
    if (!(medium.sigma_s_per_mm > 0.0) || !(r > 0.0)) return 0.0;
    const double high = std::acos(critical_cosine(medium.eta));
    // cot t + 1/sin t = cot(t/2): beyond 45 more of it in the exponent nothing is left of a beam
    // that fades away from the boundary.
    const double deepest = 1.0 / std::tan(high / 2.0) + 45.0 / (sigma_t * r);
    double low = 2.0 * std::atan(1.0 / deepest);
    const double thickness = medium.thickness_mm.value_or(0.0);
    if (medium.thickness_mm) {
        low =
            beams.toward > 0.0 ? std::atan2(r, thickness) : std::max(low, std::atan2(r, thickness));
    }
    if (low >= high) return 0.0;
    const auto at = [&](double angle) {
        const double cosine = std::cos(angle), sine = std::sin(angle);
        const double depth = r * cosine / sine;
        const double path = r / sine;
        double scattered = 0.0;
        if (beams.away > 0.0) {
            scattered +=
                beams.away * phase(medium.g, -cosine) * std::exp(-sigma_t * (depth + path));
        }
        // Toward the boundary a beam grows with the depth that it has still to go: its power here
        // stands for all of it.
        if (beams.toward > 0.0) {
            scattered +=
                beams.toward * phase(medium.g, cosine) *
                std::exp(-sigma_t * (path + (medium.thickness_mm ? thickness - depth : 0.0)));
        }
        return scattered * cosine * (1.0 - inner_reflectance(medium.eta, cosine));
    };
    return LIVERY_MUTATED(
        single_scattering,
        medium.sigma_s_per_mm / r * integrate_angles(low, high, 1.0 - std::abs(medium.g), at));
}

/// Over the plane, the depth integrated in closed form.
double total(const ScatteringMedium& medium, Exit beams) {
    static const auto nodes = gauss_legendre(64);
    const double sigma_t = medium.sigma_t();
    const double optical = medium.thickness_mm ? sigma_t * *medium.thickness_mm : 0.0;
    const double critical = critical_cosine(medium.eta);
    double sum = 0.0;
    for (const QuadratureNode& t : nodes) {
        const double mu = critical + (1.0 - critical) * t.at * t.at;
        const double weight = 2.0 * t.at * t.weight * (1.0 - critical);
        // int e^{-tau} e^{-tau/mu} dtau, and int e^{-(T - tau)} e^{-tau/mu} dtau
        const double steep = 1.0 + 1.0 / mu;
        const double away = (medium.thickness_mm ? -std::expm1(-optical * steep) : 1.0) / steep;
        const double slope = 1.0 / mu - 1.0;
        const double x = optical * slope;
        const double toward =
            std::exp(-optical) * optical * (x > 1e-8 ? -std::expm1(-x) / x : 1.0 - 0.5 * x);
        double scattered = 0.0;
        if (beams.away > 0.0) scattered += beams.away * phase(medium.g, -mu) * away;
        if (beams.toward > 0.0) scattered += beams.toward * phase(medium.g, mu) * toward;
        sum += weight * scattered * (1.0 - inner_reflectance(medium.eta, mu));
    }
    return 2.0 * std::numbers::pi * sum * medium.sigma_s_per_mm / sigma_t;
}

/// Seen from the top the beam flies away and its mirror image arrives, the power of each taken
/// where it starts; seen from the bottom the other way round.
Exit from_top(const ScatteringMedium& medium) {
    const Beams beams = beams_of(medium);
    return {beams.down, beams.up};
}
Exit from_bottom(const ScatteringMedium& medium) {
    const Beams beams = beams_of(medium);
    return {beams.up, beams.down};
}

}  // namespace

double single_scattering_reflectance(const ScatteringMedium& medium, double radius_mm) {
    return exitance(medium, radius_mm, from_top(medium));
}

double single_scattering_transmittance(const ScatteringMedium& medium, double radius_mm) {
    return medium.thickness_mm ? exitance(medium, radius_mm, from_bottom(medium)) : 0.0;
}

DiffuseTotals single_scattering_totals(const ScatteringMedium& medium) {
    if (!(medium.sigma_s_per_mm > 0.0)) return {};
    const double transmittance = medium.thickness_mm ? total(medium, from_bottom(medium)) : 0.0;
    return {total(medium, from_top(medium)), transmittance};
}

}  // namespace livery
