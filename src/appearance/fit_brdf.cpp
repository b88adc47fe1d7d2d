#include "appearance/fit_brdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <numbers>
#include <optional>

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "appearance/bsdf.h"
#include "appearance/model_table.h"
#include "appearance/parameter_table.h"
#include "core/colour.h"
#include "core/error.h"

namespace livery {
namespace {

constexpr double kLargestTheta_rad = 80.0 * std::numbers::pi / 180.0;
constexpr double kFloor = 0.01;  // of f cos: darker differences are not seen beside a highlight
constexpr std::array kStartAlphas{0.02, 0.06, 0.15, 0.35};
constexpr std::array kStartCoatAlphas{0.01, 0.05, 0.2};
// Many short searches, the best of them longer, the best of those to its end.
constexpr int kFirstSteps = 6, kSecondSteps = 30, kFinalSteps = 60;
constexpr std::size_t kSecondStarts = 4;
constexpr double kDifference = 1e-5;  // of a coordinate, whose natural scale is 1

double thread_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// One number of a parameter, searched on a scale without ends.
struct Coordinate {
    const ParameterInfo* info = nullptr;
    std::size_t component = 0;

    double get(const f64::BsdfParameters& p) const {
        f64::BsdfParameters copy = p;
        return *info->in_f64(copy)[component];
    }
    /// Both of a pair: samples of half/difference space say nothing of a grain.
    void set(f64::BsdfParameters& p, double value) const {
        const auto numbers = info->in_f64(p);
        *numbers[component] = value;
        if (info->kind == ParameterKind::pair) *numbers[1] = value;
    }
    double share(double value) const {
        return info->logarithmic ? std::log(value / info->low) / std::log(info->high / info->low)
                                 : (value - info->low) / (info->high - info->low);
    }
    double encode(double value) const {
        // Not at an end of the range, where no step changes anything.
        const double t = std::clamp(share(std::clamp(value, info->low, info->high)), 0.005, 0.995);
        return std::log(t / (1.0 - t));
    }
    double decode(double x) const {
        const double t = 1.0 / (1.0 + std::exp(-x));
        return info->logarithmic ? info->low * std::pow(info->high / info->low, t)
                                 : info->low + (info->high - info->low) * t;
    }
};

/// Not searched: a tint, which samples can hardly tell from the colours below it.
bool is_fixed(const std::string& parameter) { return parameter == "coat_transmittance"; }

std::vector<Coordinate> coordinates_of(const ModelInfo& model) {
    std::vector<Coordinate> coordinates;
    for (const char* name : model.parameters) {
        if (is_fixed(name)) continue;
        const ParameterInfo& info = parameter_info(name);
        const std::size_t count = info.kind == ParameterKind::colour ? 3 : 1;
        for (std::size_t k = 0; k < count; ++k) coordinates.push_back({&info, k});
    }
    return coordinates;
}

/// Residuals of all samples, and their differences by each coordinate.
class Residuals : public ceres::CostFunction {
  public:
    Residuals(const ModelInfo& model,
              const FitSamples& samples,
              std::size_t stride,
              const f64::BsdfParameters& start)
        : model_(model),
          samples_(samples),
          stride_(stride),
          start_(start),
          coordinates_(coordinates_of(model)) {
        const std::size_t used = (samples.pairs.size() + stride - 1) / stride;
        logarithms_.reserve(3 * used);
        for (std::size_t i = 0; i < samples.pairs.size(); i += stride) {
            const double cosine = samples.pairs[i].wi.z;
            for (int c = 0; c < 3; ++c) {
                logarithms_.push_back(
                    std::log(std::max(samples.values_working[i][c], 0.0) * cosine + kFloor));
            }
        }
        set_num_residuals(static_cast<int>(logarithms_.size()));
        mutable_parameter_block_sizes()->push_back(static_cast<int>(coordinates_.size()));
    }

    f64::BsdfParameters parameters(const double* x) const {
        f64::BsdfParameters p = start_;
        for (std::size_t k = 0; k < coordinates_.size(); ++k) {
            coordinates_[k].set(p, coordinates_[k].decode(x[k]));
        }
        return p;
    }
    std::vector<double> encoded() const {
        std::vector<double> x;
        for (const Coordinate& c : coordinates_) x.push_back(c.encode(c.get(start_)));
        return x;
    }
    double rms(const double* x) const {
        std::vector<double> residuals(logarithms_.size());
        evaluate(parameters(x), residuals.data());
        double sum = 0.0;
        for (const double r : residuals) sum += r * r;
        return std::sqrt(sum / static_cast<double>(residuals.size()));
    }

    bool Evaluate(const double* const* x, double* residuals, double** jacobians) const override {
        evaluate(parameters(x[0]), residuals);
        if (!jacobians || !jacobians[0]) return true;
        const std::size_t columns = coordinates_.size();
        std::vector<double> moved(x[0], x[0] + columns), changed(logarithms_.size());
        for (std::size_t k = 0; k < columns; ++k) {
            moved[k] += kDifference;
            evaluate(parameters(moved.data()), changed.data());
            moved[k] = x[0][k];
            for (std::size_t i = 0; i < changed.size(); ++i) {
                jacobians[0][i * columns + k] = (changed[i] - residuals[i]) / kDifference;
            }
        }
        return true;
    }

  private:
    void evaluate(const f64::BsdfParameters& p, double* residuals) const {
        std::size_t at = 0;
        for (std::size_t i = 0; i < samples_.pairs.size(); i += stride_) {
            const DirectionPair& pair = samples_.pairs[i];
            const glm::dvec3 value = model_.f64.eval(p, pair.wi, pair.wo);
            for (int c = 0; c < 3; ++c, ++at) {
                residuals[at] =
                    std::log(std::max(value[c], 0.0) * pair.wi.z + kFloor) - logarithms_[at];
            }
        }
    }

    const ModelInfo& model_;
    const FitSamples& samples_;
    std::size_t stride_;
    f64::BsdfParameters start_;
    std::vector<Coordinate> coordinates_;
    std::vector<double> logarithms_;
};

class StopWhenAsked : public ceres::IterationCallback {
  public:
    explicit StopWhenAsked(const Progress& progress) : progress_(progress) {}
    ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
        const bool stop = progress_.stop && progress_.stop->load(std::memory_order_relaxed);
        return stop ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
    }

  private:
    const Progress& progress_;
};

struct Found {
    f64::BsdfParameters parameters;
    double rms = 0.0;
};

Found search(const ModelInfo& model,
             const FitSamples& samples,
             std::size_t stride,
             const f64::BsdfParameters& start,
             int steps,
             const Progress& progress) {
    auto* residuals = new Residuals(model, samples, stride, start);  // the problem's own
    std::vector<double> x = residuals->encoded();
    ceres::Problem problem;
    problem.AddResidualBlock(residuals, nullptr, x.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.max_num_iterations = steps;
    options.function_tolerance = 1e-6;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    StopWhenAsked stop(progress);
    options.callbacks.push_back(&stop);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    progress.check_stop();
    return {residuals->parameters(x.data()), residuals->rms(x.data())};
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

bool can_be_fitted(const ModelInfo& model) { return !coordinates_of(model).empty(); }

FitSamples fit_samples(const ReflectanceFunction& truth_working,
                       const std::function<bool(const DirectionPair&)>& is_measured,
                       FitGridSize size) {
    FitSamples samples;
    const double lowest = std::cos(kLargestTheta_rad);
    for (int i = 0; i < size.theta_h; ++i) {
        const double root = (i + 0.5) / size.theta_h;
        const double theta_h = 0.5 * std::numbers::pi * root * root;
        const glm::dvec3 h(std::sin(theta_h), 0.0, std::cos(theta_h));
        const glm::dvec3 across(std::cos(theta_h), 0.0, -std::sin(theta_h));
        for (int j = 0; j < size.theta_d; ++j) {
            const double theta_d = kLargestTheta_rad * (j + 0.5) / size.theta_d;
            for (int k = 0; k < size.phi_d; ++k) {
                const double phi_d = std::numbers::pi * (k + 0.5) / size.phi_d;
                const glm::dvec3 aside =
                    std::sin(theta_d) *
                    (std::cos(phi_d) * across + glm::dvec3(0.0, std::sin(phi_d), 0.0));
                const DirectionPair pair{std::cos(theta_d) * h + aside,
                                         std::cos(theta_d) * h - aside};
                if (pair.wi.z < lowest || pair.wo.z < lowest || !is_measured(pair)) continue;
                samples.pairs.push_back(pair);
                samples.values_working.push_back(truth_working(pair.wi, pair.wo));
            }
        }
    }
    return samples;
}

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
    const auto search_from = [&](const std::vector<f64::BsdfParameters>& from, int steps) {
        std::vector<Found> found;
        for (const auto& start : from) {
            progress.update(0.0, fmt::format("fitting {}", info.name));
            found.push_back(search(info, samples, coarse, start, steps, progress));
        }
        std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
            return a.rms < b.rms;
        });
        return found;
    };
    const std::vector<Found> first = search_from(starts, kFirstSteps);
    starts.clear();
    for (std::size_t k = 0; k < std::min(kSecondStarts, first.size()); ++k) {
        starts.push_back(first[k].parameters);
    }
    const Found second = search_from(starts, kSecondSteps).front();
    const Found best = search(info, samples, fine, second.parameters, kFinalSteps, progress);

    BrdfFit fit;
    fit.material = material_of(info, best.parameters);
    fit.error_log = best.rms;
    fit.seconds = thread_seconds() - start_s;
    const f64::BsdfParameters p = parameters_of_f64(fit.material);
    fit.difference = difference_of(
        [&](const glm::dvec3& wi, const glm::dvec3& wo) { return info.f64.eval(p, wi, wo); },
        truth_working);
    fit.largest_albedo = largest_albedo(info, p);
    return fit;
}

std::vector<BrdfFit> fit_all_models(const FitSamples& samples,
                                    const ReflectanceFunction& truth_working,
                                    const Progress& progress) {
    std::vector<BrdfFit> fits;
    for (const ModelInfo& info : model_table()) {
        if (!can_be_fitted(info)) continue;
        fits.push_back(fit_model(info.model, samples, truth_working, fits, progress));
    }
    std::stable_sort(fits.begin(), fits.end(), [](const BrdfFit& a, const BrdfFit& b) {
        return a.difference.de00_mean < b.difference.de00_mean;
    });
    return fits;
}

}  // namespace livery
