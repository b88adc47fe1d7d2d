#include "jobs/synthetic_calibration.h"

#include <cmath>
#include <limits>

#include <glm/matrix.hpp>

#include "core/colour.h"

namespace livery {

ColourCalibration synthetic_calibration(const ImageF& coverage) {
    ColourCalibration calibration;
    calibration.width = coverage.width;
    calibration.height = coverage.height;
    calibration.mode = "robust";
    calibration.made_with = "synthetic, for timing";
    calibration.xyz_from_camera = xyz_from_rec709();
    calibration.xyz_origin = "assumed Rec.709";
    calibration.unmixing = ImageF(coverage.width, coverage.height, 9);
    calibration.dark = ImageF(coverage.width, coverage.height, 3);
    calibration.span = ImageF(coverage.width, coverage.height, 3);
    calibration.status = Image8(coverage.width, coverage.height, 1);
    calibration.camera_px =
        ImageF(coverage.width, coverage.height, 2, std::numeric_limits<float>::quiet_NaN());
    const glm::dmat3 unmixing =
        glm::inverse(glm::dmat3(1.0, 0.12, 0.02, 0.18, 1.0, 0.15, 0.03, 0.2, 1.0));
    for (int y = 0; y < coverage.height; ++y) {
        for (int x = 0; x < coverage.width; ++x) {
            if (coverage.at(x, y) < 0.5f) continue;
            calibration.status.at(x, y) = static_cast<std::uint8_t>(PixelStatus::measured);
            const float scale =
                0.6f + 0.4f * static_cast<float>(x) / static_cast<float>(coverage.width);
            for (int c = 0; c < 3; ++c) {
                calibration.span.at(x, y, c) = scale;
                calibration.dark.at(x, y, c) = 0.001f;
                for (int k = 0; k < 3; ++k) {
                    calibration.unmixing.at(x, y, 3 * c + k) = static_cast<float>(unmixing[k][c]);
                }
            }
        }
    }
    for (ResponseCurve& curve : calibration.response) {
        curve.drive_from_n.resize(1024);
        for (std::size_t i = 0; i < curve.drive_from_n.size(); ++i) {
            const float n = static_cast<float>(i) / 1023.0f;
            curve.drive_from_n[i] = 255.0f * std::pow(n, 1.0f / 2.2f);
        }
    }
    calibration.valid_fraction = 1.0;
    return calibration;
}

}  // namespace livery
