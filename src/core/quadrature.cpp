#include "core/quadrature.h"

#include <cmath>
#include <numbers>

namespace livery {

std::vector<QuadratureNode> gauss_legendre(int points) {
    std::vector<QuadratureNode> nodes;
    for (int k = 0; k < points; ++k) {
        double x = std::cos(std::numbers::pi * (k + 0.75) / (points + 0.5));
        double slope = 1.0;
        for (int step = 0; step < 20; ++step) {
            double p = 1.0, before = 0.0;
            for (int n = 1; n <= points; ++n) {
                const double next = ((2.0 * n - 1.0) * x * p - (n - 1.0) * before) / n;
                before = p;
                p = next;
            }
            slope = points * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        nodes.push_back({0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope)});
    }
    return nodes;
}

}  // namespace livery
