#include "calibration/registration/picked_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include "calibration/registration/rotation.h"
#include "core/error.h"
#include "core/solve.h"
#include "core/worst_error.h"

namespace livery {

namespace {

/// How well somebody clicks, when the points are too few to tell.
constexpr double kClickSigma_px = 1.0;

/// Of the picture's width: what points may be off a pose.
constexpr double kLargestShare = 0.01;

Rigid3 pose_of(const double* six) {
    return {rotation_of({six[0], six[1], six[2]}), {six[3], six[4], six[5]}};
}

struct ClickError {
    const View* lens = nullptr;
    glm::dmat3 turned{1.0};  ///< the start, so that the vector that is sought stays short
    glm::dvec3 mesh_mm{0.0};
    glm::dvec2 pixel{0.0};

    bool operator()(const double* six, double* residual) const {
        View view = *lens;
        view.view_from_world = pose_of(six);
        view.view_from_world.rotation = view.view_from_world.rotation * turned;
        const auto place = project(view, mesh_mm);
        if (!place) return false;
        residual[0] = place->x - pixel.x;
        residual[1] = place->y - pixel.y;
        return true;
    }
};

struct Fit {
    Rigid3 view_from_mesh;
    double squares = 1e300;
    std::array<double, 36> covariance{};
};

/// 24 turns of a cube, and these turned by 45 degrees about a diagonal.
std::vector<glm::dmat3> starting_turns() {
    std::vector<glm::dmat3> turns;
    const glm::dvec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const glm::dmat3 tilted =
        rotation_of(glm::normalize(glm::dvec3(1, 1, 1)) * (0.25 * std::numbers::pi));
    for (int x = 0; x < 3; ++x)
        for (int z = 0; z < 3; ++z) {
            if (x == z) continue;
            for (const double a : {1.0, -1.0})
                for (const double c : {1.0, -1.0}) {
                    const glm::dvec3 first = a * axes[x], third = c * axes[z];
                    const glm::dmat3 turn(first, glm::cross(third, first), third);
                    turns.push_back(turn);
                    turns.push_back(tilted * turn);
                }
        }
    return turns;
}

std::optional<Fit> fitted(const View& lens,
                          std::span<const MeshPick> points,
                          const std::vector<std::size_t>& used,
                          const glm::dmat3& start,
                          bool with_covariance,
                          const Progress& progress) {
    const auto count = static_cast<double>(used.size());
    glm::dvec3 middle(0.0);
    glm::dvec2 middle_px(0.0);
    for (const std::size_t k : used) {
        middle += points[k].mesh_mm / count;
        middle_px += points[k].pixel / count;
    }
    double spread = 0.0, spread_px = 0.0, farthest = 0.0;
    for (const std::size_t k : used) {
        const glm::dvec3 apart = points[k].mesh_mm - middle;
        spread += glm::dot(apart, apart) / 3.0;
        farthest = std::max(farthest, glm::length(apart));
        const glm::dvec2 apart_px = (points[k].pixel - middle_px) / lens.focal_px;
        spread_px += glm::dot(apart_px, apart_px) / 2.0;
    }
    View view = lens;
    view.view_from_world = {};
    const glm::dvec3 toward = ray_through(view, middle_px).direction;
    const double depth = std::max(std::sqrt(spread / spread_px), 1.5 * farthest);
    const glm::dvec3 shift = toward * depth - start * middle;
    double six[6] = {0.0, 0.0, 0.0, shift.x, shift.y, shift.z};
    ceres::Problem problem;
    for (const std::size_t k : used)
        problem.AddResidualBlock(
            new ceres::NumericDiffCostFunction<ClickError, ceres::CENTRAL, 2, 6>(
                new ClickError{&lens, start, points[k].mesh_mm, points[k].pixel}),
            nullptr,
            six);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 60;
    options.logging_type = ceres::SILENT;
    const ceres::Solver::Summary summary = solved(options, problem, progress);
    if (!summary.IsSolutionUsable()) return std::nullopt;
    Fit fit;
    fit.view_from_mesh = pose_of(six);
    fit.view_from_mesh.rotation = fit.view_from_mesh.rotation * start;
    fit.squares = 2.0 * summary.final_cost;
    if (with_covariance) {
        ceres::Covariance::Options how;
        how.algorithm_type = ceres::DENSE_SVD;
        how.null_space_rank = -1;
        ceres::Covariance covariance(how);
        const std::pair<const double*, const double*> block(six, six);
        if (!covariance.Compute({block}, &problem)) return std::nullopt;
        covariance.GetCovarianceBlock(six, six, fit.covariance.data());
    }
    return fit;
}

/// Every pose that is a minimum, the best first.
std::vector<Fit> minima(const View& lens,
                        std::span<const MeshPick> points,
                        const std::vector<std::size_t>& used,
                        const Progress& progress) {
    std::vector<Fit> all;
    for (const glm::dmat3& start : starting_turns())
        if (const auto fit = fitted(lens, points, used, start, false, progress))
            all.push_back(*fit);
    std::sort(
        all.begin(), all.end(), [](const Fit& a, const Fit& b) { return a.squares < b.squares; });
    std::vector<Fit> distinct;
    for (const Fit& one : all) {
        const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const Fit& other) {
            return angle_of(glm::transpose(one.view_from_mesh.rotation) *
                            other.view_from_mesh.rotation) < 0.09;
        });
        if (!known) distinct.push_back(one);
    }
    return distinct;
}

/// Root mean square residual of a coordinate, the six sought numbers counted.
double deviation(double squares, std::size_t points) {
    return std::sqrt(squares / (2.0 * static_cast<double>(points) - 6.0));
}

glm::dvec3 spreads(std::span<const MeshPick> points, const std::vector<std::size_t>& used) {
    glm::dvec3 middle(0.0);
    for (const std::size_t k : used) middle += points[k].mesh_mm / static_cast<double>(used.size());
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const std::size_t k : used) {
        const glm::dvec3 apart = points[k].mesh_mm - middle;
        const Eigen::Vector3d row(apart.x, apart.y, apart.z);
        sum += row * row.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum);
    const Eigen::Vector3d squares = solver.eigenvalues().cwiseMax(0.0);
    return {std::sqrt(squares[2]), std::sqrt(squares[1]), std::sqrt(squares[0])};
}

/// The points without those picked twice. Throws Refused.
std::vector<std::size_t> distinct_points(std::span<const MeshPick> points, const Bounds& mesh_mm) {
    const double near = 1e-3 * glm::length(mesh_mm.high - mesh_mm.low);
    std::vector<std::size_t> used;
    std::vector<std::string> doubled;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const bool again = std::any_of(used.begin(), used.end(), [&](std::size_t other) {
            return glm::length(points[other].mesh_mm - points[k].mesh_mm) < near;
        });
        if (again) {
            doubled.push_back(points[k].name);
        } else {
            used.push_back(k);
        }
    }
    if (used.size() < kLeastPoints)
        throw Refused(fmt::format("{} distinct points{}",
                                  used.size(),
                                  doubled.empty() ? std::string()
                                                  : fmt::format(" ({} picked again)",
                                                                fmt::join(doubled, ", "))),
                      fmt::format("pick {} or more, spread over the mock-up", kLeastPoints));
    const glm::dvec3 spread = spreads(points, used);
    if (spread.y < 0.05 * spread.x)
        throw Refused("the points lie on a line: the mock-up could turn about it",
                      "pick points beside it too");
    return used;
}

std::vector<std::size_t> without(std::vector<std::size_t> used, std::size_t one) {
    used.erase(std::find(used.begin(), used.end(), one));
    return used;
}

double distance_px(const View& lens, const Rigid3& view_from_mesh, const MeshPick& point) {
    View view = lens;
    view.view_from_world = view_from_mesh;
    const auto place = project(view, point.mesh_mm);
    return place ? glm::length(*place - point.pixel) : 1e9;
}

/// The point without which the others agree, if there is one.
std::optional<std::size_t> bad_click(const View& lens,
                                     std::span<const MeshPick> points,
                                     const std::vector<std::size_t>& used,
                                     double all_deviation,
                                     const Progress& progress) {
    std::optional<std::size_t> bad;
    double best = 0.35 * all_deviation;
    for (const std::size_t k : used) {
        const auto rest = without(used, k);
        const std::vector<Fit> fits = minima(lens, points, rest, progress);
        if (fits.empty()) continue;
        const double alone = deviation(fits[0].squares, rest.size());
        const double off = distance_px(lens, fits[0].view_from_mesh, points[k]);
        if (alone >= best || off < std::max(6.0 * alone, 4.0 * kClickSigma_px)) continue;
        best = alone;
        bad = k;
    }
    return bad;
}

using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

/// What was sought turns about the product's origin: x = turn (start m) + t. As it is documented,
/// both are applied after the pose, to what has turned and moved: t's change less that by the turn.
std::array<double, 36> applied_after(const Fit& fit, double sigma_px) {
    Matrix6 change = Matrix6::Identity();
    const glm::dvec3 t = fit.view_from_mesh.translation;
    // t x w
    change(3, 1) = -t.z;
    change(3, 2) = t.y;
    change(4, 0) = t.z;
    change(4, 2) = -t.x;
    change(5, 0) = -t.y;
    change(5, 1) = t.x;
    const Eigen::Map<const Matrix6> sought(fit.covariance.data());
    std::array<double, 36> covariance{};
    Eigen::Map<Matrix6>(covariance.data()) =
        sigma_px * sigma_px * (change * sought * change.transpose());
    return covariance;
}

}  // namespace

double held_px(const View& lens,
               const Rigid3& view_from_picked,
               const PickedPose& pose,
               const Bounds& mesh_mm) {
    View view = lens;
    view.view_from_world = view_from_picked;
    const Eigen::Map<const Matrix6> covariance(pose.covariance.data());
    double largest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 place((corner & 1) ? mesh_mm.high.x : mesh_mm.low.x,
                               (corner & 2) ? mesh_mm.high.y : mesh_mm.low.y,
                               (corner & 4) ? mesh_mm.high.z : mesh_mm.low.z);
        const glm::dvec3 seen = pose.view_from_mesh * place;
        Eigen::Matrix<double, 2, 6> slope;
        for (int k = 0; k < 6; ++k) {
            const double step = k < 3 ? 1e-6 : 1e-4;
            const auto moved = [&](double by) {
                double six[6] = {};
                six[k] = by;
                return project(view, pose_of(six) * seen);
            };
            const auto ahead = moved(step), behind = moved(-step);
            if (!ahead || !behind) return std::numeric_limits<double>::infinity();
            for (int c = 0; c < 2; ++c) slope(c, k) = ((*ahead)[c] - (*behind)[c]) / (2.0 * step);
        }
        const Eigen::Matrix2d spread = slope * covariance * slope.transpose();
        largest = worse_of(largest, std::sqrt(worse_of(0.0, spread.trace())));
    }
    return largest;
}

PickedPose pose_from_points(const View& lens,
                            std::span<const MeshPick> points,
                            const Bounds& mesh_mm,
                            const Progress& progress) {
    PickedPose result;
    std::vector<std::size_t> used = distinct_points(points, mesh_mm);
    const double largest_px = kLargestShare * lens.width;
    std::vector<Fit> fits = minima(lens, points, used, progress);
    if (!fits.empty()) {
        const double all = deviation(fits[0].squares, used.size());
        if (all > 0.5 * kClickSigma_px) result.bad = bad_click(lens, points, used, all, progress);
        if (result.bad) {
            used = without(used, *result.bad);
            fits = minima(lens, points, used, progress);
        }
    }
    if (fits.empty())
        throw Refused("no pose puts the points where they were picked",
                      "check that each line has the mesh's point and its own pixel");
    const double sigma = deviation(fits[0].squares, used.size());
    if (!(sigma <= largest_px)) {
        const auto worst = *std::max_element(used.begin(), used.end(), [&](auto a, auto b) {
            return distance_px(lens, fits[0].view_from_mesh, points[a]) <
                   distance_px(lens, fits[0].view_from_mesh, points[b]);
        });
        throw Refused(
            fmt::format("the points agree with no pose: {:.1f} px apart, {} the most",
                        sigma,
                        points[worst].name),
            "pick again where more than one is wrong; check the mesh's scale and that the pixels "
            "are of this view");
    }
    const double sigma_px = std::max(sigma, kClickSigma_px);
    if (fits.size() > 1 && deviation(fits[1].squares, used.size()) < 1.5 * sigma + 0.5)
        throw Refused(fmt::format("two poses fit the points alike, {:.0f} degrees apart",
                                  angle_of(glm::transpose(fits[0].view_from_mesh.rotation) *
                                           fits[1].view_from_mesh.rotation) *
                                      180.0 / std::numbers::pi),
                      "pick points farther apart and at different depths, not all on one face");
    const auto fit = fitted(lens, points, used, fits[0].view_from_mesh.rotation, true, progress);
    if (!fit) throw Refused("the points do not hold the pose", "pick points farther apart");
    result.view_from_mesh = fit->view_from_mesh;
    if (result.bad) result.bad_px = distance_px(lens, result.view_from_mesh, points[*result.bad]);
    result.covariance = applied_after(*fit, sigma_px);
    const double held = held_px(lens, Rigid3{}, result, mesh_mm);
    if (held > largest_px)
        throw Refused(
            fmt::format("the points hold the mock-up only to {:.0f} px: they lie too near to one "
                        "another or to one plane",
                        held),
            "pick points farther apart and at different depths");
    double squares = 0.0, squares_mm = 0.0;
    for (const std::size_t k : used) {
        const double off = distance_px(lens, result.view_from_mesh, points[k]);
        const double depth = (result.view_from_mesh * points[k].mesh_mm).z;
        squares += off * off;
        squares_mm += std::pow(off * depth / lens.focal_px.x, 2.0);
    }
    const auto count = static_cast<double>(used.size());
    result.rms_px = std::sqrt(squares / count);
    result.rms_mm = std::sqrt(squares_mm / count);
    result.inliers = used;
    return result;
}

}  // namespace livery
