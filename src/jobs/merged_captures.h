// The photographs of one scene as one picture of its light, and the part of it that a sphere fills.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "calibration/captures/exposure_merge.h"
#include "calibration/sphere/sphere_outline.h"
#include "capture/captures_folder.h"
#include "core/progress.h"
#include "scene/view.h"

namespace livery {

/// Throws FileError, also for a photograph of another size than the camera's.
Photograph load_photograph_of(const Capture& capture, const View& camera);

struct MergedCaptures {
    MergedPhotographs picture;
    double clipped_light = 0.0;  ///< file units a second, in the shortest exposure
    /// Every pixel is saturated in every photograph.
    bool all_saturated() const;
};

/// `load` gives each of `captures` as it is to be merged, all of one size. Throws what it throws,
/// Cancelled.
MergedCaptures merge_captures(const std::vector<Capture>& captures,
                              const std::function<Photograph(const Capture&)>& load,
                              const Progress& progress = {});

/// The part of a photograph that the sphere fills, with a margin, and how the camera sees it.
struct SphereWindow {
    PictureWindow pixels;
    View view;
};

/// Pixels are averaged in blocks where the sphere is more than `most_across_px` wide. Throws
/// FileError that names `manifest` for a sphere that the camera does not see, or of less than 40
/// pixels.
SphereWindow window_around(const View& camera,
                           const Sphere& sphere,
                           double most_across_px,
                           const std::filesystem::path& manifest);

}  // namespace livery
