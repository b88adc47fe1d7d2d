// Sums over the nodes of a mirror quadrature (light/mirror_quadrature.h), eight nodes at a time,
// compiled for several instruction sets and chosen at run time. Plain arrays only: the units behind
// this header may not share inline functions with the rest of the program.
#pragma once

#include <cstddef>

namespace livery {

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

/// What kNodeBlock fragments mirror by one look-up a lobe (light/mirror_look_up.h).
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
/// The best that this processor has, first; "portable" is always the last.
struct MirrorSums {
    const char* instruction_set;
    MirrorSum sum;
    MirrorLookUps look_up;
};
const MirrorSums& best_mirror_sums();
std::size_t mirror_sums_available();
const MirrorSums& mirror_sums_available(std::size_t index);

}  // namespace livery
