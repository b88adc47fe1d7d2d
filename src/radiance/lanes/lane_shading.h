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

/// The uniforms of shade.glsl.
struct PaintUniforms {
    float exposure, diffuse[3], sky_diffuse[3], f0[3], alpha[4], base_layers[4], coat_layers[4];
    float flakes[4], flakes_most[3], flake_layers[4], film[2];  ///< film[0] > 0: it has one
    float coat_log_transmittance[3], coat_inverse_index_squared;
};

struct LaneJob {
    PaintUniforms paint;
    const float* eye = nullptr;               ///< 4 channels
    const float* const* lights = nullptr;     ///< 4 channels each
    const float* light_irradiance = nullptr;  ///< R, G, B of each
    const float* light_radius2 = nullptr;
    int light_count = 0;
    const std::uint16_t* lit = nullptr;            ///< half floats, 3 channels
    const std::uint16_t* sky = nullptr;            ///< the same
    const std::uint16_t* const* mirror = nullptr;  ///< the same for each layer
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

struct LaneFunctions {
    const char* instruction_set;
    void (*lambert)(const LaneJob&);
    void (*ggx[2])(const LaneJob&);        ///< without and with an environment
    void (*clearcoat[2])(const LaneJob&);  ///< the same
    void (*car_paint[2])(const LaneJob&);  ///< the same
    void (*car_paint_glints[2])(const LaneJob&);
};

/// The best that this processor has, first; "portable" is always the last.
const LaneFunctions& best_lanes();
std::size_t lanes_available();
const LaneFunctions& lanes_available(std::size_t index);

}  // namespace livery
