// Gray code photographs -> where each projector pixel is seen by the camera.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/bench_ports.h"
#include "core/image.h"
#include "core/progress.h"

namespace livery {

/// A photograph with the role of the pattern that it shows.
struct RoledPhotograph {
    std::string role;
    Photograph photograph;
};

/// Standard deviation of a place of which only the whole pixel is known: 1 / sqrt(12).
inline constexpr float kWholePixelError = 0.28867513f;

/// Where the light comes from that each camera pixel sees.
struct CameraToProjector {
    ImageF projector_px;  ///< camera pixels -> projector pixel (2 channels, centres at halves), NaN
    Image8 decoded;       ///< 255 where decoded
    /// Standard error of projector_px by the photographs' noise (2 channels, NaN where not
    /// decoded); kWholePixelError where only the whole pixel is known. Empty: it is so everywhere.
    ImageF sigma_px;
    double lit_fraction = 0.0;      ///< of the camera picture
    double decoded_fraction = 0.0;  ///< of the lit pixels
    double lit_threshold = 0.0;     ///< white - black over which a pixel counts as lit, file units
};

/// What decoding looks at: the mean of red, green and blue, or the one channel there is.
ImageF mean_of_channels(const ImageF& image);

/// Throws FileError where `roles`, those of photographs in `source`, lack one of this projector's
/// Gray code, or hold a finer bit, which means another projector. Other roles are ignored.
void check_gray_code(const std::filesystem::path& source,
                     const std::vector<std::string>& roles,
                     int projector_width,
                     int projector_height);

/// Decodes by the sign of each bit pair. `lit_threshold` is white - black in file units (mean of
/// the channels); negative picks it from the noise of the black picture. Lit pixels that answer
/// to the stripes with less than a third of white - black, or to more than three bits of an axis
/// with less than a fifth (lit by other parts only), are left out. Several photographs of one role
/// are averaged.
/// Throws Refused when too little decodes, FileError for unequal sizes and as check_gray_code().
CameraToProjector decode_gray_code(const std::vector<RoledPhotograph>& photographs,
                                   int projector_width,
                                   int projector_height,
                                   double lit_threshold = -1.0);

/// The same from pictures of one channel in the order of geometry_patterns(); nothing is converted
/// or copied.
CameraToProjector decode_gray_code(std::span<const Image8> in_pattern_order,
                                   int projector_width,
                                   int projector_height,
                                   double lit_threshold = -1.0);
CameraToProjector decode_gray_code(std::span<const Image16> in_pattern_order,
                                   int projector_width,
                                   int projector_height,
                                   double lit_threshold = -1.0);
CameraToProjector decode_gray_code(std::span<const ImageF> in_pattern_order,
                                   int projector_width,
                                   int projector_height,
                                   double lit_threshold = -1.0);

/// Standard deviation of a place in a map made from whole pixels, camera pixels.
inline constexpr double kMapError = 0.15;
/// The least that is believed of a finer one: lenses and surfaces are not affine over a window.
inline constexpr double kFineMapError = 0.02;

/// Projector pixels -> sub-pixel camera pixel (2 channels, centres at halves), NaN where unknown;
/// local fits that do not reach across depth or part edges. `edge` is 255 where the pixel's
/// neighbourhood breaks: the camera pixels around it see something else or were not decoded.
/// `filled` (empty: none) is 255 where the place is not the pixel's own but that of neighbours
/// which agree: its own camera pixels decoded wrongly or not at all, alone among theirs.
struct ProjectorToCamera {
    ImageF camera_px;
    Image8 edge;
    Image8 filled;
    double sigma_px = kMapError;  ///< standard deviation of camera_px along an axis, typical
};

/// Robust affine fits over 5 x 5 to 9 x 9 projector pixels, wider where the camera is coarser, with
/// parts of a pixel where `decoded` has them (sigma_px). `sigma_px` of the result is then the
/// median of what the fits' residuals say. A camera pixel that agrees with hardly any of its
/// neighbours counts as not decoded.
ProjectorToCamera invert_map(const CameraToProjector& decoded,
                             int projector_width,
                             int projector_height);

/// Whether the camera sees the projector's picture mirrored: the map turns its sense of rotation.
bool is_mirrored(const ProjectorToCamera& map);

}  // namespace livery
