#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>

#include "appearance/bsdf.h"
#include "appearance/material.h"
#include "core/image.h"
#include "core/progress.h"
#include "mesh/mesh.h"
#include "scene/look.h"
#include "scene/view.h"
#include "tracing/tracer.h"
#include "twin/spectra.h"

namespace livery {

/// A clear-coated paint, its colours as spectra. The parameters are those of the clearcoat model
/// (docs/materials.md); the coat itself is colourless.
struct SpectralPaint {
    std::string name;
    std::string family;  ///< solid, metallic
    Spectrum diffuse{};  ///< albedo of the diffuse layer
    Spectrum f0{};       ///< Fresnel reflectance of the base at normal incidence
    double alpha = 0.3;  ///< GGX slope parameter of the base
    double coat_alpha = 0.1;
    double coat_f0 = 0.04;
    std::string provenance;
};

/// A paint file (docs/bench.md), or the name of a shipped one ("silver-metallic"). Throws
/// FileError.
SpectralPaint read_spectral_paint(const std::filesystem::path& file_or_name);
/// The same of a file's text; its spectra lie beside the file.
SpectralPaint parse_spectral_paint(const std::string& text, const std::filesystem::path& file);

/// The names of the shipped paints, sorted.
std::vector<std::string> spectral_paint_names();

/// The clearcoat model over all bands at once: what the bands share is computed once a direction
/// pair.
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

/// The same paint for a renderer of three channels: each spectrum integrated under D65.
Material material_of(const SpectralPaint& paint);

/// Reflectance of every band for one pair of directions in local coordinates (z the normal), per
/// steradian, without the cosine: the clearcoat model band by band.
Spectrum evaluate_paint(const SpectralPaint& paint, const glm::dvec3& wi, const glm::dvec3& wo);

/// XYZ that the painted mesh sends to the eye, for what each pixel of `view` covers (3 channels;
/// the mean over `samples_a_side` squared samples that meet the mesh, 0 where none does). The
/// lights shine with D65; their colours must be neutral (std::invalid_argument). A white diffuser
/// that faces a light of radiance 1 has Y = 1. The sum over all bands is exact.
ImageF paint_radiance_xyz(const Mesh& mesh,
                          const Tracer& tracer,
                          const View& view,
                          glm::dvec3 eye_mm,
                          const SpectralPaint& paint,
                          std::span<const DirectionalLight> lights,
                          int samples_a_side = 2,
                          const Progress& progress = {});

}  // namespace livery
