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
    SpectralPaint paint_;
    f64::BsdfParameters bands_{};  ///< the parameters without spectra
    Spectrum diffuse_{};           ///< the coated diffuse layer's albedo, over its share
    double index_squared_ = 1.0;   ///< of the coat, inverse
    double largest_f0_ = 0.0;
};

}  // namespace livery
