#include "twin/sphere_stand.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "appearance/paint_bsdf.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
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

}  // namespace livery
