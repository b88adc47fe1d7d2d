// The shading source (shaders/radiance/shade.glsl) on the processor, eight fragments at a time,
// compiled for several instruction sets and chosen at run time. Plain arrays only: the units behind
// this header may not share inline functions with the rest of the program.
#pragma once

#include <cstddef>
#include <cstdint>

namespace livery {

/// Fragments that are shaded together: inputs hold, for each block, its first channel's values,
/// then the next one's.
inline constexpr std::size_t kLaneBlock = 8;

/// Lobes that a model mirrors with, at most.
inline constexpr std::size_t kMostLobes = 3;

struct LaneJob {
    float exposure = 1.0f;
    const float* prepared = nullptr;          ///< PreparedPaint::numbers
    const float* lobe_layers = nullptr;       ///< 4 of each lobe, see u_lobe_layers of shade.glsl
    const float* eye = nullptr;               ///< 4 channels
    const float* const* lights = nullptr;     ///< 4 channels each
    const float* light_irradiance = nullptr;  ///< R, G, B of each
    const float* light_radius2 = nullptr;
    int light_count = 0;
    const std::uint16_t* lit = nullptr;  ///< half floats, 3 channels
    const std::uint16_t* sky = nullptr;  ///< the same
    /// The same for each layer; null: nothing is mirrored, or one that the paint does not read.
    const std::uint16_t* const* mirror = nullptr;
    float mirror_unit = 1.0f;
    const std::uint16_t* const* grazing = nullptr;  ///< after those layers: how much of it grazes
    const float* places = nullptr;  ///< 4 channels: position, side of a pixel there, in mm
    float glint_density = 0.0f;     ///< flakes on a mm^2 of the mock-up
    float* shaded = nullptr;        ///< R, G, B, 1 of each fragment
    /// Of a paint of an artwork, 4 channels: it is added with the weight of_colour * (R, G, B) +
    /// of_alpha * A, over of_cover * A less of what is there. Null: what is there is replaced.
    const float* artwork = nullptr;
    float of_colour = 1.0f, of_alpha = 0.0f, of_cover = 1.0f;
    std::size_t first_block = 0, end_block = 0;
};

using LaneFunction = void (*)(const LaneJob&);

struct LaneFunctions {
    const char* instruction_set;
    /// What shades a model that prepares this struct ("CarPaintPrepared"); null: none.
    LaneFunction (*of)(const char* prepared, bool environment, bool glints);
};

/// The best that this processor has, first; "portable" is always the last.
const LaneFunctions& best_lanes();
std::size_t lanes_available();
const LaneFunctions& lanes_available(std::size_t index);

}  // namespace livery
