#include "appearance/subsurface/monte_carlo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include "appearance/subsurface/layered_sources.h"
#include "appearance/subsurface/scattering_medium.h"
#include "core/mutation.h"
#include "core/parallel.h"
#include "core/random.h"

namespace livery {

namespace {

constexpr std::size_t kBatches = 64;
constexpr std::size_t kBatchesAtOnce = 16;
constexpr int kMostScatterings = 20'000;
/// Of lighter photons one in five goes on, five times as heavy. What that gains and loses is
/// nothing in the mean and is booked as absorbed, so that powers add up.
constexpr double kLightWeight = 0.02, kSurvivors = 0.2;
/// Of a flight of so many mean free paths nothing is scored.
constexpr double kOutOfReach = 40.0;

/// Rings of any order and overlap, cut into pieces that do not overlap.
class RingPieces {
  public:
    explicit RingPieces(const std::vector<ProfileRing>& rings) {
        for (const ProfileRing& ring : rings) {
            edges2_.push_back(ring.inner_mm * ring.inner_mm);
            edges2_.push_back(ring.outer_mm * ring.outer_mm);
        }
        std::sort(edges2_.begin(), edges2_.end());
        edges2_.erase(std::unique(edges2_.begin(), edges2_.end()), edges2_.end());
    }
    /// Piece 0 is within the first edge, the last one beyond all.
    std::size_t count() const { return edges2_.size() + 1; }
    std::size_t find(double radius2) const {
        return static_cast<std::size_t>(std::upper_bound(edges2_.begin(), edges2_.end(), radius2) -
                                        edges2_.begin());
    }
    double mean_over(const ProfileRing& ring, const std::vector<double>& power) const {
        const std::size_t first = find(ring.inner_mm * ring.inner_mm);
        const std::size_t last = find(ring.outer_mm * ring.outer_mm);
        double sum = 0.0;
        for (std::size_t k = first; k < last; ++k) sum += power[k];
        const double area =
            std::numbers::pi * (ring.outer_mm - ring.inner_mm) * (ring.outer_mm + ring.inner_mm);
        return sum / area;
    }

  private:
    std::vector<double> edges2_;
};

/// What one batch of photons did, in photons.
struct PhotonTally {
    std::vector<double> top, bottom;  ///< by pieces of rings
    double reflected = 0.0, transmitted = 0.0, absorbed = 0.0;
    double unscattered_reflected = 0.0, unscattered_transmitted = 0.0;
};

/// A direction after a scattering (Henyey and Greenstein 1941).
glm::dvec3 scattered(const glm::dvec3& from, double g, Random& random) {
    double x = 0.0, y = 0.0, length2 = 0.0;
    do {
        x = 2.0 * random.uniform() - 1.0;
        y = 2.0 * random.uniform() - 1.0;
        length2 = x * x + y * y;
    } while (length2 > 1.0 || length2 == 0.0);
    const double to_unit = 1.0 / std::sqrt(length2);
    x *= to_unit;
    y *= to_unit;
    const double u = 2.0 * random.uniform() - 1.0;
    if (g == 0.0) {
        const double sine = std::sqrt(std::max(1.0 - u * u, 0.0));
        return {sine * x, sine * y, u};
    }
    double cosine = u;
    if (std::abs(g) > 1e-6) {
        const double t = (1.0 - g) * (1.0 + g) / (1.0 + g * u);
        cosine = std::clamp((1.0 + g * g - t * t) / (2.0 * g), -1.0, 1.0);
    }
    const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
    // A frame around `from` (Duff et al. 2017).
    const double sign = std::copysign(1.0, from.z);
    const double a = -1.0 / (sign + from.z), b = from.x * from.y * a;
    const glm::dvec3 s{1.0 + sign * from.x * from.x * a, sign * b, -sign * from.x};
    const glm::dvec3 t{b, sign + from.y * from.y * a, -from.y};
    const glm::dvec3 to = sine * x * s + sine * y * t + cosine * from;
    return to / std::sqrt(to.x * to.x + to.y * to.y + to.z * to.z);
}

/// Where a photon is: the layer, and its depth under the top of all.
struct PhotonPlace {
    std::size_t layer = 0;
    double depth_mm = 0.0;
};

/// Layers without boundaries between them: a flight is straight through all of them.
class Strata {
  public:
    explicit Strata(const ScatteringStack& stack) {
        double from = 0.0, optical = 0.0;
        for (const ScatteringMedium& layer : stack.layers) {
            const double thickness =
                layer.thickness_mm.value_or(std::numeric_limits<double>::infinity());
            const double sigma_t = layer.sigma_t();
            layers_.push_back({from,
                               from + thickness,
                               optical,
                               sigma_t,
                               sigma_t > 0.0 ? layer.sigma_s_per_mm / sigma_t : 0.0,
                               layer.g});
            from += thickness;
            if (sigma_t > 0.0) optical += sigma_t * thickness;
        }
        optical_ = optical;
    }
    struct Layer {
        double top, bottom, optical, sigma_t, albedo, g;
    };
    const Layer& at(std::size_t layer) const { return layers_[layer]; }
    std::size_t last() const { return layers_.size() - 1; }
    double thickness() const { return layers_.back().bottom; }

    /// Mean free paths from a place straight up, or down, to the boundary.
    double optical_to_boundary(const PhotonPlace& place, bool up) const {
        const Layer& layer = layers_[place.layer];
        if (layers_.size() == 1) {
            return layer.sigma_t * (up ? place.depth_mm : layer.bottom - place.depth_mm);
        }
        const double here = layer.optical + layer.sigma_t * (place.depth_mm - layer.top);
        return up ? here : std::max(optical_ - here, 0.0);
    }
    /// How far a flight of so many mean free paths goes, which meets something before a boundary;
    /// `place` becomes where.
    double fly(PhotonPlace& place, double flight, double cosine) const {
        double flown = 0.0;
        while (true) {
            const Layer& layer = layers_[place.layer];
            const double room = cosine < 0.0   ? (layer.top - place.depth_mm) / cosine
                                : cosine > 0.0 ? (layer.bottom - place.depth_mm) / cosine
                                               : std::numeric_limits<double>::infinity();
            const bool ends = place.layer == (cosine < 0.0 ? 0 : last());
            const double here = layer.sigma_t > 0.0 ? flight / layer.sigma_t : room;
            if (ends || (here < room && layer.sigma_t > 0.0)) {
                place.depth_mm += here * cosine;
                return flown + here;
            }
            flight = std::max(flight - layer.sigma_t * room, 0.0);
            flown += room;
            place.depth_mm = cosine < 0.0 ? layer.top : layer.bottom;
            place.layer = cosine < 0.0 ? place.layer - 1 : place.layer + 1;
        }
    }

  private:
    std::vector<Layer> layers_;
    double optical_ = 0.0;
};

class Walk {
  public:
    Walk(const ScatteringStack& stack, const RingPieces& pieces)
        : eta_(stack.eta()),
          is_slab_(stack.is_slab()),
          pieces_(pieces),
          strata_(stack),
          diffusion_(diffusion_stack(stack, classical_diffusion)),
          far_(LayeredDiffusion(diffusion_.layers, diffusion_.top, diffusion_.bottom).at(0.0)) {}

    void photon(Random& random, PhotonTally& tally) const {
        glm::dvec3 at{0.0}, along{0.0, 0.0, 1.0};
        std::size_t layer = 0;
        double weight = 1.0;
        int scatterings = 0;
        while (true) {
            // What of this flight would meet a boundary, and what the boundary lets out.
            const bool up = along.z < 0.0;
            const bool has_boundary = up || is_slab_;
            const double room = up ? at.z : strata_.thickness() - at.z;
            const double boundary =
                along.z != 0.0 ? room / std::abs(along.z) : std::numeric_limits<double>::infinity();
            double optical = std::numeric_limits<double>::infinity();
            if (along.z != 0.0) {
                optical = strata_.optical_to_boundary({layer, at.z}, up) / std::abs(along.z);
            }
            const double flight = -std::log1p(-random.uniform());
            double mirrored = 1.0;
            if (has_boundary && (optical < kOutOfReach || flight >= optical)) {
                mirrored = inner_reflectance(eta_, std::abs(along.z));
            }
            if (scatterings > 0 && mirrored < 1.0) {
                const double x = at.x + boundary * along.x, y = at.y + boundary * along.y;
                std::vector<double>& rings = up ? tally.top : tally.bottom;
                rings[pieces_.find(x * x + y * y)] +=
                    weight * (1.0 - mirrored) * std::exp(-optical);
            }
            if (flight >= optical) {
                if (!has_boundary) {
                    tally.absorbed += weight;
                    return;
                }
                leave(up, scatterings > 0, weight * (1.0 - mirrored), tally);
                weight *= mirrored;
                at += boundary * along;
                at.z = up ? 0.0 : strata_.thickness();
                layer = up ? 0 : strata_.last();
                along.z = -along.z;
            } else {
                PhotonPlace place{layer, at.z};
                at += strata_.fly(place, flight, along.z) * along;
                if (place.layer != layer) at.z = place.depth_mm;
                layer = place.layer;
                const Strata::Layer& met = strata_.at(layer);
                tally.absorbed += weight * (1.0 - met.albedo);
                weight *= LIVERY_MUTATED(monte_carlo, met.albedo);
                along = scattered(along, met.g, random);
                if (++scatterings == kMostScatterings) {
                    share_out({layer, at.z}, weight, tally);
                    return;
                }
            }
            if (weight < kLightWeight) {
                const bool goes_on = weight > 0.0 && random.uniform() < kSurvivors;
                const double after = goes_on ? weight / kSurvivors : 0.0;
                tally.absorbed += weight - after;
                if (!goes_on) return;
                weight = after;
            }
        }
    }

  private:
    static void leave(bool up, bool diffuse, double power, PhotonTally& tally) {
        if (diffuse) {
            (up ? tally.reflected : tally.transmitted) += power;
        } else {
            (up ? tally.unscattered_reflected : tally.unscattered_transmitted) += power;
        }
    }
    /// Whoever has scattered so often is far from the beam, and goes where diffusion goes.
    void share_out(const PhotonPlace& place, double weight, PhotonTally& tally) const {
        Exitance out = far_.of(place.layer, place.depth_mm - strata_.at(place.layer).top);
        if (diffusion_.lost_below) out.transmitted = 0.0;
        const double all = std::max(out.reflected + out.transmitted, 1.0);
        tally.reflected += weight * out.reflected / all;
        tally.transmitted += weight * out.transmitted / all;
        tally.absorbed += weight * (1.0 - (out.reflected + out.transmitted) / all);
    }

    double eta_;
    bool is_slab_;
    const RingPieces& pieces_;
    Strata strata_;
    DiffusionStack diffusion_;
    LayeredDiffusion::Spectrum far_;
};

/// Of the batches' values per photon.
template <typename Value>
Estimate estimate(const Value& value_of_batch) {
    double sum = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < kBatches; ++k) sum += value_of_batch(k);
    const double mean = sum / kBatches;
    for (std::size_t k = 0; k < kBatches; ++k) {
        const double off = value_of_batch(k) - mean;
        squares += off * off;
    }
    return {mean, std::sqrt(squares / (kBatches * (kBatches - 1.0)))};
}

/// Nothing is met: what enters goes straight on.
MonteCarloProfile of_nothing(const ScatteringStack& stack, std::size_t rings) {
    const UnscatteredLight light = unscattered_light(stack);
    MonteCarloProfile profile;
    profile.rd.resize(rings);
    profile.rt.resize(rings);
    profile.unscattered_reflectance = light.reflected;
    profile.unscattered_transmittance = light.transmitted;
    profile.absorbed.value = 1.0 - light.reflected - light.transmitted;
    return profile;
}

}  // namespace

ProfileRing ring_around(const ScatteringStack& stack, double radius_mm) {
    const double least = least_radius_mm(stack);
    if (radius_mm < least) return {0.0, least};
    return {0.98 * radius_mm, 1.02 * radius_mm};
}

ProfileRing ring_around(const ScatteringMedium& medium, double radius_mm) {
    return ring_around(ScatteringStack{{medium}}, radius_mm);
}

MonteCarloProfile monte_carlo_profile(const ScatteringMedium& medium,
                                      const std::vector<ProfileRing>& rings,
                                      const MonteCarloSettings& settings,
                                      const Progress& progress) {
    check_medium(medium);
    return monte_carlo_profile(ScatteringStack{{medium}}, rings, settings, progress);
}

MonteCarloProfile monte_carlo_profile(const ScatteringStack& given,
                                      const std::vector<ProfileRing>& rings,
                                      const MonteCarloSettings& settings,
                                      const Progress& progress) {
    check_stack(given);
    const ScatteringStack stack = merged(given);
    check_argument(
        settings.photons >= kBatches,
        fmt::format("photons: found {}, expected {} or more", settings.photons, kBatches));
    for (const ProfileRing& ring : rings) {
        check_argument(
            ring.inner_mm >= 0.0 && ring.outer_mm > ring.inner_mm && std::isfinite(ring.outer_mm),
            fmt::format("ring: found {} to {} mm, expected 0 <= inner < outer",
                        ring.inner_mm,
                        ring.outer_mm));
    }
    if (!(stack.depth() > 0.0)) return of_nothing(stack, rings.size());

    const RingPieces pieces(rings);
    const Walk walk(stack, pieces);
    const std::uint64_t each = (settings.photons + kBatches - 1) / kBatches;
    std::vector<PhotonTally> tallies(kBatches);
    for (std::size_t first = 0; first < kBatches; first += kBatchesAtOnce) {
        progress.update(static_cast<double>(first) / kBatches, "photons");
        parallel_for(kBatchesAtOnce, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = first + begin; k < first + end; ++k) {
                PhotonTally tally;
                tally.top.resize(pieces.count());
                tally.bottom.resize(pieces.count());
                Random random(settings.seed, k);
                for (std::uint64_t photon = 0; photon < each; ++photon) {
                    if (photon % 256 == 0) progress.check_stop();
                    walk.photon(random, tally);
                }
                tallies[k] = std::move(tally);
            }
        });
    }
    progress.update(1.0, "photons");

    MonteCarloProfile profile;
    profile.photons = each * kBatches;
    const double per_photon = 1.0 / static_cast<double>(each);
    const auto of = [&](double PhotonTally::*member) {
        return estimate([&](std::size_t k) { return tallies[k].*member * per_photon; });
    };
    profile.total_reflectance = of(&PhotonTally::reflected);
    profile.total_transmittance = of(&PhotonTally::transmitted);
    profile.absorbed = of(&PhotonTally::absorbed);
    profile.unscattered_reflectance = of(&PhotonTally::unscattered_reflected).value;
    profile.unscattered_transmittance = of(&PhotonTally::unscattered_transmitted).value;
    for (const ProfileRing& ring : rings) {
        profile.rd.push_back(estimate(
            [&](std::size_t k) { return pieces.mean_over(ring, tallies[k].top) * per_photon; }));
        profile.rt.push_back(estimate(
            [&](std::size_t k) { return pieces.mean_over(ring, tallies[k].bottom) * per_photon; }));
    }
    return profile;
}

}  // namespace livery
