#include "appearance/subsurface/single_scattering.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "appearance/subsurface/scattering_medium.h"
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

/// A layer by the depth at which it begins, straight on from the boundary where the light leaves.
struct Slice {
    double sigma_t = 0.0, sigma_s = 0.0, g = 0.0;
    double from_mm = 0.0, from_optical = 0.0;
    std::optional<double> thickness_mm;

    double optical_at(double depth) const { return from_optical + sigma_t * (depth - from_mm); }
};

/// A whole stack, and how deep it is.
struct Slices {
    std::vector<Slice> slices;
    double eta = 1.0, optical = 0.0;  ///< of a slab
    bool is_slab = false;
};

Slices slices_of(const std::vector<ScatteringMedium>& layers, bool from_bottom) {
    Slices made;
    made.eta = layers.front().eta;
    made.is_slab = layers.back().thickness_mm.has_value();
    double depth = 0.0;
    for (std::size_t n = 0; n < layers.size(); ++n) {
        const ScatteringMedium& layer = layers[from_bottom ? layers.size() - 1 - n : n];
        made.slices.push_back({layer.sigma_t(),
                               layer.sigma_s_per_mm,
                               layer.g,
                               depth,
                               made.optical,
                               layer.thickness_mm});
        if (!layer.thickness_mm) break;
        depth += *layer.thickness_mm;
        made.optical += layer.sigma_t() * *layer.thickness_mm;
    }
    return made;
}

Beams beams_of(const Slices& stack) {
    if (!stack.is_slab) return {};
    const double mirrored = inner_reflectance(stack.eta, 1.0);
    const double once = std::exp(-stack.optical);
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

double exitance_of(const Slices& stack, const Slice& slice, double r, Exit beams) {
    if (!(slice.sigma_s > 0.0)) return 0.0;
    const double critical = std::acos(critical_cosine(stack.eta));
    const double high =
        slice.from_mm > 0.0 ? std::min(critical, std::atan2(r, slice.from_mm)) : critical;
    // cot t + 1/sin t = cot(t/2): beyond 45 more of it in the exponent nothing is left of a beam
    // that fades away from the boundary.
    const double reach = 45.0 / slice.sigma_t;
    double low = slice.from_mm > 0.0
                     ? std::atan2(r, slice.from_mm + reach)
                     : 2.0 * std::atan(1.0 / (1.0 / std::tan(high / 2.0) + reach / r));
    if (slice.thickness_mm) {
        const double whole = std::atan2(r, slice.from_mm + *slice.thickness_mm);
        low = beams.toward > 0.0 ? whole : std::max(low, whole);
    }
    if (low >= high) return 0.0;
    const auto at = [&](double angle) {
        const double cosine = std::cos(angle), sine = std::sin(angle);
        const double straight = slice.optical_at(r * cosine / sine);
        const double path = straight / cosine;
        double scattered = 0.0;
        if (beams.away > 0.0) {
            scattered += beams.away * phase(slice.g, -cosine) * std::exp(-(straight + path));
        }
        // Toward the boundary a beam grows with the depth that it has still to go: its power here
        // stands for all of it.
        if (beams.toward > 0.0) {
            scattered += beams.toward * phase(slice.g, cosine) *
                         std::exp(-(path + std::max(stack.optical - straight, 0.0)));
        }
        return scattered * cosine * (1.0 - inner_reflectance(stack.eta, cosine));
    };
    return slice.sigma_s / r * integrate_angles(low, high, 1.0 - std::abs(slice.g), at);
}

double exitance(const Slices& stack, double r, Exit beams) {
    if (!(r > 0.0)) return 0.0;
    double sum = 0.0;
    for (const Slice& slice : stack.slices) sum += exitance_of(stack, slice, r, beams);
    return LIVERY_MUTATED(single_scattering, sum);
}

/// Over the plane, the depth integrated in closed form.
double total_of(const Slices& stack, const Slice& slice, Exit beams) {
    static const auto nodes = gauss_legendre(64);
    if (!(slice.sigma_s > 0.0)) return 0.0;
    const double optical = slice.thickness_mm ? slice.sigma_t * *slice.thickness_mm : 0.0;
    const double critical = critical_cosine(stack.eta);
    double sum = 0.0;
    for (const QuadratureNode& t : nodes) {
        const double mu = critical + (1.0 - critical) * t.at * t.at;
        const double weight = 2.0 * t.at * t.weight * (1.0 - critical);
        // int e^{-tau} e^{-tau/mu} dtau, and int e^{-(T - tau)} e^{-tau/mu} dtau
        const double steep = 1.0 + 1.0 / mu;
        const double slope = 1.0 / mu - 1.0;
        const double away = std::exp(-slice.from_optical * steep) *
                            (slice.thickness_mm ? -std::expm1(-optical * steep) : 1.0) / steep;
        const double x = optical * slope;
        const double toward = std::exp(-stack.optical - slice.from_optical * slope) * optical *
                              (x > 1e-8 ? -std::expm1(-x) / x : 1.0 - 0.5 * x);
        double scattered = 0.0;
        if (beams.away > 0.0) scattered += beams.away * phase(slice.g, -mu) * away;
        if (beams.toward > 0.0) scattered += beams.toward * phase(slice.g, mu) * toward;
        sum += weight * scattered * (1.0 - inner_reflectance(stack.eta, mu));
    }
    return 2.0 * std::numbers::pi * sum * slice.sigma_s / slice.sigma_t;
}

double total(const Slices& stack, Exit beams) {
    double sum = 0.0;
    for (const Slice& slice : stack.slices) sum += total_of(stack, slice, beams);
    return sum;
}

/// Seen from the top the beam flies away and its mirror image arrives, the power of each taken
/// where it starts; seen from the bottom the other way round.
Exit from_top(const Slices& stack) {
    const Beams beams = beams_of(stack);
    return {beams.down, beams.up};
}
Exit from_bottom(const Slices& stack) {
    const Beams beams = beams_of(stack);
    return {beams.up, beams.down};
}

double reflectance(const std::vector<ScatteringMedium>& layers, double radius_mm) {
    const Slices stack = slices_of(layers, false);
    return exitance(stack, radius_mm, from_top(stack));
}

double transmittance(const std::vector<ScatteringMedium>& layers, double radius_mm) {
    if (!layers.back().thickness_mm) return 0.0;
    const Slices stack = slices_of(layers, true);
    return exitance(stack, radius_mm, from_bottom(stack));
}

DiffuseTotals totals(const std::vector<ScatteringMedium>& layers) {
    const Slices down = slices_of(layers, false);
    if (!down.is_slab) return {total(down, from_top(down)), 0.0};
    const Slices up = slices_of(layers, true);
    return {total(down, from_top(down)), total(up, from_bottom(up))};
}

}  // namespace

double single_scattering_reflectance(const ScatteringMedium& medium, double radius_mm) {
    return reflectance({medium}, radius_mm);
}
double single_scattering_transmittance(const ScatteringMedium& medium, double radius_mm) {
    return transmittance({medium}, radius_mm);
}
DiffuseTotals single_scattering_totals(const ScatteringMedium& medium) { return totals({medium}); }

double single_scattering_reflectance(const ScatteringStack& stack, double radius_mm) {
    return reflectance(stack.layers, radius_mm);
}
double single_scattering_transmittance(const ScatteringStack& stack, double radius_mm) {
    return transmittance(stack.layers, radius_mm);
}
DiffuseTotals single_scattering_totals(const ScatteringStack& stack) {
    return totals(stack.layers);
}

}  // namespace livery
