#include "calibration/registration/pair_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <ceres/ceres.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/registration/rotation.h"
#include "core/error.h"
#include "core/random.h"
#include "core/solve.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr std::size_t kWanted = 3000, kLeast = 500;
constexpr int kPoseSamples = 800;
constexpr double kOnePlane = 4.0;  ///< as well as the pose does: within so many times its error

/// The same place in both pictures, lens distortion undone: x / z, y / z.
struct Sighting {
    Eigen::Vector3d camera, projector;
};

Eigen::Vector3d normalised(const View& lens, const glm::dvec2& pixel) {
    View alone = lens;
    alone.view_from_world = Rigid3{};
    const glm::dvec3 direction = ray_through(alone, pixel).direction;
    return {direction.x / direction.z, direction.y / direction.z, 1.0};
}

std::vector<Sighting> sightings_of(const View& camera,
                                   const View& projector,
                                   const ProjectorToCamera& map) {
    const ImageF& place = map.camera_px;
    check_argument(place.width == projector.width && place.height == projector.height,
                   "pose_of_pair: a map of another size than the projector's");
    std::vector<std::size_t> known;
    for (std::size_t i = 0; i < place.pixel_count(); ++i) {
        if (!std::isfinite(place.values[2 * i])) continue;
        if (!map.edge.empty() && map.edge.values[i]) continue;
        known.push_back(i);
    }
    if (known.size() < kLeast)
        throw Refused(
            fmt::format("the camera sees only {} of the projector's pixels", known.size()),
            "aim both at the mock-up and its table, and darken the room");
    std::vector<Sighting> result;
    const auto width = static_cast<std::size_t>(place.width);
    // A step that shares no factor with the width, so that no column is preferred.
    std::size_t step = std::max<std::size_t>(1, known.size() / kWanted);
    for (std::size_t k = step / 2; k < known.size(); k += step) {
        const std::size_t i = known[k];
        const glm::dvec2 at(static_cast<double>(i % width) + 0.5,
                            static_cast<double>(i / width) + 0.5);
        const glm::dvec2 seen(place.values[2 * i], place.values[2 * i + 1]);
        result.push_back({normalised(camera, seen), normalised(projector, at)});
    }
    return result;
}

/// First order distance of a sighting from E, in the camera's normalised plane (Sampson 1982); the
/// projector's picture counts as the camera's.
double sampson(const Eigen::Matrix3d& e, const Sighting& at) {
    const Eigen::Vector3d line_p = e * at.camera, line_c = e.transpose() * at.projector;
    const double gradient = line_p.head<2>().squaredNorm() + line_c.head<2>().squaredNorm();
    return gradient > 0.0 ? at.projector.dot(line_p) / std::sqrt(gradient) : 0.0;
}

/// Moves the points' middle to 0 and their mean distance to sqrt 2 (Hartley 1997).
Eigen::Matrix3d conditioning(const std::vector<Sighting>& all, Eigen::Vector3d Sighting::*side) {
    Eigen::Vector2d middle(0.0, 0.0);
    for (const Sighting& one : all) middle += (one.*side).head<2>();
    middle /= static_cast<double>(all.size());
    double spread = 0.0;
    for (const Sighting& one : all) spread += ((one.*side).head<2>() - middle).norm();
    const double scale = std::sqrt(2.0) * static_cast<double>(all.size()) / spread;
    Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
    result.diagonal() << scale, scale, 1.0;
    result.col(2).head<2>() = -scale * middle;
    return result;
}

/// The matrix whose nine numbers, row by row, a sum of squares makes smallest.
Eigen::Matrix3d null_matrix(const Eigen::Matrix<double, 9, 9>& sums) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(sums);
    Eigen::Matrix3d matrix;
    for (int r = 0; r < 3; ++r) matrix.row(r) = solver.eigenvectors().col(0).segment<3>(3 * r);
    return matrix;
}

/// From eight or more: the null vector, with two equal singular values and a zero.
Eigen::Matrix3d essential_of(const std::vector<Sighting>& all,
                             const std::vector<std::size_t>& chosen,
                             const Eigen::Matrix3d& to_c,
                             const Eigen::Matrix3d& to_p) {
    Eigen::Matrix<double, 9, 9> sums = Eigen::Matrix<double, 9, 9>::Zero();
    for (const std::size_t k : chosen) {
        const Eigen::Vector3d c = to_c * all[k].camera, p = to_p * all[k].projector;
        Eigen::Matrix<double, 9, 1> row;
        row << p.x() * c, p.y() * c, p.z() * c;
        sums += row * row.transpose();
    }
    const Eigen::Matrix3d matrix = to_p.transpose() * null_matrix(sums) * to_c;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Vector3d two(1.0, 1.0, 0.0);
    return svd.matrixU() * two.asDiagonal() * svd.matrixV().transpose();
}

double median_distance(const Eigen::Matrix3d& e, const std::vector<Sighting>& all) {
    std::vector<double> distances;
    distances.reserve(all.size());
    for (const Sighting& one : all) distances.push_back(std::abs(sampson(e, one)));
    return median(distances);
}

struct TurnAndShift {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    Eigen::Vector3d shift = Eigen::Vector3d::UnitX();  ///< unit
};

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
    Eigen::Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

/// Sightings whose rays meet in front of both.
std::size_t count_in_front(const TurnAndShift& pose, const std::vector<Sighting>& all) {
    std::size_t count = 0;
    for (const Sighting& one : all) {
        // z_p p = z_c R c + t, for both depths, least squares
        Eigen::Matrix<double, 3, 2> rays;
        rays << pose.turn * one.camera, -one.projector;
        const Eigen::Vector2d depth =
            (rays.transpose() * rays).ldlt().solve(rays.transpose() * -pose.shift);
        count += depth.x() > 0.0 && depth.y() > 0.0;
    }
    return count;
}

/// The one of the four poses of an essential matrix that has everything in front.
TurnAndShift pose_in_front(const Eigen::Matrix3d& e, const std::vector<Sighting>& all) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(e, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d u = svd.matrixU(), v = svd.matrixV();
    if (u.determinant() < 0.0) u.col(2) *= -1.0;
    if (v.determinant() < 0.0) v.col(2) *= -1.0;
    Eigen::Matrix3d quarter;
    quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    TurnAndShift best;
    std::size_t most = 0;
    for (const Eigen::Matrix3d& turn : {Eigen::Matrix3d(u * quarter * v.transpose()),
                                        Eigen::Matrix3d(u * quarter.transpose() * v.transpose())}) {
        for (const double sign : {1.0, -1.0}) {
            const TurnAndShift pose{turn, sign * u.col(2)};
            const std::size_t count = count_in_front(pose, all);
            if (count <= most) continue;
            most = count;
            best = pose;
        }
    }
    return best;
}

/// Turned by three, the shift tilted by two; both small.
TurnAndShift changed(const double* turn, const double* tilt, const TurnAndShift& pose) {
    const glm::dmat3 r = rotation_of({turn[0], turn[1], turn[2]});
    TurnAndShift result;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) result.turn(row, column) = r[column][row];
    result.turn *= pose.turn;
    const Eigen::Vector3d across =
        pose.shift
            .cross(std::abs(pose.shift.x()) < 0.9 ? Eigen::Vector3d::UnitX()
                                                  : Eigen::Vector3d::UnitY())
            .normalized();
    result.shift =
        (pose.shift + tilt[0] * across + tilt[1] * pose.shift.cross(across)).normalized();
    return result;
}

Eigen::Matrix3d essential_of(const TurnAndShift& pose) { return cross(pose.shift) * pose.turn; }

struct EpipolarError {
    const TurnAndShift* start;
    const Sighting* at;
    double sigma;
    bool operator()(const double* turn, const double* tilt, double* residual) const {
        residual[0] = sampson(essential_of(changed(turn, tilt, *start)), *at) / sigma;
        return true;
    }
};

/// Least squares, its standard deviations in `result`.
TurnAndShift refined(const TurnAndShift& start,
                     const std::vector<Sighting>& all,
                     PairPose& result,
                     const Progress& progress) {
    std::array<double, 3> turn{};
    std::array<double, 2> tilt{};
    const double sigma = 1.4826 * std::max(1e-9, median_distance(essential_of(start), all));
    ceres::Problem problem;
    for (const Sighting& one : all)
        problem.AddResidualBlock(
            new ceres::NumericDiffCostFunction<EpipolarError, ceres::CENTRAL, 1, 3, 2>(
                new EpipolarError{&start, &one, sigma}),
            new ceres::CauchyLoss(2.0),
            turn.data(),
            tilt.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    solved(options, problem, progress);

    ceres::Covariance::Options how;
    how.algorithm_type = ceres::DENSE_SVD;
    how.null_space_rank = 0;
    ceres::Covariance covariance(how);
    const double* const blocks[] = {turn.data(), tilt.data()};
    std::array<double, 9> of_turn{};
    std::array<double, 4> of_tilt{};
    if (!covariance.Compute({{blocks[0], blocks[0]}, {blocks[1], blocks[1]}}, &problem))
        throw Refused("everything that the camera sees lies on one plane",
                      "light the mock-up and what it stands on together");
    covariance.GetCovarianceBlock(blocks[0], blocks[0], of_turn.data());
    covariance.GetCovarianceBlock(blocks[1], blocks[1], of_tilt.data());
    result.turn_sigma_rad = std::sqrt(of_turn[0] + of_turn[4] + of_turn[8]);
    result.shift_sigma_rad = std::sqrt(of_tilt[0] + of_tilt[3]);
    return changed(turn.data(), tilt.data(), start);
}

/// From four or more: the null vector.
Eigen::Matrix3d homography_of(const std::vector<Sighting>& all,
                              const std::vector<std::size_t>& chosen,
                              const Eigen::Matrix3d& to_c,
                              const Eigen::Matrix3d& to_p) {
    Eigen::Matrix<double, 9, 9> sums = Eigen::Matrix<double, 9, 9>::Zero();
    for (const std::size_t k : chosen) {
        const Eigen::Vector3d c = to_c * all[k].camera, p = to_p * all[k].projector;
        Eigen::Matrix<double, 2, 9> rows = Eigen::Matrix<double, 2, 9>::Zero();
        rows.block<1, 3>(0, 0) = p.z() * c.transpose();
        rows.block<1, 3>(0, 6) = -p.x() * c.transpose();
        rows.block<1, 3>(1, 3) = p.z() * c.transpose();
        rows.block<1, 3>(1, 6) = -p.y() * c.transpose();
        sums += rows.transpose() * rows;
    }
    return to_p.inverse() * null_matrix(sums) * to_c;
}

/// Whether one homography explains nearly all sightings as well as the pose does: then nothing but
/// a plane was seen, to which two poses fit (Longuet-Higgins 1986).
bool lies_on_a_plane(const std::vector<Sighting>& all,
                     const Eigen::Matrix3d& e,
                     const Eigen::Matrix3d& to_c,
                     const Eigen::Matrix3d& to_p,
                     Random& random) {
    std::vector<double> off_pose;
    for (const Sighting& one : all) off_pose.push_back(std::abs(sampson(e, one)));
    const double allowed = kOnePlane * quantile(std::move(off_pose), 0.9);
    for (int k = 0; k < kPoseSamples / 8; ++k) {
        std::vector<std::size_t> chosen(24);
        for (std::size_t& one : chosen) one = random.below(static_cast<std::uint32_t>(all.size()));
        const Eigen::Matrix3d h = homography_of(all, chosen, to_c, to_p);
        std::vector<double> off;
        for (const Sighting& one : all) {
            const Eigen::Vector3d p = h * one.camera;
            off.push_back((p.head<2>() / p.z() - one.projector.head<2>()).norm());
        }
        if (quantile(std::move(off), 0.9) < allowed) return true;
    }
    return false;
}

}  // namespace

PairPose pose_of_pair(const View& camera,
                      const View& projector,
                      const ProjectorToCamera& map,
                      double distance_mm,
                      std::uint64_t seed,
                      const Progress& progress) {
    check_argument(std::isfinite(distance_mm) && distance_mm > 0.0,
                   fmt::format("pose_of_pair: lenses {} mm apart", distance_mm));
    progress.update(0.0, "finding how camera and projector stand to each other");
    const std::vector<Sighting> all = sightings_of(camera, projector, map);

    // Random samples; the smallest median counts (Rousseeuw 1984).
    const Eigen::Matrix3d to_c = conditioning(all, &Sighting::camera);
    const Eigen::Matrix3d to_p = conditioning(all, &Sighting::projector);
    Random random(seed, 20);
    Eigen::Matrix3d best = Eigen::Matrix3d::Zero();
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < kPoseSamples; ++k) {
        progress.check_stop();
        // More than eight: noise matters more than outliers do.
        std::vector<std::size_t> chosen(24);
        for (std::size_t& one : chosen) one = random.below(static_cast<std::uint32_t>(all.size()));
        const Eigen::Matrix3d e = essential_of(all, chosen, to_c, to_p);
        const double middle = median_distance(e, all);
        if (middle < least) {
            least = middle;
            best = e;
        }
    }

    PairPose result;
    TurnAndShift pose = refined(pose_in_front(best, all), all, result, progress);
    pose = refined(pose, all, result, progress);
    const Eigen::Matrix3d e = essential_of(pose);
    const double off = median_distance(e, all);
    result.median_px = off * camera.focal_px.x;
    if (lies_on_a_plane(all, e, to_c, to_p, random))
        throw Refused("everything that the camera sees lies on one plane, to which two poses fit",
                      "light the mock-up and what it stands on together");
    std::size_t inliers = 0;
    for (const Sighting& one : all) inliers += std::abs(sampson(e, one)) < 5.0 * 1.4826 * off;
    result.inlier_share = static_cast<double>(inliers) / static_cast<double>(all.size());
    const double in_front =
        static_cast<double>(count_in_front(pose, all)) / static_cast<double>(all.size());
    if (result.median_px > 0.01 * camera.width || in_front < 0.9)
        throw Refused(
            fmt::format("the camera's rays pass the projector's by {:.1f} camera pixels in the "
                        "median, and {:.0f}% of them meet in front of both",
                        result.median_px,
                        100.0 * in_front),
            "check the lens data of camera and projector, that neither moved, and that no picture "
            "is mirrored");
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            result.projector_from_camera.rotation[column][row] = pose.turn(row, column);
        result.projector_from_camera.translation[row] = distance_mm * pose.shift[row];
    }
    return result;
}

}  // namespace livery
