#include "twin/spot_stand.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "appearance/subsurface/scattering_medium.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/random.h"

namespace livery {

namespace {

/// Share of unpolarised light that a boundary mirrors, met at this cosine from outside of a medium
/// of this index; `within` gets the cosine of what goes on inside.
double mirrored_outside(double cosine, double eta, double& within) {
    within = std::sqrt(std::max(1.0 - (1.0 - cosine * cosine) / (eta * eta), 0.0));
    const double across = (cosine - eta * within) / (cosine + eta * within);
    const double along = (eta * cosine - within) / (eta * cosine + within);
    return 0.5 * (across * across + along * along);
}

/// Squares of the surface z = 0 around the origin, `cells` a side.
struct SpotGrid {
    int cells = 1024;
    double half_width_mm = 20.0;
    double cell_mm() const { return 2.0 * half_width_mm / cells; }
};

/// Light that falls in a round Gaussian spot around the origin, from one direction.
struct PhotonSpot {
    double sigma_mm = 0.1;
    glm::dvec3 toward_light{0.0, 0.0, 1.0};  ///< unit length
    glm::dvec3 toward_eye{0.0, 0.0, 1.0};    ///< unit length
    std::uint64_t photons = 200'000;
    std::uint64_t seed = 1;
};

constexpr double kSpotPi = std::numbers::pi;
constexpr std::size_t kSpotBatches = 8;  ///< a picture each, added in their order
constexpr double kFaint = 0.02, kGoesOn = 0.2;

/// `unit` bent into the medium; z is out of it.
glm::dvec3 refracted_in(const glm::dvec3& unit, double eta) {
    double within = 0.0;
    mirrored_outside(std::abs(unit.z), eta, within);
    return {unit.x / eta, unit.y / eta, std::copysign(within, unit.z)};
}

glm::dvec3 scattered(const glm::dvec3& d, double g, Random& random) {
    const double u = 2.0 * random.uniform() - 1.0;
    double cosine = u;
    if (std::abs(g) > 1e-6) {
        const double t = (1.0 - g * g) / (1.0 + g * u);
        cosine = std::clamp((1.0 + g * g - t * t) / (2.0 * g), -1.0, 1.0);
    }
    const double sine = std::sqrt(1.0 - cosine * cosine);
    const double turn = 2.0 * kSpotPi * random.uniform();
    const glm::dvec3 helper = std::abs(d.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(helper, d));
    return glm::normalize(sine * std::cos(turn) * across +
                          sine * std::sin(turn) * glm::cross(d, across) + cosine * d);
}

class SpotWalk {
  public:
    SpotWalk(const ScatteringMedium& medium, const SpotGrid& grid, const PhotonSpot& spot)
        : medium_(medium),
          grid_(grid),
          spot_(spot),
          in_(refracted_in(-spot.toward_light, medium.eta)),
          out_(refracted_in(spot.toward_eye, medium.eta)) {
        double within = 0.0;
        const double mirrored = mirrored_outside(spot.toward_eye.z, medium.eta, within);
        // Solid angles widen at the boundary, so that radiance falls by the square of the index.
        seen_ = (1.0 - mirrored) / (medium.eta * medium.eta * within);
    }

    void photon(Random& random, std::vector<float>& picture) const {
        glm::dvec3 place(spot_.sigma_mm * random.normal(), spot_.sigma_mm * random.normal(), 0.0);
        glm::dvec3 direction = in_;
        double weight = 1.0;
        while (true) {
            const double path = -std::log(1.0 - random.uniform()) / medium_.sigma_t();
            if (place.z + path * direction.z > 0.0) {
                place -= (place.z / direction.z) * direction;
                place.z = 0.0;
                weight *= mirrored_inside(direction.z);
                direction.z = -direction.z;
            } else {
                place += path * direction;
                weight *= medium_.sigma_s_per_mm / medium_.sigma_t();
                score(place, direction, weight, picture);
                direction = scattered(direction, medium_.g, random);
            }
            if (weight < kFaint) {
                if (random.uniform() >= kGoesOn) return;
                weight /= kGoesOn;
            }
        }
    }

  private:
    double mirrored_inside(double cosine) const {
        const double sine2 = medium_.eta * medium_.eta * (1.0 - cosine * cosine);
        if (sine2 >= 1.0) return 1.0;
        double within = 0.0;
        return mirrored_outside(std::sqrt(1.0 - sine2), medium_.eta, within);
    }
    void score(const glm::dvec3& place,
               const glm::dvec3& direction,
               double weight,
               std::vector<float>& picture) const {
        const double path = -place.z / out_.z;
        const double cell = grid_.cell_mm();
        const double column = (place.x + path * out_.x + grid_.half_width_mm) / cell;
        const double row = (place.y + path * out_.y + grid_.half_width_mm) / cell;
        const double cells = grid_.cells;
        if (!(column >= 0.0 && row >= 0.0 && column < cells && row < cells)) return;
        const double g = medium_.g;
        const double d = 1.0 + g * g - 2.0 * g * glm::dot(direction, out_);
        const double phase = (1.0 - g * g) / (4.0 * kSpotPi * d * std::sqrt(d));
        const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.cells) +
                        static_cast<std::size_t>(column);
        picture[at] +=
            static_cast<float>(weight * phase * std::exp(-medium_.sigma_t() * path) * seen_);
    }

    ScatteringMedium medium_;
    SpotGrid grid_;
    PhotonSpot spot_;
    glm::dvec3 in_, out_;
    double seen_ = 0.0;
};

/// Radiance toward the eye of each square, row by row from (-x, -y), per unit power that enters:
/// per mm^2 and sr. The medium fills z < 0. Every scattering sends the eye what gets there
/// straight, by phase function, absorption, Fresnel and the widening of the beam, so that nothing
/// is assumed of how light leaves. The same for the same seed on any number of threads. Throws
/// Cancelled.
std::vector<float> spot_radiance(const ScatteringMedium& medium,
                                 const SpotGrid& grid,
                                 const PhotonSpot& spot,
                                 const Progress& progress = {}) {
    check_medium(medium);
    const SpotWalk walk(medium, grid, spot);
    const auto squares =
        static_cast<std::size_t>(grid.cells) * static_cast<std::size_t>(grid.cells);
    const std::uint64_t each = (spot.photons + kSpotBatches - 1) / kSpotBatches;
    std::vector<std::vector<float>> pictures(kSpotBatches);
    parallel_for(kSpotBatches, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            pictures[k].resize(squares);
            Random random(spot.seed, k);
            for (std::uint64_t photon = 0; photon < each; ++photon) {
                if (photon % 256 == 0) progress.check_stop();
                walk.photon(random, pictures[k]);
            }
        }
    });
    const double area = grid.cell_mm() * grid.cell_mm();
    const auto unit = static_cast<float>(1.0 / (area * static_cast<double>(each * kSpotBatches)));
    std::vector<float> radiance(squares);
    for (const std::vector<float>& one : pictures) {
        for (std::size_t k = 0; k < squares; ++k) radiance[k] += unit * one[k];
    }
    return radiance;
}

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
