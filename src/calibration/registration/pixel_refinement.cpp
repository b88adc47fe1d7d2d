#include "calibration/registration/pixel_refinement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include <Eigen/Dense>
#include <ceres/ceres.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/registration/gaussian_prior.h"
#include "calibration/registration/rotation.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/solve.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr int kWantedPairs = 2500;  // correspondences a sight
constexpr int kRefinements = 12;

Rigid3 moved(const double* six, const Rigid3& pose) {
    const glm::dmat3 turn = rotation_of({six[0], six[1], six[2]});
    return {turn * pose.rotation, turn * pose.translation + glm::dvec3(six[3], six[4], six[5])};
}

/// Changes of a lens: focal length (logarithm), principal point, distortion
/// (geometry/solve_pair.h).
using LensChange = std::array<double, kLensTerms>;
using PoseChange = std::array<double, kPoseTerms>;

View with_lens(const double* change, View view) {
    view.focal_px *= std::exp(change[0]);
    view.principal_px += glm::dvec2(change[1], change[2]);
    for (std::size_t k = 0; k < view.distortion.size(); ++k) view.distortion[k] += change[3 + k];
    return view;
}

/// Everything sought, as changes of what was given.
struct State {
    PoseChange pose{};               ///< projector_from_mesh, moved
    std::vector<PoseChange> stereo;  ///< camera_from_projector, moved
    LensChange projector_lens{}, camera_lens{};
    std::array<double, 1> scale{};  ///< logarithm
};

struct Given {
    View projector;  ///< world: the mesh
    std::vector<Rigid3> camera_from_projector;
    std::vector<View> cameras;  ///< their lenses

    View projector_of(const double* pose, const double* lens) const {
        View view = with_lens(lens, projector);
        view.view_from_world = moved(pose, projector.view_from_world);
        return view;
    }
    View camera_of(const double* stereo,
                   const double* lens,
                   std::size_t k,
                   const View& in_projector) const {
        View view = with_lens(lens, cameras[k]);
        view.view_from_world =
            moved(stereo, camera_from_projector[k]) * in_projector.view_from_world;
        return view;
    }
    View projector_of(const State& state) const {
        return projector_of(state.pose.data(), state.projector_lens.data());
    }
    View camera_of(const State& state, std::size_t k, const View& in_projector) const {
        return camera_of(state.stereo[k].data(), state.camera_lens.data(), k, in_projector);
    }
};

struct Correspondence {
    std::size_t sight = 0;
    glm::dvec2 projector_px{0.0}, camera_px{0.0};
    glm::dvec3 place{0.0}, normal{0.0};  ///< of the tangent plane, the mesh's own size
};

/// Where the camera's ray meets the plane, in the projector's picture.
std::optional<glm::dvec2> predicted(const View& projector,
                                    const View& camera,
                                    double scale,
                                    const Correspondence& at) {
    const std::optional<Ray> ray = find_ray(camera, at.camera_px);
    if (!ray) return std::nullopt;
    const double toward = glm::dot(at.normal, ray->direction);
    if (std::abs(toward) < 1e-3) return std::nullopt;
    const double t = glm::dot(at.normal, scale * at.place - ray->origin) / toward;
    return project(projector, ray->origin + t * ray->direction);
}

struct PixelError {
    const Given* given = nullptr;
    Correspondence at;
    double sigma_px = 1.0;

    bool operator()(const double* pose,
                    const double* stereo,
                    const double* projector_lens,
                    const double* camera_lens,
                    const double* scale,
                    double* residual) const {
        const View projector = given->projector_of(pose, projector_lens);
        const View camera = given->camera_of(stereo, camera_lens, at.sight, projector);
        const auto pixel = predicted(projector, camera, std::exp(scale[0]), at);
        if (!pixel) return false;
        residual[0] = (pixel->x - at.projector_px.x) / sigma_px;
        residual[1] = (pixel->y - at.projector_px.y) / sigma_px;
        return true;
    }
};

/// What falls on the mesh with the views as they are now, and not farther from where it was seen
/// than `within_px`.
std::vector<Correspondence> correspondences_of(const Mesh& mesh,
                                               const Tracer& tracer,
                                               const std::vector<Sight>& sights,
                                               const Given& given,
                                               const State& state,
                                               const Image8& ignored,
                                               double within_px,
                                               std::vector<double>* errors) {
    const View projector = given.projector_of(state);
    const double scale = std::exp(state.scale[0]);
    // The mesh fills a part of the picture: so many pixels of it are wanted that enough fall on it.
    const Bounds box = bounds_of(mesh);
    const double across =
        glm::length(box.high - box.low) * scale /
        glm::length(centre_in_world(projector) - 0.5 * scale * (box.low + box.high)) *
        projector.focal_px.x;
    const int stride = std::max(1, static_cast<int>(across * 0.5 / std::sqrt(kWantedPairs)));
    std::vector<std::vector<Correspondence>> rows(
        static_cast<std::size_t>(projector.height / stride));
    const auto row_of = [&](std::size_t row) {
        const int y = static_cast<int>(row) * stride + stride / 2;
        std::vector<TraceRay> rays;
        std::vector<int> columns;
        for (int x = stride / 2; x < projector.width; x += stride) {
            if (!ignored.empty() && ignored.at(x, y)) continue;
            const std::optional<Ray> ray = find_ray(projector, {x + 0.5, y + 0.5});
            if (!ray) continue;
            TraceRay trace;
            trace.origin = glm::vec3(ray->origin / scale);
            trace.direction = glm::vec3(ray->direction);
            rays.push_back(trace);
            columns.push_back(x);
        }
        std::vector<Hit> hits(rays.size());
        tracer.closest(rays, hits);
        for (std::size_t i = 0; i < hits.size(); ++i) {
            if (!hits[i].valid()) continue;
            const SurfacePoint point = surface_point(mesh, hits[i]);
            // A rough mesh's triangles face anywhere; its corners' normals are means over some.
            const glm::dvec3 normal(point.normal);
            if (glm::dot(normal, glm::dvec3(rays[i].direction)) > -0.15) continue;
            for (std::size_t k = 0; k < sights.size(); ++k) {
                const ProjectorToCamera& map = sights[k].map;
                const float* seen = map.camera_px.pixel(columns[i], y);
                if (!std::isfinite(seen[0])) continue;
                if (!map.edge.empty() && map.edge.at(columns[i], y)) continue;
                rows[row].push_back({k,
                                     {columns[i] + 0.5, y + 0.5},
                                     {seen[0], seen[1]},
                                     glm::dvec3(point.position_mm),
                                     normal});
            }
        }
    };
    parallel_for(rows.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) row_of(row);
    });
    std::vector<View> cameras;
    for (std::size_t k = 0; k < sights.size(); ++k)
        cameras.push_back(given.camera_of(state, k, projector));
    std::vector<Correspondence> result;
    for (const auto& row : rows)
        for (const Correspondence& one : row) {
            const glm::dvec3 to_camera = centre_in_world(cameras[one.sight]) - scale * one.place;
            if (glm::dot(one.normal, to_camera) < 0.15 * glm::length(to_camera)) continue;
            const auto pixel = predicted(projector, cameras[one.sight], scale, one);
            if (!pixel) continue;
            const double error = glm::length(*pixel - one.projector_px);
            if (error > within_px) continue;
            if (errors) errors->push_back(error);
            result.push_back(one);
        }
    return result;
}

/// The last problem: what it sought, and what each residual block is of.
struct Solved {
    ceres::Problem* problem = nullptr;
    std::vector<ceres::ResidualBlockId> pixels, priors;
    std::vector<int> tile;  ///< of the projector's picture, one a pixel
    std::vector<std::pair<double*, int>> sought;
};

/// Tiles across the projector's picture that are taken to err on their own.
constexpr int kTilesAcross = 12;

/// Of all that is sought, in its order. Neighbouring pixels err together (an edge of a stripe, the
/// mesh, what the lens's model lacks), so that counting each by itself promises too much: the
/// sandwich of Liang and Zeger (1986) over tiles, with the priors as they are, and no less than
/// what independent pixels would give.
Eigen::MatrixXd covariance_of(const Solved& solved) {
    ceres::Problem::EvaluateOptions options;
    options.residual_blocks = solved.pixels;
    options.residual_blocks.insert(
        options.residual_blocks.end(), solved.priors.begin(), solved.priors.end());
    Eigen::Index count = 0;
    for (const auto& [block, size] : solved.sought) {
        options.parameter_blocks.push_back(block);
        count += size;
    }
    std::vector<double> residuals;
    ceres::CRSMatrix jacobian;
    if (!solved.problem->Evaluate(options, nullptr, &residuals, nullptr, &jacobian)) {
        throw Refused("the pose has no covariance", "photograph more of the mock-up");
    }
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count), meat = information;
    std::map<int, Eigen::VectorXd> of_tile;
    for (int row = 0; row < jacobian.num_rows; ++row) {
        Eigen::VectorXd slope = Eigen::VectorXd::Zero(count);
        const auto at = static_cast<std::size_t>(row);
        for (int k = jacobian.rows[at]; k < jacobian.rows[at + 1]; ++k) {
            const auto entry = static_cast<std::size_t>(k);
            slope[jacobian.cols[entry]] = jacobian.values[entry];
        }
        information += slope * slope.transpose();
        if (at / 2 < solved.tile.size()) {
            const auto tile =
                of_tile.try_emplace(solved.tile[at / 2], Eigen::VectorXd::Zero(count));
            tile.first->second += residuals[at] * slope;
        } else {
            meat += slope * slope.transpose();
        }
    }
    // Radians, pixels and millimetres: to unit diagonal before it is inverted
    const Eigen::VectorXd unit = information.diagonal().array().max(1e-300).rsqrt().matrix();
    const Eigen::MatrixXd scaled = unit.asDiagonal() * information * unit.asDiagonal();
    const Eigen::MatrixXd inverse = unit.asDiagonal() *
                                    scaled.completeOrthogonalDecomposition().pseudoInverse() *
                                    unit.asDiagonal();
    // Few tiles fit what is sought to their own errors: so many of them count as pixels told
    // numbers
    const double told = static_cast<double>(count) - (inverse * meat).trace();
    const auto tiles = static_cast<double>(of_tile.size());
    for (const auto& [tile, gradient] : of_tile) {
        meat += tiles / std::max(tiles - told, 1.0) * gradient * gradient.transpose();
    }
    const Eigen::MatrixXd sandwich = inverse * meat * inverse;
    const Eigen::VectorXd wider =
        (sandwich.diagonal().array() / inverse.diagonal().array()).max(1.0).sqrt().matrix();
    return wider.asDiagonal() * inverse * wider.asDiagonal();
}

/// How many neighbouring pixels err as one, from the residuals of a solution, each weighed as its
/// loss weighs it: the design effect of tiles as clusters (Kish 1965).
double pixels_that_err_together(const Solved& solved) {
    ceres::Problem::EvaluateOptions options;
    options.residual_blocks = solved.pixels;
    std::vector<double> residuals;
    if (!solved.problem->Evaluate(options, nullptr, &residuals, nullptr, nullptr)) return 1.0;
    std::map<int, glm::dvec2> of_tile;
    double squares = 0.0, of_sums = 0.0;
    for (std::size_t k = 0; k < solved.tile.size(); ++k) {
        const glm::dvec2 residual(residuals[2 * k], residuals[2 * k + 1]);
        of_tile[solved.tile[k]] += residual;
        squares += glm::dot(residual, residual);
    }
    for (const auto& [tile, sum] : of_tile) of_sums += glm::dot(sum, sum);
    return std::max(of_sums / std::max(squares, 1e-300), 1.0);
}

void describe(const Solved& solved,
              State& state,
              const LensPrior& prior,
              const Eigen::MatrixXd& known,
              PixelRefinement& result) {
    const Eigen::MatrixXd covariance = covariance_of(solved);
    for (int i = 0; i < 6; ++i)
        for (int k = 0; k < 6; ++k)
            result.covariance[static_cast<std::size_t>(6 * i + k)] = covariance(i, k);
    Eigen::Index from = kPoseTerms;  // sought in this order: the pose, lenses, the pair, the scale
    const auto tell = [&](const char* name, double change, double before) {
        result.lens.push_back({name, change, std::sqrt(covariance(from, from)), before});
        ++from;
    };
    if (!prior.lens_fixed) {
        constexpr std::array<const char*, kPairTerms> names = {"projector focal",
                                                               "projector principal x",
                                                               "projector principal y",
                                                               "projector k1",
                                                               "projector k2",
                                                               "projector p1",
                                                               "projector p2",
                                                               "projector k3",
                                                               "camera focal",
                                                               "camera principal x",
                                                               "camera principal y",
                                                               "camera k1",
                                                               "camera k2",
                                                               "camera p1",
                                                               "camera p2",
                                                               "camera k3",
                                                               "camera turn x",
                                                               "camera turn y",
                                                               "camera turn z",
                                                               "camera shift x",
                                                               "camera shift y",
                                                               "camera shift z"};
        std::vector<double> changes(state.projector_lens.begin(), state.projector_lens.end());
        changes.insert(changes.end(), state.camera_lens.begin(), state.camera_lens.end());
        changes.insert(changes.end(), state.stereo.front().begin(), state.stereo.front().end());
        const Eigen::VectorXd sigma = covariance_from(known).diagonal().cwiseSqrt();
        for (std::size_t k = 0; k < names.size(); ++k)
            tell(names[k], changes[k], sigma[static_cast<Eigen::Index>(k)]);
    }
    if (prior.scale_free) tell("mesh scale", state.scale[0], prior.scale);
}

/// Throws Refused for a lens that leaves a corner of its picture without a ray.
void check_lens(const View& view, const char* whose) {
    for (const double x : {0.5, view.width - 0.5})
        for (const double y : {0.5, view.height - 0.5})
            if (!find_ray(view, {x, y}))
                throw Refused(
                    fmt::format("the {}'s lens that fits best is none: its distortion k1 would be "
                                "{:.2f}",
                                whose,
                                view.distortion[0]),
                    "check focal length, sensor width, throw ratio, lens shift and the distance "
                    "between the lenses, and that the mesh is the mock-up's");
}

}  // namespace

PixelRefinement refine_on_pixels(const Mesh& mesh,
                                 const Tracer& tracer,
                                 const View& projector,
                                 const std::vector<Sight>& sights,
                                 const Rigid3& world_from_mesh,
                                 const Image8& ignored,
                                 const LensPrior& prior,
                                 const Progress& progress) {
    Given given;
    given.projector = projector;
    given.projector.view_from_world = projector.view_from_world * world_from_mesh;
    for (const Sight& sight : sights) {
        given.cameras.push_back(sight.camera);
        given.camera_from_projector.push_back(sight.camera.view_from_world *
                                              inverse(projector.view_from_world));
    }
    State state;
    state.stereo.resize(sights.size());
    const double distance = glm::length(given.projector.view_from_world.translation);
    const auto pair_before = [&](std::size_t k) {
        return known_before(prior, projector, sights[k].camera, distance, k);
    };
    // Hardly a prior: a bound for what nothing holds, the turn of a sphere.
    Eigen::VectorXd pose_sigma(kPoseTerms);
    pose_sigma << 1.0, 1.0, 1.0, distance, distance, distance;

    double within_px = 0.03 * projector.width, sigma_px = 2.0, together = 1.0;
    PixelRefinement result;
    std::vector<double> before;
    for (int round = 0; round < kRefinements; ++round) {
        progress.update(static_cast<double>(round) / kRefinements, "refining pose and lenses");
        std::vector<double> errors;
        const std::vector<Correspondence> found =
            correspondences_of(mesh, tracer, sights, given, state, ignored, within_px, &errors);
        if (found.size() < 200)
            throw Refused(
                fmt::format("only {} of the pixels looked at fall on the mock-up", found.size()),
                "light more of the mock-up, and let the camera see what the projector lights");
        sigma_px = std::clamp(1.4826 / 1.4142 * median(errors), 0.02, 5.0);
        ceres::Problem problem;
        Solved solved;
        solved.problem = &problem;
        for (const Correspondence& one : found) {
            const glm::ivec2 tile(one.projector_px * (kTilesAcross / double(projector.width)));
            solved.tile.push_back(tile.y * kTilesAcross + tile.x);
            solved.pixels.push_back(problem.AddResidualBlock(
                new ceres::NumericDiffCostFunction<PixelError,
                                                   ceres::FORWARD,
                                                   2,
                                                   kPoseTerms,
                                                   kPoseTerms,
                                                   kLensTerms,
                                                   kLensTerms,
                                                   1>(new PixelError{&given, one, sigma_px}),
                new ceres::ScaledLoss(
                    new ceres::CauchyLoss(2.0), 1.0 / together, ceres::TAKE_OWNERSHIP),
                state.pose.data(),
                state.stereo[one.sight].data(),
                state.projector_lens.data(),
                state.camera_lens.data(),
                state.scale.data()));
        }
        // Sought, where it is free, with what is known of it before
        const auto seek = [&](auto& block, bool free) {
            const int size = static_cast<int>(block.size());
            problem.AddParameterBlock(block.data(), size);
            if (!free) return problem.SetParameterBlockConstant(block.data());
            solved.sought.emplace_back(block.data(), size);
        };
        const auto know = [&](const Eigen::MatrixXd& information,
                              const std::vector<double*>& blocks,
                              const std::vector<int>& sizes) {
            solved.priors.push_back(
                problem.AddResidualBlock(new GaussianPrior(information, sizes), nullptr, blocks));
        };
        seek(state.pose, true);
        know(independent(pose_sigma), {state.pose.data()}, {kPoseTerms});
        seek(state.projector_lens, !prior.lens_fixed);
        seek(state.camera_lens, !prior.lens_fixed);
        for (auto& stereo : state.stereo) seek(stereo, !prior.lens_fixed);
        seek(state.scale, prior.scale_free);
        if (!prior.lens_fixed) {
            know(pair_before(0),
                 {state.projector_lens.data(), state.camera_lens.data(), state.stereo[0].data()},
                 {kLensTerms, kLensTerms, kPoseTerms});
            for (std::size_t k = 1; k < sights.size(); ++k) {
                // Of itself, the lenses being those of the first
                const Eigen::MatrixXd pose =
                    covariance_from(pair_before(k)).bottomRightCorner(kPoseTerms, kPoseTerms);
                know(pose.inverse(), {state.stereo[k].data()}, {kPoseTerms});
            }
        }
        if (prior.scale_free)
            know(independent(Eigen::VectorXd::Constant(1, prior.scale)), {state.scale.data()}, {1});
        ceres::Solver::Options options;
        options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
        options.max_num_iterations = 8;
        options.num_threads = thread_count();
        options.logging_type = ceres::SILENT;
        const ceres::Solver::Summary summary = livery::solved(options, problem, progress);
        within_px = std::max(8.0 * sigma_px, 1.5);
        together = pixels_that_err_together(solved);
        const bool settled =
            round > 3 && summary.initial_cost - summary.final_cost < 1e-4 * summary.initial_cost;
        if (!settled && round + 1 < kRefinements) continue;
        describe(solved, state, prior, pair_before(0), result);
        break;
    }

    std::vector<double> every_error, errors;
    const std::vector<Correspondence> all =
        correspondences_of(mesh, tracer, sights, given, state, ignored, 1e9, &every_error);
    std::vector<Correspondence> inliers;
    double misfit = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        misfit += std::pow(std::min(every_error[i], kMisfitLimit_px), 2.0);
        if (every_error[i] > within_px) continue;
        inliers.push_back(all[i]);
        errors.push_back(every_error[i]);
    }
    result.misfit_px =
        std::sqrt(misfit / static_cast<double>(std::max<std::size_t>(all.size(), 1)));
    result.projector = given.projector_of(state);
    for (std::size_t k = 0; k < sights.size(); ++k)
        result.cameras.push_back(given.camera_of(state, k, result.projector));
    check_lens(result.projector, "projector");
    for (const View& camera : result.cameras) check_lens(camera, "camera");
    result.mesh_scale = std::exp(state.scale[0]);
    result.correspondences = all.size();
    result.inliers = inliers.size();
    result.median_px = median(errors);
    double squares = 0.0, squares_mm = 0.0;
    const glm::dvec3 lamp = centre_in_world(result.projector);
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const double mm_per_px =
            glm::length(result.mesh_scale * inliers[i].place - lamp) / result.projector.focal_px.x;
        squares += errors[i] * errors[i];
        squares_mm += std::pow(errors[i] * mm_per_px, 2.0);
    }
    const auto count = static_cast<double>(errors.size());
    // What the mesh's own size sees: x_view = R (s x) + t has the pixels of R x + t / s.
    result.projector.view_from_world.translation /= result.mesh_scale;
    for (View& camera : result.cameras) camera.view_from_world.translation /= result.mesh_scale;
    result.rms_px = std::sqrt(squares / (2.0 * count));
    result.rms_mm = std::sqrt(squares_mm / count);
    return result;
}

}  // namespace livery
