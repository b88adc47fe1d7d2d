#include "jobs/calibrate/calibration_folder.h"

#include <limits>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"
#include "core/image_io.h"
#include "core/json.h"
#include "core/paths.h"
#include "core/replace_folder.h"
#include "scene/mockup_mask.h"

namespace livery {

namespace {

constexpr const char* kFile = "origin.json";
constexpr const char* kRoom = "room.json";
constexpr const char* kAround = "around.exr";

ImageF read_plane(const std::filesystem::path& file, int channels = 1) {
    ImageF plane = read_image(file).image;
    if (plane.channels != channels)
        throw FileError(file, "channels", std::to_string(plane.channels), std::to_string(channels));
    return plane;
}

/// What is no longer known must not be read with what is new.
void write_or_remove(const std::filesystem::path& file, const ImageF& plane) {
    if (!plane.empty()) {
        write_exr(file, plane);
        return;
    }
    std::error_code error;
    std::filesystem::remove(file, error);
    if (error) throw FileError(file, "", error.message(), "a file that can be removed");
}

ImageF around_of(const RoomPose& room, const Mesh& mesh) {
    ImageF around = room.seen.map.camera_px;
    if (around.empty()) return around;
    const Image8 mockup = mockup_mask(mesh, room.geometry.projector);
    for (std::size_t i = 0; i < mockup.values.size(); ++i)
        if (mockup.values[i] || room.seen.map.edge.values[i])
            around.values[2 * i] = around.values[2 * i + 1] =
                std::numeric_limits<float>::quiet_NaN();
    return around;
}

}  // namespace

CalibrationOrigin origin_of(const CalibrationResult& made, const CalibrationSettings& settings) {
    CalibrationOrigin origin;
    if (settings.product) origin = origin_for(*settings.product, settings.made_with);
    origin.made_with = settings.made_with;
    if (made.room) {
        origin.room = made.room->geometry;
        if (settings.product) origin.around = around_of(*made.room, settings.product->mesh);
    }
    if (!made.white.image.empty())
        origin.ends = drift_reference(made.white, made.black, made.latency_photographs);
    origin.capture_seconds = made.all_captured().all;
    origin.solve_seconds = made.all_solve_seconds();
    return origin;
}

CalibrationOrigin origin_for(const Product& product, const std::string& made_with) {
    CalibrationOrigin origin;
    origin.product = product.name;
    origin.shape = shape_hash(product.mesh);
    origin.made_with = made_with;
    return origin;
}

void write_origin(const std::filesystem::path& folder, const CalibrationOrigin& origin) {
    Json json = {{"format_version", kOriginVersion},
                 {"kind", "origin"},
                 {"product", origin.product},
                 {"shape", origin.shape},
                 {"made_with", origin.made_with},
                 {"capture_seconds", origin.capture_seconds},
                 {"solve_seconds", origin.solve_seconds}};
    if (origin.ends) {
        json["ends"] = {{"exposure_s", origin.ends->exposure_s},
                        {"late", origin.ends->late},
                        {"light", json_from(origin.ends->light)}};
        write_exr(folder / "white.exr", origin.ends->white);
        write_exr(folder / "black.exr", origin.ends->black);
    }
    if (!origin.reposed_from.empty()) json["reposed_from"] = origin.reposed_from;
    write_or_remove(folder / kAround, origin.around);
    if (origin.room) write_room_file(folder / kRoom, *origin.room);
    write_json_file(folder / kFile, json);
}

std::optional<CalibrationOrigin> read_origin(const std::filesystem::path& folder,
                                             bool with_photographs) {
    std::error_code error;
    const auto file = folder / kFile;
    if (!std::filesystem::exists(file, error)) return std::nullopt;
    CalibrationOrigin origin = parse_origin(read_text_file(file), file);
    if (origin.ends && with_photographs) {
        origin.ends->white = read_plane(folder / "white.exr");
        origin.ends->black = read_plane(folder / "black.exr");
    }
    if (std::filesystem::exists(folder / kRoom, error))
        origin.room = read_room_file(folder / kRoom);
    if (with_photographs && origin.room && std::filesystem::exists(folder / kAround, error)) {
        origin.around = read_plane(folder / kAround, 2);
        const View& view = origin.room->projector;
        if (origin.around.width != view.width || origin.around.height != view.height)
            throw FileError(folder / kAround,
                            "size",
                            fmt::format("{}x{}", origin.around.width, origin.around.height),
                            fmt::format("{}x{}, as the projector", view.width, view.height));
    }
    return origin;
}

std::string another_product(const CalibrationOrigin& origin, const Product& product) {
    if (origin.shape.empty() || origin.product == product.name ||
        origin.shape == shape_hash(product.mesh))
        return "";
    return fmt::format("the calibration was made for {}, not for {}", origin.product, product.name);
}

std::vector<std::string> what_changed(const CalibrationOrigin& origin,
                                      const Product& product,
                                      const std::string& projector) {
    std::vector<std::string> changes;
    if (const std::string other = another_product(origin, product); !other.empty())
        changes.push_back(other + ": calibrate again");
    else if (!origin.shape.empty() && origin.shape != shape_hash(product.mesh))
        changes.push_back(
            fmt::format("the mesh of {} has changed since: calibrate again", product.name));
    // A simulated bench's projector has no name that a monitor could have.
    const bool names_monitor = origin.made_with.find(" at ") != std::string::npos;
    if (!projector.empty() && names_monitor &&
        origin.made_with.find(projector) == std::string::npos)
        changes.push_back(fmt::format(
            "it was made with {}, and the projector is {}: choose that projector, or calibrate "
            "again",
            origin.made_with,
            projector));
    return changes;
}

namespace {

constexpr const char* kProjectorFile = "projector.json";

}  // namespace

void write_setup(const std::filesystem::path& folder,
                 const ColourCalibration& calibration,
                 const View& projector) {
    check_projector(projector, folder / kProjectorFile, calibration.width, calibration.height);
    FolderReplacement replacement(folder);
    write_camera_file(replacement.staging() / kProjectorFile, projector);
    write_calibration(replacement.staging(), calibration);
    replacement.commit("calibration.json");
}

std::optional<View> projector_view_of(const std::filesystem::path& calibration_folder) {
    const auto file = calibration_folder / kProjectorFile;
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return std::nullopt;
    return read_camera_file(file);
}

void add_projector(const std::filesystem::path& calibration_folder,
                   const std::filesystem::path& camera_file) {
    const View view = read_camera_file(camera_file);
    const ColourCalibration calibration = read_calibration(calibration_folder);
    check_projector(view, camera_file, calibration.width, calibration.height);
    write_camera_file(calibration_folder / kProjectorFile, view);
}

void check_projector(const View& view,
                     const std::filesystem::path& camera_file,
                     int calibration_width,
                     int calibration_height) {
    if (view.width == calibration_width && view.height == calibration_height) return;
    throw FileError(
        camera_file,
        "width, height",
        fmt::format("{} x {}", view.width, view.height),
        fmt::format("{} x {}, as the calibration", calibration_width, calibration_height));
}

}  // namespace livery
