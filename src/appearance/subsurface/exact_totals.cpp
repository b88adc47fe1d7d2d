#include "appearance/subsurface/exact_totals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "appearance/subsurface/scattering_medium.h"
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

/// A layer of the thickness, or one so thick that nothing gets through.
Layer homogeneous_layer(const Cosines& cosines, const ScatteringMedium& medium, int points) {
    const double cut =
        std::pow(std::abs(medium.g), points) * (medium.g < 0.0 && points % 2 != 0 ? -1.0 : 1.0);
    const double scattered = medium.sigma_s_per_mm * (1.0 - cut);
    const double extinction = medium.sigma_a_per_mm + scattered;
    const double albedo = extinction > 0.0 ? scattered / extinction : 0.0;

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
    return layer;
}

Vector mirrored_at(const Cosines& cosines, double eta) {
    Vector mirrored(cosines.mu.size());
    for (Eigen::Index k = 0; k < mirrored.size(); ++k) {
        mirrored[k] = inner_reflectance(eta, cosines.mu[k]);
    }
    return mirrored;
}

/// Rounding of forty doublings may gain some millionths, and lose them where nothing is absorbed.
DiffuseTotals conserving(double up, double down, const UnscatteredLight& light, bool lossless) {
    DiffuseTotals totals{std::clamp(up, 0.0, 1.0), std::clamp(down, 0.0, 1.0)};
    const double scattered_share = 1.0 - light.reflected - light.transmitted;
    const double sum = totals.reflectance + totals.transmittance;
    if (sum > scattered_share || (lossless && sum > 0.0)) {
        totals.reflectance *= scattered_share / sum;
        totals.transmittance *= scattered_share / sum;
    }
    return totals;
}

/// Several layers, which do not look the same from above (down) and from below (up).
struct Layers {
    Matrix reflected_down, transmitted_down, reflected_up, transmitted_up;
};

Layers added(const Layers& above, const Layers& below) {
    const Eigen::Index count = above.reflected_up.rows();
    const Matrix one = Matrix::Identity(count, count);
    const auto down = (one - above.reflected_up * below.reflected_down).partialPivLu();
    const auto up = (one - below.reflected_down * above.reflected_up).partialPivLu();
    const Matrix between_down = down.solve(above.transmitted_down);
    const Matrix between_up = up.solve(below.transmitted_up);
    return {above.reflected_down + above.transmitted_up * below.reflected_down * between_down,
            below.transmitted_down * between_down,
            below.reflected_up + below.transmitted_down * above.reflected_up * between_up,
            above.transmitted_up * between_up};
}

}  // namespace

DiffuseTotals exact_totals(const ScatteringMedium& medium, int points) {
    check_medium(medium);
    if (medium.sigma_s_per_mm == 0.0) return {};
    // All that enters a half space comes out again.
    if (!medium.thickness_mm && medium.sigma_a_per_mm == 0.0) return {1.0, 0.0};
    const Cosines cosines = cosines_of(medium.eta, points);
    const Layer layer = homogeneous_layer(cosines, medium, points);

    // Even light of radiance 1 from above, and what the two boundaries then send to and fro: half
    // of it is the same from above and below, half the opposite.
    const Vector mirrored = mirrored_at(cosines, medium.eta);
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
    return conserving(LIVERY_MUTATED(exact_totals, std::clamp(up, 0.0, 1.0)),
                      medium.thickness_mm ? down : 0.0,
                      unscattered,
                      medium.sigma_a_per_mm == 0.0);
}

DiffuseTotals exact_totals(const ScatteringStack& given, int points) {
    check_stack(given);
    const ScatteringStack stack = merged(given);
    if (stack.layers.size() == 1) return exact_totals(stack.layers.front(), points);
    if (!stack.scatters()) return {};
    const ScatteringMedium& last = stack.layers.back();
    const bool lossless = std::all_of(stack.layers.begin(),
                                      stack.layers.end(),
                                      [](const auto& one) { return one.sigma_a_per_mm == 0.0; });
    const bool open_below = !stack.is_slab() && !(last.sigma_t() > 0.0);
    if (lossless && !stack.is_slab() && !open_below) return {1.0, 0.0};

    const Cosines cosines = cosines_of(stack.eta(), points);
    const Eigen::Index count = cosines.mu.size();
    const Matrix one = Matrix::Identity(count, count);
    Layers whole{Matrix::Zero(count, count), one, Matrix::Zero(count, count), one};
    for (const ScatteringMedium& layer : stack.layers) {
        if (&layer == &last && open_below) continue;
        const Layer next = homogeneous_layer(cosines, layer, points);
        whole = added(whole, {next.reflected, next.transmitted, next.reflected, next.transmitted});
    }
    // By reciprocity what a beam along the normal makes leave at the top, and the bottom, is what
    // even light from above, and from below, shows along the normal at the top.
    const Vector mirrored = mirrored_at(cosines, stack.eta());
    const Vector below = stack.is_slab() ? mirrored : Vector(Vector::Zero(count));
    const Vector entering = Vector::Ones(count) - mirrored;
    Matrix system(2 * count, 2 * count);
    system << one - whole.reflected_down * mirrored.asDiagonal(),
        -whole.transmitted_up * below.asDiagonal(), -whole.transmitted_down * mirrored.asDiagonal(),
        one - whole.reflected_up * below.asDiagonal();
    Matrix light(2 * count, 2);
    light << whole.reflected_down * entering, whole.transmitted_up * entering,
        whole.transmitted_down * entering, whole.reflected_up * entering;
    const Matrix seen = system.partialPivLu().solve(light);
    const UnscatteredLight unscattered = unscattered_light(stack);
    return conserving(seen(count - 1, 0) - unscattered.reflected,
                      stack.is_slab() ? seen(count - 1, 1) - unscattered.transmitted : 0.0,
                      unscattered,
                      lossless && stack.is_slab());
}

}  // namespace livery
