#include "twin/spot_stand.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "twin/spot_photons.h"

namespace livery {

namespace {

constexpr double kRadian = std::numbers::pi / 180.0;
constexpr double kSpotCamera_mm = 600.0, kSpotProjector_mm = 700.0;
constexpr double kOffNormal_deg = 45.0, kIncidence_deg = 5.0;
constexpr int kSamplesASpotPixel = 3;  ///< squared
constexpr int kSpotCells = 1536;
constexpr double kRoomTilt = 0.1;
/// Of the room's light, what such samples give back; it is taken off, and its size does not matter.
constexpr double kSampleInRoom = 0.7;

/// Where a pixel's sub-samples meet the surface.
template <typename Body>
void for_each_sample(const View& view, int x, int y, const Body& body) {
    for (int v = 0; v < kSamplesASpotPixel; ++v) {
        for (int u = 0; u < kSamplesASpotPixel; ++u) {
            const Ray ray = ray_through(
                view, {x + (u + 0.5) / kSamplesASpotPixel, y + (v + 0.5) / kSamplesASpotPixel});
            body(ray.origin - (ray.origin.z / ray.direction.z) * ray.direction);
        }
    }
}

/// Half the side of the square that the camera sees, from its corners.
double seen_half_width_mm(const View& view) {
    double farthest = 0.0;
    for (const glm::dvec2 corner : {glm::dvec2(0.0, 0.0),
                                    glm::dvec2(view.width, 0.0),
                                    glm::dvec2(0.0, view.height),
                                    glm::dvec2(view.width, view.height)}) {
        const Ray ray = ray_through(view, corner);
        const glm::dvec3 at = ray.origin - (ray.origin.z / ray.direction.z) * ray.direction;
        farthest = std::max({farthest, std::abs(at.x), std::abs(at.y)});
    }
    return farthest;
}

/// Of light far from the spot, per mm, nearly; for a choice of picture and spot alone.
double decay_of(const ScatteringMedium& medium) {
    return std::sqrt(3.0 * medium.sigma_a_per_mm * medium.sigma_t_prime());
}

/// Adds one channel of the spot on both surfaces.
void add_spot(const SpotStand& stand,
              int channel,
              const std::vector<float>& radiance,
              const SpotGrid& grid,
              SpotScenes& scenes) {
    const View& view = stand.camera.view;
    const double variance = stand.spot_sigma_mm * stand.spot_sigma_mm;
    const double power = 2.0 * std::numbers::pi * variance;  // of an irradiance of 1 in the middle
    double within = 0.0;
    const ScatteringMedium& medium = stand.media[static_cast<std::size_t>(channel)];
    const double entering =
        power * (1.0 - mirrored_outside(glm::normalize(stand.projector_mm).z, medium.eta, within));
    constexpr double kShare = 1.0 / (kSamplesASpotPixel * kSamplesASpotPixel);
    parallel_for(static_cast<std::size_t>(view.height), 8, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < view.width; ++x) {
                double white = 0.0, sample = 0.0;
                for_each_sample(view, x, y, [&](const glm::dvec3& at) {
                    white += std::exp(-0.5 * (at.x * at.x + at.y * at.y) / variance);
                    const auto column =
                        static_cast<int>((at.x + grid.half_width_mm) / grid.cell_mm());
                    const auto row = static_cast<int>((at.y + grid.half_width_mm) / grid.cell_mm());
                    if (column < 0 || row < 0 || column >= grid.cells || row >= grid.cells) return;
                    sample += static_cast<double>(
                        radiance[static_cast<std::size_t>(row * grid.cells + column)]);
                });
                // A perfect white of irradiance 1 has a radiance of 1/pi, and reads 1 here.
                const double unit = kShare * stand.units_per_s;
                scenes.white.at(x, y, channel) += static_cast<float>(unit * stand.white * white);
                scenes.sample.at(x, y, channel) +=
                    static_cast<float>(unit * std::numbers::pi * entering * sample);
            }
        }
    });
}

ImageF room_light(const SpotStand& stand, double reflectance) {
    const View& view = stand.camera.view;
    ImageF light(view.width, view.height, 3);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const double tilt = 1.0 + kRoomTilt * (2.0 * x / view.width - 1.0);
            for (int c = 0; c < 3; ++c) {
                light.at(x, y, c) =
                    static_cast<float>(stand.units_per_s * stand.room * reflectance * tilt);
            }
        }
    }
    return light;
}

}  // namespace

SpotStand usual_spot_stand(const CameraDescription& camera,
                           const std::array<ScatteringMedium, 3>& media,
                           int size_px) {
    SpotStand stand;
    stand.media = media;
    double spread_mm = 1e9;
    for (const ScatteringMedium& medium : media) {
        spread_mm = std::min(spread_mm, std::sqrt(medium.mean_free_path_mm() / decay_of(medium)));
    }
    stand.spot_sigma_mm = 0.055 * spread_mm;
    const double incidence = kIncidence_deg * kRadian, off = kOffNormal_deg * kRadian;
    stand.projector_mm =
        kSpotProjector_mm * glm::dvec3(std::sin(incidence), 0.0, std::cos(incidence));
    stand.camera = camera;
    // The farther side of a slanting picture is the smaller one.
    const double half_mm = 3.75 / decay_of(media[1]);
    stand.camera.view = look_at(kSpotCamera_mm * glm::dvec3(0.0, -std::sin(off), std::cos(off)),
                                {0.0, 0.0, 0.0},
                                2.0 * std::atan(half_mm / kSpotCamera_mm),
                                size_px,
                                size_px);
    // No lens is without.
    stand.camera.view.principal_px += glm::dvec2(2.3, -1.7);
    stand.camera.view.distortion = {-0.3, 0.0, 0.0003, -0.0002, 0.0};
    return stand;
}

SpotScenes spot_scenes(const SpotStand& stand, const Progress& progress) {
    const View& view = stand.camera.view;
    SpotScenes scenes;
    scenes.sample = scenes.sample_black = room_light(stand, kSampleInRoom);
    scenes.white = scenes.white_black = room_light(stand, stand.white);
    const SpotGrid grid{kSpotCells, seen_half_width_mm(view)};
    PhotonSpot spot;
    spot.sigma_mm = stand.spot_sigma_mm;
    spot.toward_light = glm::normalize(stand.projector_mm);
    spot.toward_eye = glm::normalize(centre_in_world(view));
    spot.photons = stand.photons;
    for (int c = 0; c < 3; ++c) {
        progress.update(c / 3.0, "photons");
        spot.seed = stand.seed + static_cast<std::uint64_t>(c);
        const auto radiance =
            spot_radiance(stand.media[static_cast<std::size_t>(c)], grid, spot, progress);
        add_spot(stand, c, radiance, grid, scenes);
    }
    return scenes;
}

}  // namespace livery
