#include "appearance/subsurface/exact_totals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "appearance/subsurface/fresnel_moments.h"
#include "core/mutation.h"
#include "core/quadrature.h"

namespace livery {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Cosines inside with their weights. The last is the normal itself, of no weight: what is seen
/// along it is what a beam along it gives everywhere (reciprocity).
struct Cosines {
    Vector mu, weight;
};

Cosines cosines_of(double eta, int points) {
    const double critical = critical_cosine(eta);
    const auto nodes = gauss_legendre(points);
    std::vector<std::pair<double, double>> found;
    for (const auto& [low, high] : {std::pair(0.0, critical), std::pair(critical, 1.0)}) {
        if (high - low < 1e-6) continue;
        for (const QuadratureNode& node : nodes) {
            found.emplace_back(low + (high - low) * node.at, (high - low) * node.weight);
        }
    }
    found.emplace_back(1.0, 0.0);
    const auto count = static_cast<Eigen::Index>(found.size());
    Cosines cosines{Vector(count), Vector(count)};
    for (Eigen::Index k = 0; k < count; ++k) {
        cosines.mu[k] = found[static_cast<std::size_t>(k)].first;
        cosines.weight[k] = found[static_cast<std::size_t>(k)].second;
    }
    return cosines;
}

/// Intensities that leave a layer for those that meet it.
struct Layer {
    Matrix reflected, transmitted;
};

/// Henyey and Greenstein's function averaged over azimuths, by its Legendre series from degree 0 to
/// `terms` - 1 without the peak `cut`: forward, and back.
std::pair<Matrix, Matrix> redistribution(const Vector& mu, double g, double cut, int terms) {
    const Eigen::Index count = mu.size();
    Matrix forward = Matrix::Zero(count, count), back = forward;
    Vector p = Vector::Ones(count), before = Vector::Zero(count);
    double moment = 1.0;
    for (int l = 0; l < terms; ++l) {
        const double weight = (2.0 * l + 1.0) * (moment - cut) / (1.0 - cut);
        const Matrix product = weight * p * p.transpose();
        forward += product;
        back += (l % 2 == 0 ? 1.0 : -1.0) * product;
        const Vector next =
            ((2.0 * l + 1.0) * mu.cwiseProduct(p) - static_cast<double>(l) * before) / (l + 1.0);
        before = p;
        p = next;
        moment *= g;
    }
    return {forward, back};
}

/// A layer so thin that intensities go straight across it (the diamond rule, Wiscombe 1976).
Layer thin_layer(
    const Cosines& cosines, double albedo, double depth, double g, double cut, int terms) {
    const auto [forward, back] = redistribution(cosines.mu, g, cut, terms);
    const Eigen::Index count = cosines.mu.size();
    const Matrix one = Matrix::Identity(count, count);
    const auto per_mu = cosines.mu.cwiseInverse().asDiagonal();
    const auto weights = cosines.weight.asDiagonal();
    const Matrix across = 0.5 * depth * (per_mu * (one - 0.5 * albedo * forward * weights));
    const Matrix turned = 0.25 * albedo * depth * (per_mu * back * weights);
    const Matrix halved = (one + across).inverse();
    const Matrix kept = (one + across - turned * halved * turned).inverse();
    return {2.0 * kept * turned * halved, 2.0 * kept - one};
}

/// Twice as thick.
Layer doubled(const Layer& layer) {
    const Eigen::Index count = layer.reflected.rows();
    const Matrix one = Matrix::Identity(count, count);
    const Matrix to_and_fro = (one - layer.reflected * layer.reflected)
                                  .transpose()
                                  .partialPivLu()
                                  .solve(layer.transmitted.transpose())
                                  .transpose();
    return {layer.reflected + to_and_fro * layer.reflected * layer.transmitted,
            to_and_fro * layer.transmitted};
}

constexpr double kNothing = 1e-9;

}  // namespace

DiffuseTotals exact_totals(const ScatteringMedium& medium, int points) {
    check_medium(medium);
    if (medium.sigma_s_per_mm == 0.0) return {};
    // All that enters a half space comes out again.
    if (!medium.thickness_mm && medium.sigma_a_per_mm == 0.0) return {1.0, 0.0};
    const Cosines cosines = cosines_of(medium.eta, points);
    const double cut =
        std::pow(std::abs(medium.g), points) * (medium.g < 0.0 && points % 2 != 0 ? -1.0 : 1.0);
    const double scattered = medium.sigma_s_per_mm * (1.0 - cut);
    const double extinction = medium.sigma_a_per_mm + scattered;
    const double albedo = scattered / extinction;

    // A layer of the thickness, or one so thick that nothing gets through.
    const double thinnest = 0.02 * cosines.mu.minCoeff();
    double depth = thinnest;
    int doublings = 80;
    if (medium.thickness_mm) {
        const double whole = extinction * *medium.thickness_mm;
        doublings = std::clamp(
            static_cast<int>(std::ceil(std::log2(std::max(whole / thinnest, 1.0)))), 0, 80);
        depth = std::ldexp(whole, -doublings);
    }
    Layer layer = thin_layer(cosines, albedo, depth, medium.g, cut, points);
    for (int k = 0; k < doublings; ++k) {
        if (layer.transmitted.cwiseAbs().maxCoeff() < kNothing) break;
        layer = doubled(layer);
    }

    // Even light of radiance 1 from above, and what the two boundaries then send to and fro: half
    // of it is the same from above and below, half the opposite.
    Vector mirrored(cosines.mu.size());
    for (Eigen::Index k = 0; k < mirrored.size(); ++k) {
        mirrored[k] = inner_reflectance(medium.eta, cosines.mu[k]);
    }
    const Vector entering = 0.5 * (Vector::Ones(mirrored.size()) - mirrored);
    const Matrix one = Matrix::Identity(mirrored.size(), mirrored.size());
    const auto leaves = [&](const Matrix& through) -> Vector {
        const Matrix to_and_fro = one - mirrored.asDiagonal() * through;
        return through * to_and_fro.partialPivLu().solve(entering);
    };
    const Vector alike = leaves(layer.reflected + layer.transmitted);
    const Vector opposite = leaves(layer.reflected - layer.transmitted);

    // What leaves along the normal, without what never scattered.
    const Eigen::Index normal = mirrored.size() - 1;
    const UnscatteredLight unscattered = unscattered_light(medium);
    const double up = alike[normal] + opposite[normal] - unscattered.reflected;
    const double down = alike[normal] - opposite[normal] - unscattered.transmitted;
    DiffuseTotals totals;
    totals.reflectance = LIVERY_MUTATED(exact_totals, std::clamp(up, 0.0, 1.0));
    totals.transmittance = medium.thickness_mm ? std::clamp(down, 0.0, 1.0) : 0.0;
    // Rounding of forty doublings may gain some millionths, and lose them where nothing is
    // absorbed.
    const double scattered_share = 1.0 - unscattered.reflected - unscattered.transmitted;
    const double sum = totals.reflectance + totals.transmittance;
    if (sum > scattered_share || (medium.sigma_a_per_mm == 0.0 && sum > 0.0)) {
        totals.reflectance *= scattered_share / sum;
        totals.transmittance *= scattered_share / sum;
    }
    return totals;
}

}  // namespace livery
