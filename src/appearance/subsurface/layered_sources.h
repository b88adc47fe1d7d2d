// A beam's sources in layers, the diffusion equation there for one wave number along the surface at
// a time, and where the light leaves.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "appearance/subsurface/diffusion.h"
#include "appearance/subsurface/scattering_stack.h"

namespace livery {

struct DiffusionLayer {
    Diffusion diffusion;
    std::optional<double> thickness_mm;
};

/// Layers between two boundaries at which the fluence vanishes z_b outside. Fluence and flux pass
/// from layer to layer as they are, as they do between equal indices.
class LayeredDiffusion {
  public:
    /// `top` and `bottom`: z_b and the exitance there, with the layers' own coefficients otherwise.
    /// Only the last layer may have no thickness.
    LayeredDiffusion(std::vector<DiffusionLayer> layers,
                     const Diffusion& top,
                     const Diffusion& bottom);

    /// What a source of power 1 at this depth in a layer makes leave, transformed (Hankel, order
    /// 0): over the whole plane at wave number 0.
    class Spectrum {
      public:
        Exitance of(std::size_t layer, double depth_in_layer_mm) const;

      private:
        friend class LayeredDiffusion;
        /// D phi'/phi of what lies beyond a depth, and what leaves beyond for each phi there.
        struct Side {
            double admittance = 0.0, exitance = 0.0;
        };
        struct Layer {
            double coefficient_mm, decay_per_mm;
            std::optional<double> thickness_mm;
            Side above, below;
        };
        static Side through(const Layer& layer, const Side& beyond, double distance_mm);
        std::vector<Layer> layers_;
    };
    Spectrum at(double per_mm) const;

  private:
    std::vector<DiffusionLayer> layers_;
    Diffusion top_, bottom_;
};

/// The same of a half space, for a source at this depth.
double half_space_spectrum(const Diffusion& diffusion, double depth_mm, double per_mm);

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
