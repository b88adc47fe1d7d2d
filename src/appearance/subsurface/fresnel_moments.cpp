#include "appearance/subsurface/fresnel_moments.h"

#include <cmath>

#include "appearance/gloss_optics.h"
#include "core/mutation.h"
#include "core/quadrature.h"

namespace livery {

double critical_cosine(double eta) {
    return eta > 1.0 ? std::sqrt((1.0 - 1.0 / eta) * (1.0 + 1.0 / eta)) : 0.0;
}

double inner_reflectance(double eta, double mu) {
    const double value = dielectric_reflectance(mu, 1.0 / eta);
    return std::isfinite(value) ? value : 1.0;  // 0/0 at grazing incidence on no boundary
}

FresnelMoments fresnel_moments(double eta) {
    static const auto nodes = gauss_legendre(48);
    FresnelMoments moments;
    const double critical = critical_cosine(eta);
    // All of it is reflected up to the critical cosine.
    moments.c1 = critical * critical / 2.0;
    moments.c2 = critical * critical * critical / 3.0;
    // Beyond, F leaves 1 like a root: mu = critical + (1 - critical) t^2 makes it smooth.
    for (const QuadratureNode& t : nodes) {
        const double mu = critical + (1.0 - critical) * t.at * t.at;
        const double weight = 2.0 * t.at * t.weight * (1.0 - critical);
        const double f = inner_reflectance(eta, mu);
        moments.c1 += weight * f * mu;
        moments.c2 += weight * f * mu * mu;
        const double passed = LIVERY_MUTATED(boundary_passed, weight * (1.0 - f) * mu);
        const double mu2 = mu * mu;
        moments.passed[0] += passed;
        moments.passed[1] += passed * mu;
        moments.passed[2] += passed * (3.0 * mu2 - 1.0) / 2.0;
        moments.passed[3] += passed * mu * (5.0 * mu2 - 3.0) / 2.0;
    }
    return moments;
}

}  // namespace livery
