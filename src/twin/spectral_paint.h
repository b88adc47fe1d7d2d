// The clearcoat model over all bands at once: what the bands share is computed once a direction
// pair.
#pragma once

#include "appearance/bsdf.h"
#include "twin/painted_sphere.h"

namespace livery {

class PaintBands {
  public:
    explicit PaintBands(const SpectralPaint& paint);
    void evaluate(const glm::dvec3& wi, const glm::dvec3& wo, Spectrum& result) const;

  private:
    /// A value that is a straight line in f0.
    struct Straight {
        double at_zero = 0.0, slope = 0.0;
    };
    /// What the interface leaves to the diffuse layer at a cosine.
    Straight kept_by_interface(double mu) const;

    SpectralPaint paint_;
    f64::BsdfParameters bands_{};  ///< the parameters without spectra
    Spectrum diffuse_{};           ///< the coated diffuse layer's albedo, over its share
    double index_squared_ = 1.0;   ///< of the coat, inverse
    double largest_f0_ = 0.0;
};

}  // namespace livery
