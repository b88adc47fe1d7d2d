// Decoded camera pixels sorted by the projector pixel that they see.
#pragma once

#include <vector>

#include "calibration/correspondence/gray_code.h"

namespace livery {

/// The camera pixels that decoded to one projector pixel, without those far from their median.
struct Bin {
    float count = 0.0f;
    float x = 0.0f, y = 0.0f;  ///< mean camera position
    float u = 0.0f, v = 0.0f;  ///< mean place, off the projector pixel's centre
};

struct Bins {
    int width = 0, height = 0;
    std::vector<Bin> bins;
    double camera_px_per_pixel = 1.0;  ///< along one axis

    const Bin* find(int x, int y) const {
        if (x < 0 || y < 0 || x >= width || y >= height) return nullptr;
        const Bin& bin = bins[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(x)];
        return bin.count > 0.0f ? &bin : nullptr;
    }
};

/// The decoded pixels (non-zero) without those that agree with fewer than two of the eight around
/// them to within `reach` projector pixels: in a shadow that other parts light, codes come out at
/// random and name places elsewhere.
Image8 without_strays(const CameraToProjector& decoded, double reach);

/// `kept` says which camera pixels count. Where some of a projector pixel's are known finely, the
/// others are left out of its mean.
Bins gather(const CameraToProjector& decoded, const Image8& kept, int width, int height);

}  // namespace livery
