// What leaves the projector: device values to light, pixel by pixel.
#pragma once

#include "core/image.h"
#include "twin/description.h"

namespace livery {

/// Light of one channel at a drive in [0, 1], 1 at full drive; `field_radius` is the distance from
/// the picture's middle over that of its corners.
double channel_light(const ProjectorDescription& projector,
                     int channel,
                     double drive,
                     double field_radius);

/// Light of each pixel: 4 channels (red, green, blue over their full light; the clear segment over
/// the luminance of full red + green + blue), leak and defocus included.
ImageF light_from_drive(const ProjectorDescription& projector, const Image8& drive);

}  // namespace livery
