// Pictures for people: XYZ as sRGB, difference maps, crops.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/bench_ports.h"
#include "core/image.h"

namespace livery {

/// Around all non-zero pixels of a mask, `margin_px` wider and inside the picture.
PixelRectangle bounds_of_mask(const Image8& mask, int margin_px);

/// A photograph's linear camera colour through `xyz_from_camera`, for showing it to people.
ImageF developed(const Photograph& photograph, const glm::dmat3& xyz_from_camera);

/// XYZ relative to `white_y` -> 8-bit sRGB, clipped.
Image8 srgb_from_xyz(const ImageF& xyz, double white_y);

/// Working-space colour (1 = white; alpha ignored) -> 8-bit sRGB, clipped: what an uncorrected
/// program would send to the projector.
Image8 srgb_from_working(const ImageF& working);
/// The same into a picture that is kept from frame to frame.
void srgb_from_working_into(const ImageF& working, Image8* srgb);

/// CIEDE2000 from 0 (dark) to `full_scale` (bright) in a perceptually even ramp; NaN is mid grey.
Image8 difference_map(const ImageF& de00, double full_scale);

/// A legend strip for difference_map, left 0 to right full scale.
Image8 difference_legend(int width, int height);

}  // namespace livery
