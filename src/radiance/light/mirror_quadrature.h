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

#include <glm/vec3.hpp>

#include "core/memory.h"
#include "radiance/lanes/lane_functions.h"
#include "radiance/light/mirror_lobes.h"
#include "radiance/light/sphere_lookup.h"

namespace livery {

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
/// As wide as long for so many nodes a ring; 0: few, where nothing is hidden.
MirrorRings mirror_rings(int nodes);
/// In place of nodes a ring: no sum, one look-up a lobe (mirrored_environment.h).
inline constexpr int kNoNodes = -1;
/// What a fragment then costs: looks up the environment, and traces.
int mirror_nodes(int nodes);
int mirror_rays(int nodes);

class MirrorQuadrature {
  public:
    /// Node k belongs to facet k % kFacets, so that each gets as many of each ring. There are a
    /// multiple of kFacets nodes.
    static constexpr std::size_t kFacets = 4;

    /// What is kept of a node, in the order of a row's lists (lanes/lane_functions.h).
    using Node = std::array<float, kRowLists>;
    /// What shade.glsl takes those weights to be on the mean over lobes of even light.
    struct Even {
        std::array<Texel, kGrazingLayers> of;  ///< kHalfAngleLobes, then kEntryLobes
    };

    explicit MirrorQuadrature(const MirrorRings& rings);

    int nodes() const { return nodes_; }  ///< a ring
    std::size_t count() const { return count_; }
    /// Places of a facet's nodes in a row's lists: the last few stand for none, and have no weight.
    std::size_t places() const { return places_; }
    /// Of node k among those of all facets.
    std::size_t place_of(std::size_t k) const { return k % kFacets * places_ + k / kFacets; }

    /// Nodes as an eye sees them whose direction has this sine to the normal, between two tabulated
    /// ones: their half vectors in their facet's frame (x the eye's projection, z the normal), of
    /// about unit length; the variance of the Gaussian over each one's cell, rad^2 along each axis;
    /// their share in each of kMirrorAlphas' lobes, all nodes together mirror_correction().
    class Row {
      public:
        /// A facet's lists, as sums over nodes read them.
        const float* below(std::size_t facet) const { return below_ + facet * facet_size_; }
        const float* above(std::size_t facet) const { return below(facet) + row_size_; }
        float share() const { return share_; }
        glm::vec3 half_vector(std::size_t k) const {
            return {of(k, kHalfVectorX), of(k, kHalfVectorY), of(k, kHalfVectorZ)};
        }
        /// What the widest lobe has nothing of has nothing to give.
        bool has_weight(std::size_t k) const { return of(k, kLastLobe) > 0.0f; }
        Even even() const;

      private:
        friend class MirrorQuadrature;
        float of(std::size_t k, std::size_t list) const {
            const float* at = below(k % kFacets) + list * places_ + k / kFacets;
            return at[0] + share_ * (at[row_size_] - at[0]);
        }
        const float* below_ = nullptr;
        const Even* even_ = nullptr;
        std::size_t places_ = 0, facet_size_ = 0, row_size_ = 0;
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

    void fill_row(std::size_t row, std::span<const Node> nodes);
    void find_beside(const MirrorRings& size);
    void share_out_rays(std::size_t rings, const MirrorRings& size);

    int nodes_ = 0;
    std::size_t count_ = 0, places_ = 0;
    LargeTable<float> rows_;  ///< row, facet, list, node
    std::vector<Even> even_;
    std::vector<Ray> rays_;
    std::vector<std::uint16_t> beside_;
    std::vector<std::array<std::uint8_t, kTurns>> nearest_;
    std::array<std::vector<std::size_t>, kTurns> traced_;
};

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
