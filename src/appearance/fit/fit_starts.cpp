#include "appearance/fit/fit_starts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "appearance/bsdf.h"
#include "appearance/fit/fit_search.h"
#include "appearance/parameter_table.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr std::array kStartAlphas{0.02, 0.06, 0.15, 0.35};
constexpr std::array kStartCoatAlphas{0.01, 0.05, 0.2};
/// A lobe in the place of two: reflectances and slope parameters of a narrow and a wide one.
struct LobeSplit {
    double f0, alpha, flake_f0, flake_alpha;
};
constexpr std::array kLobeSplits{
    LobeSplit{0.5, 0.6, 1.0, 1.7}, LobeSplit{0.3, 0.4, 1.0, 1.2}, LobeSplit{0.8, 0.9, 1.0, 3.0}};
// Of the searches of simpler forms.
constexpr int kOneLobeSteps = 6, kTwoLobeSteps = 30;

/// What the samples say at first sight.
struct FirstSight {
    glm::dvec3 diffuse{0.0};  ///< albedo, from the darker quarter
    glm::dvec3 peak{0.0};     ///< reflectance with light and eye around the normal's mirror
};

FirstSight first_sight(const FitSamples& samples) {
    FirstSight sight;
    std::vector<std::size_t> by_half(samples.pairs.size());
    for (std::size_t i = 0; i < by_half.size(); ++i) by_half[i] = i;
    const auto height = [&](std::size_t i) {
        const DirectionPair& pair = samples.pairs[i];
        return glm::normalize(pair.wi + pair.wo).z;
    };
    const std::size_t near = std::max<std::size_t>(1, by_half.size() / 100);
    std::partial_sort(by_half.begin(),
                      by_half.begin() + static_cast<std::ptrdiff_t>(near),
                      by_half.end(),
                      [&](std::size_t a, std::size_t b) { return height(a) > height(b); });
    for (int c = 0; c < 3; ++c) {
        std::vector<double> values, peaks;
        for (const glm::dvec3& value : samples.values_working) values.push_back(value[c]);
        for (std::size_t k = 0; k < near; ++k) {
            peaks.push_back(samples.values_working[by_half[k]][c]);
        }
        sight.diffuse[c] = std::clamp(std::numbers::pi * quantile(values, 0.25), 1e-3, 0.95);
        sight.peak[c] = std::max(median(peaks) - sight.diffuse[c] / std::numbers::pi, 1e-3);
    }
    return sight;
}

/// Sets a parameter by its name, where the model has it.
void start_with(const ModelInfo& model,
                f64::BsdfParameters& p,
                const char* name,
                const glm::dvec3& value) {
    if (!model.has(name)) return;
    const ParameterInfo& info = parameter_info(name);
    const auto numbers = info.in_f64(p);
    for (int k = 0; k < info.count(); ++k) {
        *numbers[static_cast<std::size_t>(k)] = std::clamp(value[k], info.low, info.high);
    }
}

f64::BsdfParameters with_two_lobes(const ModelInfo& model,
                                   const f64::BsdfParameters& one,
                                   const LobeSplit& split) {
    f64::BsdfParameters p = one;
    start_with(model, p, "f0", split.f0 * one.f0);
    start_with(model, p, "alpha", glm::dvec3(split.alpha * one.alpha_x));
    start_with(model, p, "flake_f0", split.flake_f0 * one.f0);
    start_with(model, p, "flake_alpha", glm::dvec3(split.flake_alpha * one.alpha_x));
    return p;
}

std::vector<f64::BsdfParameters> starts_by_width(const ModelInfo& model, const FirstSight& sight) {
    std::vector<f64::BsdfParameters> starts;
    f64::BsdfParameters p = parameters_of_f64(Material{});
    start_with(model, p, "diffuse", sight.diffuse);
    for (const double alpha : kStartAlphas) {
        // D V at its peak is 1 / (4 pi alpha^2).
        const glm::dvec3 f0 = 4.0 * std::numbers::pi * alpha * alpha * sight.peak;
        start_with(model, p, "f0", f0);
        start_with(model, p, "specular", f0);
        start_with(model, p, "alpha", glm::dvec3(alpha));
        start_with(model, p, "exponent", glm::dvec3(2.0 / (alpha * alpha) - 2.0));
        for (const double coat_alpha : kStartCoatAlphas) {
            start_with(model, p, "coat_alpha", glm::dvec3(coat_alpha));
            if (!model.has("flake_alpha")) {
                starts.push_back(p);
            } else {
                for (const LobeSplit& split : kLobeSplits)
                    starts.push_back(with_two_lobes(model, p, split));
            }
            if (!model.has("coat_alpha")) break;
        }
        if (!model.mirrors()) break;
    }
    return starts;
}

/// For a coat over two lobes: from one lobe without a coat to two without, to two under coats of
/// several widths. The larger model alone may end in a worse valley than the smaller.
std::vector<f64::BsdfParameters> starts_by_lobes(const ModelInfo& model,
                                                 const FitSamples& samples,
                                                 const FirstSight& sight,
                                                 std::size_t stride,
                                                 const Progress& progress) {
    const ModelInfo& one_lobe = model_info(ReflectanceModel::ggx);
    const Residuals residuals = sample_residuals(samples, Metric::logarithm, stride);
    const auto nearest = [](std::span<const Found> found) {
        return *std::min_element(found.begin(), found.end(), [](const Found& a, const Found& b) {
            return a.rms < b.rms;
        });
    };
    std::vector<Found> found;
    for (const f64::BsdfParameters& start : starts_by_width(one_lobe, sight)) {
        found.push_back(
            search_from(one_lobe, residuals, start, {.steps = kOneLobeSteps}, progress));
    }
    f64::BsdfParameters p = nearest(found).parameters;
    found.clear();
    for (const LobeSplit& split : kLobeSplits) {
        f64::BsdfParameters start = with_two_lobes(model, p, split);
        start.coat_f0 = 0.0;
        found.push_back(search_from(
            model, residuals, start, {kTwoLobeSteps, {"coat_f0", "coat_alpha"}}, progress));
    }
    p = nearest(found).parameters;
    std::vector<f64::BsdfParameters> starts;
    p.coat_f0 = 0.04;
    for (const double coat_alpha : kStartCoatAlphas) {
        p.coat_alpha = coat_alpha;
        starts.push_back(p);
    }
    return starts;
}

}  // namespace

std::vector<f64::BsdfParameters> embedded(const ModelInfo& model, const Material& simpler) {
    const ModelInfo& its = model_info(simpler.model);
    f64::BsdfParameters known = parameters_of_f64(simpler);
    f64::BsdfParameters p = parameters_of_f64(Material{});
    // Nothing of what the simpler one has not.
    for (const char* name : {"diffuse_roughness", "specular", "f0", "flake_f0", "coat_f0"}) {
        if (model.has(name)) start_with(model, p, name, glm::dvec3(0.0));
    }
    for (const char* name : its.parameters) {
        if (!model.has(name)) continue;
        const ParameterInfo& info = parameter_info(name);
        const auto from = info.in_f64(known);
        glm::dvec3 value(0.0);
        for (int k = 0; k < info.count(); ++k) value[k] = *from[static_cast<std::size_t>(k)];
        start_with(model, p, name, value);
    }
    if (!its.mirrors() || !model.mirrors()) return {p};
    // One lobe by another's name.
    const glm::dvec3 share = its.has("specular") ? known.specular : known.f0;
    const double alpha = static_cast<double>(lobe_alpha(its, rounded(known)));
    start_with(model, p, "specular", share);
    start_with(model, p, "f0", share);
    start_with(model, p, "exponent", glm::dvec3(std::max(2.0 / (alpha * alpha) - 2.0, 1.0)));
    start_with(model, p, "alpha", glm::dvec3(alpha));
    if (model.has("flake_alpha")) p.flake_alpha = alpha;
    if (!model.has("coat_f0") || its.has("coat_f0")) return {p};
    // An interface is no flake: it stands for the coat.
    f64::BsdfParameters coated = p;
    coated.f0 = glm::dvec3(0.0);
    start_with(model, coated, "coat_f0", glm::dvec3((share.x + share.y + share.z) / 3.0));
    start_with(model, coated, "coat_alpha", glm::dvec3(alpha));
    return {p, coated};
}

std::vector<f64::BsdfParameters> fit_starts(const ModelInfo& model,
                                            const FitSamples& samples,
                                            std::span<const BrdfFit> simpler,
                                            std::size_t stride,
                                            const Progress& progress) {
    const FirstSight sight = first_sight(samples);
    std::vector<f64::BsdfParameters> starts = starts_by_width(model, sight);
    for (const BrdfFit& fit : simpler) {
        if (fit.material.model == model.model) continue;
        for (const auto& start : embedded(model, fit.material)) starts.push_back(start);
    }
    if (model.has("flake_alpha")) {
        for (const auto& start : starts_by_lobes(model, samples, sight, stride, progress)) {
            starts.push_back(start);
        }
    }
    return starts;
}

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
