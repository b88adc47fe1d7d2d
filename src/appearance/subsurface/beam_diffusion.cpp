#include "appearance/subsurface/beam_diffusion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "appearance/subsurface/over_plane.h"
#include "core/quadrature.h"

namespace livery {

namespace {

constexpr double kShallowest = 1e-5, kDeepest = 34.0;  // mean free paths

std::vector<double> depths_mm(const ScatteringMedium& medium) {
    std::vector<double> depths = beam_depths(0.0, medium.reduced_depth()).reduced_depths;
    for (double& depth : depths) depth /= medium.sigma_t_prime();
    return depths;
}

}  // namespace

BeamDepths beam_depths(double from, double to) {
    static const auto nodes = gauss_legendre(8);
    BeamDepths found;
    const double last = std::min(to, kDeepest);
    if (!(from < last)) return found;
    const double first = from > 0.0 ? from : std::min(kShallowest, 1e-4 * last);
    const int fewest = from > 0.0 ? 1 : 4;
    const int panels = std::max(fewest, static_cast<int>(std::ceil(std::log(last / first) / 2.2)));
    const double step = std::log(last / first) / panels;
    for (int k = 0; k < panels; ++k) {
        for (const QuadratureNode& node : nodes) {
            const double depth = first * std::exp(step * (k + node.at));
            found.reduced_depths.push_back(depth);
            found.powers.push_back(node.weight * step * depth * std::exp(-depth));
        }
    }
    return found;
}

BeamDiffusion::BeamDiffusion(const ScatteringMedium& medium)
    : sigma_t_prime_(medium.sigma_t_prime()),
      thickness_(medium.thickness_mm),
      sources_(improved_diffusion(medium), medium.thickness_mm, depths_mm(medium)) {
    const double albedo = medium.albedo_prime();
    for (const double power : beam_depths(0.0, medium.reduced_depth()).powers) {
        powers_.push_back(albedo * albedo * power);
    }
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
