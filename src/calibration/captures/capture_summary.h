// Photographs of a calibration made small: what the checks of a captures folder compare.
#pragma once

#include <string>
#include <vector>

#include "calibration/correspondence/gray_code.h"

namespace livery {

/// One photograph as means over square blocks of camera pixels, linear, per second, black taken
/// off.
struct CaptureSummary {
    std::string role;
    std::string name;                     ///< role, with the file's name where it is another
    ImageF colour;                        ///< RGB
    ImageF light;                         ///< mean of the three
    std::vector<std::uint8_t> saturated;  ///< one a block: 1 where any of its pixels is
    std::vector<std::uint8_t> unknown;    ///< one a block: 1 where any is not finite; 0 in light
    double mean = 0.0;                    ///< of light
    double taken_at = 0.0;                ///< when, in photographs
    double plateau = 0.0;  ///< largest file value, where many pixels stop exactly there, else 0
    double plateau_share = 0.0;  ///< of the pixels
    double saturates_at = 0.0;   ///< file units
    double full_light = 0.0;     ///< what full scale would be in light; infinite: not known
    bool has_black_level = false;
};

/// Side of a block in camera pixels: about 240 lie across a picture.
int summary_block_px(int picture_width);
CaptureSummary summarise(const RoledPhotograph& photograph);

/// A block that others are compared with: of the high-passed logarithm of a picture's light.
struct TextureBlock {
    int x = 0, y = 0;
    float value = 0.0f, gradient_x = 0.0f, gradient_y = 0.0f;
};

/// Those that `mask` (one channel) says count, away from the border.
std::vector<TextureBlock> texture_blocks(const ImageF& light, const Image8& mask);

/// By how many blocks `moved` is displaced against `still` (content at x in `still` is at x +
/// result in `moved`): least squares of high-passed logarithms, on which shading and brightness
/// have no say. NaN where there is nothing to hold on to.
glm::vec2 displacement(const std::vector<TextureBlock>& still, const ImageF& moved);

}  // namespace livery
