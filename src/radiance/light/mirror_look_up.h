// What fragments mirror of an environment by one look-up a lobe: for a light that is being moved,
// where sums over a lobe's nodes (mirrored_environment.h) would come too late.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

#include "radiance/lanes/mirror_sums.h"
#include "radiance/light/environment_filter.h"
#include "radiance/light/mirrored_environment.h"
#include "radiance/light/sphere_lookup.h"
#include "radiance/surface_map.h"

namespace livery {

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
           const MirrorSums& with = best_mirror_sums());
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
