// Which channels of a picture are its colours: by their names, never by their places.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "core/image_io.h"

namespace livery {

/// Where red, green and blue are; one grey channel stands for all three. Throws FileError for a
/// picture of anything else, such as X, Y, Z.
std::array<int, 3> colour_channels(const std::filesystem::path& file, const ImageFile& picture);

/// Where the channel of that name is; -1 without one.
int channel_named(const ImageFile& picture, const std::string& name);

}  // namespace livery
