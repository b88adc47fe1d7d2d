// What runs on the processor eight values at a time, compiled for several instruction sets and
// chosen at run time: the shading source (shaders/radiance/shade.glsl), fragment beside fragment,
// and sums over the nodes of a mirror quadrature (light/mirror_quadrature.h), node beside node.
// Plain arrays only: the units behind this header may not share inline functions with the rest of
// the program.
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

/// Nodes that are taken together: rows of the quadrature's table are as long as a multiple of it.
inline constexpr std::size_t kNodeBlock = 8;

/// What a row of the table holds of its nodes, one list after another: their half vectors, the
/// variance of their Gaussians, Fresnel's weight under the half angle and under the angle of
/// incidence, then their share in each lobe.
inline constexpr std::size_t kHalfVectorX = 0, kHalfVectorY = 1, kHalfVectorZ = 2, kVariance = 3,
                             kHalfAngleWeight = 4, kEntryWeight = 5, kFirstLobe = 6, kLastLobe = 19,
                             kRowLists = 20;

/// What is summed over nodes: R, G, B, then R + G + B times Fresnel's weight under the half angle
/// and under the angle of incidence.
inline constexpr std::size_t kNodeLists = 5;

/// One size of an environment's Gaussians: of each two that follow one another a picture, texels of
/// eight floats, four of each.
struct GaussianTexels {
    const float* texels = nullptr;
    int width = 0, height = 0;
    int count = 0;  ///< of Gaussians, one more than of pictures
};

/// Of a normal that mirrors: its frame, and the rows of the table that the eye's angle lies
/// between.
struct MirrorFacet {
    float x[3], y[3], normal[3], to_eye[3];
    float variance = 0.0f;  ///< on top of every node's
    const float* below = nullptr;
    const float* above = nullptr;
    float share = 0.0f;  ///< of the row above
};

struct MirrorSumJob {
    GaussianTexels sharp, wide;      ///< those of the latter follow the former
    float turns = 0.0f;              ///< of the environment about +y, and half of one
    float variance_of_first = 0.0f;  ///< rad^2, of the second of all Gaussians
    const MirrorFacet* facets = nullptr;
    std::size_t facet_count = 0;
    std::size_t nodes = 0;         ///< of each facet, a multiple of kNodeBlock
    const float* seen = nullptr;   ///< share of each node of each facet; null: all of all
    const float* width = nullptr;  ///< factor of its Gaussian's variance, where there is `seen`
    /// Lists of R, of G and of B over all facets: the light of nodes, in place of looking it up.
    const float* given = nullptr;
    /// Room for a mark of each block of given nodes, whether any light comes from there.
    unsigned char* lit = nullptr;
    const int* lobes = nullptr;    ///< to be summed
    const bool* grazes = nullptr;  ///< of each, whether what grazes is summed as well
    std::size_t lobe_count = 0;
    float* light = nullptr;  ///< room for kNodeLists numbers of each node
    float* sums = nullptr;   ///< kNodeLists of each lobe
};

/// Pictures of the whole sphere and of one size, texel beside texel of four floats.
struct SphereTexels {
    const float* texels = nullptr;
    int width = 0, height = 0;
    int count = 0;  ///< of pictures
};

/// What kNodeBlock fragments mirror by one look-up a lobe (light/mirrored_environment.h).
struct MirrorLookUpJob {
    SphereTexels sharp, wide;      ///< those of the latter follow the former
    float turns = 0.0f;            ///< of the environment about +y, and half of one
    float alpha2_of_first = 0.0f;  ///< squared slope parameter of the second of all pictures
    /// Lists of X, Y, Z to the eye and of the mean normal, then of what widens every lobe.
    const float* fragments = nullptr;
    struct Lobe {
        float alpha2 = 0.0f;
        float toward_mirrored = 1.0f;  ///< how far from the normal to the mirrored eye it is seen
        bool leans = false;            ///< no farther than that
        const float* correction = nullptr;  ///< by the root of the cosine, kCorrections of them
    };
    static constexpr int kCorrections = 33;
    const Lobe* lobes = nullptr;
    int lobe_count = 0;
    float* light = nullptr;  ///< R, G, B and one more of each fragment, lobe by lobe
};
inline constexpr std::size_t kLookUpLists = 7;
inline constexpr int kMostLookUps = 14;

using MirrorSum = void (*)(const MirrorSumJob&);
using MirrorLookUps = void (*)(const MirrorLookUpJob&);

struct LaneFunctions {
    const char* instruction_set;
    /// What shades a model that prepares this struct ("CarPaintPrepared"); null: none.
    LaneFunction (*of)(const char* prepared, bool environment, bool glints);
    MirrorSum sum_mirrored;
    MirrorLookUps look_up_mirrored;
};

/// The best that this processor has, first; "portable" is always the last.
const LaneFunctions& best_lanes();
std::size_t lanes_available();
const LaneFunctions& lanes_available(std::size_t index);

}  // namespace livery
