#include "jobs/camera_curve.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "calibration/camera_response.h"
#include "capture/transfer.h"
#include "core/error.h"
#include "core/paths.h"

namespace livery {
namespace {

std::filesystem::path file_of(Camera& camera) {
    std::string name = camera.state().model;
    if (name.empty()) return {};
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '-';
    return user_folder() / "cameras" / (name + ".json");
}

std::string transfer_of(Camera& camera) {
    const auto kept = kept_camera_curve(camera);
    return kept ? kept->string() : "srgb";
}

bool are_eight_bits(const std::vector<Photograph>& photographs) {
    return std::all_of(photographs.begin(), photographs.end(), [](const Photograph& photograph) {
        return photograph.saturates_at == 255.0 && photograph.image.channels == 3;
    });
}

}  // namespace

std::optional<std::filesystem::path> kept_camera_curve(Camera& camera) {
    const std::filesystem::path file = file_of(camera);
    std::error_code error;
    if (file.empty() || !std::filesystem::exists(file, error)) return std::nullopt;
    return file;
}

CameraCurve fit_camera_curve(
    Camera& camera, const BenchPorts& ports, int width, int height, const Progress& progress) {
    const std::filesystem::path file = file_of(camera);
    const std::string before = transfer_of(camera);
    try {
        camera.use_transfer("linear");
        const std::vector<Photograph> photographs =
            photograph_exposures(ports, width, height, progress);
        if (file.empty() || !are_eight_bits(photographs))
            throw Refused("this camera has no curve: its numbers are the sensor's",
                          "nothing needs to be done");
        const CameraResponse response = fit_camera_response(photographs);
        make_output_folder(file.parent_path());
        write_response(file, response.linear_from_file);
        camera.use_transfer(file.string());
        return {file, response.residual};
    } catch (...) {
        camera.use_transfer(before);
        throw;
    }
}

}  // namespace livery
