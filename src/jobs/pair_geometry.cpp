#include "jobs/pair_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/captures/captures.h"
#include "calibration/correspondence/fringe_decode.h"
#include "calibration/geometry/carry_corners.h"
#include "calibration/geometry/choose_model.h"
#include "calibration/geometry/find_board.h"
#include "calibration/registration/pair_pose.h"
#include "capture/captures_folder.h"
#include "core/error.h"
#include "core/paths.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr int kFormatVersion = 1;
/// A pose that the others foretell worse than this, and four times worse than the median pose, was
/// photographed while something moved, or with another board.
constexpr double kOutlier_px = 2.0;
constexpr double kOutlierRatio = 4.0;

struct DecodedFolder {
    CameraToProjector code;
    ImageF white;  ///< one channel
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
    const CapturesFolder folder = read_captures_folder(path);
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
    Captures captures;
    for (const Capture& capture : folder.captures) {
        progress.check_stop();
        if (!is_geometry_role(capture.role)) continue;
        add_capture(captures, {capture.role, load_photograph(capture)});
    }
    DecodedFolder result;
    result.code = decode_places(captures.geometry, width, height, request.black_threshold).places;
    if (request.white_threshold >= 0.0)
        drop_weak_stripes(captures, request.white_threshold, result.code.projector_px);
    for (const RoledPhotograph& one : captures.geometry)
        if (one.role == "white") result.white = mean_of_channels(one.photograph.image);
    return result;
}

double spacing_of(const std::vector<glm::dvec2>& corners, int columns) {
    std::vector<double> apart;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i)
        if ((i + 1) % static_cast<std::size_t>(columns) != 0)
            apart.push_back(glm::distance(corners[i], corners[i + 1]));
    return median(apart);
}

/// The board in one folder; `pose.reason` says why there is none.
std::optional<BoardSight> sight_of(const DecodedFolder& folder,
                                   const PairGeometryRequest& request,
                                   BoardPose& pose) {
    const glm::ivec2 size = request.board_corners;
    const std::vector<glm::dvec2> corners = find_board(folder.white, size.x, size.y);
    if (corners.empty()) {
        pose.reason = fmt::format(
            "no board of {}x{} inner corners in the white picture: all of it must be seen, flat, "
            "sharp and lit, with a white border",
            size.x,
            size.y);
        return std::nullopt;
    }
    // Nearly half of a square: what belongs to the neighbouring corner stays out.
    const double radius = std::max(4.0, 0.45 * spacing_of(corners, size.x));
    const auto carried = carry_corners(folder.code.projector_px, corners, radius);
    BoardSight sight;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        if (!carried[k]) continue;
        const auto column = static_cast<double>(k % static_cast<std::size_t>(size.x));
        const auto row = static_cast<double>(k / static_cast<std::size_t>(size.x));
        sight.board_mm.emplace_back(column * request.square_mm, row * request.square_mm);
        sight.camera_px.push_back(corners[k]);
        sight.projector_px.push_back(*carried[k]);
    }
    pose.corners = sight.board_mm.size();
    if (2 * pose.corners < corners.size()) {
        pose.reason = fmt::format(
            "only {} of its {} corners lie where the Gray code could be decoded: the projector "
            "must light the whole board, and its dark squares must not be black",
            pose.corners,
            corners.size());
        return std::nullopt;
    }
    return sight;
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
        std::optional<BoardSight> sight;
        try {
            const DecodedFolder folder = decoded_folder(request.captures[k], request, progress);
            const PictureSize size{folder.white.width, folder.white.height};
            if (camera.width == 0) camera = size;
            if (size.width != camera.width || size.height != camera.height)
                throw FileError(
                    request.captures[k],
                    "size",
                    fmt::format("photographs of {}x{} px", size.width, size.height),
                    fmt::format("the {}x{} px of the other poses", camera.width, camera.height));
            sight = sight_of(folder, request, pose);
        } catch (const Refused& refused) {
            pose.reason = refused.why() + "; " + refused.fix();
        }
        if (!sight) continue;
        sights.push_back(std::move(*sight));
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
    ChosenModel chosen;
    for (;;) {
        progress.update(0.9, "fitting lenses and poses");
        chosen = choose_model(sights, camera, projector);
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
    result.lens_model = chosen.model == LensModel::k1      ? "k1"
                        : chosen.model == LensModel::k1_k2 ? "k1 k2"
                                                           : "all five";
    return result;
}

PairGeometry from_data_sheets(const PairGeometryRequest& request, const Progress& progress) {
    check_argument(request.captures.size() == 1,
                   fmt::format("--captures: found {} folders, expected one without a board",
                               request.captures.size()));
    const DecodedFolder folder = decoded_folder(request.captures.front(), request, progress);
    const DataSheets& sheets = *request.data_sheets;
    PairGeometry result;
    result.camera = camera_of(sheets, folder.white.width, folder.white.height);
    result.projector = projector_of(sheets, request.projector_px.x, request.projector_px.y);
    const ProjectorToCamera map =
        invert_map(folder.code, request.projector_px.x, request.projector_px.y);
    const PairPose pair =
        pose_of_pair(result.camera, result.projector, map, sheets.lens_distance_mm, 1, progress);
    result.projector.view_from_world = pair.projector_from_camera;
    result.stereo_rms_px = pair.median_px;
    result.lens_model = "data sheets";
    return result;
}

Json matrix_of(const View& view) {
    return {view.focal_px.x,
            0.0,
            view.principal_px.x - 0.5,
            0.0,
            view.focal_px.y,
            view.principal_px.y - 0.5,
            0.0,
            0.0,
            1.0};
}

}  // namespace

PairGeometry find_pair_geometry(const PairGeometryRequest& request, const Progress& progress) {
    check_argument(!request.captures.empty(), "expected a captures folder");
    if (request.data_sheets) return from_data_sheets(request, progress);
    check_argument(std::isfinite(request.square_mm) && request.square_mm > 0.0,
                   fmt::format("--square-mm: found {}, expected more than 0", request.square_mm));
    return from_boards(request, progress);
}

Json figures_of(const PairGeometry& geometry) {
    const auto or_null = [&](double value) {
        return geometry.from_boards ? Json(value) : Json(nullptr);
    };
    Json poses = Json::array();
    for (const BoardPose& pose : geometry.poses)
        poses.push_back({{"folder", pose.folder},
                         {"used", pose.used},
                         {"reason", pose.reason},
                         {"corners", pose.corners},
                         {"rms_px", pose.used ? Json(pose.rms_px) : Json(nullptr)}});
    const Rigid3& pair = geometry.projector.view_from_world;
    return {{"made_from", geometry.from_boards ? "boards" : "data sheets"},
            {"lens_model", geometry.lens_model},
            {"camera_rms_px", or_null(geometry.camera_rms_px)},
            {"projector_rms_px", or_null(geometry.projector_rms_px)},
            {"stereo_rms_px", geometry.stereo_rms_px},
            {"held_out_rms_px", or_null(geometry.held_out_rms_px)},
            {"camera_matrix", matrix_of(geometry.camera)},
            {"camera_distortion", geometry.camera.distortion},
            {"camera_standard_error_px", geometry.camera_standard_error_px},
            {"projector_matrix", matrix_of(geometry.projector)},
            {"projector_distortion", geometry.projector.distortion},
            {"projector_standard_error_px", geometry.projector_standard_error_px},
            {"rotation", json_from(pair.rotation)},
            {"translation_mm", json_from(pair.translation)},
            {"poses", poses},
            {"refused", Json::array()}};
}

void write_pair_geometry(const std::filesystem::path& folder, const PairGeometry& geometry) {
    make_output_folder(folder);
    write_camera_file(folder / "camera.json", geometry.camera);
    write_camera_file(folder / "projector.json", geometry.projector);
    Json json = figures_of(geometry);
    json.erase("refused");
    json["format_version"] = kFormatVersion;
    json["kind"] = "geometry";
    write_json_file(folder / "geometry.json", json);
}

namespace {

/// Whether the calibration is one from boards.
bool read_made_from_boards(const std::filesystem::path& file) {
    const Json json = read_json_file(file);
    const JsonReader root(file, json);
    root.require_format_version(kFormatVersion);
    root["kind"].one_of({"geometry"});
    for (const char* matrix : {"camera_matrix", "projector_matrix", "rotation"})
        root[matrix].numbers(9);
    for (const char* lens : {"camera_distortion", "projector_distortion"}) root[lens].numbers(5);
    root["translation_mm"].numbers(3);
    root["stereo_rms_px"].number_between(0.0, 1e6);
    return root["made_from"].one_of({"boards", "data sheets"}) == 0;
}

}  // namespace

void check_geometry_file(const std::filesystem::path& file) { read_made_from_boards(file); }

LensPrior lens_prior_of(const std::filesystem::path& folder) {
    const auto file = folder / "geometry.json";
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return {};
    return read_made_from_boards(file) ? LensPrior{} : data_sheet_prior();
}

}  // namespace livery
