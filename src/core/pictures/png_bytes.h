// A picture as the bytes of a PNG: for files of other kinds that hold pictures.
#pragma once

#include <string>

#include "core/image.h"

namespace livery {

/// As write_png() of core/image_io.h, without a file. 1 or 3 channels; throws as that does.
std::string png_bytes(const Image8& image);

}  // namespace livery
