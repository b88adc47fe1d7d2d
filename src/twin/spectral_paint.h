// The clearcoat model over all bands at once: what the bands share is computed once a direction
// pair.
#pragma once

#include "appearance/bsdf.h"
#include "twin/painted_sphere.h"

namespace livery {

class PaintBands {
  public:
    explicit PaintBands(const SpectralPaint& paint);

    /// What light meets at one of its two directions, given the cosine.
    struct Side {
        double passed = 0.0;             ///< through the coat
        double kept = 0.0, slope = 0.0;  ///< for the diffuse layer: kept + slope f0
    };
    Side side_of(double mu) const;

    /// Every band, per steradian, without the cosine.
    void evaluate(const glm::dvec3& wi, const glm::dvec3& wo, Spectrum& result) const;

    /// The sums of all bands times three curves, prepared once. A band's value is a polynomial in
    /// its f0 and its diffuse albedo, so that the sums need only their moments.
    struct Moments {
        glm::dvec3 white{0.0}, f0{0.0};                              ///< of 1 and f0
        glm::dvec3 diffuse{0.0}, diffuse_f0{0.0}, diffuse_f02{0.0};  ///< of d, d f0, d f0^2
    };
    Moments moments(const std::array<Spectrum, 3>& curves) const;
    glm::dvec3 evaluate(const Moments& moments,
                        const glm::dvec3& wi,
                        const glm::dvec3& wo,
                        const Side& side_i,
                        const Side& side_o) const;

  private:
    /// What all bands share at a pair of directions, Fresnel's weights included.
    struct Lobes {
        double coat = 0.0;
        double f0 = 0.0, grazing = 0.0;  ///< the base's lobe: f0 x this + this
    };
    bool lobes_at(const glm::dvec3& wi, const glm::dvec3& wo, Lobes& lobes) const;

    SpectralPaint paint_;
    f64::ClearcoatPrepared bands_{};  ///< for f0 of 0 and, in two channels, of the largest
    Spectrum diffuse_{};              ///< the coated diffuse layer's albedo, over its share
    double largest_f0_ = 0.0;
};

}  // namespace livery
