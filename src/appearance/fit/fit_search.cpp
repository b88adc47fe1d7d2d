#include "appearance/fit/fit_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <ceres/ceres.h>
#include <glm/geometric.hpp>

#include "core/colour.h"
#include "core/solve.h"

namespace livery {

namespace {

constexpr double kLargestTheta_rad = 80.0 * std::numbers::pi / 180.0;

}  // namespace

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

namespace {

constexpr double kFloor = 0.01;  // of f cos: darker is not seen beside a highlight

/// Of CIEDE2000: below it a difference counts by its square, since its length has no slope at 0.
constexpr double kSoft = 0.5;
/// Of the mean square of CIEDE2000 beside its mean: at 10 both count alike.
constexpr double kSquares = 0.1;
/// Of the mean square of the logarithms: at a third it counts as much as itself not squared.
constexpr double kLogarithms = 3.0;

double measure(Metric metric, double value, double cosine) {
    const double seen = std::max(value, 0.0) * cosine;
    return metric == Metric::logarithm ? std::log(seen + kFloor) : std::cbrt(seen);
}

std::size_t count_of(std::size_t all, std::size_t stride) { return (all + stride - 1) / stride; }

}  // namespace

Residuals sample_residuals(const FitSamples& samples, Metric metric, std::size_t stride) {
    std::vector<double> wanted;
    for (std::size_t i = 0; i < samples.pairs.size(); i += stride) {
        for (int c = 0; c < 3; ++c) {
            wanted.push_back(measure(metric, samples.values_working[i][c], samples.pairs[i].wi.z));
        }
    }
    const std::size_t count = wanted.size();
    return {count,
            [&samples, metric, stride, wanted = std::move(wanted)](
                const BoundBsdf<double, glm::dvec3>& paint, double* values) {
                std::size_t at = 0;
                for (std::size_t i = 0; i < samples.pairs.size(); i += stride) {
                    const DirectionPair& pair = samples.pairs[i];
                    const glm::dvec3 value = paint.eval(pair.wi, pair.wo);
                    for (int c = 0; c < 3; ++c, ++at) {
                        values[at] = measure(metric, value[c], pair.wi.z) - wanted[at];
                    }
                }
            }};
}

Residuals sphere_residuals(const DifferenceTruth& truth,
                           const FitSamples& samples,
                           SphereStrides strides) {
    const Residuals logarithms = sample_residuals(samples, Metric::logarithm, strides.samples);
    const std::size_t pixels = count_of(truth.sphere_pairs.size(), strides.pixels);
    return {
        3 * pixels + logarithms.count,
        [&truth, logarithms, strides, pixels](const BoundBsdf<double, glm::dvec3>& paint,
                                              double* values) {
            const double pixel_weight = 1.0 / static_cast<double>(pixels);
            for (std::size_t i = 0; i < truth.sphere_pairs.size(); i += strides.pixels) {
                const DirectionPair& pair = truth.sphere_pairs[i];
                const glm::dvec3 off = ciede2000_vector(
                    lab_on_sphere(paint.eval(pair.wi, pair.wo), pair.wi.z), truth.sphere_labs[i]);
                // |off|^2 (1 / sqrt(|off|^2 + soft^2) + squares)
                const double squared = glm::dot(off, off);
                const double weight =
                    std::sqrt(pixel_weight * (1.0 / std::sqrt(squared + kSoft * kSoft) + kSquares));
                for (int c = 0; c < 3; ++c) *values++ = weight * off[c];
            }
            logarithms.write(paint, values);
            const double weight = std::sqrt(kLogarithms / static_cast<double>(logarithms.count));
            for (std::size_t i = 0; i < logarithms.count; ++i) values[i] *= weight;
        }};
}

namespace {

constexpr double kDifference = 1e-5;  // of a coordinate, whose natural scale is 1

/// Of the model `clearcoat`. A coat of less (index 1.33) is none: the lobe of the base would stand
/// for it, which samples cannot tell from a coat.
constexpr double kLeastCoatF0 = 0.02;

/// One number of a parameter, searched on a scale without ends.
struct Coordinate {
    const ParameterInfo* info = nullptr;
    std::size_t component = 0;
    double low = 0.0;

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
        return info->logarithmic ? std::log(value / low) / std::log(info->high / low)
                                 : (value - low) / (info->high - low);
    }
    double encode(double value) const {
        // Not at an end of the range, where no step changes anything.
        const double t = std::clamp(share(std::clamp(value, low, info->high)), 0.005, 0.995);
        return std::log(t / (1.0 - t));
    }
    double decode(double x) const {
        const double t = 1.0 / (1.0 + std::exp(-x));
        return info->logarithmic ? low * std::pow(info->high / low, t)
                                 : low + (info->high - low) * t;
    }
};

/// A film of less has no colour of its own.
constexpr double kThinnestFilm_nm = 20.0;

/// Not searched unless asked for: a tint, which samples can hardly tell from the colours below it,
/// and what a paint need not have.
bool is_fixed(const ParameterInfo& parameter) {
    return parameter.optional || std::string_view(parameter.name) == "coat_transmittance";
}

double lowest_of(const ModelInfo& model, const ParameterInfo& parameter) {
    const std::string_view name = parameter.name;
    if (model.model == ReflectanceModel::clearcoat && name == "coat_f0") return kLeastCoatF0;
    return name == "film_nm" ? kThinnestFilm_nm : parameter.low;
}

bool holds(const std::vector<std::string>& names, const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<Coordinate> coordinates_of(const ModelInfo& model, const FitSearch& how = {}) {
    std::vector<Coordinate> coordinates;
    for (const char* name : model.parameters) {
        const ParameterInfo& info = parameter_info(name);
        if (holds(how.held, name) || (is_fixed(info) && !holds(how.freed, name))) continue;
        const std::size_t count = info.kind == ParameterKind::colour ? 3 : 1;
        for (std::size_t k = 0; k < count; ++k) {
            coordinates.push_back({&info, k, lowest_of(model, info)});
        }
    }
    return coordinates;
}

/// Residuals and their differences by each coordinate.
class Differentiated : public ceres::CostFunction {
  public:
    Differentiated(const ModelInfo& model,
                   const Residuals& residuals,
                   const f64::BsdfParameters& start,
                   const FitSearch& how)
        : model_(model),
          residuals_(residuals),
          start_(start),
          coordinates_(coordinates_of(model, how)) {
        set_num_residuals(static_cast<int>(residuals.count));
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

    bool Evaluate(const double* const* x, double* residuals, double** jacobians) const override {
        residuals_.write(*model_.f64.bound(parameters(x[0])), residuals);
        if (!jacobians || !jacobians[0]) return true;
        const std::size_t columns = coordinates_.size();
        std::vector<double> moved(x[0], x[0] + columns), changed(residuals_.count);
        for (std::size_t k = 0; k < columns; ++k) {
            moved[k] += kDifference;
            residuals_.write(*model_.f64.bound(parameters(moved.data())), changed.data());
            moved[k] = x[0][k];
            for (std::size_t i = 0; i < changed.size(); ++i) {
                jacobians[0][i * columns + k] = (changed[i] - residuals[i]) / kDifference;
            }
        }
        return true;
    }

  private:
    const ModelInfo& model_;
    const Residuals& residuals_;
    f64::BsdfParameters start_;
    std::vector<Coordinate> coordinates_;
};

}  // namespace

bool can_be_fitted(const ModelInfo& model) { return !coordinates_of(model).empty(); }

double rms_of(const ModelInfo& model,
              const Residuals& residuals,
              const f64::BsdfParameters& parameters) {
    std::vector<double> values(residuals.count);
    residuals.write(*model.f64.bound(parameters), values.data());
    double sum = 0.0;
    for (const double r : values) sum += r * r;
    return std::sqrt(sum / static_cast<double>(values.size()));
}

Found search_from(const ModelInfo& model,
                  const Residuals& residuals,
                  const f64::BsdfParameters& start,
                  const FitSearch& how,
                  const Progress& progress) {
    Differentiated function(model, residuals, start, how);
    std::vector<double> x = function.encoded();
    ceres::Problem::Options ours;
    ours.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(ours);
    problem.AddResidualBlock(&function, nullptr, x.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.max_num_iterations = how.steps;
    options.function_tolerance = 1e-6;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    solved(options, problem, progress);
    const f64::BsdfParameters found = function.parameters(x.data());
    return {found, rms_of(model, residuals, found)};
}

}  // namespace livery
