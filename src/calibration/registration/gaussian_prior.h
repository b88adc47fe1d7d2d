// What is known before a registration, as residuals of a least squares (Ceres).
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Dense>
#include <ceres/ceres.h>

#include "calibration/registration/pixel_refinement.h"

namespace livery {

/// What is known of some parameter blocks together: a Gaussian about 0 with that inverse
/// covariance, its residuals independent and of unit variance. Throws std::bad_optional_access for
/// a matrix that is none.
class GaussianPrior final : public ceres::CostFunction {
  public:
    GaussianPrior(const Eigen::MatrixXd& information, const std::vector<int>& sizes);
    bool Evaluate(double const* const* values, double* residuals, double** slopes) const override;

  private:
    Eigen::MatrixXd root_;
};

/// The inverse of an inverse covariance.
Eigen::MatrixXd covariance_from(const Eigen::MatrixXd& information);

/// Information about independent terms, by their standard deviations.
Eigen::MatrixXd independent(const Eigen::VectorXd& sigma);

/// Information (geometry/solve_pair.h) about everything but the mock-up's pose and scale, before
/// the photographs of it: both lenses and where the k-th camera stands against the projector.
Eigen::MatrixXd known_before(const LensPrior& prior,
                             const View& projector,
                             const View& camera,
                             double distance_mm,
                             std::size_t k);

}  // namespace livery
