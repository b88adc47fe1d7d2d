#include "support/jpeg.h"

// Chroma is halved only at a quality of 90 and less.
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace livery::testing {

std::string jpeg_of(const Image8& rgb) {
    std::string bytes;
    stbi_write_jpg_to_func(
        [](void* sink, void* data, int size) {
            static_cast<std::string*>(sink)->append(static_cast<const char*>(data),
                                                    static_cast<std::size_t>(size));
        },
        &bytes,
        rgb.width,
        rgb.height,
        3,
        rgb.values.data(),
        100);
    return bytes;
}

}  // namespace livery::testing
