// How a photograph was exposed, as its file tells it.
#pragma once

#include <filesystem>
#include <string>

namespace livery {

/// 0: the file does not say.
struct ExposureSettings {
    double time_s = 0.0, f_number = 0.0, iso = 0.0;
    bool operator==(const ExposureSettings&) const = default;
};

/// Whether both say how they were exposed, and not alike: a value that both have differs by more
/// than it may be rounded. Cameras on manual write the same numbers into every file.
bool are_exposed_otherwise(const ExposureSettings& a, const ExposureSettings& b);

/// By how many powers of two `a` was exposed more than `b`: log2 of time ISO / f-number^2, of what
/// both have.
double stops_over(const ExposureSettings& a, const ExposureSettings& b);

/// "1/125 s, f/8, ISO 200", of what it has.
std::string text_of(const ExposureSettings& settings);

/// From the file's head alone: EXIF of JPEG, TIFF and RAW, and EXR's fields of the same names. PNG
/// and HDR say nothing. Throws FileError.
ExposureSettings read_exposure_settings(const std::filesystem::path& file);

}  // namespace livery
