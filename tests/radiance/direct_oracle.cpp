#include "radiance/direct_oracle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "appearance/bsdf.h"
#include "appearance/model_table.h"
#include "core/colour.h"
#include "core/parallel.h"
#include "core/random.h"
#include "scene/artwork_cover.h"
#include "support/kept_truth.h"
#include "tracing/tracer.h"

namespace livery {
namespace {

struct Frame {
    glm::dvec3 s, t, n;
    glm::dvec3 to_local(const glm::dvec3& v) const {
        return {glm::dot(v, s), glm::dot(v, t), glm::dot(v, n)};
    }
    glm::dvec3 to_world(const glm::dvec3& v) const { return v.x * s + v.y * t + v.z * n; }
};

glm::dvec3 disc_direction(const DirectionalLight& light, glm::dvec2 u) {
    const glm::dvec3 axis = glm::normalize(light.direction);
    const glm::dvec3 s = glm::normalize(
        glm::cross(axis, std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
    const glm::dvec3 t = glm::cross(axis, s);
    const double z = 1.0 - u.x * (1.0 - std::cos(0.5 * light.angle_rad));
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    return z * axis + r * (std::cos(2 * std::numbers::pi * u.y) * s +
                           std::sin(2 * std::numbers::pi * u.y) * t);
}

glm::dvec3 sky(const Environment& environment, const glm::dvec3& direction) {
    const ImageF& map = environment.radiance_working;
    const glm::dvec2 uv = uv_from_direction(environment, direction);
    const double x = uv.x * map.width - 0.5, y = uv.y * map.height - 0.5;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    glm::dvec3 sum(0.0);
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
            const double w = (i ? x - x0 : 1 - x + x0) * (j ? y - y0 : 1 - y + y0);
            const float* p =
                map.pixel((x0 + i + map.width) % map.width, std::clamp(y0 + j, 0, map.height - 1));
            sum += w * glm::dvec3(p[0], p[1], p[2]);
        }
    }
    return environment.scale * sum;
}

/// Of a sequence that fills the unit cube evenly (Roberts 2018), shifted.
glm::dvec3 even_point(int index, const glm::dvec3& shift) {
    constexpr double kG = 1.22074408460575947536;
    const glm::dvec3 step(1.0 / kG, 1.0 / (kG * kG), 1.0 / (kG * kG * kG));
    return glm::fract(shift + static_cast<double>(index) * step);
}

using BoundPaint = BoundBsdfPointer<double, glm::dvec3>;
BoundPaint paint_of(const Material& material) {
    return model_info(material.model).f64.bound(parameters_of_f64(material));
}

/// What shines at a point: the part's paint and artwork's over it.
struct Worn {
    double share;
    BoundPaint bsdf;
};

std::vector<Worn> worn_at(const Scene& scene,
                          const std::vector<BoundPaint>& paints,
                          const SurfacePoint& point) {
    std::vector<Worn> worn{{1.0, paints[point.part]}};
    for (const PartArtwork& artwork : scene.artwork) {
        if (artwork.part != point.part) continue;
        const ArtworkPoint at = artwork_at(
            artwork, glm::dvec3(point.position_mm), glm::dvec3(point.normal), glm::dvec2(point.uv));
        if (!(at.cover > 0.0)) continue;
        for (Worn& below : worn) below.share *= 1.0 - at.cover;
        worn.push_back({at.cover, paint_of(material_at(artwork, at.rgba))});
    }
    std::erase_if(worn, [](const Worn& one) { return !(one.share > 0.0); });
    return worn;
}

glm::vec3 relieved_normal(const Scene& scene, const SurfacePoint& point) {
    const PartArtwork* relief = relief_of(scene, point.part);
    if (!relief) return point.normal;
    const glm::dvec3 normal(point.normal);
    const ArtworkPoint at =
        artwork_at(*relief, glm::dvec3(point.position_mm), normal, glm::dvec2(point.uv));
    return glm::vec3(tilted(normal,
                            relief_frame(*relief, normal, glm::dvec4(point.tangent)),
                            tilt_at(*relief, at).slope));
}

}  // namespace

ImageF direct_light(const Scene& scene, const View& view, const OracleOptions& options) {
    const Mesh& mesh = scene.product->mesh;
    const Tracer tracer(mesh);
    std::vector<BoundPaint> paints;
    for (const Material& m : scene.part_materials) paints.push_back(paint_of(m));
    ImageF image(view.width, view.height, 4);
    const int side = options.side, count = side * side;
    parallel_for(image.pixel_count(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const int px = static_cast<int>(i) % view.width, py = static_cast<int>(i) / view.width;
            Random random(i + 1);
            Random shifts(i + 1, 1);
            const glm::dvec3 shift(shifts.uniform(), shifts.uniform(), shifts.uniform());
            glm::dvec3 sum(0.0);
            int hits = 0;
            for (int k = 0; k < count; ++k) {
                const glm::dvec2 place((k % side + random.uniform()) / side,
                                       (k / side + random.uniform()) / side);
                const Ray ray = ray_through(view, glm::dvec2(px, py) + place);
                const Hit hit =
                    tracer.closest({glm::vec3(ray.origin), 0.0f, glm::vec3(ray.direction), 1e30f});
                if (!hit.valid()) continue;
                ++hits;
                SurfacePoint point = surface_point(mesh, hit);
                if (glm::dot(glm::dvec3(point.geometric_normal), ray.direction) > 0.0) {
                    point.geometric_normal = -point.geometric_normal;
                    point.normal = -point.normal;
                }
                point.normal = relieved_normal(scene, point);
                Frame frame;
                frame.n = glm::normalize(glm::dvec3(point.normal));
                const glm::dvec3 tangent(point.tangent);
                frame.s = glm::normalize(tangent - glm::dot(tangent, frame.n) * frame.n);
                frame.t = static_cast<double>(point.tangent.w) * glm::cross(frame.n, frame.s);
                glm::dvec3 wo = frame.to_local(
                    glm::normalize(scene.eye_in_world_mm - glm::dvec3(point.position_mm)));
                if (wo.z < 1e-4) {
                    wo.z = 1e-4;
                    wo = glm::normalize(wo);
                }
                const std::vector<Worn> worn = worn_at(scene, paints, point);
                const auto visible = [&](const glm::dvec3& direction) {
                    return !tracer.occluded(
                        {offset_origin(point.position_mm, point.geometric_normal),
                         0.0f,
                         glm::vec3(direction),
                         1e30f});
                };
                for (const DirectionalLight& light : scene.lights) {
                    const glm::dvec2 u(
                        std::fmod((k + random.uniform()) / count, 1.0),
                        std::fmod(k * 0.6180339887498949 + 0.1 * random.uniform(), 1.0));
                    const glm::dvec3 direction = disc_direction(light, u);
                    const glm::dvec3 wi = frame.to_local(direction);
                    if (wi.z <= 0.0 || !visible(direction)) continue;
                    for (const Worn& paint : worn) {
                        sum += paint.share * std::numbers::pi *
                               (working_from_rec709() * light.radiance_rec709) * wi.z *
                               paint.bsdf->eval(wi, wo);
                    }
                }
                for (const Worn& paint : worn) {
                    for (int j = 0; scene.environment && j < options.sky_samples; ++j) {
                        const glm::dvec3 wi =
                            paint.bsdf->sample(wo, even_point(k * options.sky_samples + j, shift));
                        if (wi.z <= 0.0) continue;
                        const double density = paint.bsdf->pdf(wi, wo);
                        const glm::dvec3 direction = frame.to_world(wi);
                        if (density <= 0.0 || !visible(direction)) continue;
                        sum += paint.share * sky(*scene.environment, direction) *
                               paint.bsdf->eval(wi, wo) * (wi.z / density / options.sky_samples);
                    }
                }
            }
            float* pixel = image.pixel(px, py);
            if (hits == 0) continue;
            sum *= std::exp2(scene.exposure_ev) / hits;
            for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(sum[c]);
            pixel[3] = static_cast<float>(hits) / static_cast<float>(count);
        }
    });
    return image;
}

ImageF kept_direct_light(const Scene& scene, const View& view, const OracleOptions& options) {
    return testing::kept_picture(
        "direct",
        testing::text_of(scene, view) + fmt::format("{} {}", options.side, options.sky_samples),
        [&] { return direct_light(scene, view, options); });
}

}  // namespace livery
