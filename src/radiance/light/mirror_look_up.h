// What fragments mirror of an environment by one look-up a lobe: for a light that is being moved,
// where sums over a lobe's nodes (mirrored_environment.h) would come too late.
#pragma once

#include <cstddef>

#include <glm/vec3.hpp>

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

    /// As MirroredEnvironment gives it; how much of the light grazes is taken to be as of even
    /// light. `environment` is the one that was filtered, turned and scaled as it may be.
    class In {
      public:
        In(const MirrorLookUp& layers, const Environment& environment, glm::dvec3 eye_mm);
        MirroredLight at_fragment(const Fragment& fragment, const MirrorLobes& lobes) const;

      private:
        const MirrorLookUp& layers_;
        SpherePlaces places_;
        float scale_;
        glm::dvec3 eye_mm_;
    };

  private:
    /// Where a lobe of this squared slope parameter lies among the layers.
    static float layer_of(float alpha2);
    glm::vec3 between(float layer,
                      const SphereStack::Footprint& sharp,
                      const SphereStack::Footprint& wide) const;

    std::size_t sharp_count_ = 0;
    SphereStack sharp_, wide_;
    float largest_ = 0.0f;
};

}  // namespace livery
