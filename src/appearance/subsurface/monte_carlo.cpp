#include "appearance/subsurface/monte_carlo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include "appearance/subsurface/diffusion.h"
#include "appearance/subsurface/fresnel_moments.h"
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

class Walk {
  public:
    Walk(const ScatteringMedium& medium, const RingPieces& pieces)
        : medium_(medium),
          pieces_(pieces),
          thickness_(medium.thickness_mm.value_or(std::numeric_limits<double>::infinity())),
          sigma_t_(medium.sigma_t()),
          albedo_(LIVERY_MUTATED(monte_carlo, medium.sigma_s_per_mm / sigma_t_)) {}

    void photon(Random& random, PhotonTally& tally) const {
        glm::dvec3 at{0.0}, along{0.0, 0.0, 1.0};
        double weight = 1.0;
        int scatterings = 0;
        while (true) {
            // What of this flight would meet a boundary, and what the boundary lets out.
            const bool up = along.z < 0.0;
            const double room = up ? at.z : thickness_ - at.z;
            const double boundary =
                along.z != 0.0 ? room / std::abs(along.z) : std::numeric_limits<double>::infinity();
            const double optical = sigma_t_ * boundary;
            const double flight = -std::log1p(-random.uniform());
            double mirrored = 1.0;
            if (optical < kOutOfReach || flight >= optical) {
                mirrored = inner_reflectance(medium_.eta, std::abs(along.z));
            }
            if (scatterings > 0 && mirrored < 1.0) {
                const double x = at.x + boundary * along.x, y = at.y + boundary * along.y;
                std::vector<double>& rings = up ? tally.top : tally.bottom;
                rings[pieces_.find(x * x + y * y)] +=
                    weight * (1.0 - mirrored) * std::exp(-optical);
            }
            if (flight >= optical) {
                leave(up, scatterings > 0, weight * (1.0 - mirrored), tally);
                weight *= mirrored;
                at += boundary * along;
                at.z = up ? 0.0 : thickness_;
                along.z = -along.z;
            } else {
                at += flight / sigma_t_ * along;
                tally.absorbed += weight * (1.0 - albedo_);
                weight *= albedo_;
                along = scattered(along, medium_.g, random);
                if (++scatterings == kMostScatterings) {
                    share_out(at.z, weight, tally);
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
    void share_out(double depth, double weight, PhotonTally& tally) const {
        const PointSources source(classical_diffusion(medium_), medium_.thickness_mm, {depth});
        const Exitance out = source.total(0);
        const double all = std::max(out.reflected + out.transmitted, 1.0);
        tally.reflected += weight * out.reflected / all;
        tally.transmitted += weight * out.transmitted / all;
        tally.absorbed += weight * (1.0 - (out.reflected + out.transmitted) / all);
    }

    ScatteringMedium medium_;
    const RingPieces& pieces_;
    double thickness_, sigma_t_, albedo_;
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
MonteCarloProfile of_nothing(const ScatteringMedium& medium, std::size_t rings) {
    const UnscatteredLight light = unscattered_light(medium);
    MonteCarloProfile profile;
    profile.rd.resize(rings);
    profile.rt.resize(rings);
    profile.unscattered_reflectance = light.reflected;
    profile.unscattered_transmittance = light.transmitted;
    profile.absorbed.value = 1.0 - light.reflected - light.transmitted;
    return profile;
}

}  // namespace

ProfileRing ring_around(const ScatteringMedium& medium, double radius_mm) {
    const double least = least_radius_mm(medium);
    if (radius_mm < least) return {0.0, least};
    return {0.98 * radius_mm, 1.02 * radius_mm};
}

MonteCarloProfile monte_carlo_profile(const ScatteringMedium& medium,
                                      const std::vector<ProfileRing>& rings,
                                      const MonteCarloSettings& settings,
                                      const Progress& progress) {
    check_medium(medium);
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
    if (!(medium.sigma_t() > 0.0)) return of_nothing(medium, rings.size());

    const RingPieces pieces(rings);
    const Walk walk(medium, pieces);
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
