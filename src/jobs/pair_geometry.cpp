#include "jobs/pair_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/captures/captures.h"
#include "calibration/correspondence/fringe_decode.h"
#include "calibration/geometry/board_sight.h"
#include "calibration/geometry/solve_pair.h"
#include "calibration/registration/pair_pose.h"
#include "capture/captures_folder.h"
#include "core/error.h"
#include "core/statistics.h"
#include "jobs/captured_calibration.h"

namespace livery {

namespace {

/// A pose that the others foretell worse than this, and four times worse than the median pose, was
/// photographed while something moved, or with another board.
constexpr double kOutlier_px = 2.0;
constexpr double kOutlierRatio = 4.0;

struct DecodedFolder {
    Captures captures;
    CameraToProjector code;
    std::vector<std::string> warnings;
};

/// Pixels whose stripes and inverse differ by less than `least` somewhere are not decoded.
void drop_weak_stripes(const Captures& captures, double least, ImageF& projector_px) {
    std::map<std::string, const ImageF*> by_role;
    for (const RoledPhotograph& one : captures.geometry)
        by_role.emplace(one.role, &one.photograph.image);
    for (const auto& [role, image] : by_role) {
        const auto inverse = by_role.find(role + "-inverse");
        if (inverse == by_role.end()) continue;
        for (std::size_t i = 0; i < image->values.size(); ++i) {
            const float apart = std::abs(image->values[i] - inverse->second->values[i]);
            if (static_cast<double>(apart) >= least) continue;
            projector_px.values[2 * i] = projector_px.values[2 * i + 1] =
                std::numeric_limits<float>::quiet_NaN();
        }
    }
}

DecodedFolder decoded_folder(const std::filesystem::path& path,
                             const PairGeometryRequest& request,
                             const Progress& progress) {
    DecodedFolder result;
    const CapturesFolder folder = read_shown_captures(
        path, PhotographUse::places, request.patterns_manifest, result.warnings, progress);
    const int width = request.projector_px.x, height = request.projector_px.y;
    if (folder.projector_width > 0 &&
        (folder.projector_width != width || folder.projector_height != height))
        throw FileError(path,
                        "projector",
                        fmt::format("{}x{}", folder.projector_width, folder.projector_height),
                        fmt::format("--projector {}x{}", width, height));
    std::vector<std::string> roles;
    for (const Capture& capture : folder.captures) roles.push_back(capture.role);
    check_gray_code(path, roles, width, height);
    check_fringes(path, roles);
    Captures& captures = result.captures;
    for (const Capture& capture : folder.captures) {
        progress.check_stop();
        if (!is_geometry_role(capture.role)) continue;
        add_capture(captures, {capture.role, load_photograph(capture)});
    }
    result.code = decode_places(captures.geometry, width, height, request.black_threshold).places;
    if (request.white_threshold >= 0.0)
        drop_weak_stripes(captures, request.white_threshold, result.code.projector_px);
    return result;
}

/// A tape finds the front of a lens; the ray's centre lies up to 20 mm behind or before it.
void check_lens_distance(const PairGeometryRequest& request, const PairGeometry& found) {
    constexpr double kTape_mm = 20.0, kTape = 0.05;
    const double tape_mm = request.lens_distance_mm;
    if (tape_mm <= 0.0) return;
    const double distance_mm = glm::length(inverse(found.projector.view_from_world).translation);
    if (std::abs(distance_mm - tape_mm) <= std::max(kTape_mm, kTape * tape_mm)) return;
    throw Refused(
        fmt::format("the lenses are {:.0f} mm apart by squares of {:.2f} mm and {:.0f} mm "
                    "by the tape",
                    distance_mm,
                    request.board.square_mm,
                    tape_mm),
        fmt::format("measure a square of the print: by the tape its side is {:.2f} mm; "
                    "give --square-mm as it is, or measure the lenses' distance again",
                    request.board.square_mm * tape_mm / distance_mm));
}

PairGeometry from_boards(const PairGeometryRequest& request, const Progress& progress) {
    PairGeometry result;
    result.from_boards = true;
    std::vector<BoardSight> sights;
    std::vector<std::size_t> pose_of;
    PictureSize camera;
    const PictureSize projector{request.projector_px.x, request.projector_px.y};
    for (std::size_t k = 0; k < request.captures.size(); ++k) {
        progress.update(0.8 * static_cast<double>(k) / static_cast<double>(request.captures.size()),
                        "reading " + request.captures[k].string());
        BoardPose& pose = result.poses.emplace_back();
        pose.folder = request.captures[k].string();
        SightSearch search;
        try {
            const DecodedFolder folder = decoded_folder(request.captures[k], request, progress);
            for (const std::string& warning : folder.warnings)
                result.warnings.push_back(pose.folder + ": " + warning);
            const ImageF& map = folder.code.projector_px;
            const PictureSize size{map.width, map.height};
            if (camera.width == 0) camera = size;
            if (size.width != camera.width || size.height != camera.height)
                throw FileError(
                    request.captures[k],
                    "size",
                    fmt::format("photographs of {}x{} px", size.width, size.height),
                    fmt::format("the {}x{} px of the other poses", camera.width, camera.height));
            search = search_sight(folder.captures.geometry, map, request.board, progress);
        } catch (const Refused& refused) {
            search.reason = refused.why() + "; " + refused.fix();
        }
        pose.reason = search.reason;
        pose.corners = search.corners;
        pose.edge_px = search.edge_px;
        pose.moved_px = search.moved_px;
        if (!search.sight) continue;
        sights.push_back(std::move(*search.sight));
        pose_of.push_back(k);
    }
    const auto without = [&](std::size_t k, const std::string& reason) {
        result.poses[pose_of[k]].reason = reason;
        sights.erase(sights.begin() + static_cast<std::ptrdiff_t>(k));
        pose_of.erase(pose_of.begin() + static_cast<std::ptrdiff_t>(k));
    };
    if (sights.size() < 4) {
        std::string why = fmt::format("{} of {} folders show the board and its Gray code",
                                      sights.size(),
                                      request.captures.size());
        for (const BoardPose& pose : result.poses)
            if (!pose.reason.empty()) why += fmt::format("; {}: {}", pose.folder, pose.reason);
        throw Refused(why, "four poses or more are needed, the board tilted otherwise in each");
    }

    // The worst pose is left out as long as the others foretell it badly.
    CheckedPair chosen;
    double done = 0.8;
    for (;;) {
        progress.update(done, "fitting lenses and poses");
        // Half of what is left, since nobody knows how often a pose is left out.
        const double then = 0.5 * (1.0 + done);
        chosen = solve_leaving_each_out(sights, camera, projector, progress.part(done, then));
        done = then;
        const auto worst = static_cast<std::size_t>(
            std::max_element(chosen.held_out_px.begin(), chosen.held_out_px.end()) -
            chosen.held_out_px.begin());
        const double off = chosen.held_out_px[worst];
        if (off < std::max(kOutlier_px, kOutlierRatio * median(chosen.held_out_px))) break;
        if (sights.size() <= 4)
            throw Refused(fmt::format("the other poses foretell that of {} {:.1f} px off",
                                      result.poses[pose_of[worst]].folder,
                                      off),
                          "photograph it again with nothing moving, the same board and a flat one");
        without(
            worst,
            fmt::format("the other poses foretell it {:.1f} px off: something moved, or another "
                        "board or a bent one was photographed",
                        off));
    }
    for (std::size_t k = 0; k < sights.size(); ++k) {
        BoardPose& pose = result.poses[pose_of[k]];
        pose.used = true;
        pose.rms_px = chosen.held_out_px[k];
    }
    const PairSolution& solution = chosen.solution;
    result.camera = solution.camera;
    result.projector = solution.projector;
    result.camera_rms_px = solution.camera_rms_px;
    result.projector_rms_px = solution.projector_rms_px;
    result.stereo_rms_px = std::sqrt(0.5 * (solution.camera_rms_px * solution.camera_rms_px +
                                            solution.projector_rms_px * solution.projector_rms_px));
    result.held_out_rms_px = chosen.held_out_rms_px;
    result.camera_standard_error_px = solution.camera_standard_error_px;
    result.projector_standard_error_px = solution.projector_standard_error_px;
    result.information = solution.information;
    result.turn_standard_error_rad = solution.turn_standard_error_rad;
    result.shift_standard_error_mm = solution.shift_standard_error_mm;
    check_lens_distance(request, result);
    return result;
}

PairGeometry from_data_sheets(const PairGeometryRequest& request, const Progress& progress) {
    check_argument(request.captures.size() == 1,
                   fmt::format("--captures: found {} folders, expected one without a board",
                               request.captures.size()));
    const DecodedFolder folder = decoded_folder(request.captures.front(), request, progress);
    const DataSheets& sheets = *request.data_sheets;
    PairGeometry result;
    result.warnings = folder.warnings;
    result.camera =
        camera_of(sheets, folder.code.projector_px.width, folder.code.projector_px.height);
    result.projector = projector_of(sheets, request.projector_px.x, request.projector_px.y);
    const ProjectorToCamera map =
        invert_map(folder.code, request.projector_px.x, request.projector_px.y);
    const PairPose pair =
        pose_of_pair(result.camera, result.projector, map, sheets.lens_distance_mm, 1, progress);
    result.projector.view_from_world = pair.projector_from_camera;
    result.stereo_rms_px = pair.median_px;
    return result;
}

}  // namespace

PairGeometry find_pair_geometry(const PairGeometryRequest& request, const Progress& progress) {
    check_argument(!request.captures.empty(), "expected a captures folder");
    if (request.data_sheets) return from_data_sheets(request, progress);
    check_board(request.board);
    return from_boards(request, progress);
}

}  // namespace livery
