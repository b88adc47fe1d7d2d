// A colour calibration from a folder of photographs: what `livery calibrate color` does.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "calibration/colour/colour.h"
#include "capture/captures_folder.h"
#include "core/image.h"
#include "core/progress.h"
#include "mesh/mesh.h"
#include "scene/colour_calibration.h"
#include "scene/product.h"
#include "scene/view.h"

namespace livery {

/// cos(theta) / distance^2 (1/mm^2) of the surface that each projector pixel lights, its mean over
/// the lit part of the pixel; one channel, 0 where the mesh covers less than half of the pixel.
ImageF projector_irradiance(const Mesh& mesh, const View& projector, const Progress& progress = {});

struct CapturedCalibrationRequest {
    std::filesystem::path captures;            ///< or the folder of a capture in stages
    std::filesystem::path patterns_manifest;   ///< for folders without a manifest of their own
    std::optional<std::filesystem::path> map;  ///< else decoded from the same folder
    std::optional<std::filesystem::path> camera_to_xyz;
    ColourMode mode = ColourMode::robust;
    /// With both, pixels that the camera does not see are predicted (calibration/predict.h).
    std::shared_ptr<const Product> product;
    std::optional<View> projector;  ///< world: the product's frame
};

/// Throws FileError, Refused, std::invalid_argument.
ColourCalibration calibrate_from_folder(const CapturedCalibrationRequest& request,
                                        const Progress& progress = {});

/// `--map` files: EXR in projector pixels, channels X,Y = camera pixel (OpenCV centres), NaN where
/// unknown.
ProjectorToCamera read_map(const std::filesystem::path& file,
                           int projector_width,
                           int projector_height);
void write_map(const std::filesystem::path& file, const ProjectorToCamera& map);

}  // namespace livery
