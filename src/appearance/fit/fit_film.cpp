#include "appearance/fit/fit_film.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "appearance/fit/fit_search.h"

namespace livery {
namespace {

constexpr std::array kIndices{1.35, 1.8, 2.5};
// Index times thickness: a fringe of green light is 275 nm.
constexpr double kFirstPath_nm = 50.0, kLastPath_nm = 1250.0, kPathStep_nm = 50.0;
constexpr std::size_t kFirstSamples = 400, kSecondSamples = 1500;
constexpr int kFilmFirstSteps = 4, kFilmSecondSteps = 25;
constexpr std::size_t kFilmSecondStarts = 8, kKept = 3;
constexpr double kFaintest = 0.05;  ///< of a flake's reflectance to start from

double mean_of(const glm::dvec3& v) { return (v.x + v.y + v.z) / 3.0; }

/// The first lobe as the second and the other way round: the same but for what one covers of the
/// other.
f64::BsdfParameters exchanged(const f64::BsdfParameters& p) {
    f64::BsdfParameters q = p;
    const glm::dvec3 one(1.0);
    q.f0 = p.flake_f0 * (one - p.f0);
    q.flake_f0 = glm::clamp(p.f0 / glm::max(one - q.f0, glm::dvec3(1e-3)), 0.0, 1.0);
    q.alpha_x = q.alpha_y = p.flake_alpha;
    q.flake_alpha = p.alpha_x;
    return q;
}

std::vector<f64::BsdfParameters> starts_of(const f64::BsdfParameters& without) {
    std::vector<f64::BsdfParameters> starts;
    // Both lobes as one film's, under a coat of its own.
    f64::BsdfParameters merged = without;
    const f64::BsdfParameters other = exchanged(without);
    merged.flake_f0 = glm::clamp(without.flake_f0 + other.flake_f0, 0.0, 1.0);
    merged.flake_alpha = std::sqrt(without.alpha_x * without.flake_alpha);
    merged.f0 = 0.2 * without.f0;
    merged.coat_f0 = 0.04;
    merged.coat_alpha = std::min({without.alpha_x, without.flake_alpha, without.coat_alpha});
    for (f64::BsdfParameters p : {without, other, merged}) {
        // The film makes the colour, or deepens one that is there.
        const glm::dvec3 own = glm::max(p.flake_f0, glm::dvec3(kFaintest));
        for (const glm::dvec3& flake : {own, glm::dvec3(mean_of(own))}) {
            p.flake_f0 = flake;
            for (const double index : kIndices) {
                p.film_eta = index;
                for (double path = kFirstPath_nm; path <= kLastPath_nm; path += kPathStep_nm) {
                    p.film_nm = path / index;
                    starts.push_back(p);
                }
            }
        }
    }
    return starts;
}

}  // namespace

std::vector<f64::BsdfParameters> with_films(const ModelInfo& model,
                                            const FitSamples& samples,
                                            const f64::BsdfParameters& without,
                                            const Progress& progress) {
    const auto nearest_of = [&](const std::vector<f64::BsdfParameters>& starts,
                                std::size_t count,
                                const FitSearch& how,
                                std::size_t kept,
                                const Progress& its_progress) {
        const Residuals residuals = sample_residuals(
            samples, Metric::logarithm, std::max<std::size_t>(1, samples.pairs.size() / count));
        std::vector<Found> found;
        for (std::size_t k = 0; k < starts.size(); ++k) {
            its_progress.update(static_cast<double>(k) / static_cast<double>(starts.size()),
                                "looking for a film on the flakes");
            found.push_back(search_from(model, residuals, starts[k], how, progress));
        }
        std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
            return a.rms < b.rms;
        });
        std::vector<f64::BsdfParameters> nearest;
        for (std::size_t k = 0; k < std::min(kept, found.size()); ++k) {
            nearest.push_back(found[k].parameters);
        }
        return nearest;
    };
    // What flakes and varnish are like is known; which colours the film makes is not.
    const FitSearch colours{kFilmFirstSteps,
                            {"alpha", "flake_alpha", "coat_alpha", "coat_f0"},
                            {"film_nm", "film_eta"}};
    const auto first = nearest_of(
        starts_of(without), kFirstSamples, colours, kFilmSecondStarts, progress.part(0.0, 0.6));
    return nearest_of(first,
                      kSecondSamples,
                      {kFilmSecondSteps, {}, {"film_nm", "film_eta"}},
                      kKept,
                      progress.part(0.6, 1.0));
}

}  // namespace livery
