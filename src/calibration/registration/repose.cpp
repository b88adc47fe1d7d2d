#include "calibration/registration/repose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "calibration/registration/rotation.h"
#include "calibration/registration/symmetry.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/statistics.h"

namespace livery {

namespace {

/// Fewer places than these say nothing.
inline constexpr std::size_t kLeastAround = 100;

constexpr double kFound_px = 0.5;
constexpr int kEvery = 3;  // pixels along an edge

bool meets(const Tracer& tracer, const Rigid3& now_from_then, const Ray& ray) {
    TraceRay trace;
    trace.origin = glm::vec3(now_from_then * ray.origin);
    trace.direction = glm::vec3(now_from_then.rotation * ray.direction);
    return tracer.occluded(trace);
}

/// A border of a stripe as the map had it: between the pixel before the edge and that after it.
struct MappedEdge {
    glm::dvec2 projector_px{0.0}, camera_px{0.0};
    double camera_px_per_px = 0.0;  ///< across the stripes
    bool rising = false;
};

std::vector<MappedEdge> mapped_edges(const StripeCode& code, const ImageF& around) {
    std::vector<MappedEdge> edges;
    for (std::size_t k = 0; k < code.edges.size(); ++k) {
        const int edge = code.edges[k], length = code.rows ? code.width : code.height;
        for (int along = kEvery / 2; along < length; along += kEvery) {
            const int x = code.rows ? along : edge, y = code.rows ? edge : along;
            const float* after = around.pixel(x, y);
            const float* before = around.pixel(x - (code.rows ? 0 : 1), y - (code.rows ? 1 : 0));
            if (!std::isfinite(after[0]) || !std::isfinite(before[0])) continue;
            MappedEdge one;
            one.projector_px = code.rows ? glm::dvec2(x + 0.5, y) : glm::dvec2(x, y + 0.5);
            const glm::dvec2 a(before[0], before[1]), b(after[0], after[1]);
            one.camera_px = 0.5 * (a + b);
            one.camera_px_per_px = glm::length(b - a);
            one.rising = k % 2 == 0;
            edges.push_back(one);
        }
    }
    return edges;
}

/// Borders of stripes off the mock-up, of then and of now, where `around` knows where they were
/// seen; none without it. A place that is found again lies within half a camera pixel: the map's
/// and the crossing's error, three times.
AroundEvidence evidence_around(const Mesh& mesh,
                               const Tracer& tracer,
                               const ReposeInput& input,
                               const StripeSight& sight,
                               const Rigid3& then_from_now) {
    AroundEvidence evidence;
    const StripeCode& code = input.code;
    const ImageF& around = input.around;
    if (around.empty()) return evidence;
    check_argument(around.width == code.width && around.height == code.height &&
                       around.channels == 2 && !mesh.triangles.empty(),
                   "what is around the mock-up is not two channels of the projector's size");
    const Rigid3 now_from_then = inverse(then_from_now);
    std::size_t still = 0;
    for (const MappedEdge& edge : mapped_edges(code, around)) {
        const auto lit = find_ray(input.projector, edge.projector_px);
        const auto seen = find_ray(input.camera, edge.camera_px);
        if (!lit || !seen) continue;
        // Nor where the mock-up stood: the map is nearly its own there.
        if (meets(tracer, now_from_then, *lit) || meets(tracer, now_from_then, *seen) ||
            meets(tracer, {}, *lit) || meets(tracer, {}, *seen))
            continue;
        const double stripe_px = code.mean_stripe_px() * edge.camera_px_per_px;
        if (stripe_px < 3.0) continue;  // the camera does not part them
        const double within_px = std::max(2.0, 0.4 * stripe_px);
        ++evidence.places;
        const double offset = sight.offset_of(edge.camera_px, edge.rising, within_px);
        still += std::abs(offset) < kFound_px;
    }
    if (evidence.places == 0) return evidence;
    const auto count = static_cast<double>(evidence.places);
    evidence.still_share = static_cast<double>(still) / count;
    return evidence;
}

/// Throws Refused where enough places are known and fewer than half are seen where they were. A
/// table that was bumped is refused like a camera: stripes one way do not tell a camera that nods
/// from a table that tips with the mock-up on it.
void check_pair(const AroundEvidence& around) {
    if (around.places < kLeastAround || around.still_share >= 0.5) return;
    throw Refused(
        fmt::format("of what stands around the mock-up only {:.0f}% is seen where it was: camera "
                    "or projector moved too, or all that the mock-up stands on",
                    100.0 * around.still_share),
        "let everything stand still, and photograph the geometry again");
}

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t kForSearch = 600, kForFit = 20000;  // crossings
constexpr std::size_t kLeastCrossings = 200;
constexpr double kLeastAgreement = 0.6, kLargestMedian_px = 0.5;
constexpr double kFacing = 0.15;
constexpr int kStarts = 300, kSearchRounds = 10, kFitRounds = 30;

const char* const kAnew =
    "see that it is the calibration's mock-up, and find where everything stands with the geometry "
    "step again";

/// A crossing's ray in the room, whose frame is the product's of then.
struct CrossingRay {
    glm::dvec3 origin{0.0}, direction{0.0};
    bool rising = false;
};

/// What a crossing says of the motion.
struct CrossingRow {
    double residual_px = 0.0;
    Vector6 slope;  ///< of it, by a turn times radius and a shift, both mm
    Vector6 slip;   ///< of the surface along its normal, by the same
};

struct Fitting {
    const Mesh& mesh;
    const Tracer& tracer;
    const View& projector;
    const StripeCode& code;
    glm::dvec3 middle{0.0};  ///< of the mock-up then
    double radius_mm = 1.0;
};

std::optional<double> across_at(const Fitting& fitting, const glm::dvec3& place) {
    const auto pixel = project(fitting.projector, place);
    if (!pixel) return std::nullopt;
    return fitting.code.across(*pixel);
}

/// Of the crossings that fall on the mesh as it lies with `then_from_now`.
std::vector<CrossingRow> rows_of(const Fitting& fitting,
                                 const Rigid3& then_from_now,
                                 std::span<const CrossingRay> crossings) {
    const Rigid3 now_from_then = inverse(then_from_now);
    const glm::dvec3 lamp = centre_in_world(fitting.projector);
    const glm::vec3 lamp_now(now_from_then * lamp);
    const glm::dvec3 middle = then_from_now * fitting.middle;
    std::vector<std::optional<CrossingRow>> found(crossings.size());
    parallel_for(crossings.size(), 512, [&](std::size_t begin, std::size_t end) {
        std::vector<TraceRay> rays(end - begin);
        for (std::size_t i = begin; i < end; ++i) {
            rays[i - begin].origin = glm::vec3(now_from_then * crossings[i].origin);
            rays[i - begin].direction = glm::vec3(now_from_then.rotation * crossings[i].direction);
        }
        std::vector<Hit> hits(rays.size());
        fitting.tracer.closest(rays, hits);
        for (std::size_t i = begin; i < end; ++i) {
            const Hit& hit = hits[i - begin];
            if (!hit.valid()) continue;
            const CrossingRay& crossing = crossings[i];
            const SurfacePoint point = surface_point(fitting.mesh, hit);
            const glm::dvec3 place =
                crossing.origin + static_cast<double>(hit.t) * crossing.direction;
            const glm::dvec3 normal = then_from_now.rotation * glm::dvec3(point.normal);
            const double facing = glm::dot(normal, crossing.direction);
            const glm::dvec3 to_lamp = lamp - place;
            if (facing > -kFacing || glm::dot(normal, to_lamp) < kFacing * glm::length(to_lamp))
                continue;
            TraceRay shadow;
            shadow.origin = offset_origin(point.position_mm, point.geometric_normal);
            shadow.direction = lamp_now - shadow.origin;
            shadow.t_max = 1.0f;
            if (fitting.tracer.occluded(shadow)) continue;
            constexpr double kStep_mm = 0.05;
            const auto here = across_at(fitting, place);
            const auto beyond = across_at(fitting, place + kStep_mm * crossing.direction);
            if (!here || !beyond) continue;
            const double edge = fitting.code.nearest_edge(*here, crossing.rising);
            if (!std::isfinite(edge)) continue;
            CrossingRow row;
            row.residual_px = *here - edge;
            const glm::dvec3 lever = glm::cross((place - middle) / fitting.radius_mm, normal);
            row.slip << lever.x, lever.y, lever.z, normal.x, normal.y, normal.z;
            row.slope = (*beyond - *here) / (kStep_mm * facing) * row.slip;
            found[i] = row;
        }
    });
    std::vector<CrossingRow> rows;
    for (auto& row : found)
        if (row) rows.push_back(std::move(*row));
    return rows;
}

double median_of(const std::vector<CrossingRow>& rows) {
    std::vector<double> sizes;
    for (const CrossingRow& row : rows) sizes.push_back(std::abs(row.residual_px));
    return median(std::move(sizes));
}

std::size_t agreeing(const std::vector<CrossingRow>& rows) {
    return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [](const auto& row) {
        return std::abs(row.residual_px) < kReposeAgrees_px;
    }));
}

/// The normal equations over what the surface does not slip along.
struct Equations {
    Matrix6 information = Matrix6::Zero();  ///< sum of weighted slopes squared
    Vector6 right = Vector6::Zero();
    Eigen::Matrix<double, 6, Eigen::Dynamic> held;  ///< directions that the surface holds
    double scale_px = 1.0;

    Vector6 solution() const {
        const Eigen::MatrixXd square = held.transpose() * information * held;
        return held * square.ldlt().solve(held.transpose() * right);
    }
    Matrix6 covariance() const {
        const Eigen::MatrixXd square = held.transpose() * information * held;
        return held * square.inverse() * held.transpose();
    }
};

Equations equations_of(const std::vector<CrossingRow>& rows, double largest_scale_px) {
    Equations equations;
    equations.scale_px = std::clamp(1.4826 * median_of(rows), 0.05, largest_scale_px);
    Matrix6 slips = Matrix6::Zero();
    double weights = 0.0;
    for (const CrossingRow& row : rows) {
        // Cauchy: half the weight at twice the scale.
        const double ratio = row.residual_px / (2.0 * equations.scale_px);
        const double weight = 1.0 / (1.0 + ratio * ratio);
        equations.information += weight * row.slope * row.slope.transpose();
        equations.right -= weight * row.residual_px * row.slope;
        slips += weight * row.slip * row.slip.transpose();
        weights += weight;
    }
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(slips / std::max(weights, 1e-9));
    int slipping = 0;
    while (slipping < 6 && solver.eigenvalues()[slipping] < kSlipsFreely * kSlipsFreely) ++slipping;
    equations.held = solver.eigenvectors().rightCols(6 - slipping);
    return equations;
}

/// Turned about the mock-up's middle and shifted, in the room.
Rigid3 moved_by(const Fitting& fitting, const Vector6& step, const Rigid3& then_from_now) {
    const glm::dvec3 middle = then_from_now * fitting.middle;
    const glm::dmat3 turn = rotation_of(glm::dvec3(step[0], step[1], step[2]) / fitting.radius_mm);
    const glm::dvec3 shift(step[3], step[4], step[5]);
    return Rigid3{turn, middle + shift - turn * middle} * then_from_now;
}

struct PoseFit {
    Rigid3 then_from_now;
    std::vector<CrossingRow> rows;
    Equations equations;
};

PoseFit fitted(const Fitting& fitting,
               const Rigid3& start,
               std::span<const CrossingRay> crossings,
               int rounds) {
    PoseFit fit{start, {}, {}};
    const double largest_scale_px = 0.25 * fitting.code.mean_stripe_px();
    for (int round = 0; round <= rounds; ++round) {
        fit.rows = rows_of(fitting, fit.then_from_now, crossings);
        fit.equations = equations_of(fit.rows, largest_scale_px);
        if (round == rounds || fit.rows.size() < 6 || fit.equations.held.cols() == 0) break;
        Vector6 step = fit.equations.solution();
        const double length = step.norm(), longest = 0.1 * fitting.radius_mm;
        if (!std::isfinite(length)) break;
        if (length > longest) step *= longest / length;
        fit.then_from_now = moved_by(fitting, step, fit.then_from_now);
        if (length < 1e-5 * fitting.radius_mm) {
            fit.rows = rows_of(fitting, fit.then_from_now, crossings);
            fit.equations = equations_of(fit.rows, largest_scale_px);
            break;
        }
    }
    return fit;
}

/// Every so manieth, so that about `count` are left, spread over the picture.
std::vector<CrossingRay> thinned_out(const std::vector<CrossingRay>& all, std::size_t count) {
    std::vector<CrossingRay> some;
    const double step = std::max(1.0, static_cast<double>(all.size()) / static_cast<double>(count));
    for (double k = 0.0; k < static_cast<double>(all.size()); k += step)
        some.push_back(all[static_cast<std::size_t>(k)]);
    return some;
}

/// Places to begin with: the old one, and more and more from all around it. A border is taken for
/// its neighbour from half a stripe on, which a centimetre is more than. What the product leaves
/// open is not `turned`: nothing would turn it back.
Rigid3 start_of(const Fitting& fitting, int number, bool turned) {
    if (number == 0) return {};
    constexpr double kFarthest_mm = 12.0, kMostTurned_rad = 0.09;  // 5 degrees
    Random random(static_cast<std::uint64_t>(number), 17);
    const double reach = std::min(1.0, 0.3 + 0.7 * number / (0.5 * kStarts));
    const auto one = [&] { return reach * (2.0 * random.uniform() - 1.0); };
    Vector6 step;
    for (int k = 0; k < 3; ++k)
        step[k] = turned ? kMostTurned_rad * fitting.radius_mm * one() : 0.0;
    for (int k = 3; k < 6; ++k) step[k] = kFarthest_mm * one();
    return moved_by(fitting, step, {});
}

/// The way in the camera's picture in which the stripes' number grows, over the mesh as it lay.
glm::dvec2 uphill_of(const Fitting& fitting, const View& camera) {
    const auto at = [&](const glm::dvec3& place) { return project(camera, place); };
    const auto here = at(fitting.middle);
    const auto across = across_at(fitting, fitting.middle);
    glm::dvec2 uphill(0.0);
    // Steps in the plane that faces the camera, as the surface does on the whole.
    const glm::dvec3 toward = glm::normalize(fitting.middle - centre_in_world(camera));
    for (int axis = 0; axis < 3 && here && across; ++axis) {
        glm::dvec3 step(0.0);
        step[axis] = 1.0;
        step -= glm::dot(step, toward) * toward;
        const auto there = at(fitting.middle + step);
        const auto moved = across_at(fitting, fitting.middle + step);
        if (there && moved) uphill += (*moved - *across) * (*there - *here);
    }
    return uphill;
}

void refuse_bad(const PoseFit& fit, double share, double median_px) {
    if (fit.rows.size() < kLeastCrossings)
        throw Refused(
            fmt::format("only {} borders of stripes are seen on the mock-up", fit.rows.size()),
            "see that it stands in the projector's light and that nothing hides it; if "
            "it was moved far, photograph the geometry again");
    if (share < kLeastAgreement)
        throw Refused(
            fmt::format("only {:.0f}% of the stripes on the mock-up lie where its mesh has them: "
                        "it was moved too far, or it is another",
                        100.0 * share),
            kAnew);
    if (median_px > kLargestMedian_px)
        throw Refused(
            fmt::format("the stripes on the mock-up lie {:.2f} px from where its mesh has "
                        "them",
                        median_px),
            kAnew);
}

}  // namespace

Repose find_mockup_again(const Mesh& mesh,
                         const Tracer& tracer,
                         const ReposeInput& input,
                         const Progress& progress) {
    const Bounds box = bounds_of(mesh);
    const Fitting fitting{mesh,
                          tracer,
                          input.projector,
                          input.code,
                          0.5 * (box.low + box.high),
                          0.5 * glm::length(box.high - box.low)};
    progress.update(0.0, "looking for the stripes");
    const StripeSight sight =
        see_stripes(input.stripes, input.inverse, uphill_of(fitting, input.camera));
    if (sight.signal.width != input.camera.width || sight.signal.height != input.camera.height)
        throw FileError("the camera's photographs",
                        "size",
                        fmt::format("{}x{}", sight.signal.width, sight.signal.height),
                        fmt::format("{}x{}, as at the calibration: set the camera as it was",
                                    input.camera.width,
                                    input.camera.height));
    // What passes the mock-up at twice its size is of no use here.
    std::vector<CrossingRay> rays;
    for (const StripeCrossing& crossing : sight.crossings) {
        const auto ray = find_ray(input.camera, crossing.camera_px);
        if (!ray) continue;
        const glm::dvec3 past = glm::cross(fitting.middle - ray->origin, ray->direction);
        if (glm::length(past) > 2.0 * fitting.radius_mm) continue;
        rays.push_back({ray->origin, ray->direction, crossing.rising});
    }

    const std::vector<CrossingRay> few = thinned_out(rays, kForSearch);
    std::optional<PoseFit> best;
    for (int k = 0; k < kStarts; ++k) {
        progress.update(0.1 + 0.6 * k / kStarts, "looking for the mock-up");
        PoseFit fit =
            fitted(fitting, start_of(fitting, k, input.free_turns == 0), few, kSearchRounds);
        const std::size_t agree = agreeing(fit.rows);
        if (!best || agree > agreeing(best->rows)) best = std::move(fit);
        // Unequal stripes agree by the dozen in one place alone.
        const bool sure = 10 * agreeing(best->rows) > 8 * best->rows.size() &&
                          best->rows.size() * 5 > few.size() / 2 && median_of(best->rows) < 0.3;
        if (sure) break;
    }
    progress.update(0.7, "finding its place");
    const PoseFit fit =
        fitted(fitting, best->then_from_now, thinned_out(rays, kForFit), kFitRounds);

    Repose result;
    result.then_from_now = fit.then_from_now;
    result.on_product = fit.rows.size();
    result.median_px = median_of(fit.rows);
    result.agree_share = static_cast<double>(agreeing(fit.rows)) /
                         static_cast<double>(std::max<std::size_t>(fit.rows.size(), 1));
    refuse_bad(fit, result.agree_share, result.median_px);
    const auto open = static_cast<int>(6 - fit.equations.held.cols());
    if (open > input.free_turns)
        throw Refused(
            "what is seen of the mock-up does not tell how it moved: it slips along "
            "itself",
            "let projector and camera see more of it, and photograph the geometry again");
    if (open > 0)
        result.warnings.push_back(
            "the product looks the same when it is turned: its turn is taken to be what it was");

    progress.update(0.9, "looking at what stands around");
    result.around = evidence_around(mesh, tracer, input, sight, fit.then_from_now);
    check_pair(result.around);
    if (result.around.places < kLeastAround)
        result.warnings.push_back(
            "nothing that stands around the mock-up is known or lit: whether camera and projector "
            "stand as they did is not looked at");

    result.projector = input.projector;
    result.projector.view_from_world = input.projector.view_from_world * fit.then_from_now;
    result.camera = input.camera;
    result.camera.view_from_world = input.camera.view_from_world * fit.then_from_now;
    result.moved_mm = glm::length(fit.then_from_now * fitting.middle - fitting.middle);
    result.turned_rad = angle_of(fit.then_from_now.rotation);
    const Matrix6 covariance =
        fit.equations.scale_px * fit.equations.scale_px * fit.equations.covariance();
    for (int k = 0; k < 3; ++k) {
        result.turn_error_rad[k] = std::sqrt(std::max(covariance(k, k), 0.0)) / fitting.radius_mm;
        result.shift_error_mm[k] = std::sqrt(std::max(covariance(k + 3, k + 3), 0.0));
    }
    return result;
}

}  // namespace livery
