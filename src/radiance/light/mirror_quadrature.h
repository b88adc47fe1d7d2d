// Directions and weights for the light that GGX lobes of all roughnesses mirror, one set for all.
//
// A lobe's mean radiance is an integral over the slopes of its half vectors: GGX's distribution of
// slopes times masking, a smooth factor. In slopes all lobes have one centre and differ in width
// alone, so rings whose radii grow by a constant factor serve each of them: every node stands for a
// cell as wide as it is long, over which the environment's mean is that of a Gaussian.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radiance/light/sphere_lookup.h"

namespace livery {

/// Slope parameters for which each fragment keeps what it mirrors; paints in between interpolate.
inline constexpr std::array<float, 12> kMirrorAlphas{
    0.01f, 0.02f, 0.03f, 0.042f, 0.06f, 0.085f, 0.12f, 0.17f, 0.24f, 0.34f, 0.5f, 1.0f};

/// Fresnel's term rises where light grazes, and a lobe at a slant takes light from grazing and from
/// steep directions: how bright each is decides what is reflected. Some lobes (of kMirrorAlphas)
/// keep that for each fragment, others interpolate (shade.glsl has the same): for the mirror's own
/// Fresnel term, under the half angle, and for that of a coat above, under the angle of incidence.
/// The former have more, since they make up for the errors of ggx_albedo_fit() as well.
using GrazingLobes = std::array<std::size_t, 3>;
inline constexpr std::array<GrazingLobes, 3> kHalfAngleLobes{{{1, 3, 4}, {5, 6, 7}, {8, 10, 11}}};
inline constexpr GrazingLobes kEntryLobes{4, 7, 10};
/// Layers of what is mirrored: the lobes, then how much of it grazes, three lobes a layer.
inline constexpr std::size_t kGrazingLayers = kHalfAngleLobes.size() + 1;
inline constexpr std::size_t kMirrorLayers = kMirrorAlphas.size() + kGrazingLayers;

/// A lobe between the tabulated ones: four that follow one another, and the share of each.
struct MirrorMix {
    int first = 0;
    std::array<float, 4> share{};
};
MirrorMix mirror_mix(double alpha);

/// What the lobe really returns of even light, over what ggx_albedo_fit() says (f0 = 1): the fit
/// may be too large, by up to .7%, but never too small. Whoever shades multiplies by the fit.
double mirror_correction(double cosine_to_eye, double alpha);

/// How fine: nodes a ring, a multiple of four, and the logarithm of the ratio of two rings' radii.
/// Gaussians as wide as their cells (overlap 1) would leave gaps between the nodes: how bright a
/// lamp is would depend on where it lies among them.
struct MirrorRings {
    int nodes = 0;
    double step = 0.0;
    double overlap = 1.0;
};
/// As wide as long for so many nodes a ring; 0: the draft's, where nothing is hidden.
MirrorRings mirror_rings(int nodes);
/// What a fragment then costs: looks up the environment, and traces.
int mirror_nodes(int nodes);
int mirror_rays(int nodes);

class MirrorQuadrature {
  public:
    /// Node k belongs to facet k % kFacets, so that each gets as many of each ring. There are a
    /// multiple of kFacets nodes.
    static constexpr std::size_t kFacets = 4;

    struct Node {
        /// Its half vector in its facet's frame (x the eye's projection, z the normal), of about
        /// unit length; then the variance of the Gaussian over its cell, rad^2 along each axis.
        Texel half_vector;
        /// Share in each of kMirrorAlphas' lobes; all nodes together have mirror_correction().
        std::array<Texel, kMirrorAlphas.size() / 4> weight;
        /// Fresnel's weight under the half angle and under the angle of incidence; two unused.
        Texel grazing;
    };
    /// What shade.glsl takes those weights to be on the mean over lobes of even light.
    struct Even {
        std::array<Texel, kGrazingLayers> of;  ///< kHalfAngleLobes, then kEntryLobes
    };

    explicit MirrorQuadrature(const MirrorRings& rings);

    int nodes() const { return nodes_; }  ///< a ring
    std::size_t count() const { return count_; }

    /// Nodes as an eye sees them whose direction has this sine to the normal, between two tabulated
    /// ones.
    class Row {
      public:
        Node node(std::size_t k) const;
        Even even() const;

      private:
        friend class MirrorQuadrature;
        const Node* below_ = nullptr;
        const Node* above_ = nullptr;
        const Even* even_ = nullptr;
        float share_ = 0.0f;
    };
    Row seen_under(float sine) const;

    /// A node whose ray each fragment traces: its facet's first one, which mirrors straight. It
    /// stands for the nodes close by. Other rays are shared out among neighbours.
    static constexpr std::uint8_t kStraight = 0xff;
    struct Ray {
        std::uint8_t turn = kStraight;  ///< which of kTurns fragments traces it, or kStraight
        std::uint8_t bit = 0;           ///< in that fragment's answer; the facet if straight
    };
    static constexpr std::size_t kTurns = 8;
    const Ray& ray(std::size_t k) const { return rays_[k]; }
    /// Those around it, among which its light is seen if any of them is hidden.
    std::span<const std::uint16_t> beside(std::size_t k) const {
        return {&beside_[k * kBeside], kBeside};
    }
    /// The bit of a fragment of another turn that comes closest.
    std::uint8_t nearest(std::size_t k, std::size_t turn) const { return nearest_[k][turn]; }
    /// Nodes that a fragment of this turn traces, by bit; the straight ones are the same in all.
    const std::vector<std::size_t>& traced(std::size_t turn) const { return traced_[turn]; }

  private:
    static constexpr std::size_t kBeside = 6;

    void find_beside(std::size_t rings);
    void share_out_rays(std::size_t rings, const MirrorRings& size);

    int nodes_ = 0;
    std::size_t count_ = 0;
    std::vector<Node> rows_;
    std::vector<Even> even_;
    std::vector<Ray> rays_;
    std::vector<std::uint16_t> beside_;
    std::vector<std::array<std::uint8_t, kTurns>> nearest_;
    std::array<std::vector<std::size_t>, kTurns> traced_;
};

// Inline: once for each of a fragment's nodes.

inline MirrorQuadrature::Node MirrorQuadrature::Row::node(std::size_t k) const {
    const Texel share{share_, share_, share_, share_};
    const auto between = [&](const Texel& a, const Texel& b) { return a + share * (b - a); };
    Node result;
    result.half_vector = between(below_[k].half_vector, above_[k].half_vector);
    for (std::size_t i = 0; i < result.weight.size(); ++i) {
        result.weight[i] = between(below_[k].weight[i], above_[k].weight[i]);
    }
    result.grazing = between(below_[k].grazing, above_[k].grazing);
    return result;
}

inline MirrorQuadrature::Even MirrorQuadrature::Row::even() const {
    const Texel share{share_, share_, share_, share_};
    const auto between = [&](const Texel& a, const Texel& b) { return a + share * (b - a); };
    Even even;
    for (std::size_t i = 0; i < even.of.size(); ++i) {
        even.of[i] = between(even_[0].of[i], even_[1].of[i]);
    }
    return even;
}

}  // namespace livery
