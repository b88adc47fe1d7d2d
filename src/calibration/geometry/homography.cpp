#include "calibration/geometry/homography.h"

#include <algorithm>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "core/error.h"

namespace livery {

namespace {

Eigen::Matrix3d normaliser_of(std::span<const glm::dvec2> points) {
    glm::dvec2 middle(0.0);
    double spread = 0.0;
    for (const auto& p : points) middle += p / static_cast<double>(points.size());
    for (const auto& p : points) spread += glm::length(p - middle);
    const double s = static_cast<double>(points.size()) / std::max(spread, 1e-9);
    Eigen::Matrix3d m;
    m << s, 0.0, -s * middle.x, 0.0, s, -s * middle.y, 0.0, 0.0, 1.0;
    return m;
}

}  // namespace

glm::dmat3 homography_of(std::span<const glm::dvec2> from, std::span<const glm::dvec2> to) {
    check_argument(from.size() >= 4 && from.size() == to.size(),
                   "a homography takes four points or more in both planes");
    const Eigen::Matrix3d a = normaliser_of(from), b = normaliser_of(to);
    Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
    for (std::size_t k = 0; k < from.size(); ++k) {
        const Eigen::Vector3d x = a * Eigen::Vector3d(from[k].x, from[k].y, 1.0);
        const Eigen::Vector3d u = b * Eigen::Vector3d(to[k].x, to[k].y, 1.0);
        for (int c = 0; c < 2; ++c) {
            Eigen::Matrix<double, 9, 1> row = Eigen::Matrix<double, 9, 1>::Zero();
            row.segment<3>(3 * c) = x;
            row.segment<3>(6) = -u[c] * x;
            normal += row * row.transpose();
        }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(normal);
    Eigen::Matrix3d h;
    for (int r = 0; r < 3; ++r) h.row(r) = solver.eigenvectors().col(0).segment<3>(3 * r);
    h = b.inverse() * h * a;
    glm::dmat3 result;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) result[column][row] = h(row, column);
    return result;
}

}  // namespace livery
