// How a photograph was exposed, without its pixels.
#pragma once

#include <filesystem>

#include "core/pictures/exposure_settings.h"

namespace livery {

/// From the file's head alone: EXIF of JPEG, TIFF and RAW, and EXR's fields of the same names. PNG
/// and HDR say nothing. Throws FileError.
ExposureSettings read_exposure_settings(const std::filesystem::path& file);

}  // namespace livery
