#include "twin/sphere_stand.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "appearance/paint_bsdf.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "mesh/mesh.h"
#include "tracing/tracer.h"
#include "twin/place.h"
#include "twin/sensor.h"

namespace livery {

namespace {

constexpr double kCamera_mm = 1000.0, kLamp_mm = 600.0;
constexpr int kLamps = 28;
constexpr double kFirstLamp_deg = 4.0, kLastLamp_deg = 158.0;
constexpr double kShownHeight_mm = 88.0;
constexpr int kSamplesASide = 4;

/// What a lamp's light becomes on the way: seen through one sample of a pixel.
class SphereScene {
  public:
    SphereScene(const SphereStand& stand, const Material& paint, const glm::dvec3& lamp_mm)
        : stand_(stand), reflectance_(reflectance_of(paint)), lamp_mm_(lamp_mm) {
        const glm::dvec3 away = glm::normalize(lamp_mm);
        const glm::dvec3 helper =
            std::abs(away.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
        side_ = glm::normalize(glm::cross(helper, away));
        up_ = glm::cross(away, side_);
    }

    /// `u`, `v` in [0, 1): a point of the lamp. Of white that faces it at 600 mm: 1.
    glm::dvec3 along(const Ray& ray, double u, double v) const {
        const double radius = 0.5 * stand_.lamp_diameter_mm * std::sqrt(u);
        const double turn = 2.0 * std::numbers::pi * v;
        const glm::dvec3 lamp = lamp_mm_ + radius * (std::cos(turn) * side_ + std::sin(turn) * up_);
        const double sphere_radius = 0.5 * stand_.diameter_mm;
        const double b = glm::dot(ray.origin, ray.direction);
        const double c = glm::dot(ray.origin, ray.origin) - sphere_radius * sphere_radius;
        if (b * b > c) {
            const glm::dvec3 p = ray.origin + (-b - std::sqrt(b * b - c)) * ray.direction;
            return on_sphere(p, p / sphere_radius, -ray.direction, lamp);
        }
        // The cloth hangs across the camera's axis.
        const double t = (-stand_.cloth_behind_mm - ray.origin.z) / ray.direction.z;
        const glm::dvec3 way = lamp - (ray.origin + t * ray.direction);
        const double squared = glm::dot(way, way);
        const double cosine = way.z / std::sqrt(squared);
        return glm::dvec3(stand_.cloth_reflectance * std::max(cosine, 0.0) * kLamp_mm * kLamp_mm /
                          squared);
    }

  private:
    glm::dvec3 on_sphere(const glm::dvec3& p,
                         const glm::dvec3& n,
                         const glm::dvec3& to_camera,
                         const glm::dvec3& lamp) const {
        const glm::dvec3 way = lamp - p;
        const double squared = glm::dot(way, way);
        const glm::dvec3 to_lamp = way / std::sqrt(squared);
        const double cosine = glm::dot(n, to_lamp);
        if (cosine <= 0.0) return glm::dvec3(0.0);
        const glm::dvec3 helper = std::abs(n.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
        const glm::dvec3 t = glm::normalize(glm::cross(helper, n)), b = glm::cross(n, t);
        const glm::dvec3 wi(glm::dot(to_lamp, t), glm::dot(to_lamp, b), cosine);
        const glm::dvec3 wo(glm::dot(to_camera, t), glm::dot(to_camera, b), glm::dot(to_camera, n));
        return reflectance_(wi, wo) * (std::numbers::pi * cosine * kLamp_mm * kLamp_mm / squared);
    }

    const SphereStand& stand_;
    ReflectanceFunction reflectance_;
    glm::dvec3 lamp_mm_, side_, up_;
};

}  // namespace

SphereStand usual_sphere_stand(const CameraDescription& camera, int width, int height) {
    SphereStand stand;
    stand.camera = camera;
    stand.camera.view = look_at({0.0, 0.0, kCamera_mm},
                                {0.0, 0.0, 0.0},
                                2.0 * std::atan(0.5 * kShownHeight_mm / kCamera_mm),
                                width,
                                height);
    // No lens is without.
    stand.camera.view.principal_px += glm::dvec2(3.4, -2.2);
    stand.camera.view.distortion = {-0.8, 0.0, 0.0004, -0.0003, 0.0};
    const glm::dmat3 mixed =
        glm::transpose(glm::dmat3(0.80, 0.20, 0.00, 0.10, 0.80, 0.10, 0.00, 0.15, 0.85));
    const glm::dvec3 balance(0.6, 1.0, 0.75);
    for (int c = 0; c < 3; ++c) stand.camera_from_working[c] = balance * mixed[c];
    constexpr double kDegree = std::numbers::pi / 180.0;
    const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (int k = 0; k < kLamps; ++k) {
        const double angle =
            kDegree * (kFirstLamp_deg + (kLastLamp_deg - kFirstLamp_deg) * k / (kLamps - 1));
        const double turn = golden_angle * k;
        stand.lamps_mm.push_back(kLamp_mm * glm::dvec3(std::sin(angle) * std::cos(turn),
                                                       std::sin(angle) * std::sin(turn),
                                                       std::cos(angle)));
    }
    return stand;
}

ImageF sphere_light(const SphereStand& stand,
                    const Material& paint,
                    const glm::dvec3& lamp_mm,
                    const Progress& progress) {
    check_argument(2.0 * glm::length(lamp_mm) > stand.diameter_mm + stand.lamp_diameter_mm,
                   fmt::format("sphere_light: a lamp {} mm from the middle of a sphere of {} mm",
                               glm::length(lamp_mm),
                               stand.diameter_mm));
    const View& view = stand.camera.view;
    const SphereScene scene(stand, paint, lamp_mm);
    // The lens is undone at the pixels' corners and interpolated inside, where it is even.
    const auto stride = static_cast<std::size_t>(view.width) + 1;
    const auto rows = static_cast<std::size_t>(view.height);
    std::vector<glm::dvec3> corners(stride * (rows + 1));
    parallel_for(corners.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            corners[k] = ray_through(view, glm::dvec2(k % stride, k / stride)).direction;
        }
    });
    const glm::dvec3 eye = centre_in_world(view);
    ImageF light(view.width, view.height, 3);
    constexpr int kSamples = kSamplesASide * kSamplesASide;
    parallel_for(rows, 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            progress.check_stop();
            for (std::size_t x = 0; x + 1 < stride; ++x) {
                const glm::dvec3* corner = corners.data() + y * stride + x;
                glm::dvec3 sum(0.0);
                for (int s = 0; s < kSamples; ++s) {
                    const auto bits = hash_3d(static_cast<std::uint32_t>(x),
                                              static_cast<std::uint32_t>(y),
                                              static_cast<std::uint32_t>(s));
                    const double u = (s % kSamplesASide + 0.5) / kSamplesASide;
                    const double v = (s / kSamplesASide + 0.5) / kSamplesASide;
                    const glm::dvec3 direction =
                        glm::mix(glm::mix(corner[0], corner[1], u),
                                 glm::mix(corner[stride], corner[stride + 1], u),
                                 v);
                    sum += scene.along({eye, glm::normalize(direction)},
                                       (bits & 0xffffu) * 0x1p-16,
                                       (bits >> 16u) * 0x1p-16);
                }
                const glm::dvec3 seen =
                    stand.camera_from_working * (sum * (stand.units_per_s / kSamples));
                for (int c = 0; c < 3; ++c) {
                    // A colour outside of the working space is no light in that channel.
                    light.at(static_cast<int>(x), static_cast<int>(y), c) =
                        static_cast<float>(std::max(seen[c], 0.0));
                }
            }
        }
    });
    if (stand.camera.flare > 0.0) {
        return with_flare(light, stand.camera.flare, stand.camera.flare_radius);
    }
    return light;
}

namespace {

constexpr double kBallCamera_mm = 800.0, kTurn_deg = 110.0;
constexpr double kShownPart = 0.75;
constexpr int kRings = 180;  ///< of the mesh: its outline is round to a hundredth of a pixel

/// The ball and, where it has a size, the camera that photographs it.
Mesh stand_mesh(const MirrorBallStand& stand, const View& view) {
    Mesh mesh = make_sphere(glm::dvec3(0.0), 0.5 * stand.diameter_mm, kRings, "ball");
    if (stand.camera_radius_mm > 0.0) {
        append(mesh, make_sphere(centre_in_world(view), stand.camera_radius_mm, 40, "camera"), "");
    }
    return mesh;
}

/// What comes back along rays from one camera.
class BallScene {
  public:
    BallScene(const MirrorBallStand& stand, const View& view, const LightFrom& light_from)
        : stand_(stand), light_from_(light_from), mesh_(stand_mesh(stand, view)), tracer_(mesh_) {}

    glm::dvec3 along(TraceRay ray) const {
        // The camera's own body is behind its lens.
        ray.t_min = static_cast<float>(1.01 * stand_.camera_radius_mm);
        const Hit hit = tracer_.closest(ray);
        const glm::dvec3 direction(ray.direction);
        if (!hit.valid()) return light_from_(glm::normalize(direction));
        const SurfacePoint place = surface_point(mesh_, hit);
        if (place.part != 0) return glm::dvec3(0.0);
        const glm::dvec3 normal = glm::normalize(glm::dvec3(place.normal));
        const glm::dvec3 incoming = glm::normalize(direction);
        const double cosine = -glm::dot(incoming, normal);
        const glm::dvec3 mirrored = glm::reflect(incoming, normal);
        if (stand_.camera_radius_mm > 0.0) {
            const TraceRay on{offset_origin(place.position_mm, place.geometric_normal),
                              0.0f,
                              glm::vec3(mirrored)};
            if (tracer_.occluded(on)) return glm::dvec3(0.0);
        }
        const glm::dvec3 light = light_from_(mirrored);
        return stand_.metal ? light * metal_reflectance(*stand_.metal, std::max(cosine, 0.0))
                            : light;
    }

  private:
    const MirrorBallStand& stand_;
    const LightFrom& light_from_;
    Mesh mesh_;
    Tracer tracer_;
};

}  // namespace

glm::dvec3 metal_reflectance(const MetalIndex& metal, double cosine) {
    glm::dvec3 result;
    for (int c = 0; c < 3; ++c) {
        const std::complex<double> index(metal.n[c], metal.k[c]);
        // Snell's law with a complex angle.
        const std::complex<double> sine = std::sqrt(1.0 - cosine * cosine) / index;
        const std::complex<double> inside = std::sqrt(1.0 - sine * sine);
        const auto across = (cosine - index * inside) / (cosine + index * inside);
        const auto along = (index * cosine - inside) / (index * cosine + inside);
        result[c] = 0.5 * (std::norm(across) + std::norm(along));
    }
    return result;
}

MirrorBallStand usual_mirror_ball_stand(const CameraDescription& camera, int size_px, int count) {
    MirrorBallStand stand;
    const double half = std::asin(0.5 * stand.diameter_mm / kBallCamera_mm);
    for (int k = 0; k < count; ++k) {
        const double turn = std::numbers::pi / 180.0 * kTurn_deg * k;
        CameraDescription one = camera;
        one.view = look_at(kBallCamera_mm * glm::dvec3(std::sin(turn), 0.0, std::cos(turn)),
                           {0.0, 0.0, 0.0},
                           2.0 * std::atan(std::tan(half) / kShownPart),
                           size_px,
                           size_px);
        // No lens is without.
        one.view.principal_px += glm::dvec2(2.3, -1.7);
        one.view.distortion = {-0.3, 0.0, 0.0003, -0.0002, 0.0};
        stand.cameras.push_back(one);
    }
    return stand;
}

LightFrom light_of(const Environment& environment) {
    return [&environment](const glm::dvec3& direction) {
        const ImageF& map = environment.radiance_working;
        const glm::dvec2 uv = uv_from_direction(environment, direction);
        const float* value =
            map.pixel(static_cast<int>(uv.x * map.width), static_cast<int>(uv.y * map.height));
        return environment.scale * glm::dvec3(value[0], value[1], value[2]);
    };
}

ImageF mirror_ball_light(const MirrorBallStand& stand,
                         const CameraDescription& camera,
                         const LightFrom& light_from,
                         int samples_a_side,
                         const Progress& progress) {
    check_argument(samples_a_side > 0, "mirror_ball_light: no samples");
    const View& view = camera.view;
    const BallScene scene(stand, view, light_from);
    const PixelRays rays_of(view, {0, 0, view.width, view.height}, samples_a_side);
    ImageF light(view.width, view.height, 3);
    parallel_for(static_cast<std::size_t>(view.height), 4, [&](std::size_t begin, std::size_t end) {
        std::vector<TraceRay> rays;
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            progress.check_stop();
            for (int x = 0; x < view.width; ++x) {
                rays.clear();
                rays_of.add(x, y, rays);
                glm::dvec3 sum(0.0);
                for (const TraceRay& ray : rays) sum += scene.along(ray);
                const glm::dvec3 seen =
                    stand.camera_from_working *
                    (sum * (stand.units_per_s / static_cast<double>(rays.size())));
                for (int c = 0; c < 3; ++c) {
                    light.at(x, y, c) = static_cast<float>(std::max(seen[c], 0.0));
                }
            }
        }
    });
    return camera.flare > 0.0 ? with_flare(light, camera.flare, camera.flare_radius) : light;
}

}  // namespace livery
