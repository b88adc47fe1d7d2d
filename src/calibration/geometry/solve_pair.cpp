#include "calibration/geometry/solve_pair.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Dense>
#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/geometry/homography.h"
#include "calibration/registration/rotation.h"
#include "core/error.h"
#include "core/solve.h"

namespace livery {

namespace {

constexpr double kHuber_px = 1.0;
constexpr double kLargestFocalError = 0.05;
constexpr double kLeastTilt_rad = 0.09;  ///< between two boards

/// fx, fy, cx, cy, k1, k2, p1, p2, k3.
using Lens = std::array<double, 9>;

/// A pose near `start`: a turn of the start, then a translation.
struct Pose {
    glm::dmat3 start{1.0};
    std::array<double, 6> six{};

    Rigid3 rigid(const double* values) const {
        return {rotation_of({values[0], values[1], values[2]}) * start,
                {values[3], values[4], values[5]}};
    }
    Rigid3 rigid() const { return rigid(six.data()); }
};

Pose pose_from(const Rigid3& rigid) {
    const glm::dvec3 t = rigid.translation;
    return {rigid.rotation, {0.0, 0.0, 0.0, t.x, t.y, t.z}};
}

View view_of(const double* lens, const PictureSize& size) {
    View view;
    view.width = size.width;
    view.height = size.height;
    view.focal_px = {lens[0], lens[1]};
    view.principal_px = {lens[2], lens[3]};
    std::copy(lens + 4, lens + 9, view.distortion.begin());
    return view;
}

struct PointError {
    PictureSize size;
    const Pose* board = nullptr;
    const Pose* stereo = nullptr;  ///< null: seen by the camera
    glm::dvec2 board_mm, pixel;

    bool operator()(const double* lens, const double* board_six, double* residual) const {
        return between(lens, board->rigid(board_six), residual);
    }
    bool operator()(const double* lens,
                    const double* board_six,
                    const double* stereo_six,
                    double* residual) const {
        return between(lens, stereo->rigid(stereo_six) * board->rigid(board_six), residual);
    }
    bool between(const double* lens, const Rigid3& view_from_board, double* residual) const {
        View view = view_of(lens, size);
        view.view_from_world = view_from_board;
        const auto place = project(view, glm::dvec3(board_mm, 0.0));
        if (!place) return false;
        residual[0] = place->x - pixel.x;
        residual[1] = place->y - pixel.y;
        return true;
    }
};

Eigen::Matrix3d homography(const std::vector<glm::dvec2>& from, const std::vector<glm::dvec2>& to) {
    const glm::dmat3 h = homography_of(from, to);
    Eigen::Matrix3d result;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) result(row, column) = h[column][row];
    return result;
}

/// Zhang's two equations a board for 1/f^2, the principal point known; nothing where they give no
/// focal length. (Z. Zhang: A flexible new technique for camera calibration, PAMI 2000.)
std::optional<double> focal_of(const std::vector<Eigen::Matrix3d>& homographies, glm::dvec2 c) {
    double up = 0.0, down = 0.0;
    Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
    shift(0, 2) = -c.x;
    shift(1, 2) = -c.y;
    for (const Eigen::Matrix3d& one : homographies) {
        Eigen::Matrix3d h = shift * one;
        h /= h.col(0).norm();
        const double cross = h(0, 0) * h(0, 1) + h(1, 0) * h(1, 1);
        const double apart = h.col(0).head<2>().squaredNorm() - h.col(1).head<2>().squaredNorm();
        const double right = h(2, 0) * h(2, 1);
        const double right_apart = h(2, 0) * h(2, 0) - h(2, 1) * h(2, 1);
        up -= cross * right + apart * right_apart;
        down += cross * cross + apart * apart;
    }
    if (!(up > 0.0) || !(down > 0.0)) return std::nullopt;
    return std::sqrt(down / up);
}

Rigid3 pose_of(const Eigen::Matrix3d& homography, double focal, glm::dvec2 c) {
    Eigen::Matrix3d k = Eigen::Matrix3d::Identity();
    k(0, 0) = k(1, 1) = focal;
    k(0, 2) = c.x;
    k(1, 2) = c.y;
    Eigen::Matrix3d m = k.inverse() * homography;
    m *= 2.0 / (m.col(0).norm() + m.col(1).norm());
    if (m(2, 2) < 0.0) m = -m;
    Eigen::Matrix3d r;
    r << m.col(0), m.col(1), m.col(0).cross(m.col(1));
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
    r = svd.matrixU() * svd.matrixV().transpose();
    Rigid3 pose;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) pose.rotation[column][row] = r(row, column);
    pose.translation = {m(0, 2), m(1, 2), m(2, 2)};
    return pose;
}

struct BoardsState {
    Lens camera{}, projector{};
    Pose stereo;
    std::vector<Pose> boards;
    double cost = 1e300;
};

void add_points(ceres::Problem& problem,
                const BoardSight& sight,
                PictureSize size,
                Lens& lens,
                Pose& board,
                Pose* stereo) {
    const auto& pixels = stereo != nullptr ? sight.projector_px : sight.camera_px;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
        auto* error = new PointError{size, &board, stereo, sight.board_mm[k], pixels[k]};
        auto* loss = new ceres::HuberLoss(kHuber_px);
        if (stereo != nullptr) {
            problem.AddResidualBlock(
                new ceres::NumericDiffCostFunction<PointError, ceres::CENTRAL, 2, 9, 6, 6>(error),
                loss,
                lens.data(),
                board.six.data(),
                stereo->six.data());
        } else {
            problem.AddResidualBlock(
                new ceres::NumericDiffCostFunction<PointError, ceres::CENTRAL, 2, 9, 6>(error),
                loss,
                lens.data(),
                board.six.data());
        }
    }
}

void build(ceres::Problem& problem,
           BoardsState& state,
           std::span<const BoardSight> sights,
           PictureSize camera,
           PictureSize projector) {
    for (std::size_t k = 0; k < sights.size(); ++k) {
        add_points(problem, sights[k], camera, state.camera, state.boards[k], nullptr);
        add_points(problem, sights[k], projector, state.projector, state.boards[k], &state.stereo);
    }
}

/// Residuals are pixels; `noise_px` is what one of them counts as one deviation.
void add_distortion_prior(ceres::Problem& problem, Lens& lens, double noise_px) {
    constexpr std::array<double, 5> kSigma = {0.5, 0.5, 0.003, 0.003, 0.5};  // k1 k2 p1 p2 k3
    ceres::Matrix weights = ceres::Matrix::Zero(5, 9);
    for (Eigen::Index k = 0; k < 5; ++k)
        weights(k, 4 + k) = noise_px / kSigma[static_cast<std::size_t>(k)];
    problem.AddResidualBlock(
        new ceres::NormalPrior(weights, ceres::Vector::Zero(9)), nullptr, lens.data());
}

/// For a start: k1 alone.
void hold_all_but_k1(ceres::Problem& problem, Lens& lens) {
    problem.SetManifold(lens.data(), new ceres::SubsetManifold(9, {5, 6, 7, 8}));
}

/// False where no usable step was found.
bool solve(ceres::Problem& problem, int iterations, const Progress& progress, double& cost) {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = iterations;
    options.function_tolerance = 1e-10;
    options.logging_type = ceres::SILENT;
    const ceres::Solver::Summary summary = solved(options, problem, progress);
    cost = summary.final_cost;
    return summary.IsSolutionUsable();
}

std::vector<BoardsState> starts(std::span<const BoardSight> sights,
                                PictureSize camera,
                                PictureSize projector) {
    std::vector<Eigen::Matrix3d> seen, lit;
    for (const BoardSight& sight : sights) {
        seen.push_back(homography(sight.board_mm, sight.camera_px));
        lit.push_back(homography(sight.board_mm, sight.projector_px));
    }
    const glm::dvec2 middle(0.5 * camera.width, 0.5 * camera.height);
    const double focal = focal_of(seen, middle).value_or(2.0 * camera.width);
    std::vector<BoardsState> all;
    for (const double share : {0.5, 1.0, 1.5, 0.0, -0.5}) {
        const glm::dvec2 c(0.5 * projector.width, share * projector.height);
        const double projector_focal = focal_of(lit, c).value_or(2.0 * projector.width);
        BoardsState state;
        state.camera = {focal, focal, middle.x, middle.y};
        state.projector = {projector_focal, projector_focal, c.x, c.y};
        for (const Eigen::Matrix3d& one : seen)
            state.boards.push_back(pose_from(pose_of(one, focal, middle)));
        state.stereo =
            pose_from(pose_of(lit[0], projector_focal, c) * inverse(state.boards[0].rigid()));
        all.push_back(state);
    }
    return all;
}

Lens lens_of(const View& view) {
    Lens lens{view.focal_px.x, view.focal_px.y, view.principal_px.x, view.principal_px.y};
    std::copy(view.distortion.begin(), view.distortion.end(), lens.begin() + 4);
    return lens;
}

BoardsState state_of(const PairSolution& solution) {
    BoardsState state;
    state.camera = lens_of(solution.camera);
    state.projector = lens_of(solution.projector);
    state.stereo = pose_from(solution.projector.view_from_world);
    for (const Rigid3& pose : solution.camera_from_board) state.boards.push_back(pose_from(pose));
    return state;
}

/// From several starts, with k1 alone; no boards where none leads to lenses.
BoardsState best_of_starts(std::span<const BoardSight> sights,
                           PictureSize camera,
                           PictureSize projector,
                           const Progress& progress) {
    BoardsState best;
    for (BoardsState& start : starts(sights, camera, projector)) {
        ceres::Problem problem;
        build(problem, start, sights, camera, projector);
        hold_all_but_k1(problem, start.camera);
        hold_all_but_k1(problem, start.projector);
        double cost = 0.0;
        if (solve(problem, 60, progress, cost) && cost < best.cost) {
            best = start;
            best.cost = cost;
        }
    }
    return best;
}

void check_sights(std::span<const BoardSight> sights) {
    for (const BoardSight& sight : sights)
        check_argument(sight.board_mm.size() >= 8 &&
                           sight.camera_px.size() == sight.board_mm.size() &&
                           sight.projector_px.size() == sight.board_mm.size(),
                       "a sight needs 8 or more points, all in both pictures");
    if (sights.size() < 3)
        throw Refused(fmt::format("{} poses of the board", sights.size()),
                      "photograph the board in five or more poses, tilted differently");
}

void check_tilts(const BoardsState& state) {
    double largest = 0.0;
    for (const Pose& a : state.boards)
        for (const Pose& b : state.boards) {
            const glm::dvec3 u = a.rigid().rotation[2], v = b.rigid().rotation[2];
            largest = std::max(largest, std::asin(std::min(1.0, glm::length(glm::cross(u, v)))));
        }
    if (largest < kLeastTilt_rad)
        throw Refused("all boards are parallel: the focal lengths cannot be told",
                      "tilt the board by 20 to 40 degrees, to all four sides");
}

/// Of camera (9), projector (9) and projector_from_camera (6), all boards' poses free: the normal
/// equations with the poses eliminated (Schur complement).
Eigen::MatrixXd information_of(ceres::Problem& problem, BoardsState& state) {
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks = {
        state.camera.data(), state.projector.data(), state.stereo.six.data()};
    for (Pose& board : state.boards) options.parameter_blocks.push_back(board.six.data());
    ceres::CRSMatrix jacobian;
    if (!problem.Evaluate(options, nullptr, nullptr, nullptr, &jacobian))
        throw Refused("the lenses could not be fitted", "photograph the board in more poses");
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(jacobian.num_cols, jacobian.num_cols);
    for (std::size_t row = 0; row + 1 < jacobian.rows.size(); ++row)
        for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i)
            for (int k = jacobian.rows[row]; k < jacobian.rows[row + 1]; ++k) {
                const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(k);
                normal(jacobian.cols[a], jacobian.cols[b]) +=
                    jacobian.values[a] * jacobian.values[b];
            }
    const auto boards = static_cast<Eigen::Index>(6 * state.boards.size());
    const Eigen::Index free = normal.rows() - boards;
    const Eigen::MatrixXd of_boards = normal.bottomRightCorner(boards, boards);
    const Eigen::MatrixXd beside = normal.bottomLeftCorner(boards, free);
    return normal.topLeftCorner(free, free) - beside.transpose() * of_boards.ldlt().solve(beside);
}

/// Standard deviations; infinite where nothing tells. In units of the terms' own slopes, since
/// pixels stand beside k3.
Eigen::VectorXd deviations_of(const Eigen::MatrixXd& information) {
    const Eigen::VectorXd unit = information.diagonal().array().max(1e-300).rsqrt().matrix();
    const Eigen::MatrixXd scaled = unit.asDiagonal() * information * unit.asDiagonal();
    const Eigen::LDLT<Eigen::MatrixXd> solver(scaled);
    if (!solver.isPositive())
        return Eigen::VectorXd::Constant(unit.size(), std::numeric_limits<double>::infinity());
    const Eigen::MatrixXd inverse =
        solver.solve(Eigen::MatrixXd::Identity(unit.size(), unit.size()));
    return (inverse.diagonal().array().max(0.0).sqrt() * unit.array()).matrix();
}

/// The same in the terms that registration seeks: one focal length a lens, the pose from the
/// camera's side.
PairInformation pair_information(const Eigen::MatrixXd& information, const PairSolution& solution) {
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(24, kPairTerms);
    const auto lens = [&](int row, int column, const View& view) {
        change(row, column) = view.focal_px.x;
        change(row + 1, column) = view.focal_px.y;
        for (int k = 0; k < 7; ++k) change(row + 2 + k, column + 1 + k) = 1.0;
    };
    lens(9, 0, solution.projector);
    lens(0, kLensTerms, solution.camera);
    // exp(v) R^T and exp(v) tc + s on the camera's side are exp(-R v) R and t - R s on the other
    const glm::dmat3& turn = solution.projector.view_from_world.rotation;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            for (const int part : {0, 3})
                change(18 + part + row, 2 * kLensTerms + part + column) = -turn[column][row];
    const Eigen::MatrixXd known = change.transpose() * information * change;
    PairInformation result{};
    for (int row = 0; row < kPairTerms; ++row)
        for (int column = 0; column < kPairTerms; ++column)
            result[static_cast<std::size_t>(kPairTerms * row + column)] = known(row, column);
    return result;
}

double rms_px(const View& view, const Rigid3& view_from_board, const BoardSight& sight, bool lit) {
    View there = view;
    there.view_from_world = view_from_board;
    double squares = 0.0;
    for (std::size_t k = 0; k < sight.board_mm.size(); ++k) {
        const auto place = project(there, glm::dvec3(sight.board_mm[k], 0.0));
        if (!place) return std::numeric_limits<double>::quiet_NaN();
        const glm::dvec2 off = *place - (lit ? sight.projector_px[k] : sight.camera_px[k]);
        squares += glm::dot(off, off);
    }
    return std::sqrt(squares / static_cast<double>(sight.board_mm.size()));
}

/// Of both, over all sights.
double rms_px(const BoardsState& state,
              std::span<const BoardSight> sights,
              PictureSize camera,
              PictureSize projector) {
    const View seen = view_of(state.camera.data(), camera);
    const View lit = view_of(state.projector.data(), projector);
    double squares = 0.0;
    for (std::size_t k = 0; k < sights.size(); ++k) {
        const Rigid3 pose = state.boards[k].rigid();
        squares += std::pow(rms_px(seen, pose, sights[k], false), 2.0) +
                   std::pow(rms_px(lit, state.stereo.rigid() * pose, sights[k], true), 2.0);
    }
    return std::sqrt(squares / (2.0 * static_cast<double>(sights.size())));
}

void check_focal(const char* who, double focal_px, double error_px) {
    if (error_px <= kLargestFocalError * std::abs(focal_px)) return;
    throw Refused(fmt::format("the {}'s focal length is {:.0f} px, with a standard error of {:.0f}",
                              who,
                              focal_px,
                              error_px),
                  "add poses: tilted by 20 to 40 degrees, to all four sides, near and far");
}

}  // namespace

PairSolution solve_pair(std::span<const BoardSight> sights,
                        PictureSize camera,
                        PictureSize projector,
                        const PairSolution* near,
                        const Progress& progress) {
    check_sights(sights);
    check_argument(!near || near->camera_from_board.size() == sights.size(),
                   "a solution to begin at has a pose for each sight");
    BoardsState best = near ? state_of(*near) : best_of_starts(sights, camera, projector, progress);
    if (best.boards.empty())
        throw Refused("no start leads to lenses that explain the boards",
                      "check the size of the board and of its squares");
    check_tilts(best);
    ceres::Problem problem;
    build(problem, best, sights, camera, projector);
    const double noise_px =
        std::max(rms_px(best, sights, camera, projector) / std::sqrt(2.0), 1e-6);
    add_distortion_prior(problem, best.camera, noise_px);
    add_distortion_prior(problem, best.projector, noise_px);
    if (!solve(problem, 200, progress, best.cost))
        throw Refused("the lenses could not be fitted", "photograph the board in more poses");

    PairSolution result;
    result.camera = view_of(best.camera.data(), camera);
    result.projector = view_of(best.projector.data(), projector);
    result.projector.view_from_world = best.stereo.rigid();
    double camera_squares = 0.0, projector_squares = 0.0, points = 0.0;
    for (std::size_t k = 0; k < sights.size(); ++k) {
        const Rigid3 pose = best.boards[k].rigid();
        const auto count = static_cast<double>(sights[k].board_mm.size());
        const double seen = rms_px(result.camera, pose, sights[k], false);
        const double lit = rms_px(result.projector, best.stereo.rigid() * pose, sights[k], true);
        camera_squares += count * seen * seen;
        projector_squares += count * lit * lit;
        points += count;
        result.camera_from_board.push_back(pose);
    }
    result.camera_rms_px = std::sqrt(camera_squares / points);
    result.projector_rms_px = std::sqrt(projector_squares / points);

    // About where the poses came to be, so that their turns are small ones
    best.stereo = pose_from(best.stereo.rigid());
    for (Pose& board : best.boards) board = pose_from(board.rigid());
    ceres::Problem settled;
    build(settled, best, sights, camera, projector);
    add_distortion_prior(settled, best.camera, noise_px);
    add_distortion_prior(settled, best.projector, noise_px);
    // At the residuals' own spread
    const double unknowns = 24.0 + 6.0 * static_cast<double>(sights.size());
    const double variance =
        (camera_squares + projector_squares) / std::max(1.0, 4.0 * points - unknowns);
    const Eigen::MatrixXd information = information_of(settled, best) / std::max(variance, 1e-12);
    const Eigen::VectorXd deviations = deviations_of(information);
    const auto errors_from = [&](Eigen::Index first, auto& errors) {
        for (std::size_t k = 0; k < errors.size(); ++k)
            errors[k] = deviations[first + static_cast<Eigen::Index>(k)];
    };
    errors_from(0, result.camera_standard_error_px);
    errors_from(9, result.projector_standard_error_px);
    errors_from(18, result.turn_standard_error_rad);
    errors_from(21, result.shift_standard_error_mm);
    result.information = pair_information(information, result);
    for (std::size_t k = 0; k < 2; ++k) {
        check_focal("camera", best.camera[k], result.camera_standard_error_px[k]);
        check_focal("projector", best.projector[k], result.projector_standard_error_px[k]);
    }
    return result;
}

std::optional<double> held_out_px(const PairSolution& solution, const BoardSight& sight) {
    const View& lens = solution.camera;
    Lens values = lens_of(lens);
    Pose board = pose_from(
        pose_of(homography(sight.board_mm, sight.camera_px), lens.focal_px.x, lens.principal_px));
    ceres::Problem problem;
    add_points(problem, sight, {lens.width, lens.height}, values, board, nullptr);
    problem.SetParameterBlockConstant(values.data());
    double cost = 0.0;
    if (!solve(problem, 100, Progress{}, cost)) return std::nullopt;
    const Rigid3 projector_from_board = solution.projector.view_from_world * board.rigid();
    const double rms = rms_px(solution.projector, projector_from_board, sight, true);
    if (std::isnan(rms)) return std::nullopt;
    return rms;
}

CheckedPair solve_leaving_each_out(std::span<const BoardSight> sights,
                                   PictureSize camera,
                                   PictureSize projector,
                                   const Progress& progress) {
    if (sights.size() < 4)
        throw Refused(fmt::format("{} poses of the board, too few to leave one out", sights.size()),
                      "photograph the board in five or more poses, tilted differently");
    CheckedPair result;
    result.solution = solve_pair(sights, camera, projector, nullptr, progress);
    double squares = 0.0;
    for (std::size_t out = 0; out < sights.size(); ++out) {
        progress.update(static_cast<double>(out) / static_cast<double>(sights.size()),
                        fmt::format("fitting without pose {} of {}", out + 1, sights.size()));
        std::vector<BoardSight> rest(sights.begin(), sights.end());
        PairSolution start = result.solution;
        const auto place = static_cast<std::ptrdiff_t>(out);
        rest.erase(rest.begin() + place);
        start.camera_from_board.erase(start.camera_from_board.begin() + place);
        const PairSolution without = solve_pair(rest, camera, projector, &start, progress);
        const std::optional<double> error = held_out_px(without, sights[out]);
        if (!error)
            throw Refused("the lenses that fit all poses but one cannot show that one",
                          "tilt the board by 20 to 40 degrees, to all four sides");
        result.held_out_px.push_back(*error);
        squares += *error * *error / static_cast<double>(sights.size());
    }
    result.held_out_rms_px = std::sqrt(squares);
    return result;
}

}  // namespace livery
