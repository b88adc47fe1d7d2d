// The diffusion equation in layers, solved for one wave number along the surface at a time.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "appearance/subsurface/diffusion.h"

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

}  // namespace livery
