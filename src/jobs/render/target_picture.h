// `--target`: a wanted picture in projector pixels.
#pragma once

#include <filesystem>

#include "core/image.h"

namespace livery {

struct TargetPicture {
    ImageF wanted;  ///< working space, coverage in the fourth channel
    bool has_coverage = false;
};

/// Linear Rec.709 floats -> working space with coverage: 1 where the file has no A, by which colour
/// is multiplied where it has one (associated alpha). NaN and Inf stay: the compensation counts
/// them as invalid. Throws FileError (size, integers, channels).
TargetPicture read_target_picture(const std::filesystem::path& file, int width, int height);

}  // namespace livery
