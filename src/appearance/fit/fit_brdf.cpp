#include "appearance/fit/fit_brdf.h"

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

double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
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
    // Searches on a part of the samples, the last on more of them.
    const std::size_t coarse = std::max<std::size_t>(1, samples.pairs.size() / 2000);
    const std::size_t fine = std::max<std::size_t>(1, samples.pairs.size() / 12000);
    std::vector<f64::BsdfParameters> starts = fit_starts(info, samples, simpler, coarse, progress);
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
        fit.difference = difference_of(reflectance_of(fit.material), truth_working);
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
