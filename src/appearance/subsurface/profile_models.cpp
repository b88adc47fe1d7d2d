#include "appearance/subsurface/profile_models.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "appearance/subsurface/profile_integrals.h"
#include "appearance/subsurface/scattering_medium.h"
#include "core/mutation.h"
#include "core/quadrature.h"

namespace livery {

NormalizedDiffusion::NormalizedDiffusion(double total_reflectance, double mean_free_path_mm)
    : albedo(total_reflectance) {
    const double off = std::abs(albedo - 0.8);
    d_mm = mean_free_path_mm / (1.85 - albedo + 7.0 * off * off * off);
}

double NormalizedDiffusion::at(double radius_mm) const {
    const double x = radius_mm / d_mm;
    return albedo * (std::exp(-x) + std::exp(-x / 3.0)) /
           (8.0 * std::numbers::pi * d_mm * radius_mm);
}

double NormalizedDiffusion::cumulative(double radius_mm) const {
    const double x = radius_mm / d_mm;
    return 1.0 - 0.25 * std::exp(-x) - 0.75 * std::exp(-x / 3.0);
}

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

P3Dipole::P3Dipole(const ScatteringMedium& medium) {
    const FresnelMoments moments = fresnel_moments(medium.eta);
    passed_ = moments.passed;
    albedo_ = medium.albedo_prime();
    depth_ = 1.0 / medium.sigma_t_prime();

    // What the moments of degree 0 to 3 lose, per mm.
    const double g = medium.g, s = medium.sigma_s_per_mm, s0 = medium.sigma_a_per_mm;
    const double s1 = s0 + s * (1.0 - g);
    const double s2 = s0 + s * (1.0 - g * g);
    const double s3 = s0 + s * (1.0 - g * g * g);

    // The roots of the dispersion relation. gamma is 0 without absorption: the small root then is
    // a quotient and never a difference.
    const double beta = 27.0 * s0 * s1 + 28.0 * s0 * s3 + 35.0 * s2 * s3;
    const double gamma = 3780.0 * s0 * s1 * s2 * s3;
    const double root = std::sqrt(std::max(beta * beta - gamma, 0.0));
    const double large2 = (beta + root) / 18.0;
    const double small2 = gamma / (18.0 * (beta + root));
    const double apart = 3.0 * (large2 - small2);
    const auto strength = [&](double nu2) {
        return (35.0 * s1 * s2 * s3 - nu2 * (9.0 * s1 + 28.0 * s3 / 3.0)) / apart;
    };

    // G_1/nu = sigma_a/nu^2 is the diffusion coefficient: for the small root without a 0 below.
    const double diffusion = 3.0 * large2 / (35.0 * s1 * s2 * s3);
    const auto third = [&](double second) { return 3.0 * second / (7.0 * s3); };
    const double small_second = 2.0 * diffusion / (5.0 * s2 - 9.0 * small2 / (7.0 * s3));
    roots_[0] = {
        std::sqrt(small2), strength(small2), {1.0, diffusion, small_second, third(small_second)}};
    const double large_second = (1.5 * s0 * s1 / large2 - 0.5) / large2;
    roots_[1] = {std::sqrt(large2),
                 -strength(large2),
                 {1.0, s0 / large2, large_second, third(large_second)}};

    const double a = (1.0 + 3.0 * moments.c2) / (1.0 - 2.0 * moments.c1);
    image_depth_ = depth_ + 4.0 * a * diffusion;
}

/// Sum over roots and degrees of (2l+1)/2 T_l phi_l P_l, in which nu^{l+1} k_l(nu d) is
/// e^{-x} times a polynomial of x = nu d, over d^{l+1}.
double P3Dipole::moments_at(double depth, double radius) const {
    const double d = std::hypot(depth, radius);
    const double mu = depth / d, mu2 = mu * mu;
    const std::array<double, 4> legendre{
        1.0, mu, 0.5 * (3.0 * mu2 - 1.0), 0.5 * mu * (5.0 * mu2 - 3.0)};
    double sum = 0.0;
    for (const Root& r : roots_) {
        const double x = r.nu * d;
        const std::array<double, 4> radial{
            1.0, 1.0 + x, 3.0 + x * (3.0 + x), 15.0 + x * (15.0 + x * (6.0 + x))};
        double of_root = 0.0, power = 1.0 / d;
        for (std::size_t l = 0; l < 4; ++l) {
            of_root += 0.5 * (2.0 * static_cast<double>(l) + 1.0) * passed_[l] * r.moment[l] *
                       radial[l] * power * legendre[l];
            power /= d;
        }
        sum += r.strength * std::exp(-x) * of_root;
    }
    return sum / (4.0 * std::numbers::pi);
}

double P3Dipole::at(double radius_mm) const {
    return LIVERY_MUTATED(
        p3, albedo_ * (moments_at(depth_, radius_mm) - moments_at(-image_depth_, radius_mm)));
}

double P3Dipole::total() const {
    double sum = 0.0;
    for (const Root& r : roots_) {
        const double near = std::exp(-r.nu * depth_), far = std::exp(-r.nu * image_depth_);
        const double apart = image_depth_ - depth_;
        const double x = r.nu * apart;
        const double difference_over_nu = near * (x > 1e-12 ? -std::expm1(-x) / r.nu : apart);
        double power = 1.0;
        for (std::size_t l = 0; l < 4; ++l) {
            // nu^{l-1} times the difference or the sum
            const double spread = l % 2 == 0 ? power * difference_over_nu : power * (near + far);
            sum += 0.5 * (2.0 * static_cast<double>(l) + 1.0) * passed_[l] * r.strength *
                   r.moment[l] / 2.0 * spread;
            if (l % 2 == 1) power *= r.nu * r.nu;
        }
    }
    return albedo_ * sum;
}

}  // namespace livery
