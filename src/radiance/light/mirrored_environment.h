// What fragments mirror of an environment: past the product by the nodes of a quadrature, and by
// one look-up a lobe for a light that is being moved.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "radiance/lanes/lane_functions.h"
#include "radiance/light/environment_filter.h"
#include "radiance/light/mirror_lobes.h"
#include "radiance/light/mirror_quadrature.h"
#include "radiance/light/mirror_visibility.h"
#include "radiance/light/sphere_lookup.h"
#include "radiance/smooth_runs.h"
#include "radiance/surface_map.h"

namespace livery {

/// Layers that are asked for, and the lobes that they are made of.
class MirrorLobes {
  public:
    explicit MirrorLobes(const MirrorLayers& layers);
    const MirrorLayers& layers() const { return layers_; }
    std::size_t count() const { return count_; }
    const int* lobes() const { return lobes_.data(); }
    const bool* grazes() const { return grazes_.data(); }
    std::size_t place_of(std::size_t lobe) const { return place_[lobe]; }

  private:
    MirrorLayers layers_;
    std::size_t count_ = 0;
    std::array<int, kMirrorAlphas.size()> lobes_{};
    std::array<bool, kMirrorAlphas.size()> grazes_{};
    std::array<std::size_t, kMirrorAlphas.size()> place_{};  ///< of each lobe among lobes_
};

/// Of the lobes of kMirrorAlphas, the mean radiance of the environment over the fragment's mirror
/// lobe, times mirror_correction(). Of kHalfAngleLobes, then kEntryLobes: how many times as much of
/// the light stands where Fresnel's term is high as does of even light.
using MirroredLight = std::array<glm::vec3, kMirrorLayers>;

class MirroredEnvironment {
  public:
    /// Without `visibility` nothing is hidden, and a pixel has one normal. What hides the
    /// environment sends what `product` says; without hits it is black.
    MirroredEnvironment(const Environment& environment,
                        const FilteredEnvironment& filtered,
                        const Mesh& mesh,
                        const SurfaceMap& map,
                        glm::dvec3 eye_mm,
                        const MirrorVisibility* visibility,
                        const MirroredProduct& product = {});

    bool knows_what_hides() const { return visibility_ != nullptr; }

    /// For one thread.
    class Scratch {
        friend class MirroredEnvironment;
        std::vector<FragmentNeighbours::Neighbour> neighbours;
        std::vector<float> seen_nodes;        ///< share of each node
        std::vector<glm::vec3> hidden_light;  ///< of the rest: what the product sends, by its share
        std::vector<float> seen, width;  ///< by place: the same, and of its Gaussian's variance
        std::vector<float> in_the_way;   ///< by colour and place: hidden_light
        std::vector<float> light;
        std::vector<unsigned char> lit;  ///< blocks of nodes
        std::array<float, kNodeLists * kMirrorAlphas.size()> sums{}, of_product{};
    };
    /// Sums over the nodes that see the environment, to be kept: kSumsALobe numbers a lobe.
    static constexpr std::size_t kSumsALobe = kNodeLists;
    /// Layers that are not asked for are left black. `sums`, if there are any, take the
    /// environment's; where those are `known` only the product's light is summed.
    MirroredLight at_fragment(std::size_t fragment,
                              const MirrorLobes& lobes,
                              Scratch& scratch,
                              std::span<float> sums = {},
                              bool known = false) const;

  private:
    /// Whether any node is hidden, and what the product sends from there; unless that alone is
    /// asked for, also by how much each is.
    bool find_seen(std::size_t fragment, bool light_alone, Scratch& scratch) const;
    void ask_neighbours(std::size_t fragment, Scratch& scratch) const;
    void ask_itself(const MirrorVisibility::Alone& alone, Scratch& scratch) const;
    /// None: the fragment does not look for itself.
    const MirrorVisibility::Alone* find_alone(std::size_t fragment) const;
    /// What one that looks for itself has found: every other turn's word, from its own on, and
    /// where each one's hits begin.
    struct AloneWords {
        const MirrorVisibility::Alone* of = nullptr;
        std::size_t turn = 0;
        std::array<std::uint32_t, MirrorQuadrature::kTurns / 2> first{};
    };
    AloneWords words_of(const MirrorVisibility::Alone& alone) const;
    /// What is sent along the ray of a word's bit, if it is set; the word's hits begin at `first`.
    glm::vec3 sent_at(std::uint64_t word, std::uint8_t bit, std::uint32_t first) const;
    std::uint32_t first_hit(std::size_t fragment) const {
        return product_.hits ? product_.hits->first[fragment] : 0;
    }

    float scale_;
    MirrorSumJob job_;
    GaussianLayers layers_;
    const Mesh& mesh_;
    const SurfaceMap& map_;
    glm::dvec3 eye_mm_;
    const MirrorVisibility* visibility_;
    MirroredProduct product_;
    std::optional<MirrorQuadrature> unoccluded_;
    const MirrorQuadrature& quadrature_;
    std::optional<FragmentNeighbours> neighbours_;
};

/// An environment under the lobes of kLayerAlphas as each is seen along the normal, looked up where
/// the mean normal mirrors the eye: Karis, Real shading in Unreal Engine 4 (2013). What a lobe
/// loses is that it grows long where it is seen at a slant, that it is not even across that length,
/// and all that hides the environment.
class MirrorLookUp {
  public:
    /// Of filter_environment(), with what is `mirrored`.
    explicit MirrorLookUp(const FilteredEnvironment& filtered);

    /// Of the environment's brightest texel, in its own units.
    float largest() const { return largest_; }

    /// What lobes mirror for one eye. `environment` is the one that was filtered, turned and scaled
    /// as it may be.
    class In {
      public:
        In(const MirrorLookUp& layers,
           const Environment& environment,
           glm::dvec3 eye_mm,
           const MirrorLobes& lobes,
           const LaneFunctions& with = best_lanes());
        /// Of kNodeBlock fragments at most: as MirroredEnvironment gives it, but that light is
        /// taken to graze as even light does, and layers that are not asked for are ones.
        void at_fragments(std::span<const Fragment* const> fragments,
                          std::array<MirroredLight, kNodeBlock>& light) const;

      private:
        std::array<std::size_t, kMirrorAlphas.size()> layers_{};  ///< of each lobe
        std::array<MirrorLookUpJob::Lobe, kMirrorAlphas.size()> lobes_{};
        MirrorLookUpJob job_;
        MirrorLookUps look_up_;
        float scale_;
        glm::vec3 eye_mm_;
    };

  private:
    SphereStack sharp_, wide_;
    float largest_ = 0.0f;
};

}  // namespace livery
