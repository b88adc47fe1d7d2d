#include "jobs/registration.h"

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/captures/captures.h"
#include "calibration/correspondence/patterns.h"
#include "capture/captures_folder.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "jobs/captured_calibration.h"
#include "jobs/pair_geometry.h"
#include "mesh/ply_write.h"

namespace livery {

namespace {

/// Where the camera sees each projector pixel, by a folder's photographs.
ProjectorToCamera decoded(const std::filesystem::path& captures,
                          const std::filesystem::path& patterns_manifest,
                          const CalibratedPair& pair,
                          const std::filesystem::path& calibration,
                          std::vector<std::string>& warnings,
                          SeparatedLight& light,
                          const Progress& progress) {
    const CapturesFolder folder =
        read_shown_captures(captures, PhotographUse::places, patterns_manifest, warnings, progress);
    const int width = pair.projector.width, height = pair.projector.height;
    if (folder.projector_width > 0 &&
        (folder.projector_width != width || folder.projector_height != height))
        throw FileError(
            captures,
            "projector",
            fmt::format("{}x{}", folder.projector_width, folder.projector_height),
            fmt::format(
                "the {}x{} of {}", width, height, (calibration / "projector.json").string()));
    std::vector<std::string> roles;
    for (const Capture& capture : folder.captures) roles.push_back(capture.role);
    check_gray_code(captures, roles, width, height);
    check_fringes(captures, roles);
    Captures photographs;
    double done = 0.0;
    for (const Capture& capture : folder.captures) {
        progress.update(done / static_cast<double>(folder.captures.size()),
                        "reading " + capture.file.filename().string());
        done += 1.0;
        if (!is_geometry_role(capture.role)) continue;
        add_capture(photographs, {capture.role, load_photograph(capture)});
    }
    progress.check_stop();
    if (photographs.width != pair.camera.width)
        throw FileError(
            captures,
            "width",
            fmt::format("photographs of {} px", photographs.width),
            fmt::format(
                "the {} px of {}", pair.camera.width, (calibration / "camera.json").string()));
    return map_of_captures(photographs, width, height, warnings, &light);
}

/// The scan's frame as a product's: turned over, so that the picture's up is up.
Rigid3 product_from_camera(const Mesh& surface) {
    const Bounds box = bounds_of(surface);
    const glm::dmat3 turned_over(1, 0, 0, 0, -1, 0, 0, 0, -1);
    return {turned_over, -(turned_over * (0.5 * (box.low + box.high)))};
}

PickedPose picked_pose(const RegistrationRequest& request,
                       const CalibratedPair& pair,
                       const std::vector<MeshPick>& points,
                       std::string& picked_in,
                       const Progress& progress) {
    const Bounds box = bounds_of(request.product->mesh);
    const auto in = [&](const View& view, const char* name) {
        picked_in = name;
        return pose_from_points(view, points, box, progress);
    };
    if (request.pick_view == PickView::camera) return in(pair.camera, "camera");
    if (request.pick_view == PickView::projector) return in(pair.projector, "projector");
    std::optional<PickedPose> camera, projector;
    std::optional<Refused> refused;
    try {
        camera = in(pair.camera, "camera");
    } catch (const Refused& one) {
        refused = one;
    }
    try {
        projector = in(pair.projector, "projector");
    } catch (const Refused&) {
        if (!camera) throw *refused;
    }
    if (camera && projector && camera->rms_px < 2.0 * projector->rms_px &&
        projector->rms_px < 2.0 * camera->rms_px)
        throw Refused(fmt::format("the points fit the camera's picture ({:.2f} px) and the "
                                  "projector's ({:.2f} px) about alike",
                                  camera->rms_px,
                                  projector->rms_px),
                      "say where they were picked: --view camera or --view projector");
    const bool is_camera = camera && (!projector || camera->rms_px < projector->rms_px);
    picked_in = is_camera ? "camera" : "projector";
    return is_camera ? *camera : *projector;
}

}  // namespace

CalibratedPair read_calibrated_pair(const std::filesystem::path& folder) {
    return {read_camera_file(folder / "camera.json"), read_camera_file(folder / "projector.json")};
}

ScannedLight decode_light(const std::vector<std::filesystem::path>& captures,
                          const std::vector<std::filesystem::path>& calibrations,
                          const std::filesystem::path& patterns_manifest,
                          const Progress& progress) {
    check_argument(!captures.empty(), "expected a captures folder");
    check_argument(calibrations.size() == 1 || calibrations.size() == captures.size(),
                   fmt::format("--calibration: found {} folders, expected one, or one for each of "
                               "the {} captures folders",
                               calibrations.size(),
                               captures.size()));
    ScannedLight light;
    for (std::size_t k = 0; k < captures.size(); ++k) {
        const auto& calibration = calibrations[calibrations.size() == 1 ? 0 : k];
        const CalibratedPair pair = read_calibrated_pair(calibration);
        if (k == 0) light.projector = pair.projector;
        SeparatedLight& separated = light.separated.emplace_back();
        Sight sight{pair.camera,
                    decoded(captures[k],
                            patterns_manifest,
                            pair,
                            calibration,
                            light.warnings,
                            separated,
                            progress)};
        sight.camera.view_from_world = pair.camera.view_from_world *
                                       inverse(pair.projector.view_from_world) *
                                       light.projector.view_from_world;
        light.sights.push_back(std::move(sight));
    }
    return light;
}

ScanFiles scan_product(const ScannedLight& light,
                       double spacing_mm,
                       int without_planes,
                       const Progress& progress) {
    progress.update(0.0, "triangulating");
    ScanFiles result;
    result.scan = scan_of(light.projector, light.sights);
    const double pixel_mm = point_spacing(result.scan);
    result.removed = remove_planes(result.scan, without_planes);
    const int step = std::max(1, static_cast<int>(std::lround(spacing_mm / pixel_mm)));
    result.spacing_mm = step * pixel_mm;
    progress.update(0.6, "joining the points to a surface");
    result.surface = mesh_of_scan(result.scan, step);
    const View& camera = light.sights.front().camera;
    // From here on the camera's frame is the scan's.
    Mesh in_camera = result.surface;
    for (glm::vec3& place : in_camera.positions_mm)
        place = glm::vec3(camera.view_from_world * glm::dvec3(place));
    const Rigid3 product_from_world = product_from_camera(in_camera) * camera.view_from_world;
    for (glm::vec3& place : result.surface.positions_mm)
        place = glm::vec3(product_from_world * glm::dvec3(place));
    compute_normals(result.surface);
    compute_tangents(result.surface);
    const Rigid3 world_from_product = inverse(product_from_world);
    result.projector = light.projector;
    result.projector.view_from_world = light.projector.view_from_world * world_from_product;
    result.camera = camera;
    result.camera.view_from_world = camera.view_from_world * world_from_product;
    return result;
}

void write_scan(const std::filesystem::path& folder, const ScanFiles& scan) {
    std::filesystem::create_directories(folder);
    write_camera_file(folder / "camera.json", scan.camera);
    write_camera_file(folder / "projector.json", scan.projector);
    write_text_file(folder / "scan.ply", ply_bytes(scan.surface));
}

bool write_separated_light(const std::filesystem::path& folder, const ScannedLight& light) {
    bool written = false;
    for (std::size_t k = 0; k < light.separated.size(); ++k) {
        const SeparatedLight& one = light.separated[k];
        if (one.direct.empty()) continue;
        const std::string number = k == 0 ? "" : fmt::format("-{}", k + 1);
        std::filesystem::create_directories(folder);
        write_exr(folder / ("direct" + number + ".exr"), one.direct);
        write_exr(folder / ("global" + number + ".exr"), one.global);
        written = true;
    }
    return written;
}

RegisteredMockup register_mockup(const RegistrationRequest& request, const Progress& progress) {
    check_argument(!request.calibrations.empty(), "expected a calibration folder");
    const CalibratedPair pair = read_calibrated_pair(request.calibrations.front());
    RegisteredMockup result;
    RegistrationOptions options;
    options.prior = lens_prior_of(request.calibrations);
    options.prior.scale_free = request.scale_free;
    options.prior.lens_fixed = request.lens_fixed;
    if (!request.points.empty()) {
        progress.update(0.0, "fitting the picked points");
        result.points = read_picked_points(request.points);
        result.by_points = picked_pose(request, pair, result.points, result.picked_in, progress);
        const View& view = result.picked_in == "camera" ? pair.camera : pair.projector;
        options.start = inverse(view.view_from_world) * result.by_points->view_from_mesh;
        result.held_px = held_px(pair.projector,
                                 pair.projector.view_from_world * inverse(view.view_from_world),
                                 *result.by_points,
                                 bounds_of(request.product->mesh));
    }
    MockupPose& pose = result.pose;
    pose.product = request.product_name;
    result.camera = pair.camera;
    result.projector = pair.projector;
    if (request.captures.empty()) {
        pose.method = "points";
        pose.camera_from_product = pair.camera.view_from_world * *options.start;
        result.camera.view_from_world = pose.camera_from_product;
        result.projector.view_from_world = pair.projector.view_from_world * *options.start;
        pose.rms_px = result.by_points->rms_px;
        pose.rms_mm = result.by_points->rms_mm;
        pose.inliers = result.by_points->inliers.size();
        pose.covariance = result.by_points->covariance;
    } else {
        const ScannedLight light = decode_light(
            request.captures, request.calibrations, request.patterns_manifest, progress);
        result.by_scan =
            register_scan(request.product->mesh, light.projector, light.sights, options, progress);
        const PixelRefinement& refined = result.by_scan->refined;
        pose.method = "scan";
        pose.mesh_scale = refined.mesh_scale;
        result.camera = refined.cameras.front();
        result.projector = refined.projector;
        pose.camera_from_product = result.camera.view_from_world;
        pose.camera_from_product.translation *= refined.mesh_scale;
        pose.rms_px = refined.rms_px;
        pose.rms_mm = refined.rms_mm;
        pose.inliers = refined.inliers;
        pose.covariance = refined.covariance;
        pose.warnings = light.warnings;
        pose.warnings.insert(
            pose.warnings.end(), result.by_scan->warnings.begin(), result.by_scan->warnings.end());
    }
    if (result.by_points && result.by_points->bad)
        pose.warnings.push_back(
            fmt::format("{} of the points was left out: {:.0f} px from where "
                        "the others have it",
                        result.points[*result.by_points->bad].name,
                        result.by_points->bad_px));
    return result;
}

void write_registration(const std::filesystem::path& folder, const RegisteredMockup& mockup) {
    std::filesystem::create_directories(folder);
    write_camera_file(folder / "camera.json", mockup.camera);
    write_camera_file(folder / "projector.json", mockup.projector);
    write_pose_file(folder / "pose.json", mockup.pose);
}

}  // namespace livery
