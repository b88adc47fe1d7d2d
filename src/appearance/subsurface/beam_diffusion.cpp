#include "appearance/subsurface/beam_diffusion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "appearance/subsurface/over_plane.h"
#include "core/quadrature.h"

namespace livery {

namespace {

constexpr double kShallowest = 1e-5, kDeepest = 34.0;  // mean free paths

struct Depths {
    std::vector<double> depths_mm, powers;
};

/// Depths of the beam in panels that grow with the depth, each with the power that is left there:
/// what is near the surface shapes the profile near the beam.
Depths depths_of(const ScatteringMedium& medium) {
    static const auto nodes = gauss_legendre(8);
    const double all = medium.sigma_t_prime();
    const double last = std::min(medium.reduced_depth(), kDeepest);
    const double first = std::min(kShallowest, 1e-4 * last);
    Depths found;
    const int panels = std::max(4, static_cast<int>(std::ceil(std::log(last / first) / 2.2)));
    const double step = std::log(last / first) / panels;
    for (int k = 0; k < panels; ++k) {
        for (const QuadratureNode& node : nodes) {
            const double depth = first * std::exp(step * (k + node.at));
            found.depths_mm.push_back(depth / all);
            found.powers.push_back(node.weight * step * depth * std::exp(-depth));
        }
    }
    return found;
}

}  // namespace

BeamDiffusion::BeamDiffusion(const ScatteringMedium& medium)
    : sigma_t_prime_(medium.sigma_t_prime()),
      thickness_(medium.thickness_mm),
      sources_(improved_diffusion(medium), medium.thickness_mm, depths_of(medium).depths_mm) {
    const double albedo = medium.albedo_prime();
    for (const double power : depths_of(medium).powers) powers_.push_back(albedo * albedo * power);
}

Exitance BeamDiffusion::at(double radius_mm) const {
    static thread_local std::vector<Exitance> each;
    sources_.at(radius_mm, each);
    const std::vector<double>& depths = sources_.depths_mm();
    // Grosjean's solution holds where light has scattered often: an empirical factor takes away
    // what it has too much of near the beam.
    const auto often = [&](double depth, double to_exit) {
        const double path = depth + std::hypot(radius_mm, to_exit);
        return -std::expm1(-2.0 * sigma_t_prime_ * path);
    };
    Exitance sum;
    for (std::size_t k = 0; k < depths.size(); ++k) {
        sum.reflected += powers_[k] * each[k].reflected * often(depths[k], depths[k]);
        if (!thickness_) continue;
        sum.transmitted +=
            powers_[k] * each[k].transmitted * often(depths[k], *thickness_ - depths[k]);
    }
    return sum;
}

Exitance BeamDiffusion::total() const {
    return over_plane(
        1.0 / sigma_t_prime_, sources_.decay_per_mm(), [&](double r) { return at(r); });
}

}  // namespace livery
