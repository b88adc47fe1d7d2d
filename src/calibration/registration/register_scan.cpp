#include "calibration/registration/register_scan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/registration/rotation.h"
#include "calibration/registration/scan_poses.h"
#include "calibration/registration/surface_samples.h"
#include "core/error.h"
#include "core/parallel.h"

namespace livery {

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::size_t kGuesses = 120;   // followed from the votes
constexpr std::size_t kFinalists = 16;  // of these, made exact

/// Shares of the product's size.
constexpr double kCoarse = 0.045;  // spacing of the samples that vote
constexpr double kFine = 0.006;    // of those that closest points compare
constexpr double kNear = 0.012;    // what the scan may be off a right pose, its lenses 1% off
constexpr double kSame = 0.03;     // poses that far apart are two

constexpr const char* kOtherMesh =
    "check that this is the mock-up's mesh, in the mock-up's size (product JSON mesh_scale, unit), "
    "and that nothing stands before the mock-up; or pick points (--points)";

struct PoseCandidate {
    Rigid3 scan_from_mesh;
    PoseEvidence evidence;
};

/// A mesh made ready to be looked for.
struct TargetMesh {
    const Mesh& mesh;
    Tracer tracer;
    double size_mm;
    glm::dvec3 middle_mm;
    SurfaceSamples coarse, fine;
    NearestSample tree;
    FreeTurns free;

    explicit TargetMesh(const Mesh& of)
        : mesh(of),
          tracer(of),
          size_mm(glm::length(bounds_of(of).high - bounds_of(of).low)),
          middle_mm(0.5 * (bounds_of(of).low + bounds_of(of).high)),
          coarse(sample_mesh(of, tracer, kCoarse * size_mm)),
          fine(sample_mesh(of, tracer, kFine * size_mm)),
          tree(fine.points),
          free(free_turns(fine, kCoarse * size_mm)) {}
};

/// The scan made ready: without what lies on planes larger than any of the product.
struct Haystack {
    const Scan& scan;
    const std::vector<Sight>& sights;
    SurfaceSamples coarse, fine;
    Image8 ignored;
};

Haystack haystack_of(const Scan& scan, const std::vector<Sight>& sights, const TargetMesh& target) {
    const double spacing = 0.5 * kCoarse * target.size_mm;
    const SurfaceSamples all = sample_scan(scan, spacing);
    const SurfaceSamples mesh = thinned(target.fine, spacing);
    const std::size_t largest = std::max<std::size_t>(30, largest_plane(mesh, spacing) * 13 / 10);
    const std::vector<std::uint8_t> background = on_large_planes(all, spacing, largest);

    // A pixel is of the background when its nearest sample is.
    const NearestSample tree(all.points);
    Haystack result{scan, sights, {}, {}, Image8(scan.projector.width, scan.projector.height, 1)};
    SurfaceSamples rest;
    const auto rows = static_cast<std::size_t>(scan.projector.height);
    parallel_for(rows, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * static_cast<std::size_t>(scan.projector.width);
             i < end * static_cast<std::size_t>(scan.projector.width);
             ++i) {
            const float* p = &scan.points_mm.values[3 * i];
            const float* n = &scan.normals.values[3 * i];
            if (!std::isfinite(p[0])) continue;
            const auto nearest = tree.of({p[0], p[1], p[2]}, 2.0 * spacing);
            if (!nearest || !background[*nearest]) continue;
            const glm::dvec3 normal = all.normals[*nearest];
            const glm::dvec3 apart = glm::dvec3(p[0], p[1], p[2]) - all.points[*nearest];
            const bool along =
                !std::isfinite(n[0]) || glm::dot(normal, glm::dvec3(n[0], n[1], n[2])) > 0.9;
            if (along && std::abs(glm::dot(apart, normal)) < 0.25 * spacing)
                result.ignored.values[i] = 1;
        }
    });
    for (std::size_t i = 0; i < scan.sigma_mm.values.size(); ++i) {
        const float *p = &scan.points_mm.values[3 * i], *n = &scan.normals.values[3 * i];
        if (result.ignored.values[i] || !std::isfinite(p[0]) || !std::isfinite(n[0])) continue;
        rest.points.emplace_back(p[0], p[1], p[2]);
        rest.normals.emplace_back(n[0], n[1], n[2]);
    }
    result.coarse = thinned(rest, kCoarse * target.size_mm);
    result.fine = thinned(rest, 2.5 * kFine * target.size_mm);
    return result;
}

PoseEvidence judged(const TargetMesh& target,
                    const Haystack& haystack,
                    const Rigid3& pose,
                    int rays) {
    return evidence_of(target.tracer,
                       target.mesh,
                       pose,
                       haystack.scan,
                       haystack.sights,
                       haystack.ignored,
                       kNear * target.size_mm,
                       stride_for(haystack.scan.projector, rays));
}

bool are_same(const TargetMesh& target, const Rigid3& a, const Rigid3& b) {
    return same_pose(a, b, target.free, target.middle_mm, 8.0 * kDegree, kSame * target.size_mm);
}

/// Sorted by how well they fit; each pose once.
std::vector<PoseCandidate> candidates_of(const TargetMesh& target,
                                         const Haystack& haystack,
                                         const std::optional<Rigid3>& start,
                                         const Progress& progress) {
    progress.update(0.2, "looking for the product in the scan");
    std::vector<PoseGuess> guesses =
        poses_by_pairs(target.coarse, haystack.coarse, kCoarse * target.size_mm, kGuesses);
    if (start) guesses.push_back({*start, 0.0});
    std::vector<PoseCandidate> candidates(guesses.size());
    progress.update(0.4, "trying the poses that were found");
    parallel_for(guesses.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            progress.check_stop();
            const Aligned aligned = closest_points(target.fine,
                                                   target.tree,
                                                   haystack.coarse,
                                                   guesses[i].scan_from_mesh,
                                                   0.1 * target.size_mm,
                                                   0.03 * target.size_mm,
                                                   15);
            candidates[i] = {aligned.scan_from_mesh,
                             judged(target, haystack, aligned.scan_from_mesh, 8000)};
        }
    });
    const auto better = [](const PoseCandidate& a, const PoseCandidate& b) {
        return a.evidence.score() > b.evidence.score();
    };
    const auto keep_distinct = [&] {
        std::stable_sort(candidates.begin(), candidates.end(), better);
        std::vector<PoseCandidate> distinct;
        for (const PoseCandidate& one : candidates) {
            const bool known =
                std::any_of(distinct.begin(), distinct.end(), [&](const PoseCandidate& other) {
                    return are_same(target, one.scan_from_mesh, other.scan_from_mesh);
                });
            if (!known) distinct.push_back(one);
        }
        candidates = distinct;
    };
    keep_distinct();
    if (candidates.size() > kFinalists) candidates.resize(kFinalists);
    progress.update(0.5, "trying the poses that were found");
    parallel_for(candidates.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            progress.check_stop();
            candidates[i].scan_from_mesh = closest_points(target.fine,
                                                          target.tree,
                                                          haystack.fine,
                                                          candidates[i].scan_from_mesh,
                                                          0.04 * target.size_mm,
                                                          0.01 * target.size_mm,
                                                          25)
                                               .scan_from_mesh;
            candidates[i].evidence = judged(target, haystack, candidates[i].scan_from_mesh, 40000);
        }
    });
    keep_distinct();
    return candidates;
}

/// The mesh as a mirror shows it.
Mesh mirrored(Mesh mesh) {
    for (glm::vec3& point : mesh.positions_mm) point.x = -point.x;
    for (glm::vec3& normal : mesh.normals) normal.x = -normal.x;
    for (glm::uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    return mesh;
}

std::string shares(const PoseEvidence& evidence) {
    return fmt::format(
        "in the best pose found the scan confirms {:.0f}% of what would be seen of "
        "the mesh",
        100.0 * evidence.agreement());
}

[[noreturn]] void refuse_mirrored(const std::string& why) {
    throw Refused("the scan is the mirror image of the mesh: " + why,
                  "mirror the mesh (one axis of its file runs the other way), or switch off "
                  "mirroring in the projector or the camera");
}

[[noreturn]] void refuse_mesh(const TargetMesh& target,
                              const Haystack& haystack,
                              const std::vector<PoseCandidate>& found,
                              double least) {
    const std::string why =
        found.empty() ? "nothing in the scan has the shape of the mesh" : shares(found[0].evidence);
    const Mesh other = mirrored(target.mesh);
    const TargetMesh mirror(other);
    const auto reversed = candidates_of(mirror, haystack, std::nullopt, {});
    if (!reversed.empty() && reversed[0].evidence.agreement() >= least &&
        (found.empty() || reversed[0].evidence.score() > 1.2 * found[0].evidence.score()))
        refuse_mirrored(why);
    throw Refused("the mesh does not fit the scan: " + why, kOtherMesh);
}

void name_turns(const FreeTurns& free, std::vector<std::string>& warnings) {
    if (free.count == 3)
        warnings.emplace_back(
            "the product is a sphere: its three turns cannot be told from its "
            "shape and stay as they were found");
    if (free.count == 1)
        warnings.push_back(fmt::format(
            "the product is a surface of revolution about ({:.3f}, {:.3f}, {:.3f}): its "
            "turn about this axis cannot be told from its shape",
            free.axis.x,
            free.axis.y,
            free.axis.z));
}

/// The refined pose among those about as good by their evidence: details tell apart what the whole
/// does not. Poses that still fit alike are those of a symmetric product; of any other, refused.
PixelRefinement best_refined(const TargetMesh& target,
                             const Haystack& haystack,
                             const View& projector,
                             const std::vector<PoseCandidate>& found,
                             const LensPrior& prior,
                             const Progress& progress,
                             Registration& result) {
    constexpr std::size_t kMostPosesAlike = 6;
    std::vector<const PoseCandidate*> alike;
    for (const PoseCandidate& one : found)
        if (one.evidence.score() > 0.9 * found[0].evidence.score() &&
            alike.size() < kMostPosesAlike)
            alike.push_back(&one);
    std::vector<PixelRefinement> refined;
    std::vector<PoseEvidence> evidence;
    const int stride = stride_for(projector, 40000);
    for (const PoseCandidate* one : alike) {
        PixelRefinement next = refine_on_pixels(target.mesh,
                                                target.tracer,
                                                projector,
                                                haystack.sights,
                                                one->scan_from_mesh,
                                                haystack.ignored,
                                                prior,
                                                progress);
        if (!outline_of(target.tracer, next.projector, haystack.scan, stride).is_seen()) continue;
        refined.push_back(std::move(next));
        evidence.push_back(one->evidence);
    }
    if (refined.empty())
        throw Refused(
            "the mesh does not fit the scan: it agrees with a part of a larger plane, and "
            "its outline is nowhere to be seen",
            kOtherMesh);
    std::size_t best = 0;
    for (std::size_t k = 1; k < refined.size(); ++k)
        if (refined[k].misfit_px < refined[best].misfit_px) best = k;
    for (std::size_t k = 0; k < refined.size(); ++k) {
        if (k == best || refined[k].misfit_px > 1.15 * refined[best].misfit_px) continue;
        const Rigid3 motion =
            inverse(refined[best].projector.view_from_world) * refined[k].projector.view_from_world;
        const double turn = angle_of(motion.rotation) / kDegree;
        const glm::dvec3 axis = axis_of(motion.rotation);
        const double within_mm = 0.015 * target.size_mm;
        if (!maps_onto_itself(target.fine, target.tree, motion, within_mm))
            throw Refused(
                fmt::format("two poses of the mesh fit alike, {:.0f} degrees apart: {:.2f} and "
                            "{:.2f} projector pixels",
                            turn,
                            refined[best].misfit_px,
                            refined[k].misfit_px),
                "photograph from another position of the camera too (a second --captures), turn "
                "the mock-up so that what tells its ends apart is lit, or pick points (--points)");
        result.equal_motions.push_back(motion);
        result.warnings.push_back(fmt::format(
            "the product is symmetric to within {:.1f} mm: turned by {:.0f} degrees about ({:.2f}, "
            "{:.2f}, {:.2f}) it fits alike",
            within_mm,
            turn,
            axis.x,
            axis.y,
            axis.z));
    }
    result.evidence = evidence[best];
    return refined[best];
}

/// Where much of the mesh is not where its pixels are seen: whether its mirror image is.
void check_details(const TargetMesh& target,
                   const Haystack& haystack,
                   const View& projector,
                   const PixelRefinement& refined,
                   const LensPrior& prior,
                   const Progress& progress) {
    const double share =
        static_cast<double>(refined.inliers) / static_cast<double>(refined.correspondences);
    if (share > 0.97) return;
    progress.update(0.9, "comparing with the mesh's mirror image");
    const Mesh other = mirrored(target.mesh);
    const TargetMesh mirror(other);
    const auto reversed = candidates_of(mirror, haystack, std::nullopt, {});
    const std::string why =
        fmt::format("{:.0f}% of the pixels on it are seen where the mesh has them", 100.0 * share);
    if (!reversed.empty() && reversed[0].evidence.agreement() > 0.5) {
        const PixelRefinement image = refine_on_pixels(other,
                                                       mirror.tracer,
                                                       projector,
                                                       haystack.sights,
                                                       reversed[0].scan_from_mesh,
                                                       haystack.ignored,
                                                       prior);
        if (image.misfit_px < 0.7 * refined.misfit_px) refuse_mirrored(why);
    }
    if (share < 0.6)
        throw Refused("the mesh does not fit the scan: only " + why,
                      "check that this is the mock-up's mesh, and that the mock-up has not moved "
                      "since it was photographed");
}

}  // namespace

Registration register_scan(const Mesh& mesh,
                           const View& projector,
                           const std::vector<Sight>& sights,
                           const RegistrationOptions& options,
                           const Progress& progress) {
    progress.update(0.0, "triangulating the scan");
    const Scan scan = scan_of(projector, sights);
    progress.update(0.1, "sampling the mesh");
    const TargetMesh target(mesh);
    const Haystack haystack = haystack_of(scan, sights, target);
    const std::vector<PoseCandidate> found =
        candidates_of(target, haystack, options.start, progress);
    if (found.empty() || found[0].evidence.agreement() < options.least_agreement)
        refuse_mesh(target, haystack, found, options.least_agreement);
    constexpr int kLeastPixels = 1500;
    const int stride = stride_for(projector, 40000);
    const int pixels = found[0].evidence.agree * stride * stride;
    if (pixels < kLeastPixels)
        throw Refused(
            fmt::format("only about {} projector pixels fall on the product", pixels),
            "bring the projector nearer or zoom in, so that the product fills more of its picture");

    Registration result;
    result.free = target.free;
    name_turns(target.free, result.warnings);
    // Lenses that may give way take it up
    if (options.prior.lens_fixed) {
        result.warnings.insert(result.warnings.end(), scan.warnings.begin(), scan.warnings.end());
    }
    progress.update(0.6, "refining pose and lenses");
    result.refined =
        best_refined(target, haystack, projector, found, options.prior, progress, result);
    check_details(target, haystack, projector, result.refined, options.prior, progress);
    // The pose among the views that were given is what the sought lenses leave of it.
    Rigid3 camera_from_mesh = result.refined.cameras[0].view_from_world;
    camera_from_mesh.translation *= result.refined.mesh_scale;
    result.world_from_mesh = inverse(sights.front().camera.view_from_world) * camera_from_mesh;
    progress.update(1.0, "registered");
    return result;
}

}  // namespace livery
