// The integral of a profile over the plane.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "appearance/subsurface/diffusion.h"
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

}  // namespace livery
