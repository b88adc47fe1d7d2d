#include "twin/mirror_ball_stand.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "mesh/mesh.h"
#include "tracing/tracer.h"
#include "twin/place.h"
#include "twin/sensor.h"

namespace livery {

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
