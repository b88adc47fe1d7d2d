// Profiles over the plane: their integral, from a spectrum over wave numbers to the radius, and
// what every model shares on its way to a profile.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "appearance/subsurface/diffusion.h"
#include "appearance/subsurface/subsurface_profile.h"
#include "core/quadrature.h"

namespace livery {

/// int 2 pi r f(r) dr over radii from 0 to `largest_mm`, in panels of equal ratio, where f goes as
/// 1/r below `smallest_mm`.
template <typename Function>
Exitance over_disc(double smallest_mm, double largest_mm, const Function& f) {
    static const auto nodes = gauss_legendre(4);
    const Exitance middle = f(smallest_mm);
    const double inside = 2.0 * std::numbers::pi * smallest_mm * smallest_mm;
    Exitance sum{inside * middle.reflected, inside * middle.transmitted};
    const double span = std::log(largest_mm / smallest_mm);
    const int panels = std::max(1, static_cast<int>(std::ceil(span)));
    for (int k = 0; k < panels; ++k) {
        for (const QuadratureNode& node : nodes) {
            const double r = smallest_mm * std::exp(span * (k + node.at) / panels);
            const double weight = 2.0 * std::numbers::pi * r * r * node.weight * span / panels;
            const Exitance value = f(r);
            sum.reflected += weight * value.reflected;
            sum.transmitted += weight * value.transmitted;
        }
    }
    return sum;
}

/// The same over the whole plane, for a profile of a medium with this mean free path that decays
/// like e^{-decay r}, or r^-3 where `decay` is 0.
template <typename Function>
Exitance over_plane(double mean_free_path_mm, double decay_per_mm, const Function& f) {
    const double far = 1e5 * mean_free_path_mm;
    const double end = decay_per_mm * far > 45.0 ? 45.0 / decay_per_mm : far;
    return over_disc(1e-5 * mean_free_path_mm, std::max(end, 40.0 * mean_free_path_mm), f);
}

struct HankelNode {
    double x = 0.0, weight = 0.0;
};
/// Of int f(x) J_0(x) x dx over all x: panels of equal ratio up to the first zero of J_0, then one
/// from each zero to the next, the sums up to the last of which are averaged again and again
/// (Euler's transformation), so that slowly decaying f will do.
const std::vector<HankelNode>& hankel_nodes();

/// 1/(2 pi) int F(s) J_0(s r) s ds at r > 0, of a smooth F, within about 1e-8 of F(0)/r^2.
/// `add(s, weight)` adds weight times F(s) to whatever is summed.
template <typename Add>
void inverse_hankel(double radius_mm, const Add& add) {
    const double scale = 1.0 / (2.0 * std::numbers::pi * radius_mm * radius_mm);
    for (const HankelNode& node : hankel_nodes()) add(node.x / radius_mm, scale * node.weight);
}

/// A profile and its totals, of which each model makes its own.
struct MadeProfile {
    std::function<Exitance(double radius_mm)> at;
    Exitance totals;
};

/// What `multiple` is to be multiplied with to add up to the exact totals beside single scattering.
Exitance factors_to(const DiffuseTotals& exact,
                    const DiffuseTotals& once,
                    const MadeProfile& multiple);

/// Fills in totals, scale and both sides: nothing below 0, no more than what scatters.
void finish_profile(const MadeProfile& made,
                    const UnscatteredLight& unscattered,
                    SubsurfaceProfile& profile);

}  // namespace livery
