#include "twin/spectral_paint.h"

#include <algorithm>
#include <numbers>

#include <glm/geometric.hpp>

#include "appearance/bsdf_source.h"
#include "core/colour.h"
#include "core/mutation.h"
#include "twin/painted_sphere.h"

namespace livery {

PaintBands::PaintBands(const SpectralPaint& paint) : paint_(paint) {
    largest_f0_ = *std::max_element(paint.f0.begin(), paint.f0.end());
    f64::BsdfParameters p{};
    p.coat_alpha = paint.coat_alpha;
    p.coat_f0 = paint.coat_f0;
    p.alpha_x = p.alpha_y = paint.alpha;
    p.coat_transmittance = glm::dvec3(1.0);
    p.f0 = glm::dvec3(0.0, largest_f0_, largest_f0_);
    bands_ = f64::clearcoat_prepare(p);

    // The diffuse layer's part depends on no direction. A band stands beside the largest, which
    // decides for all how they behave at grazing light.
    for (std::size_t k = 0; k < kSpectrumCount; ++k) {
        p.diffuse = glm::dvec3(paint.diffuse[k]);
        p.f0 = glm::dvec3(paint.f0[k], largest_f0_, largest_f0_);
        diffuse_[k] = f64::clearcoat_prepare(p).base.diffuse.x;
    }
}

PaintBands::Side PaintBands::side_of(double mu) const {
    // What the interface lets through is a straight line in f0: one call of the model has its ends.
    const f64::Passage passage = f64::passage_of(bands_, mu);
    Side side;
    side.passed = passage.coat;
    side.kept = passage.base.x;
    side.slope = largest_f0_ > 0.0 ? LIVERY_MUTATED(twin_paint_slope,
                                                    (passage.base.y - passage.base.x) / largest_f0_)
                                   : 0.0;
    return side;
}

bool PaintBands::lobes_at(const glm::dvec3& wi, const glm::dvec3& wo, Lobes& lobes) const {
    const glm::dvec3 h = wi + wo;
    const double hh = glm::dot(h, h);
    if (wi.z <= 0.0 || wo.z <= 0.0 || hh < 1e-8) return false;
    const double weight = f64::fresnel_weight(bands_.base.fresnel, hh);
    lobes.coat = f64::coat_fresnel(bands_.coat, hh) *
                 f64::ggx_distribution_visibility(wi, wo, hh, paint_.coat_alpha, paint_.coat_alpha);
    const double base = f64::ggx_distribution_visibility(wi, wo, hh, paint_.alpha, paint_.alpha);
    lobes.f0 = base * (1.0 - weight);
    lobes.grazing = base * f64::grazing_reflectance(largest_f0_) * weight;
    return true;
}

void PaintBands::evaluate(const glm::dvec3& wi, const glm::dvec3& wo, Spectrum& result) const {
    result.fill(0.0);
    Lobes lobes;
    if (!lobes_at(wi, wo, lobes)) return;
    const Side i = side_of(wi.z), o = side_of(wo.z);
    for (std::size_t k = 0; k < kSpectrumCount; ++k) {
        const double f0 = paint_.f0[k];
        const double kept = (i.kept + f0 * i.slope) * (o.kept + f0 * o.slope);
        const double under =
            f0 * lobes.f0 + lobes.grazing + diffuse_[k] * kept * std::numbers::inv_pi;
        result[k] = lobes.coat + i.passed * o.passed * under;
    }
}

PaintBands::Moments PaintBands::moments(const std::array<Spectrum, 3>& curves) const {
    Moments m;
    for (std::size_t k = 0; k < kSpectrumCount; ++k) {
        const glm::dvec3 curve(curves[0][k], curves[1][k], curves[2][k]);
        const double f0 = paint_.f0[k], d = diffuse_[k];
        m.white += curve;
        m.f0 += f0 * curve;
        m.diffuse += d * curve;
        m.diffuse_f0 += d * f0 * curve;
        m.diffuse_f02 += d * f0 * f0 * curve;
    }
    return m;
}

glm::dvec3 PaintBands::evaluate(const Moments& m,
                                const glm::dvec3& wi,
                                const glm::dvec3& wo,
                                const Side& i,
                                const Side& o) const {
    Lobes lobes;
    if (!lobes_at(wi, wo, lobes)) return glm::dvec3(0.0);
    const glm::dvec3 diffuse = i.kept * o.kept * m.diffuse +
                               (i.kept * o.slope + i.slope * o.kept) * m.diffuse_f0 +
                               i.slope * o.slope * m.diffuse_f02;
    const glm::dvec3 under =
        lobes.f0 * m.f0 + lobes.grazing * m.white + diffuse * std::numbers::inv_pi;
    return LIVERY_MUTATED(twin_paint, lobes.coat * m.white + i.passed * o.passed * under);
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
