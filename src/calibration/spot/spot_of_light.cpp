#include "calibration/spot/spot_of_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {

namespace {

/// Area by the places of a pixel's neighbours; at the picture's edge, of itself and one neighbour.
float area_of(const PlanePixels& pixels, int x, int y) {
    const int left = std::max(x - 1, 0), right = std::min(x + 1, pixels.width - 1);
    const int up = std::max(y - 1, 0), down = std::min(y + 1, pixels.height - 1);
    const float *l = pixels.pixel(left, y), *r = pixels.pixel(right, y);
    const float *u = pixels.pixel(x, up), *d = pixels.pixel(x, down);
    for (const float* one : {l, r, u, d}) {
        if (!(one[3] > 0.0f)) return 0.0f;
    }
    const auto columns = static_cast<float>(right - left), rows = static_cast<float>(down - up);
    const float across = (r[0] - l[0]) * (d[1] - u[1]) - (r[1] - l[1]) * (d[0] - u[0]);
    return columns > 0.0f && rows > 0.0f ? std::abs(across) / (columns * rows) : 0.0f;
}

}  // namespace

glm::dvec3 axis_across(const SamplePlane& plane) {
    const glm::dvec3& n = plane.normal;
    const glm::dvec3 helper = std::abs(n.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return glm::normalize(helper - glm::dot(helper, n) * n);
}

PlanePixels plane_pixels(const View& view, const SamplePlane& plane) {
    const glm::dvec3 across = axis_across(plane), along = glm::cross(plane.normal, across);
    PlanePixels pixels(view.width, view.height, 4);
    const auto height = static_cast<std::size_t>(view.height);
    parallel_for(height, 8, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < view.width; ++x) {
                const auto ray = find_ray(view, {x + 0.5, y + 0.5});
                if (!ray) continue;
                const double cosine = -glm::dot(ray->direction, plane.normal);
                const double above = glm::dot(ray->origin - plane.point_mm, plane.normal);
                if (!(cosine > 1e-3 && above > 0.0)) continue;
                const glm::dvec3 at =
                    ray->origin + above / cosine * ray->direction - plane.point_mm;
                float* pixel = pixels.pixel(x, y);
                pixel[0] = static_cast<float>(glm::dot(at, across));
                pixel[1] = static_cast<float>(glm::dot(at, along));
                pixel[3] = static_cast<float>(cosine);
            }
        }
    });
    parallel_for(height, 8, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < view.width; ++x) pixels.at(x, y, 2) = area_of(pixels, x, y);
        }
    });
    return pixels;
}

namespace {

constexpr double kOverNoise = 8.0;  ///< of means of 3x3 pixels, which many are
constexpr double kFaintChannel = 0.01;
constexpr double kDiscOfHalf = 6.0;  ///< its radius over that of half the power
constexpr int kRounds = 4;
constexpr std::size_t kNoiseSamples = 100'000;
const char* const kChannelNames[] = {"red", "green", "blue"};

glm::dvec2 place_of(const PlanePixels& pixels, int x, int y) {
    const float* one = pixels.pixel(x, y);
    return {one[0], one[1]};
}

/// Sum of the channels, of 3x3 pixels' mean; NaN where one is not known or sees no plane.
double smooth_light(const PlanePixels& pixels, const ImageF& light, int x, int y) {
    double sum = 0.0;
    for (int v = y - 1; v <= y + 1; ++v) {
        for (int u = x - 1; u <= x + 1; ++u) {
            if (!(pixels.at(u, v, 2) > 0.0f)) return std::numeric_limits<double>::quiet_NaN();
            for (int c = 0; c < 3; ++c) sum += static_cast<double>(light.at(u, v, c)) / 9.0;
        }
    }
    return sum;
}

struct Peak {
    int x = 0, y = 0;
    double light = 0.0, radius_mm = 0.0;
};

/// The brightest place, and the radius of a disc as large as what is half as bright.
Peak find_peak(const PlanePixels& pixels, const ImageF& light) {
    Peak peak;
    std::vector<double> all;
    const std::size_t step = std::max<std::size_t>(light.pixel_count() / kNoiseSamples, 1) | 1u;
    std::size_t unknown = 0, count = 0;
    for (int y = 1; y + 1 < light.height; ++y) {
        for (int x = 1; x + 1 < light.width; ++x) {
            const double here = smooth_light(pixels, light, x, y);
            if (std::isnan(here)) {
                ++unknown;
                continue;
            }
            if (count++ % step == 0) all.push_back(here);
            if (here <= peak.light) continue;
            peak.light = here;
            peak.x = x;
            peak.y = y;
        }
    }
    if (count == 0) {
        throw Refused("every pixel of the white reference is saturated in every photograph",
                      "add photographs with a shorter exposure");
    }
    const double middle = median(all);
    for (double& one : all) one = std::abs(one - middle);
    const double noise = 1.4826 * median(all);
    if (!(peak.light > middle + kOverNoise * noise)) {
        throw Refused("no spot of light shows on the white reference",
                      "compare the photographs with the spot and those of the projector's black: "
                      "they should differ by the spot alone; add longer exposures");
    }
    double area = 0.0;
    for (int y = 1; y + 1 < light.height; ++y) {
        for (int x = 1; x + 1 < light.width; ++x) {
            if (smooth_light(pixels, light, x, y) > 0.5 * peak.light) {
                area += static_cast<double>(pixels.at(x, y, 2));
            }
        }
    }
    peak.radius_mm = std::sqrt(area / std::numbers::pi);
    return peak;
}

/// Calls body(x, y, distance from `centre`, mm) for the pixels within `radius_mm`.
template <typename Body>
void for_each_within(const PlanePixels& pixels,
                     const glm::dvec2& centre,
                     double radius_mm,
                     const Body& body) {
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            if (!(pixels.at(x, y, 2) > 0.0f)) continue;
            const double distance = glm::distance(place_of(pixels, x, y), centre);
            if (distance <= radius_mm) body(x, y, distance);
        }
    }
}

/// Radius of half of the power, of one channel or (-1) of all; `power` gets the whole.
double half_power_radius(const PlanePixels& pixels,
                         const ImageF& light,
                         const glm::dvec2& centre,
                         double radius_mm,
                         int channel,
                         double& power) {
    std::vector<std::pair<double, double>> parts;
    power = 0.0;
    for_each_within(pixels, centre, radius_mm, [&](int x, int y, double distance) {
        double here = 0.0;
        for (int c = 0; c < 3; ++c) {
            const auto one = static_cast<double>(light.at(x, y, c));
            if ((channel < 0 || channel == c) && !std::isnan(one)) here += one;
        }
        here *= static_cast<double>(pixels.at(x, y, 2));
        power += here;
        parts.emplace_back(distance, here);
    });
    std::sort(parts.begin(), parts.end());
    double sum = 0.0, before = 0.0;
    for (const auto& [distance, here] : parts) {
        // Pixels are met at their middles: half of one counts as within its own distance.
        const double now = sum + 0.5 * here;
        if (now >= 0.5 * power) return 0.5 * (before + distance);
        sum += here;
        before = distance;
    }
    return radius_mm;
}

double nearest_edge_mm(const PlanePixels& pixels, const glm::dvec2& centre) {
    double nearest = std::numeric_limits<double>::infinity();
    const auto meet = [&](int x, int y) {
        if (!(pixels.at(x, y, 2) > 0.0f)) return;
        nearest = std::min(nearest, glm::distance(place_of(pixels, x, y), centre));
    };
    for (int x = 0; x < pixels.width; ++x) {
        meet(x, 0);
        meet(x, pixels.height - 1);
    }
    for (int y = 0; y < pixels.height; ++y) {
        meet(0, y);
        meet(pixels.width - 1, y);
    }
    return nearest;
}

void refuse_clipped(const PlanePixels& pixels, const ImageF& light, const SpotOfLight& spot) {
    for_each_within(pixels, spot.centre_mm, spot.radius_mm, [&](int x, int y, double) {
        for (int c = 0; c < 3; ++c) {
            if (!std::isnan(light.at(x, y, c))) continue;
            throw Refused(fmt::format("the spot on the white reference is saturated in every "
                                      "photograph: pixel {},{}, {}",
                                      x,
                                      y,
                                      kChannelNames[c]),
                          "add a photograph of white with a shorter exposure");
        }
    });
}

void refuse_cut(const SpotOfLight& spot) {
    if (spot.radius_mm <= spot.reach_mm) return;
    throw Refused(
        fmt::format("the spot on the white reference is not wholly in the picture: its light is "
                    "looked for within {:.3g} mm of its middle, and the picture's nearest edge is "
                    "{:.3g} mm away",
                    spot.radius_mm,
                    spot.reach_mm),
        "put the spot into the middle of the picture, or make it narrower");
}

}  // namespace

ImageF added_light(const MergedPhotographs& lit, const MergedPhotographs& black) {
    check_argument(
        lit.counts.width == black.counts.width && lit.counts.height == black.counts.height,
        fmt::format("added_light: {}x{} pixels and {}x{} of black",
                    lit.counts.width,
                    lit.counts.height,
                    black.counts.width,
                    black.counts.height));
    ImageF light(lit.counts.width, lit.counts.height, 3);
    for (std::size_t k = 0; k < light.values.size(); ++k) {
        const float seconds = lit.seconds.values[k], of_black = black.seconds.values[k];
        light.values[k] = seconds > 0.0f && of_black > 0.0f
                              ? lit.counts.values[k] / seconds - black.counts.values[k] / of_black
                              : std::numeric_limits<float>::quiet_NaN();
    }
    return light;
}

glm::dvec2 centre_of_light(const PlanePixels& pixels,
                           const ImageF& light,
                           const glm::dvec2& around_mm,
                           double radius_mm) {
    glm::dvec2 sum(0.0);
    double power = 0.0;
    for_each_within(pixels, around_mm, radius_mm, [&](int x, int y, double) {
        for (int c = 0; c < 3; ++c) {
            const auto one = static_cast<double>(light.at(x, y, c));
            if (std::isnan(one)) continue;
            const double part = one * static_cast<double>(pixels.at(x, y, 2));
            sum += part * place_of(pixels, x, y);
            power += part;
        }
    });
    return power > 0.0 ? sum / power : around_mm;
}

SpotOfLight spot_of_light(const PlanePixels& pixels, const ImageF& light) {
    check_argument(pixels.width == light.width && pixels.height == light.height,
                   "spot_of_light: a picture of another size than the camera's");
    const Peak peak = find_peak(pixels, light);
    SpotOfLight spot;
    spot.centre_mm = place_of(pixels, peak.x, peak.y);
    spot.pixel_mm = std::sqrt(static_cast<double>(pixels.at(peak.x, peak.y, 2)));
    double half_mm = std::max(peak.radius_mm, spot.pixel_mm);
    for (int round = 0; round < kRounds; ++round) {
        spot.radius_mm = kDiscOfHalf * half_mm;
        spot.reach_mm = nearest_edge_mm(pixels, spot.centre_mm);
        refuse_cut(spot);
        refuse_clipped(pixels, light, spot);
        spot.centre_mm = centre_of_light(pixels, light, spot.centre_mm, spot.radius_mm);
        double power = 0.0;
        half_mm = half_power_radius(pixels, light, spot.centre_mm, spot.radius_mm, -1, power);
        half_mm = std::max(half_mm, 0.5 * spot.pixel_mm);
    }
    spot.reach_mm = nearest_edge_mm(pixels, spot.centre_mm);
    refuse_cut(spot);
    for (std::size_t c = 0; c < 3; ++c) {
        spot.diameter_mm[c] =
            2.0 *
            half_power_radius(
                pixels, light, spot.centre_mm, spot.radius_mm, static_cast<int>(c), spot.power[c]);
    }
    const double strongest = *std::max_element(spot.power.begin(), spot.power.end());
    for (std::size_t c = 0; c < 3; ++c) {
        if (!(spot.power[c] > kFaintChannel * strongest)) spot.power[c] = spot.diameter_mm[c] = 0.0;
    }
    return spot;
}

}  // namespace livery
