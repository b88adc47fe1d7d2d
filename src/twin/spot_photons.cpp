#include "twin/spot_photons.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "core/random.h"

namespace livery {

namespace {

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

}  // namespace

double mirrored_outside(double cosine, double eta, double& within) {
    within = std::sqrt(std::max(1.0 - (1.0 - cosine * cosine) / (eta * eta), 0.0));
    const double across = (cosine - eta * within) / (cosine + eta * within);
    const double along = (eta * cosine - within) / (eta * cosine + within);
    return 0.5 * (across * across + along * along);
}

std::vector<float> spot_radiance(const ScatteringMedium& medium,
                                 const SpotGrid& grid,
                                 const PhotonSpot& spot,
                                 const Progress& progress) {
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

}  // namespace livery
