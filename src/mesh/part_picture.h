// Pictures along a part's own texture coordinates, as a mesh file has them.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "appearance/material.h"
#include "core/image.h"
#include "core/image_io.h"

namespace livery {

/// R, G, B, alpha from 0 to 1, rows down; colours as they are in the file, alpha 1 where it has
/// none.
struct ArtworkPicture {
    ImageF rgba;
    bool has_alpha = false;
    bool linear = false;  ///< of a floating-point file; else the colours are sRGB's
    std::filesystem::path file;

    double aspect() const { return static_cast<double>(rgba.height) / rgba.width; }
};

/// Of a picture's file, whatever channels it has. Throws FileError: values that are not finite,
/// other channels than colours, grey and alpha.
ArtworkPicture artwork_picture_of(const ImageFile& from, const std::filesystem::path& file);

/// What a mesh file says of a part beyond one paint. The picture lies along its texture
/// coordinates, again and again.
struct PartPicture {
    enum class Use {
        tint,       ///< the paint takes its colours where its alpha is
        roughness,  ///< its values squared scale the paint's slope parameters
        relief      ///< normals of the surface, `depth` times as steep
    };
    Use use = Use::tint;
    std::string name;
    Material paint;  ///< of all but a relief: what wears it
    std::shared_ptr<const ArtworkPicture> picture;
    double depth = 1.0;
};

}  // namespace livery
