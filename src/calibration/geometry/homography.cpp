#include "calibration/geometry/homography.h"

#include <algorithm>
#include <cmath>

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

namespace {

using Homography = Eigen::Matrix<double, 8, 1>;  ///< row by row, the last is 1

struct DecodedPlace {
    glm::dvec2 offset;  ///< from the corner, in radii
    glm::dvec2 lit;     ///< from the first guess, projector pixels
};

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double distance_px(const Homography& h, const DecodedPlace& one) {
    const double w = h[6] * one.offset.x + h[7] * one.offset.y + 1.0;
    const double u = (h[0] * one.offset.x + h[1] * one.offset.y + h[2]) / w;
    const double v = (h[3] * one.offset.x + h[4] * one.offset.y + h[5]) / w;
    return std::hypot(u - one.lit.x, v - one.lit.y);
}

template <typename Weight>
Homography fitted(const std::vector<DecodedPlace>& samples,
                  const Homography& before,
                  Weight&& weight) {
    Eigen::Matrix<double, 8, 8> normal = Eigen::Matrix<double, 8, 8>::Zero();
    Homography right = Homography::Zero();
    for (const DecodedPlace& one : samples) {
        const double w = weight(distance_px(before, one));
        const glm::dvec2 x = one.offset;
        Homography row;
        row << x.x, x.y, 1.0, 0.0, 0.0, 0.0, -one.lit.x * x.x, -one.lit.x * x.y;
        normal += w * row * row.transpose();
        right += w * one.lit.x * row;
        row << 0.0, 0.0, 0.0, x.x, x.y, 1.0, -one.lit.y * x.x, -one.lit.y * x.y;
        normal += w * row * row.transpose();
        right += w * one.lit.y * row;
    }
    return normal.ldlt().solve(right);
}

std::optional<glm::dvec2> carried(const ImageF& projector_px, glm::dvec2 corner, double radius) {
    std::vector<DecodedPlace> samples;
    std::vector<double> columns, rows;
    std::size_t around = 0;
    for (int y = static_cast<int>(corner.y - radius); y <= static_cast<int>(corner.y + radius); ++y)
        for (int x = static_cast<int>(corner.x - radius); x <= static_cast<int>(corner.x + radius);
             ++x) {
            const glm::dvec2 offset = (glm::dvec2(x + 0.5, y + 0.5) - corner) / radius;
            if (offset.x * offset.x + offset.y * offset.y > 1.0) continue;
            ++around;
            if (x < 0 || y < 0 || x >= projector_px.width || y >= projector_px.height) continue;
            const float* lit = projector_px.pixel(x, y);
            if (!std::isfinite(lit[0]) || !std::isfinite(lit[1])) continue;
            samples.push_back({offset, {lit[0], lit[1]}});
            columns.push_back(lit[0]);
            rows.push_back(lit[1]);
        }
    if (samples.size() < 50 || 4 * samples.size() < around) return std::nullopt;
    const glm::dvec2 guess(median(columns), median(rows));
    for (DecodedPlace& one : samples) one.lit -= guess;
    // Least absolute distance first: it bears gross errors from any start; then what lies within
    // a pixel and a half (steps of whole projector pixels lie within .71) counts, and nothing else.
    Homography h = Homography::Zero();
    for (int k = 0; k < 12; ++k)
        h = fitted(samples, h, [](double r) { return 1.0 / std::max(r, 0.3); });
    constexpr double kReach_px = 1.5;
    for (int k = 0; k < 6; ++k)
        h = fitted(samples, h, [](double r) {
            const double left = std::max(0.0, 1.0 - (r / kReach_px) * (r / kReach_px));
            return left * left;
        });
    if (!h.allFinite()) return std::nullopt;
    const auto agree = std::count_if(samples.begin(), samples.end(), [&](const DecodedPlace& one) {
        return distance_px(h, one) < kReach_px;
    });
    if (4 * static_cast<std::size_t>(agree) < around) return std::nullopt;
    return guess + glm::dvec2(h[2], h[5]);
}

}  // namespace

std::vector<std::optional<glm::dvec2>> carry_corners(const ImageF& projector_px,
                                                     std::span<const glm::dvec2> corners_px,
                                                     double radius_px) {
    check_argument(projector_px.channels == 2, "projector_px needs 2 channels");
    check_argument(radius_px >= 4.0 && radius_px < 1e4, "radius_px must be 4 or more");
    std::vector<std::optional<glm::dvec2>> all;
    for (const glm::dvec2& corner : corners_px) {
        const bool inside = corner.x >= 0.0 && corner.y >= 0.0 && corner.x < projector_px.width &&
                            corner.y < projector_px.height;
        all.push_back(inside ? carried(projector_px, corner, radius_px) : std::nullopt);
    }
    return all;
}

}  // namespace livery
