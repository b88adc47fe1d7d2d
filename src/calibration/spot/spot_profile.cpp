#include "calibration/spot/spot_profile.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "appearance/paint_figures.h"
#include "appearance/subsurface/fit_profile.h"
#include "appearance/subsurface/scattering_medium.h"
#include "core/error.h"

namespace livery {

namespace {

constexpr double kSpotsToFirstRing = 1.5, kPixelsToFirstRing = 3.0;
constexpr double kRingGrowth = 1.0625;
constexpr std::size_t kFewestRings = 6, kEighths = 8;
constexpr double kMostClipped = 0.1, kMostCircles = 50'000.0;
constexpr std::size_t kDarkRings = 3;  ///< in a row: the profile ends
/// Of the differences around the circle: with half of it dark it would be 2.6.
constexpr double kOverRingNoise = 3.0, kOverDifferences = 2.0;

/// Which eighth of the circle.
std::size_t eighth_of(const glm::dvec2& off) {
    const bool left = off.x < 0.0, below = off.y < 0.0;
    return (left ? 4u : 0u) + (below ? 2u : 0u) + (std::abs(off.x) > std::abs(off.y) ? 1u : 0u);
}

struct SpotRing {
    std::array<double, kEighths> light{}, area{};  ///< light times area, mm^2
    std::array<double, kEighths> light2{};         ///< squared light times area
    double ln_r = 0.0;                             ///< times area
    double clipped = 0.0;                          ///< area
    std::size_t pixels = 0;

    double whole_area() const {
        double sum = 0.0;
        for (const double one : area) sum += one;
        return sum;
    }
    double mean() const {
        double sum = 0.0;
        for (const double one : light) sum += one;
        return sum / whole_area();
    }
    /// Standard error of the mean, by how much pixels of one eighth differ.
    double noise() const {
        double squares = 0.0;
        for (std::size_t k = 0; k < kEighths; ++k) {
            if (area[k] > 0.0) squares += light2[k] - light[k] * light[k] / area[k];
        }
        return std::sqrt(std::max(squares, 0.0) / (whole_area() * static_cast<double>(pixels)));
    }
    /// The same, by how much its eighths differ.
    double standard_error() const {
        double squares = 0.0, count = 0.0;
        for (std::size_t k = 0; k < kEighths; ++k) {
            if (!(area[k] > 0.0)) continue;
            const double off = light[k] / area[k] - mean();
            squares += off * off;
            count += 1.0;
        }
        return count > 1.0 ? std::sqrt(squares / (count * (count - 1.0))) : mean();
    }
};

std::vector<double> ring_edges(const SpotOfLight& spot, double spot_mm) {
    std::vector<double> edges{
        std::max(kSpotsToFirstRing * spot_mm, kPixelsToFirstRing * spot.pixel_mm)};
    while (true) {
        const double next = std::max(kRingGrowth * edges.back(), edges.back() + spot.pixel_mm);
        if (next > spot.reach_mm) return edges;
        edges.push_back(next);
    }
}

/// The light of a pixel over what of the light below the boundary comes out in its direction; it
/// depends on the angle alone.
class EscapingShare {
  public:
    explicit EscapingShare(double eta) {
        for (std::size_t k = 0; k < share_.size(); ++k) {
            const double cosine = static_cast<double>(k) / static_cast<double>(share_.size() - 1);
            share_[k] = 1.0 - dielectric_reflectance(cosine, eta);
        }
    }
    double share(double cosine) const {
        const double at = std::clamp(cosine, 0.0, 1.0) * static_cast<double>(share_.size() - 1);
        const auto k = std::min(static_cast<std::size_t>(at), share_.size() - 2);
        const double part = at - static_cast<double>(k);
        return (1.0 - part) * share_[k] + part * share_[k + 1];
    }

  private:
    std::array<double, 4097> share_{};
};

/// Sums over rings, and over circles of one pixel or so from the middle on.
struct RingSums {
    std::vector<SpotRing> rings;
    std::vector<double> circles;  ///< light times area
    double step_mm = 0.0;         ///< from one circle to the next
};

RingSums sums_of(const PlanePixels& pixels,
                 const ImageF& sample,
                 const SpotOfLight& spot,
                 int channel,
                 const std::vector<double>& edges,
                 double eta) {
    const EscapingShare leaving(eta);
    RingSums sums;
    sums.rings.resize(edges.size() - 1);
    // A lens that somebody guessed may make pixels of nearly no size.
    sums.step_mm = std::max(spot.pixel_mm, edges.back() / kMostCircles);
    sums.circles.resize(static_cast<std::size_t>(edges.back() / sums.step_mm) + 1);
    for (int y = 0; y < pixels.height; ++y) {
        for (int x = 0; x < pixels.width; ++x) {
            const float* pixel = pixels.pixel(x, y);
            const auto area = static_cast<double>(pixel[2]);
            if (!(area > 0.0)) continue;
            const glm::dvec2 off = glm::dvec2(pixel[0], pixel[1]) - spot.centre_mm;
            const double r = glm::length(off);
            if (r >= edges.back()) continue;
            const auto value = static_cast<double>(sample.at(x, y, channel));
            const auto after = std::upper_bound(edges.begin(), edges.end(), r);
            SpotRing* ring = after == edges.begin()
                                 ? nullptr
                                 : &sums.rings[static_cast<std::size_t>(after - edges.begin()) - 1];
            if (std::isnan(value)) {
                if (r <= spot.radius_mm) {
                    throw Refused(fmt::format("the sample is saturated in every photograph where "
                                              "the spot is: pixel {},{}",
                                              x,
                                              y),
                                  "add a photograph of the sample with a shorter exposure");
                }
                if (ring) ring->clipped += area;
                continue;
            }
            const double light = area * value / leaving.share(static_cast<double>(pixel[3]));
            sums.circles[static_cast<std::size_t>(r / sums.step_mm)] += light;
            if (!ring) continue;
            const std::size_t eighth = eighth_of(off);
            ring->light[eighth] += light;
            ring->light2[eighth] += light * light / area;
            ring->area[eighth] += area;
            ring->ln_r += area * std::log(r);
            ++ring->pixels;
        }
    }
    return sums;
}

double sum_of(const std::vector<double>& circles, std::size_t count) {
    double sum = 0.0;
    for (std::size_t k = 0; k < count; ++k) sum += circles[k];
    return sum;
}

/// Radius within which this much light comes back; circles are `step_mm` wide.
double radius_of_share(const std::vector<double>& circles, double step_mm, double light) {
    double sum = 0.0;
    for (std::size_t k = 0; k < circles.size(); ++k) {
        if (sum + circles[k] >= light && circles[k] > 0.0) {
            return step_mm * (static_cast<double>(k) + (light - sum) / circles[k]);
        }
        sum += circles[k];
    }
    return step_mm * static_cast<double>(circles.size());
}

}  // namespace

double mean_transmittance(double eta) {
    // Directions inside fill a cone that refraction widens to the hemisphere.
    return 2.0 * eta * eta * fresnel_moments(eta).passed[0];
}

double mean_view_rad(double eta) {
    const FresnelMoments moments = fresnel_moments(eta);
    const double cosine = moments.passed[1] / moments.passed[0];
    return std::asin(std::min(eta * std::sqrt(1.0 - cosine * cosine), 1.0));
}

SpotProfile spot_profile(const PlanePixels& pixels,
                         const ImageF& sample,
                         const SpotOfLight& spot,
                         int channel,
                         const SpotOptics& optics) {
    const auto c = static_cast<std::size_t>(channel);
    check_argument(spot.power[c] > 0.0, "spot_profile: a spot without light");
    SpotProfile profile;
    profile.spot_mm = spot.diameter_mm[c];
    const std::vector<double> edges = ring_edges(spot, profile.spot_mm);
    const auto refuse_few = [&](std::size_t rings, double to_mm, const char* why) {
        throw Refused(
            fmt::format("only {} rings lie between {:.3g} mm, where the spot ends, and "
                        "{:.3g} mm, where {}",
                        rings,
                        edges.front(),
                        to_mm,
                        why),
            "a narrower and brighter spot in the middle of the picture, longer exposures");
    };
    if (edges.size() < kFewestRings + 1) {
        refuse_few(edges.size() - 1, spot.reach_mm, "the picture does");
    }
    const RingSums sums = sums_of(pixels, sample, spot, channel, edges, optics.eta);

    // Radiance off white is albedo/pi times irradiance; the sample's exitance pi times radiance
    // below the boundary times its mean transmittance; what enters, the boundary's share.
    const double scale =
        optics.white_albedo[channel] * mean_transmittance(optics.eta) /
        ((1.0 - dielectric_reflectance(optics.incidence_cosine, optics.eta)) * spot.power[c]);
    double end_mm = edges.front();
    std::size_t dark = 0;
    for (std::size_t k = 0; k < sums.rings.size() && dark < kDarkRings; ++k) {
        const SpotRing& ring = sums.rings[k];
        const double area = ring.whole_area();
        if (!(area > 0.0) || ring.clipped > kMostClipped * (area + ring.clipped)) {
            ++profile.clipped_rings;
            continue;
        }
        const double mean = ring.mean(), error = ring.standard_error();
        const bool in_noise = !(mean > kOverRingNoise * ring.noise());
        if (in_noise || !(mean > kOverDifferences * error)) {
            ++profile.doubtful_rings;
            // Beside the spot a slanting look sees light from along the beam, on one side: no end.
            if (in_noise && !profile.samples.empty()) ++dark;
            continue;
        }
        dark = 0;
        end_mm = edges[k + 1];
        profile.samples.push_back({std::exp(ring.ln_r / area), scale * mean});
        profile.standard_errors.push_back(scale * error);
        profile.pixels.push_back(ring.pixels);
    }
    profile.ends_in_noise = dark > 0;
    if (profile.samples.size() < kFewestRings) {
        refuse_few(profile.samples.size(), end_mm, "noise rules or photographs are saturated");
    }
    const auto within =
        std::min(sums.circles.size(), static_cast<std::size_t>(end_mm / sums.step_mm));
    const double whole = sum_of(sums.circles, within);
    profile.total_reflectance = scale * whole;
    profile.half_energy_radius_mm = radius_of_share(sums.circles, sums.step_mm, 0.5 * whole);
    refuse_wide_spot(profile.spot_mm, profile.half_energy_radius_mm);
    return profile;
}

}  // namespace livery
