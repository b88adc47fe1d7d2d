#include "jobs/calibrate/calibration_folder.h"

#include <system_error>

#include <fmt/format.h>

#include "core/error.h"
#include "core/replace_folder.h"

namespace livery {

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
