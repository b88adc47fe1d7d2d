// Photographs of one scene with several exposures -> one picture of its light; and those of one
// role as one picture that can be compared with other roles'.
#pragma once

#include "calibration/correspondence/gray_code.h"
#include "core/bench_ports.h"
#include "core/image.h"

namespace livery {

/// A rectangle of a picture in whole blocks of pixels, each of which becomes one.
struct PictureWindow {
    int left = 0, top = 0;
    int width = 0, height = 0;  ///< in blocks
    int block = 1;
};

/// The window's mean values. A block with a saturated pixel is saturated. Throws
/// std::invalid_argument for a window that reaches over the picture's edge.
Photograph windowed(const Photograph& photograph, const PictureWindow& window);

/// Light is counts / seconds, in file units a second. What a linear sensor counts are photons,
/// whose variance is their number: total counts over total time is then the mean with
/// inverse-variance weights, and the weights (the times) do not depend on the noisy values
/// themselves.
struct MergedPhotographs {
    ImageF counts;   ///< RGB, file units over black, of the exposures that did not saturate there
    ImageF seconds;  ///< RGB, their time; 0 where all saturated
};

/// The least light, file units a second, of a pixel that counts as saturated there.
double clipped_light(const Photograph& photograph);

/// Throws std::invalid_argument for another size.
void add(const Photograph& photograph, MergedPhotographs& merged);

/// Mean of the channels, NaN where one of them is at 98% of full scale or more: of a clipped fringe
/// nothing can be said, while stripes are read by their signs.
ImageF unsaturated_mean(const Photograph& photograph);

/// Mean over the photographs of `role` and their channels, in file units as if exposed like `like`;
/// one channel; fringes are NaN where they are saturated. Throws FileError for another size than
/// like's, std::invalid_argument where there is no such photograph.
ImageF exposed_alike(const std::vector<RoledPhotograph>& photographs,
                     const std::string& role,
                     const RoledPhotograph& like);

}  // namespace livery
