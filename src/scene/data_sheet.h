// What an operator knows of projector and camera before anything is photographed.
#pragma once

#include "scene/view.h"

namespace livery {

/// From data sheets, the file of a photograph, and a tape.
struct DataSheets {
    double throw_ratio = 1.5;       ///< distance over the picture's width
    double lens_shift = 0.5;        ///< the picture's middle over the lens's axis, picture heights
    double focal_mm = 50.0;         ///< the camera's
    double sensor_width_mm = 36.0;  ///< of what the picture's width shows
    double lens_distance_mm = 0.0;  ///< from the projector's lens to the camera's
    bool operator==(const DataSheets&) const = default;
};

/// Lenses without distortion, at the world's origin, for pictures of so many pixels.
View projector_of(const DataSheets& sheets, int width, int height);
View camera_of(const DataSheets& sheets, int width, int height);

}  // namespace livery
