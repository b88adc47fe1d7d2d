// The GGX lobes for which fragments keep what they mirror, and which of them a paint reads.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <vector>

#include "appearance/material.h"
#include "appearance/model_table.h"
#include "scene/scene.h"

namespace livery {

/// Slope parameters for which each fragment keeps what it mirrors; paints in between interpolate.
inline constexpr std::array<float, 14> kMirrorAlphas{0.003f,
                                                     0.0055f,
                                                     0.01f,
                                                     0.02f,
                                                     0.03f,
                                                     0.042f,
                                                     0.06f,
                                                     0.085f,
                                                     0.12f,
                                                     0.17f,
                                                     0.24f,
                                                     0.34f,
                                                     0.5f,
                                                     1.0f};

/// Fresnel's term rises where light grazes, and a lobe at a slant takes light from grazing and from
/// steep directions: how bright each is decides what is reflected. Some lobes (of kMirrorAlphas)
/// keep that for each fragment, others interpolate (shade.glsl has the same): for the mirror's own
/// Fresnel term, under the half angle, and for that of a coat above, under the angle of incidence.
/// The former have more, since they make up for the errors of ggx_albedo_fit() as well.
using GrazingLobes = std::array<std::size_t, 3>;
inline constexpr std::array<GrazingLobes, 3> kHalfAngleLobes{{{3, 5, 6}, {7, 8, 9}, {10, 12, 13}}};
inline constexpr GrazingLobes kEntryLobes{6, 9, 12};
/// Layers of what is mirrored: the lobes, then how much of it grazes, three lobes a layer.
inline constexpr std::size_t kGrazingLayers = kHalfAngleLobes.size() + 1;
inline constexpr std::size_t kMirrorLayers = kMirrorAlphas.size() + kGrazingLayers;

/// How a lobe between the tabulated ones is mixed: of the four around it, or, in half of the time
/// and up to 6% too bright, of two.
enum class MirrorMixing { cubic, linear };
/// Of four lobes that follow one another, the share of each; what has none need not be there.
struct MirrorMix {
    int first = 0;
    std::array<float, 4> share{};
};
MirrorMix mirror_mix(double alpha, MirrorMixing mixing);

/// Whether a lobe needs what is mirrored at its roughness.
bool reads_layers(const PreparedPaint& paint, std::size_t lobe);

/// Some of those layers, in their order.
using MirrorLayers = std::bitset<kMirrorLayers>;
/// That shading a paint reads: none where it does not mirror.
MirrorLayers mirror_layers_of(const Material& paint, MirrorMixing mixing);
/// Of each part, for its paint and all paints of the artwork that lies over it.
std::vector<MirrorLayers> mirror_layers_of(const Scene& scene, MirrorMixing mixing);

/// What is solved of that, of each part.
struct SolvedMirror {
    MirrorMixing mixing = MirrorMixing::cubic;
    std::vector<MirrorLayers> of_part;

    /// Whether a scene can be drawn with no more than that, or at once: what a draft lacks is
    /// looked up while it draws.
    bool serves(const Scene& scene) const;
};

}  // namespace livery
