#include "calibration/registration/gaussian_prior.h"

#include <algorithm>
#include <optional>

namespace livery {

namespace {

using PairMatrix = Eigen::Matrix<double, kPairTerms, kPairTerms, Eigen::RowMajor>;

/// What makes changes independent and of unit variance; nothing where it is no information.
std::optional<Eigen::MatrixXd> whitening(const Eigen::MatrixXd& information) {
    if (!(information.diagonal().minCoeff() > 0.0)) return std::nullopt;
    // Pixels beside radians: to unit diagonal first
    const Eigen::VectorXd unit = information.diagonal().array().sqrt().matrix();
    const Eigen::VectorXd per_unit = unit.cwiseInverse();
    Eigen::MatrixXd scaled = per_unit.asDiagonal() * information * per_unit.asDiagonal();
    if (!scaled.isApprox(scaled.transpose(), 1e-6)) return std::nullopt;
    scaled.diagonal().array() += 1e-11;  // rounding must not make it indefinite
    const Eigen::LLT<Eigen::MatrixXd> root(scaled);
    if (root.info() != Eigen::Success) return std::nullopt;
    return Eigen::MatrixXd(root.matrixU()) * unit.asDiagonal();
}

/// What boards tell, where their terms move by two deviations: squares of such
/// changes are more than what the boards tell of some combinations. Each term gets that much of
/// slack, and what no lens's model has: (L^-1 + S)^-1 for information L and slack S.
Eigen::MatrixXd with_slack(const Eigen::MatrixXd& information,
                           const View& projector,
                           const View& camera,
                           double distance_mm) {
    constexpr double kModelError = 2e-5;  // a twentieth of a pixel across a picture
    const Eigen::VectorXd sigma = covariance_from(information).diagonal().cwiseSqrt();
    const double focal = std::max(sigma[0], sigma[kLensTerms]);
    const double relative = kModelError + 4.0 * focal * focal;
    Eigen::VectorXd slack = Eigen::VectorXd::Constant(kPairTerms, relative);
    slack.segment(1, 2) *= projector.focal_px.x;
    slack.segment(kLensTerms + 1, 2) *= camera.focal_px.x;
    slack.tail(3) *= distance_mm;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(slack.asDiagonal() * information *
                                                                slack.asDiagonal());
    const Eigen::VectorXd values = solver.eigenvalues().cwiseMax(0.0);
    const Eigen::VectorXd eased = (values.array() / (1.0 + values.array())).matrix();
    const Eigen::VectorXd per_slack = slack.cwiseInverse();
    return per_slack.asDiagonal() * solver.eigenvectors() * eased.asDiagonal() *
           solver.eigenvectors().transpose() * per_slack.asDiagonal();
}

}  // namespace

Eigen::MatrixXd covariance_from(const Eigen::MatrixXd& information) {
    const Eigen::MatrixXd root = whitening(information).value();
    const Eigen::MatrixXd inverse = root.triangularView<Eigen::Upper>().solve(
        Eigen::MatrixXd::Identity(root.rows(), root.cols()));
    return inverse * inverse.transpose();
}

Eigen::MatrixXd independent(const Eigen::VectorXd& sigma) {
    return sigma.array().square().inverse().matrix().asDiagonal();
}

GaussianPrior::GaussianPrior(const Eigen::MatrixXd& information, const std::vector<int>& sizes)
    : root_(whitening(information).value()) {
    *mutable_parameter_block_sizes() = sizes;
    set_num_residuals(static_cast<int>(root_.rows()));
}

bool GaussianPrior::Evaluate(double const* const* values,
                             double* residuals,
                             double** slopes) const {
    Eigen::Map<Eigen::VectorXd> all(residuals, root_.rows());
    all.setZero();
    Eigen::Index from = 0;
    for (std::size_t block = 0; block < parameter_block_sizes().size(); ++block) {
        const Eigen::Index size = parameter_block_sizes()[block];
        const auto part = root_.middleCols(from, size);
        all += part * Eigen::Map<const Eigen::VectorXd>(values[block], size);
        if (slopes && slopes[block])
            for (Eigen::Index row = 0; row < part.rows(); ++row)
                for (Eigen::Index column = 0; column < size; ++column)
                    slopes[block][row * size + column] = part(row, column);
        from += size;
    }
    return true;
}

Eigen::MatrixXd known_before(const LensPrior& prior,
                             const View& projector,
                             const View& camera,
                             double distance_mm,
                             std::size_t k) {
    if (!prior.boards.empty())
        return with_slack(
            Eigen::Map<const PairMatrix>(prior.boards[std::min(k, prior.boards.size() - 1)].data()),
            projector,
            camera,
            distance_mm);
    Eigen::VectorXd sigma(kPairTerms);
    const auto lens = [&](Eigen::Index first, const View& view) {
        const double principal = prior.principal * view.width;
        sigma.segment(first, kLensTerms) << prior.focal, principal, principal, prior.distortion,
            prior.distortion, prior.tangential, prior.tangential, prior.distortion;
    };
    lens(0, projector);
    lens(kLensTerms, camera);
    sigma.tail(kPoseTerms).head(3).setConstant(prior.turn_rad);
    sigma.tail(kPoseTerms).tail(3).setConstant(prior.shift * distance_mm);
    return independent(sigma);
}

bool is_information(const PairInformation& values) {
    return whitening(Eigen::Map<const PairMatrix>(values.data())).has_value();
}

}  // namespace livery
