#include "calibration/sphere/sphere_reflectance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "appearance/measured/half_difference.h"
#include "core/error.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr double kRightAngle = 0.5 * std::numbers::pi;
const double kLowestCosine = std::cos(80.0 / 180.0 * std::numbers::pi);
constexpr double kWhiteCosine = 0.5;
constexpr double kClothFrom = 1.08, kClothTo = 1.3;  ///< of the outline's angle
constexpr std::size_t kFewestCloth = 100, kFewestWhite = 100;
constexpr double kOverVeil = 2.0;
constexpr std::size_t kSides = 4;  ///< of the sphere on which a cell is seen by one lamp

/// What a pixel sees of the sphere.
struct Place {
    std::size_t pixel = 0;
    glm::dvec3 position_mm{0.0}, normal{0.0}, tangent{0.0};
    glm::dvec3 wo{0.0};  ///< toward the camera, in local coordinates
};

struct SeenSphere {
    std::vector<Place> places;
    std::vector<std::size_t> cloth;  ///< pixels around it
};

glm::dvec3 local(const Place& place, const glm::dvec3& direction) {
    return {glm::dot(direction, place.tangent),
            glm::dot(direction, glm::cross(place.normal, place.tangent)),
            glm::dot(direction, place.normal)};
}

/// The pixels whose middles see the sphere less than `lowest_cosine` aslant.
SeenSphere seen_sphere(const View& view, const Sphere& sphere, double lowest_cosine) {
    const glm::dvec3 eye = centre_in_world(view), to_centre = sphere.centre_mm - eye;
    const double distance = glm::length(to_centre), radius = 0.5 * sphere.diameter_mm;
    const double outline = std::asin(std::min(radius / distance, 1.0));
    const auto width = static_cast<std::size_t>(view.width);
    std::vector<glm::dvec3> rays(width * static_cast<std::size_t>(view.height));
    parallel_for(rays.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            rays[k] = ray_through(view, glm::dvec2(k % width, k / width) + 0.5).direction;
        }
    });
    SeenSphere seen;
    for (std::size_t k = 0; k < rays.size(); ++k) {
        const double along = glm::dot(rays[k], to_centre);
        const double aside = glm::length(glm::cross(rays[k], to_centre));
        const double angle = std::atan2(aside, along);
        if (angle > kClothFrom * outline && angle < kClothTo * outline) seen.cloth.push_back(k);
        if (aside >= radius || along <= 0.0) continue;
        Place place;
        place.pixel = k;
        place.position_mm = eye + (along - std::sqrt(radius * radius - aside * aside)) * rays[k];
        place.normal = (place.position_mm - sphere.centre_mm) / radius;
        const glm::dvec3 helper =
            std::abs(place.normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        place.tangent = glm::normalize(glm::cross(helper, place.normal));
        place.wo = local(place, -rays[k]);
        if (place.wo.z >= lowest_cosine) seen.places.push_back(place);
    }
    return seen;
}

bool is_saturated(const MergedPhotographs& picture, std::size_t pixel) {
    const float* seconds = picture.seconds.values.data() + 3 * pixel;
    return !(seconds[0] > 0.0f && seconds[1] > 0.0f && seconds[2] > 0.0f);
}

glm::dvec3 rgb(const ImageF& image, std::size_t pixel) {
    const float* value = image.values.data() + 3 * pixel;
    return {value[0], value[1], value[2]};
}

/// Direction toward a lamp in local coordinates, and 1 / mm^2 of its distance.
struct LampRay {
    glm::dvec3 wi;
    double falloff;
};

LampRay toward(const Place& place, const glm::dvec3& light_mm) {
    const glm::dvec3 way = light_mm - place.position_mm;
    const double squared = glm::dot(way, way);
    return {local(place, way / std::sqrt(squared)), LIVERY_MUTATED(sphere_falloff, 1.0 / squared)};
}

struct AngleCell {
    glm::dvec3 counts{0.0}, expected{0.0};  ///< expected: of a reflectance of 1 per steradian
    glm::dvec3 angles{0.0};                 ///< sum, weighted
    double weight = 0.0;
    double looks = 0.0, looks_weight = 0.0, looks_sum = 0.0, looks_squares = 0.0;
};

/// One lamp's view of a cell on one side of the sphere.
struct SphereLook {
    double counts = 0.0, expected = 0.0, weight = 0.0;
};

class AngleCells {
  public:
    explicit AngleCells(const SphereGrid& grid)
        : grid_(grid),
          cells_(static_cast<std::size_t>(grid.theta_h * grid.theta_d * grid.phi_d)),
          looks_(cells_.size() * kSides) {}

    /// `expected`: the counts of a reflectance of 1 per steradian.
    void add(const glm::dvec3& wi,
             const glm::dvec3& wo,
             const glm::dvec3& counts,
             const glm::dvec3& expected) {
        glm::dvec3 angles = f64::half_difference(wi, wo);
        const bool mirrored = angles.z > kRightAngle;
        if (mirrored) angles.z = std::numbers::pi - angles.z;
        const std::size_t index = index_of(angles);
        AngleCell& cell = cells_[index];
        const double weight = expected.x + expected.y + expected.z;
        cell.counts += counts;
        cell.expected += expected;
        cell.angles += weight * angles;
        cell.weight += weight;
        // Which of light and eye stands lower tells on which side of the highlight this is.
        const std::size_t look = kSides * index + (mirrored ? 2 : 0) + (wi.z > wo.z ? 1 : 0);
        if (looks_[look].weight == 0.0) touched_.push_back(look);
        looks_[look].counts += counts.x + counts.y + counts.z;
        looks_[look].expected += weight;
        looks_[look].weight += wi.z;
    }

    /// Call after each lamp.
    void end_lamp() {
        for (const std::size_t k : touched_) {
            const SphereLook& look = looks_[k];
            const double value = look.counts / look.expected;
            AngleCell& cell = cells_[k / kSides];
            cell.looks += 1.0;
            cell.looks_weight += look.weight;
            cell.looks_sum += look.weight * value;
            cell.looks_squares += look.weight * value * value;
            looks_[k] = {};
        }
        touched_.clear();
    }

    void finish(SphereReflectance& result) const {
        double squares = 0.0, weights = 0.0, domain = 0.0, seen = 0.0;
        std::vector<double> deviations;
        for (std::size_t k = 0; k < cells_.size(); ++k) {
            const AngleCell& cell = cells_[k];
            const double share = solid_angle(k);
            domain += share;
            if (cell.weight <= 0.0) continue;
            seen += share;
            add_samples(cell, result);
            const double mean = cell.looks_sum / cell.looks_weight;
            if (cell.looks < 2.0 || mean <= 0.0) continue;
            const double variance =
                std::max(cell.looks_squares / cell.looks_weight - mean * mean, 0.0) * cell.looks /
                (cell.looks - 1.0) / (mean * mean);
            squares += cell.looks_weight * variance;
            weights += cell.looks_weight;
            deviations.push_back(std::sqrt(variance));
        }
        result.coverage = seen / domain;
        result.residual = weights > 0.0 ? std::sqrt(squares / weights) : 0.0;
        result.residual_median = median(std::move(deviations));
    }

  private:
    std::size_t index_of(const glm::dvec3& angles) const {
        const auto step = [](double share, int count) {
            return std::clamp(static_cast<int>(share * count), 0, count - 1);
        };
        const int h = step(std::sqrt(angles.x / kRightAngle), grid_.theta_h);
        const int d = step(angles.y / kRightAngle, grid_.theta_d);
        const int phi = step(angles.z / kRightAngle, grid_.phi_d);
        return static_cast<std::size_t>((h * grid_.theta_d + d) * grid_.phi_d + phi);
    }

    static DirectionPair pair_at(const glm::dvec3& angles) {
        const glm::dvec3 h(std::sin(angles.x), 0.0, std::cos(angles.x));
        const glm::dvec3 across(std::cos(angles.x), 0.0, -std::sin(angles.x));
        const glm::dvec3 aside = std::sin(angles.y) * (std::cos(angles.z) * across +
                                                       glm::dvec3(0.0, std::sin(angles.z), 0.0));
        return {std::cos(angles.y) * h + aside, std::cos(angles.y) * h - aside};
    }

    /// Of the pairs of directions in a cell; 0 where its middle is beyond 80 degrees.
    double solid_angle(std::size_t cell) const {
        const auto index = static_cast<int>(cell);
        const double root = (index / grid_.phi_d / grid_.theta_d + 0.5) / grid_.theta_h;
        const double theta_d =
            kRightAngle * (index / grid_.phi_d % grid_.theta_d + 0.5) / grid_.theta_d;
        const double phi_d = kRightAngle * (index % grid_.phi_d + 0.5) / grid_.phi_d;
        const double theta_h = kRightAngle * root * root;
        const DirectionPair pair = pair_at({theta_h, theta_d, phi_d});
        if (pair.wi.z < kLowestCosine || pair.wo.z < kLowestCosine) return 0.0;
        // d wi d wo = 4 cos(theta_d) d h d wi'; theta_h steps as its root.
        return std::cos(theta_d) * std::sin(theta_d) * std::sin(theta_h) * root;
    }

    static void add_samples(const AngleCell& cell, SphereReflectance& result) {
        const glm::dvec3 value = cell.counts / cell.expected;
        if (value.x + value.y + value.z <= 0.0) return;
        glm::dvec3 angles = cell.angles / cell.weight;
        for (int side = 0; side < 2; ++side) {
            result.pairs.push_back(pair_at(angles));
            result.values.push_back(value);
            angles.z = std::numbers::pi - angles.z;
        }
    }

    SphereGrid grid_;
    std::vector<AngleCell> cells_;
    std::vector<SphereLook> looks_;
    std::vector<std::size_t> touched_;
};

/// Light a second that reaches the dark cloth, or seems to: what the lens scatters and the room
/// adds.
glm::dvec3 veil_around(const SeenSphere& seen, const MergedPhotographs& picture) {
    std::array<std::vector<double>, 3> values;
    for (const std::size_t pixel : seen.cloth) {
        if (is_saturated(picture, pixel)) continue;
        const glm::dvec3 light = rgb(picture.counts, pixel) / rgb(picture.seconds, pixel);
        for (int c = 0; c < 3; ++c) values[static_cast<std::size_t>(c)].push_back(light[c]);
    }
    if (values[0].size() < kFewestCloth) {
        throw Refused("no dark cloth shows around the sphere",
                      "leave a quarter of its diameter free on each side of it");
    }
    glm::dvec3 veil;
    for (std::size_t c = 0; c < 3; ++c) {
        veil[static_cast<int>(c)] = median(std::move(values[c]));
    }
    return veil;
}

}  // namespace

void check_lit(const View& view, const Sphere& sphere, std::span<const LitSphere> lit) {
    const SeenSphere seen = seen_sphere(view, sphere, kLowestCosine);
    std::size_t reached = 0, saturated = 0;
    for (const LitSphere& one : lit) {
        for (const Place& place : seen.places) {
            if (toward(place, one.light_mm).wi.z < kLowestCosine) continue;
            ++reached;
            if (is_saturated(one.picture, place.pixel)) ++saturated;
        }
    }
    if (reached == 0) {
        throw Refused("no light shines on the side of the sphere that the camera sees",
                      "place lights before the sphere too, and check light_position_mm");
    }
    if (saturated == reached) {
        throw Refused("the sphere is saturated in every photograph",
                      "add photographs with a shorter exposure");
    }
}

LampResponse lamp_response(const View& view,
                           const Sphere& sphere,
                           const LitSphere& white,
                           const glm::dvec3& reflectance) {
    const SeenSphere seen = seen_sphere(view, sphere, kWhiteCosine);
    const glm::dvec3 veil = veil_around(seen, white.picture);
    glm::dvec3 counts(0.0), expected(0.0);
    std::size_t reached = 0, used = 0;
    const auto for_each = [&](const auto& use) {
        for (const Place& place : seen.places) {
            const LampRay ray = toward(place, white.light_mm);
            if (ray.wi.z < kWhiteCosine) continue;
            ++reached;
            if (is_saturated(white.picture, place.pixel)) continue;
            ++used;
            const glm::dvec3 seconds = rgb(white.picture.seconds, place.pixel);
            use(rgb(white.picture.counts, place.pixel) - veil * seconds,
                reflectance / std::numbers::pi * ray.wi.z * ray.falloff * seconds);
        }
    };
    for_each([&](const glm::dvec3& seen_counts, const glm::dvec3& matte) {
        counts += seen_counts;
        expected += matte;
    });
    if (used < kFewestWhite || 2 * used < reached) {
        throw Refused(reached < kFewestWhite
                          ? "the light hardly reaches the side of the white sphere that is seen"
                          : "the white sphere is saturated",
                      reached < kFewestWhite
                          ? "photograph it under a light that stands near the camera"
                          : "photograph it with a shorter exposure");
    }
    LampResponse lamp;
    lamp.units = LIVERY_MUTATED(sphere_lamp, counts / expected);
    if (!(lamp.units.x > 0.0 && lamp.units.y > 0.0 && lamp.units.z > 0.0)) {
        throw Refused("the white sphere is not brighter than the cloth around it",
                      "check the white reference's file, exposure and black level");
    }
    double squares = 0.0, weights = 0.0;
    for_each([&](const glm::dvec3& seen_counts, const glm::dvec3& matte) {
        const glm::dvec3 off = seen_counts / (matte * lamp.units) - 1.0;
        squares += glm::dot(off, off) * matte.y;
        weights += 3.0 * matte.y;
    });
    lamp.rms = std::sqrt(squares / weights);
    return lamp;
}

SphereReflectance sphere_reflectance(const View& view,
                                     const Sphere& sphere,
                                     std::span<const LitSphere> lit,
                                     std::span<const LampResponse> lamps,
                                     const SphereGrid& grid,
                                     const Progress& progress) {
    check_argument(
        lit.size() == lamps.size() && !lit.empty(),
        fmt::format("sphere_reflectance: {} pictures, {} lamps", lit.size(), lamps.size()));
    check_argument(grid.theta_h > 0 && grid.theta_d > 0 && grid.phi_d > 0,
                   "sphere_reflectance: an empty grid");
    const SeenSphere seen = seen_sphere(view, sphere, kLowestCosine);
    AngleCells cells(grid);
    SphereReflectance result;
    for (std::size_t k = 0; k < lit.size(); ++k) {
        progress.update(static_cast<double>(k) / static_cast<double>(lit.size()), "sorting pixels");
        const MergedPhotographs& picture = lit[k].picture;
        const glm::dvec3 veil = veil_around(seen, picture);
        const double veil_sum = std::max(veil.x + veil.y + veil.z, 0.0);
        for (const Place& place : seen.places) {
            const LampRay ray = toward(place, lit[k].light_mm);
            if (ray.wi.z < kLowestCosine) continue;
            if (is_saturated(picture, place.pixel)) {
                ++result.saturated;
                continue;
            }
            const glm::dvec3 seconds = rgb(picture.seconds, place.pixel);
            const glm::dvec3 counts = rgb(picture.counts, place.pixel);
            const glm::dvec3 light = counts / seconds;
            if (light.x + light.y + light.z < kOverVeil * veil_sum) {
                ++result.dark;
                continue;
            }
            ++result.pixels;
            cells.add(ray.wi,
                      place.wo,
                      counts - veil * seconds,
                      lamps[k].units * ray.wi.z * ray.falloff * seconds);
        }
        cells.end_lamp();
    }
    if (result.pixels == 0) {
        throw Refused("the sphere is nowhere clearly brighter than the cloth around it",
                      "use a darker cloth, shade it, and keep other light out");
    }
    cells.finish(result);
    return result;
}

}  // namespace livery
