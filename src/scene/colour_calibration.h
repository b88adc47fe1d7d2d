// What a colour calibration is: an immutable value with an id, its residuals and its masks.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"

namespace livery {

/// Why a projector pixel carries a correction or not (one byte a pixel in `status`).
enum class PixelStatus : std::uint8_t {
    unlit = 0,      ///< nothing of the mock-up there, or outside the throw
    measured = 1,   ///< valid
    predicted = 2,  ///< hidden from the camera; pooled matrix and geometry; valid, marked
    too_dark = 3,   ///< T - S under 20 sigma or 0.5% of the maximum
    saturated = 4,  ///< camera at or over 98% of full scale
    ill_conditioned = 5,
    one_channel = 6,  ///< only some channels pass
    edge = 7,         ///< the camera pixel straddles a depth or part edge
    not_decoded = 8,
    filled =
        9,  ///< valid: measured at a place that agreeing neighbours gave, its own code was lost
};
inline bool is_valid(PixelStatus status) {
    return status == PixelStatus::measured || status == PixelStatus::predicted ||
           status == PixelStatus::filled;
}

/// rho of equation 8: projector drive (0..255) as a function of the invariant N, monotone,
/// sampled at `drive_from_n.size()` equally spaced N in [0, 1].
struct ResponseCurve {
    std::vector<float> drive_from_n;
    double largest_violation = 0.0;  ///< before isotonic regression, in N
};

/// For projectors that are not additive: separated colour per unit T-S for a grid of drives,
/// N = table(drive), and its inverse is searched at run time. `grid` points a side, red fastest.
struct DriveTable {
    int grid = 0;  ///< 0: the projector is additive and no table is used
    std::vector<glm::vec3> n_from_drive;
};

struct ColourCalibration {
    int width = 0, height = 0;                      ///< projector pixels
    std::string id;                                 ///< hash of the content; set by seal()
    std::string created;                            ///< ISO 8601, UTC
    std::string mode;                               ///< "paper" or "robust"
    std::string made_with;                          ///< captures folder or bench, for a person
    double dark_drive = 0.0, bright_drive = 255.0;  ///< s and t of the grey images

    // Equation 9 per projector pixel: N = (Vn^-1 C - S~) / (T~ - S~), C linear camera RGB.
    ImageF unmixing;   ///< 9 channels, Vn^-1 row by row (rows: separated channel; columns: camera)
    ImageF dark;       ///< 3 channels, S~ = Vn^-1 C_S
    ImageF span;       ///< 3 channels, T~ - S~; 0 where not valid
    Image8 status;     ///< PixelStatus
    ImageF camera_px;  ///< 2 channels, camera pixel (half-integer centres), NaN where unknown

    std::array<ResponseCurve, 3> response;
    DriveTable table;

    glm::dmat3 xyz_from_camera{1.0};  ///< of linear camera RGB, same scale for all pixels
    std::string xyz_origin;           ///< "primaries", "chart", "matrix" or "assumed Rec.709"
    glm::dvec3 camera_ambient{0.0};   ///< median C_S - leak where it is known, else 0

    // Residuals, all measured.
    double additivity_error = 0.0;
    double condition_p99 = 0.0;
    double valid_fraction = 0.0;      ///< measured and filled, of the lit pixels
    double ambient_fraction = 0.0;    ///< dark picture over bright picture, median
    double mixing_spread = 0.0;       ///< spatial spread of Vn over its noise
    double predicted_fraction = 0.0;  ///< of the measured and predicted pixels
    /// Relative error of T - S where measured pixels are predicted without their surroundings; 0
    /// when nothing was.
    double prediction_error_median = 0.0, prediction_error_p95 = 0.0;
    std::vector<std::string> warnings;  ///< each names what, the likely cause and the fix
};

/// Sets `id` from the content.
void seal(ColourCalibration& calibration);

/// One folder: calibration.json + EXR planes + status.png. Throws FileError (also when the id does
/// not match the content).
void write_calibration(const std::filesystem::path& folder, const ColourCalibration& calibration);
ColourCalibration read_calibration(const std::filesystem::path& folder);
/// What the text of its calibration.json holds: all but the planes. The id is as written.
ColourCalibration parse_calibration(const std::string& text, const std::filesystem::path& file);

}  // namespace livery
