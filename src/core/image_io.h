// Pictures from and to files. The library behind it is loaded when first needed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/pictures/exposure_settings.h"

namespace livery {

/// A picture in the units of its file.
struct ImageFile {
    ImageF image;
    std::vector<std::string> channel_names;
    double full_scale = 1.0;  ///< 255 for 8 bit, 65535 for 16 bit, 1 for floating point
    bool floating_point = false;
    ExposureSettings settings;  ///< by its EXIF or like fields
};

/// Whether a file's suffix, in any case, is one of a picture or of a camera's RAW file.
bool has_picture_suffix(const std::filesystem::path& file);
/// Of a camera's RAW file.
bool is_raw_suffix(const std::filesystem::path& file);

/// Pixels of a picture that are read unless more are asked for.
inline constexpr std::size_t kMostPicturePixels = 100'000'000;

/// EXR, HDR, PNG, TIFF, JPEG, RAW. Values as stored: integers 0 to full_scale, floats untouched
/// (NaN and Inf included: the caller decides). Throws FileError; a declared size over
/// `max_pixels` is refused before anything is allocated. `raw_half`: of RAW one pixel of each
/// square of the colour filter, nothing interpolated.
ImageFile read_image(const std::filesystem::path& file,
                     std::size_t max_pixels = kMostPicturePixels,
                     bool raw_half = false);

/// The same of bytes that stand in another file, RAW apart; `name` stands in messages.
ImageFile read_image_bytes(std::string_view bytes,
                           const std::filesystem::path& name,
                           std::size_t max_pixels = kMostPicturePixels);

/// Linear float EXR (32 bit). channel_names defaults to R,G,B(,A) or Y.
void write_exr(const std::filesystem::path& file,
               const ImageF& image,
               const std::vector<std::string>& channel_names = {});

/// Device values as they are; no colour space tag, no alpha.
void write_png(const std::filesystem::path& file, const Image8& image);
void write_png(const std::filesystem::path& file, const Image16& image);

}  // namespace livery
