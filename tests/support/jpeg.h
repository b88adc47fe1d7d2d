// Pictures as cameras compress them.
#pragma once

#include <string>

#include "core/image.h"

namespace livery::testing {

/// RGB as a JPEG of the best quality, chroma at full resolution.
std::string jpeg_of(const Image8& rgb);

}  // namespace livery::testing
