// A beam's sources in layers, and where their light leaves.
#pragma once

#include <vector>

#include "appearance/subsurface/layered_diffusion.h"
#include "appearance/subsurface/scattering_stack.h"

namespace livery {

/// The layers for the diffusion equation. One that is thinner than a third of a mean free path, or
/// clear, gets the coefficient of one as long as it is thick: light cannot spread further in it
/// along the surface before it leaves. An endless clear layer is open space.
struct DiffusionStack {
    std::vector<DiffusionLayer> layers;
    Diffusion top, bottom;
    bool lost_below = false;  ///< what leaves at the bottom never arrives anywhere
};
DiffusionStack diffusion_stack(const ScatteringStack& stack,
                               Diffusion (*diffusion)(const ScatteringMedium&));

struct BeamSource {
    std::size_t layer = 0;
    double depth_in_layer_mm = 0.0, depth_mm = 0.0;
    double reduced_depth = 0.0;
    double power = 0.0;  ///< of the beam that scatters there; times the albedo at each
};
std::vector<BeamSource> beam_sources(const ScatteringStack& stack);

/// Photon beam diffusion (Habel, Christensen and Jarosz 2013) in layers: the improved diffusion of
/// a source at each depth. Near the beam the closed form of a half space of the first layer, and
/// the transform of what all others add (inverse_hankel).
class LayeredBeamDiffusion {
  public:
    /// A stack that scatters.
    explicit LayeredBeamDiffusion(const ScatteringStack& stack);

    Exitance at(double radius_mm) const;
    /// Over the whole plane, by quadrature over the radius.
    Exitance total() const;

  private:
    DiffusionStack layers_;
    LayeredDiffusion diffusion_;
    std::vector<BeamSource> sources_;
    std::vector<double> shortest_;  ///< way to a boundary of what is transformed, each source
    std::size_t in_first_ = 0;
    PointSources near_;
    double thickness_mm_ = 0.0, reduced_depth_ = 0.0;  ///< of a slab
    double mean_free_path_mm_ = 0.0, decay_per_mm_ = 0.0;
};

}  // namespace livery
