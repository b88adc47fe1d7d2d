#include "twin/painted_sphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "appearance/bsdf_source.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "core/random.h"
#include "twin/place.h"

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

namespace {

struct Light {
    glm::dvec3 direction, side, up;  ///< unit, orthogonal
    double radiance = 0.0;           ///< of a white diffuser that faces it
    double tan_radius = 0.0;
};

std::vector<Light> neutral_lights(std::span<const DirectionalLight> lights) {
    std::vector<Light> result;
    for (const DirectionalLight& from : lights) {
        const glm::dvec3& c = from.radiance_rec709;
        const double spread = std::max({c.x, c.y, c.z}) - std::min({c.x, c.y, c.z});
        check_argument(c.x >= 0.0 && spread <= 1e-6 * std::max(1.0, c.x),
                       "paint_radiance_xyz: a coloured light; the spectral truth has only D65");
        Light light;
        light.direction = glm::normalize(from.direction);
        const glm::dvec3 helper =
            std::abs(light.direction.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        light.side = glm::normalize(glm::cross(light.direction, helper));
        light.up = glm::cross(light.direction, light.side);
        light.radiance = c.x;
        light.tan_radius = std::tan(0.5 * from.angle_rad);
        result.push_back(light);
    }
    return result;
}

/// A direction into the light's disc, from two numbers in [0, 1).
glm::dvec3 toward(const Light& light, double u, double v) {
    if (light.tan_radius == 0.0) return light.direction;
    const double radius = light.tan_radius * std::sqrt(u), angle = 2.0 * std::numbers::pi * v;
    return glm::normalize(light.direction +
                          radius * (std::cos(angle) * light.side + std::sin(angle) * light.up));
}

/// D65 seen off a white diffuser of Y = 1, times the observer's curves: XYZ a unit of radiance.
std::array<Spectrum, 3> d65_observer() {
    std::array<Spectrum, 3> curves{cie1931_x(), cie1931_y(), cie1931_z()};
    const double white_y = xyz_from_power(illuminant_d65()).y;
    for (Spectrum& curve : curves) {
        for (std::size_t k = 0; k < curve.size(); ++k) {
            curve[k] *= illuminant_d65()[k] * kSpectrumStep_nm / white_y;
        }
    }
    return curves;
}

}  // namespace

ImageF paint_radiance_xyz(const Mesh& mesh,
                          const Tracer& tracer,
                          const View& view,
                          glm::dvec3 eye_mm,
                          const SpectralPaint& paint,
                          std::span<const DirectionalLight> from_lights,
                          int samples_a_side,
                          const Progress& progress) {
    check_argument(samples_a_side >= 1 && samples_a_side <= 16,
                   "paint_radiance_xyz: 1 to 16 samples a side");
    const auto lights = neutral_lights(from_lights);
    const PaintBands bands(paint);
    const auto moments = bands.moments(d65_observer());
    const PixelRectangle rectangle = pixels_that_see(view, mesh);
    const PixelRays pixel_rays(view, rectangle, samples_a_side);
    ImageF xyz(view.width, view.height, 3);
    const auto rows = static_cast<std::size_t>(rectangle.bottom - rectangle.top);
    parallel_for(rows, 2, [&](std::size_t begin, std::size_t end) {
        std::vector<TraceRay> rays;
        std::vector<Hit> hits;
        for (std::size_t row = begin; row < end; ++row) {
            progress.check_stop();
            const int y = rectangle.top + static_cast<int>(row);
            for (int x = rectangle.left; x < rectangle.right; ++x) {
                rays.clear();
                pixel_rays.add(x, y, rays);
                hits.assign(rays.size(), Hit{});
                tracer.closest(rays, hits);
                int met = 0;
                glm::dvec3 sum(0.0);
                for (std::size_t s = 0; s < hits.size(); ++s) {
                    if (!hits[s].valid()) continue;
                    ++met;
                    const MeshPlace place = mesh_place(mesh, hits[s]);
                    const glm::dvec3 n = place.normal;
                    const glm::dvec3 helper =
                        std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
                    const glm::dvec3 t = glm::normalize(glm::cross(helper, n)),
                                     b = glm::cross(n, t);
                    const auto local = [&](const glm::dvec3& d) {
                        return glm::dvec3(glm::dot(d, t), glm::dot(d, b), glm::dot(d, n));
                    };
                    const glm::dvec3 wo = local(glm::normalize(eye_mm - place.position_mm));
                    if (wo.z <= 0.0) continue;
                    const PaintBands::Side side_o = bands.side_of(wo.z);
                    for (const Light& light : lights) {
                        const auto bits = hash_3d(static_cast<std::uint32_t>(x),
                                                  static_cast<std::uint32_t>(y),
                                                  static_cast<std::uint32_t>(s) + 1000u);
                        const double u = (static_cast<double>(s) + (bits & 0xffffu) * 0x1p-16) /
                                         static_cast<double>(hits.size());
                        const glm::dvec3 to_light = toward(light, u, (bits >> 16u) * 0x1p-16);
                        const glm::dvec3 wi = local(to_light);
                        const glm::dvec3 far_off = place.position_mm + 1e5 * to_light;
                        if (wi.z <= 0.0 ||
                            !sees(tracer, place.position_mm, place.geometric_normal, far_off)) {
                            continue;
                        }
                        sum += LIVERY_MUTATED(twin_painted_sphere, std::numbers::pi) *
                               light.radiance * wi.z *
                               bands.evaluate(moments, wi, wo, bands.side_of(wi.z), side_o);
                    }
                }
                if (met == 0) continue;
                for (int c = 0; c < 3; ++c) xyz.at(x, y, c) = static_cast<float>(sum[c] / met);
            }
        }
    });
    return xyz;
}

}  // namespace livery
