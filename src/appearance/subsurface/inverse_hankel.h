// From a spectrum over wave numbers along the surface to a profile over the radius.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

namespace livery {

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

}  // namespace livery
