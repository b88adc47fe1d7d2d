#include "appearance/fit_brdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <numbers>
#include <string_view>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "appearance/bsdf.h"
#include "appearance/fit_search.h"
#include "appearance/parameter_table.h"
#include "core/colour.h"
#include "core/error.h"

namespace livery {
namespace {

constexpr std::array kStartAlphas{0.02, 0.06, 0.15, 0.35};
constexpr std::array kStartCoatAlphas{0.01, 0.05, 0.2};
// Many short searches, the best of them longer, the best of those to its end.
constexpr int kFirstSteps = 6, kSecondSteps = 30, kFinalSteps = 60;
constexpr std::size_t kSecondStarts = 4;

double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

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
        const auto quantile = [](std::vector<double>& of, double fraction) {
            const auto at = of.begin() + static_cast<std::ptrdiff_t>(
                                             fraction * static_cast<double>(of.size() - 1));
            std::nth_element(of.begin(), at, of.end());
            return *at;
        };
        sight.diffuse[c] = std::clamp(std::numbers::pi * quantile(values, 0.25), 1e-3, 0.95);
        sight.peak[c] = std::max(quantile(peaks, 0.5) - sight.diffuse[c] / std::numbers::pi, 1e-3);
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

std::vector<f64::BsdfParameters> starts_of(const ModelInfo& model, const FirstSight& sight) {
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
            starts.push_back(p);
            if (!model.has("coat_alpha")) break;
        }
        if (!model.mirrors()) break;
    }
    return starts;
}

/// A simpler model's parameters where this one has them too.
f64::BsdfParameters start_from(const ModelInfo& model,
                               const BrdfFit& simpler,
                               f64::BsdfParameters p) {
    f64::BsdfParameters known = parameters_of_f64(simpler.material);
    const ModelInfo& its_model = model_info(simpler.material.model);
    for (const char* name : its_model.parameters) {
        if (!model.has(name)) continue;
        const ParameterInfo& info = parameter_info(name);
        const auto from = info.in_f64(known), to = info.in_f64(p);
        for (int k = 0; k < info.count(); ++k) {
            *to[static_cast<std::size_t>(k)] = *from[static_cast<std::size_t>(k)];
        }
    }
    return p;
}

double six_digits(double value) {
    return std::stod(fmt::format("{:.6g}", std::abs(value) < 1e-9 ? 0.0 : value));
}

Material material_of(const ModelInfo& model, f64::BsdfParameters p) {
    Material material;
    material.model = model.model;
    for (const char* name : model.parameters) {
        const ParameterInfo& info = parameter_info(name);
        const auto from = info.in_f64(p);
        const auto to = info.in_material(material);
        if (info.kind == ParameterKind::colour) {
            const glm::dvec3 rec709 =
                rec709_from_working() * glm::dvec3(*from[0], *from[1], *from[2]);
            for (int c = 0; c < 3; ++c) *to[static_cast<std::size_t>(c)] = six_digits(rec709[c]);
        } else {
            for (int k = 0; k < info.count(); ++k) {
                *to[static_cast<std::size_t>(k)] = six_digits(*from[static_cast<std::size_t>(k)]);
            }
        }
    }
    return material;
}

double largest_albedo(const ModelInfo& model, const f64::BsdfParameters& p) {
    constexpr int kPoints = 64;
    double largest = 0.0;
    for (const double degrees : {0.0, 20.0, 40.0, 60.0, 70.0, 80.0}) {
        const double theta = glm::radians(degrees);
        const glm::dvec3 albedo =
            directional_albedo(model.model, p, {std::sin(theta), 0.0, std::cos(theta)}, kPoints);
        largest = std::max({largest, albedo.x, albedo.y, albedo.z});
    }
    return largest;
}

}  // namespace

BrdfFit fit_model(ReflectanceModel model,
                  const FitSamples& samples,
                  const ReflectanceFunction& truth_working,
                  std::span<const BrdfFit> simpler,
                  const Progress& progress) {
    check_argument(samples.pairs.size() == samples.values_working.size(),
                   "fit_model: as many values as pairs of directions are needed");
    check_argument(
        samples.pairs.size() >= 100,
        fmt::format("fit_model: {} samples, expected 100 or more", samples.pairs.size()));
    for (const glm::dvec3& value : samples.values_working) {
        check_argument(std::isfinite(value.x + value.y + value.z),
                       "fit_model: a value is not a finite number");
    }
    const double start_s = thread_seconds();
    const ModelInfo& info = model_info(model);
    const FirstSight sight = first_sight(samples);
    std::vector<f64::BsdfParameters> starts = starts_of(info, sight);
    for (const BrdfFit& fit : simpler) {
        if (fit.material.model != model) starts.push_back(start_from(info, fit, starts.front()));
    }
    // Searches on a part of the samples, the last on more of them.
    const std::size_t coarse = std::max<std::size_t>(1, samples.pairs.size() / 2000);
    const std::size_t fine = std::max<std::size_t>(1, samples.pairs.size() / 12000);
    // The first searches are many and short, those after them a few and longer.
    const double step = 1.0 / static_cast<double>(starts.size() + kSecondStarts + 1);
    double done = 0.0;
    const auto searched = [&](const std::vector<f64::BsdfParameters>& from, int steps) {
        std::vector<Found> found;
        for (const auto& start : from) {
            progress.update(done, fmt::format("fitting {}", info.name));
            done = std::min(done + step, 1.0);
            found.push_back(
                search_from(info, samples, start, {Metric::logarithm, coarse, steps}, progress));
        }
        std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
            return a.rms < b.rms;
        });
        return found;
    };
    const std::vector<Found> first = searched(starts, kFirstSteps);
    starts.clear();
    for (std::size_t k = 0; k < std::min(kSecondStarts, first.size()); ++k) {
        starts.push_back(first[k].parameters);
    }
    f64::BsdfParameters p = searched(starts, kSecondSteps).front().parameters;

    // To the end by either measure; the one that looks nearer is taken.
    BrdfFit best;
    for (const Metric metric : {Metric::logarithm, Metric::cube_root}) {
        p = search_from(info, samples, p, {metric, fine, kFinalSteps}, progress).parameters;
        BrdfFit fit;
        fit.material = material_of(info, p);
        const f64::BsdfParameters rounded = parameters_of_f64(fit.material);
        fit.difference =
            difference_of([&](const glm::dvec3& wi,
                              const glm::dvec3& wo) { return info.f64.eval(rounded, wi, wo); },
                          truth_working);
        const bool nearer = fit.difference.de00_mean < best.difference.de00_mean;
        if (metric == Metric::logarithm || nearer) best = fit;
    }
    p = parameters_of_f64(best.material);
    best.error_log = rms_of(info, samples, p, {Metric::logarithm, fine});
    best.seconds = thread_seconds() - start_s;
    best.largest_albedo = largest_albedo(info, p);
    return best;
}

std::vector<BrdfFit> fit_all_models(const FitSamples& samples,
                                    const ReflectanceFunction& truth_working,
                                    const Progress& progress) {
    std::vector<BrdfFit> fits;
    const auto count = static_cast<double>(
        std::count_if(model_table().begin(), model_table().end(), can_be_fitted));
    double index = 0.0;
    for (const ModelInfo& info : model_table()) {
        if (!can_be_fitted(info)) continue;
        Progress part;
        part.stop = progress.stop;
        part.report = [&](double fraction, std::string_view stage) {
            if (progress.report) progress.report((index + fraction) / count, stage);
        };
        fits.push_back(fit_model(info.model, samples, truth_working, fits, part));
        index += 1.0;
    }
    std::stable_sort(fits.begin(), fits.end(), [](const BrdfFit& a, const BrdfFit& b) {
        return a.difference.de00_mean < b.difference.de00_mean;
    });
    return fits;
}

}  // namespace livery
