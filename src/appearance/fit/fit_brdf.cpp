#include "appearance/fit/fit_brdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <numbers>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "appearance/bsdf.h"
#include "appearance/fit/fit_search.h"
#include "appearance/fit/fit_starts.h"
#include "appearance/paint_bsdf.h"
#include "appearance/parameter_table.h"
#include "core/colour.h"
#include "core/error.h"

namespace livery {
namespace {

// Many short searches, the best of them longer, the best of those to its end.
constexpr int kFirstSteps = 6, kSecondSteps = 30, kFinalSteps = 60;
constexpr std::size_t kSecondStarts = 4;
// By what is seen: from the nearest ends a little, the best of them to its end.
constexpr int kSeenSteps = 15, kLastSteps = 60, kLastRounds = 3;
constexpr double kWorthARound = 0.01;
constexpr std::size_t kSeenStarts = 3, kSimplerStarts = 2, kSeenPixelStride = 3,
                      kSeenSamples = 1000;
/// A film and a tinted coat must be worth their parameters: what they gain of the weighed error, at
/// least.
constexpr double kWorthAnEffect = 0.25;

double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double six_digits(double value) {
    return std::stod(fmt::format("{:.6g}", std::abs(value) < 1e-9 ? 0.0 : value));
}

/// Six digits of a colour of Rec.709 may leave the working space by their last one.
glm::dvec3 within_digits(const glm::dvec3& working) {
    constexpr double kDigits = 1e-5;
    const double largest = std::max({working.x, working.y, working.z});
    return glm::clamp(working, std::min(kDigits * largest, 1.0 - kDigits), 1.0 - kDigits);
}

Material material_of(const ModelInfo& model, f64::BsdfParameters p) {
    Material material;
    material.model = model.model;
    for (const char* name : model.parameters) {
        const ParameterInfo& info = parameter_info(name);
        const auto from = info.in_f64(p);
        const auto to = info.in_material(material);
        if (info.kind == ParameterKind::colour) {
            const glm::dvec3 working(*from[0], *from[1], *from[2]);
            const bool is_white = working == glm::dvec3(1.0);
            const glm::dvec3 rec709 =
                is_white ? working : rec709_from_working() * within_digits(working);
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

/// One model's search, and the ends that it met, nearest first.
class ModelSearch {
  public:
    ModelSearch(const ModelInfo& model, const FitSamples& samples, const DifferenceTruth& truth)
        : model_(model),
          samples_(samples),
          truth_(truth),
          coarse_(std::max<std::size_t>(1, samples.pairs.size() / 2000)),
          fine_(std::max<std::size_t>(1, samples.pairs.size() / 12000)),
          logarithms_(sample_residuals(samples, Metric::logarithm, fine_)) {}

    const std::vector<BrdfFit>& ends() const { return ends_; }
    /// As it would be written.
    void consider(const f64::BsdfParameters& p) {
        BrdfFit fit;
        fit.material = material_of(model_, p);
        fit.difference = difference_of(reflectance_of(fit.material), truth_);
        fit.error_log = rms_of(model_, logarithms_, parameters_of_f64(fit.material));
        const auto after = std::find_if(ends_.begin(), ends_.end(), [&](const BrdfFit& end) {
            return rank_of(fit) < rank_of(end);
        });
        ends_.insert(after, fit);
    }

    void by_samples(std::span<const BrdfFit> simpler, const Progress& progress) {
        const Residuals coarse = sample_residuals(samples_, Metric::logarithm, coarse_);
        std::vector<f64::BsdfParameters> starts =
            fit_starts(model_, samples_, simpler, coarse_, progress);
        // The first searches are many and short, those after them a few and longer.
        const double step = 1.0 / static_cast<double>(starts.size() + kSecondStarts + 1);
        double done = 0.0;
        const auto searched = [&](const std::vector<f64::BsdfParameters>& from, int steps) {
            std::vector<Found> found;
            for (const auto& start : from) {
                progress.update(done, fmt::format("fitting {}", model_.name));
                done = std::min(done + step, 1.0);
                found.push_back(search_from(model_, coarse, start, {steps}, progress));
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
        for (const Metric metric : {Metric::logarithm, Metric::cube_root}) {
            const Residuals residuals = sample_residuals(samples_, metric, fine_);
            p = search_from(model_, residuals, p, {kFinalSteps}, progress).parameters;
            consider(p);
        }
        for (const BrdfFit& fit : simpler) {
            if (fit.material.model == model_.model) continue;
            for (const auto& same : embedded(model_, fit.material)) consider(same);
        }
    }

    void by_films(const Progress& progress) {
        const f64::BsdfParameters without = parameters_of_f64(ends_.front().material);
        for (const auto& p : with_films(model_, samples_, without, progress)) consider(p);
    }

    void by_sight(std::span<const BrdfFit> simpler, const Progress& progress) {
        const Residuals seen = sphere_residuals(
            truth_,
            samples_,
            {kSeenPixelStride, std::max<std::size_t>(1, samples_.pairs.size() / kSeenSamples)});
        const auto search = [&](const Material& from, int steps) {
            FitSearch how{.steps = steps};
            if (has_film(from)) how.freed = {"film_nm", "film_eta"};
            if (has_tint(from)) how.freed.push_back("coat_transmittance");
            consider(search_from(model_, seen, parameters_of_f64(from), how, progress).parameters);
        };
        std::vector<Material> starts;
        std::vector<BrdfFit> nearest(simpler.begin(), simpler.end());
        std::stable_sort(nearest.begin(), nearest.end(), [](const BrdfFit& a, const BrdfFit& b) {
            return rank_of(a) < rank_of(b);
        });
        for (std::size_t k = 0; k < std::min(kSimplerStarts, nearest.size()); ++k) {
            for (const auto& same : embedded(model_, nearest[k].material)) {
                starts.push_back(material_of(model_, same));
            }
        }
        for (const bool film : {false, true}) {
            std::size_t taken = 0;
            for (const BrdfFit& end : ends_) {
                if (has_film(end.material) != film || taken++ >= kSeenStarts) continue;
                starts.push_back(end.material);
                if (taken == 1) add_coats(end.material, starts);
            }
        }
        for (std::size_t k = 0; k < starts.size(); ++k) {
            progress.update(static_cast<double>(k) / static_cast<double>(starts.size() + 2),
                            fmt::format("fitting {} by sight", model_.name));
            search(starts[k], kSeenSteps);
        }
        for (int round = 0; round < kLastRounds; ++round) {
            const double before = rank_of(ends_.front());
            search(Material(ends_.front().material), kLastSteps);
            if (rank_of(ends_.front()) > before - kWorthARound) break;
        }
    }

  private:
    /// A coat that a search has lost no longer tells in which direction it lies. A tinted one
    /// darkens what is below it, and more so toward grazing angles.
    void add_coats(Material material, std::vector<Material>& starts) const {
        if (!model_.has("coat_f0")) return;
        for (const double tint : {1.0, 0.6}) {
            f64::BsdfParameters p = parameters_of_f64(material);
            p.coat_transmittance = glm::dvec3(tint);
            for (glm::dvec3* below : {&p.diffuse, &p.f0, &p.flake_f0}) {
                *below = glm::min(*below / (tint * tint), glm::dvec3(1.0));
            }
            for (const auto& [f0, alpha] : {std::pair{0.04, 0.003}, std::pair{0.12, 0.03}}) {
                p.coat_f0 = f0;
                p.coat_alpha = alpha;
                starts.push_back(material_of(model_, p));
            }
        }
    }

    static bool has_film(const Material& paint) { return paint.film_nm > 0.0; }
    static bool has_tint(const Material& paint) {
        return paint.coat_transmittance != glm::dvec3(1.0);
    }
    static double rank_of(const BrdfFit& fit) {
        const int effects = has_film(fit.material) + has_tint(fit.material);
        return weighed_error(fit) + kWorthAnEffect * effects;
    }

    const ModelInfo& model_;
    const FitSamples& samples_;
    const DifferenceTruth& truth_;
    std::size_t coarse_, fine_;  ///< searches look at every so manieth sample
    Residuals logarithms_;
    std::vector<BrdfFit> ends_;
};

BrdfFit fit_model(ReflectanceModel model,
                  const FitSamples& samples,
                  const DifferenceTruth& truth,
                  std::span<const BrdfFit> simpler,
                  const Progress& progress) {
    const double start_s = thread_seconds();
    const ModelInfo& info = model_info(model);
    const bool film = info.has("film_nm");
    ModelSearch search(info, samples, truth);
    search.by_samples(simpler, progress.part(0.0, film ? 0.4 : 0.7));
    if (film) search.by_films(progress.part(0.4, 0.7));
    search.by_sight(simpler, progress.part(0.7, 1.0));
    BrdfFit best = search.ends().front();
    best.seconds = thread_seconds() - start_s;
    best.largest_albedo = largest_albedo(info, parameters_of_f64(best.material));
    return best;
}

void check(const FitSamples& samples) {
    check_argument(samples.pairs.size() == samples.values_working.size(),
                   "fit_model: as many values as pairs of directions are needed");
    check_argument(
        samples.pairs.size() >= 100,
        fmt::format("fit_model: {} samples, expected 100 or more", samples.pairs.size()));
    for (const glm::dvec3& value : samples.values_working) {
        check_argument(std::isfinite(value.x + value.y + value.z),
                       "fit_model: a value is not a finite number");
    }
}

}  // namespace

double weighed_error(const BrdfFit& fit) {
    return fit.difference.de00_mean + fit.difference.de00_p95 / 5.0 + fit.error_log;
}

BrdfFit fit_model(ReflectanceModel model,
                  const FitSamples& samples,
                  const ReflectanceFunction& truth_working,
                  std::span<const BrdfFit> simpler,
                  const Progress& progress) {
    check(samples);
    return fit_model(model, samples, difference_truth(truth_working), simpler, progress);
}

std::vector<BrdfFit> fit_all_models(const FitSamples& samples,
                                    const ReflectanceFunction& truth_working,
                                    const Progress& progress) {
    check(samples);
    const DifferenceTruth truth = difference_truth(truth_working);
    std::vector<BrdfFit> fits;
    const auto count = static_cast<double>(
        std::count_if(formula_models().begin(), formula_models().end(), can_be_fitted));
    double index = 0.0;
    for (const ModelInfo& info : formula_models()) {
        if (!can_be_fitted(info)) continue;
        const Progress part = progress.part(index / count, (index + 1.0) / count);
        fits.push_back(fit_model(info.model, samples, truth, fits, part));
        index += 1.0;
    }
    std::stable_sort(fits.begin(), fits.end(), [](const BrdfFit& a, const BrdfFit& b) {
        return weighed_error(a) < weighed_error(b);
    });
    return fits;
}

}  // namespace livery
