// What livery_image_io.so offers: the only code that links OpenImageIO, which pulls in hundreds of
// shared objects. core/image_io.cpp opens it when the first picture is read or written. Only plain
// data crosses this line; an exception never does.
#pragma once

#include <cstddef>

#include "core/pictures/exposure_settings.h"

namespace livery {

struct PictureHeader {
    int width = 0, height = 0, channels = 0;
    int integer_bits = 0;  ///< 8 or 16; 0: 32-bit floating point
    ExposureSettings settings;
};

/// One line, cut when longer.
struct PictureError {
    char text[512] = "";
};

/// A format's name to `open`: RAW, one pixel of each square of the colour filter.
inline constexpr const char* kRawHalf = "raw-half";

struct ImageIoTable {
    /// Reads a header of the format named, of a file or, where `bytes` is not null, of those, which
    /// stay there until `close`; null and the reason when it cannot.
    void* (*open)(const char* file,
                  const void* bytes,
                  std::size_t size,
                  const char* format,
                  PictureHeader*,
                  PictureError*);
    /// Valid until `close`.
    const char* (*channel_name)(void* picture, int channel);
    /// All pixels, in file units; false and the reason when it cannot.
    bool (*read)(void* picture, float* values, PictureError*);
    void (*close)(void* picture);

    /// Encodes to memory and hands the bytes to `sink` in one piece. `values` holds bytes, 16-bit
    /// integers or floats as the header says; `channel_names` may be null.
    bool (*encode)(const char* format,
                   const PictureHeader& header,
                   const void* values,
                   const char* const* channel_names,
                   void (*sink)(void* context, const void* bytes, std::size_t size),
                   void* context,
                   PictureError*);
};

inline constexpr const char* kImageIoTableSymbol = "livery_image_io_table";

}  // namespace livery
