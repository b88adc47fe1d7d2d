// Gauss and Legendre's rule: the integral of a polynomial of degree 2n - 1 by n values.
#pragma once

#include <utility>
#include <vector>

namespace livery {

struct QuadratureNode {
    double at = 0.0, weight = 0.0;
};

/// Over 0 to 1; the weights add up to 1.
std::vector<QuadratureNode> gauss_legendre(int points);

/// The integral of `f` from `low` to `high` by these nodes of 0 to 1.
template <typename Function>
double integrate(const std::vector<QuadratureNode>& nodes,
                 double low,
                 double high,
                 const Function& f) {
    double sum = 0.0;
    for (const QuadratureNode& node : nodes) sum += node.weight * f(low + (high - low) * node.at);
    return sum * (high - low);
}

}  // namespace livery
