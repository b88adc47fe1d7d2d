#include "twin/spectral_paint.h"

#include <algorithm>
#include <numbers>

#include <glm/geometric.hpp>

#include "appearance/bsdf_source.h"
#include "core/colour.h"
#include "twin/painted_sphere.h"

namespace livery {

PaintBands::PaintBands(const SpectralPaint& paint) : paint_(paint) {
    bands_.coat_alpha = paint.coat_alpha;
    bands_.coat_f0 = paint.coat_f0;
    bands_.alpha_x = bands_.alpha_y = paint.alpha;
    bands_.coat_transmittance = glm::dvec3(1.0);
    largest_f0_ = *std::max_element(paint.f0.begin(), paint.f0.end());

    // The diffuse layer's part depends on no direction: three bands in each call of the model.
    index_squared_ = f64::coat_inverse_index_squared(bands_);
    for (std::size_t k = 0; k < kSpectrumCount; k += 3) {
        f64::BsdfParameters p = bands_;
        for (std::size_t c = 0; c < 3; ++c) {
            p.diffuse[static_cast<int>(c)] = paint.diffuse[k + c];
            p.f0[static_cast<int>(c)] = paint.f0[k + c];
        }
        const glm::dvec3 coated = f64::coated_diffuse(p, index_squared_);
        for (std::size_t c = 0; c < 3; ++c) diffuse_[k + c] = coated[static_cast<int>(c)];
    }
}

PaintBands::Straight PaintBands::kept_by_interface(double mu) const {
    // The interface's albedo is a straight line in f0: its ends come from one call of the model.
    f64::BsdfParameters p = bands_;
    p.f0 = glm::dvec3(0.0, largest_f0_, largest_f0_);
    const glm::dvec3 albedo = f64::ggx_interface_albedo(p, mu);
    const double slope = largest_f0_ > 0.0 ? (albedo.y - albedo.x) / largest_f0_ : 0.0;
    return {1.0 - albedo.x, -slope};
}

void PaintBands::evaluate(const glm::dvec3& wi, const glm::dvec3& wo, Spectrum& result) const {
    result.fill(0.0);
    if (wi.z <= 0.0 || wo.z <= 0.0) return;
    const glm::dvec3 h = wi + wo;
    const double hh = glm::dot(h, h);
    if (hh < 1e-8) return;

    // What all bands share.
    const double schlick = f64::schlick_weight(hh);
    const double coat_fresnel =
        paint_.coat_f0 * (1.0 - schlick) + f64::grazing_reflectance(paint_.coat_f0) * schlick;
    const double coat = coat_fresnel * f64::ggx_distribution_visibility(
                                           wi, wo, hh, paint_.coat_alpha, paint_.coat_alpha);
    const double passed =
        f64::coat_transmission(bands_, wi.z) * f64::coat_transmission(bands_, wo.z);
    const double lobe = f64::ggx_distribution_visibility(wi, wo, hh, paint_.alpha, paint_.alpha);
    const double f90 = f64::grazing_reflectance(largest_f0_);
    const Straight through_i = kept_by_interface(wi.z), through_o = kept_by_interface(wo.z);

    for (std::size_t k = 0; k < kSpectrumCount; ++k) {
        const double f0 = paint_.f0[k];
        const double specular = (f0 * (1.0 - schlick) + f90 * schlick) * lobe;
        const double kept =
            (through_i.at_zero + f0 * through_i.slope) * (through_o.at_zero + f0 * through_o.slope);
        result[k] = coat + passed * (specular + diffuse_[k] * kept * std::numbers::inv_pi);
    }
}

Spectrum evaluate_paint(const SpectralPaint& paint, const glm::dvec3& wi, const glm::dvec3& wo) {
    Spectrum result{};
    PaintBands(paint).evaluate(wi, wo, result);
    return result;
}

Material material_of(const SpectralPaint& paint) {
    const auto colour = [](const Spectrum& spectrum) {
        return rec709_from_xyz() * xyz_from_reflectance(spectrum, illuminant_d65());
    };
    Material material;
    material.name = paint.name;
    material.family = paint.family;
    material.model = ReflectanceModel::clearcoat;
    material.diffuse = colour(paint.diffuse);
    material.f0 = colour(paint.f0);
    material.alpha = glm::dvec2(paint.alpha);
    material.coat_alpha = paint.coat_alpha;
    material.coat_f0 = paint.coat_f0;
    material.provenance = "integrated under D65 from spectra: " + paint.provenance;
    return material;
}

}  // namespace livery
