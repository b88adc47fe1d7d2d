#include "appearance/subsurface/profile_integrals.h"

#include "core/quadrature.h"

namespace livery {

namespace {

constexpr int kRatioPanels = 16, kZeros = 44, kAveraged = 28;

/// McMahon's expansion: between these J_0 changes its sign.
double zero_of_j0(int n) {
    const double eight = 8.0 * (n - 0.25) * std::numbers::pi;
    return eight / 8.0 + 1.0 / eight - 124.0 / (3.0 * eight * eight * eight);
}

std::vector<HankelNode> made() {
    const auto rule = gauss_legendre(10);
    std::vector<HankelNode> nodes;
    const auto add = [&](double low, double high, double share) {
        for (const QuadratureNode& node : rule) {
            const double x = low + (high - low) * node.at;
            nodes.push_back(
                {x, share * node.weight * (high - low) * x * std::cyl_bessel_j(0.0, x)});
        }
    };
    const double first = zero_of_j0(1);
    double high = first;
    for (int k = 0; k < kRatioPanels; ++k) {
        add(high / 3.0, high, 1.0);
        high /= 3.0;
    }
    add(0.0, high, 1.0);
    // The sums up to zeros kZeros - kAveraged to kZeros by binomial weights: a panel counts with
    // the weights of all sums that hold it.
    std::vector<double> binomial(kAveraged + 1, 0.0);
    binomial[0] = std::ldexp(1.0, -kAveraged);
    for (int k = 1; k <= kAveraged; ++k) {
        binomial[static_cast<std::size_t>(k)] =
            binomial[static_cast<std::size_t>(k) - 1] * (kAveraged - k + 1) / k;
    }
    double share = 1.0;
    for (int n = 1; n < kZeros; ++n) {
        if (n >= kZeros - kAveraged) {
            share -= binomial[static_cast<std::size_t>(n - (kZeros - kAveraged))];
        }
        add(zero_of_j0(n), zero_of_j0(n + 1), share);
    }
    return nodes;
}

}  // namespace

const std::vector<HankelNode>& hankel_nodes() {
    static const std::vector<HankelNode> nodes = made();
    return nodes;
}

}  // namespace livery
