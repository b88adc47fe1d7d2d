#include "appearance/fit/fit_search.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <ceres/ceres.h>

namespace livery {
namespace {

constexpr double kFloor = 0.01;       // of f cos: darker is not seen beside a highlight
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

/// Not searched: a tint, which samples can hardly tell from the colours below it, and what a paint
/// need not have.
bool is_fixed(const ParameterInfo& parameter) {
    return parameter.optional || std::string(parameter.name) == "coat_transmittance";
}

std::vector<Coordinate> coordinates_of(const ModelInfo& model,
                                       const std::vector<std::string>& held = {}) {
    std::vector<Coordinate> coordinates;
    for (const char* name : model.parameters) {
        const ParameterInfo& info = parameter_info(name);
        if (is_fixed(info) || std::find(held.begin(), held.end(), name) != held.end()) continue;
        const bool is_varnish =
            model.model == ReflectanceModel::clearcoat && std::string_view(info.name) == "coat_f0";
        const double low = is_varnish ? kLeastCoatF0 : info.low;
        const std::size_t count = info.kind == ParameterKind::colour ? 3 : 1;
        for (std::size_t k = 0; k < count; ++k) coordinates.push_back({&info, k, low});
    }
    return coordinates;
}

double measure(Metric metric, double value, double cosine) {
    const double seen = std::max(value, 0.0) * cosine;
    return metric == Metric::logarithm ? std::log(seen + kFloor) : std::cbrt(seen);
}

/// Residuals of all samples, and their differences by each coordinate.
class Residuals : public ceres::CostFunction {
  public:
    Residuals(const ModelInfo& model,
              const FitSamples& samples,
              const f64::BsdfParameters& start,
              const FitSearch& how)
        : model_(model),
          samples_(samples),
          stride_(how.stride),
          metric_(how.metric),
          start_(start),
          coordinates_(coordinates_of(model, how.held)) {
        const std::size_t used = (samples.pairs.size() + stride_ - 1) / stride_;
        wanted_.reserve(3 * used);
        for (std::size_t i = 0; i < samples.pairs.size(); i += stride_) {
            const double cosine = samples.pairs[i].wi.z;
            for (int c = 0; c < 3; ++c) {
                wanted_.push_back(measure(metric_, samples.values_working[i][c], cosine));
            }
        }
        set_num_residuals(static_cast<int>(wanted_.size()));
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
    double rms(const f64::BsdfParameters& p) const {
        std::vector<double> residuals(wanted_.size());
        evaluate(p, residuals.data());
        double sum = 0.0;
        for (const double r : residuals) sum += r * r;
        return std::sqrt(sum / static_cast<double>(residuals.size()));
    }

    bool Evaluate(const double* const* x, double* residuals, double** jacobians) const override {
        evaluate(parameters(x[0]), residuals);
        if (!jacobians || !jacobians[0]) return true;
        const std::size_t columns = coordinates_.size();
        std::vector<double> moved(x[0], x[0] + columns), changed(wanted_.size());
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
        const auto bsdf = model_.f64.bound(p);
        std::size_t at = 0;
        for (std::size_t i = 0; i < samples_.pairs.size(); i += stride_) {
            const DirectionPair& pair = samples_.pairs[i];
            const glm::dvec3 value = bsdf->eval(pair.wi, pair.wo);
            for (int c = 0; c < 3; ++c, ++at) {
                residuals[at] = measure(metric_, value[c], pair.wi.z) - wanted_[at];
            }
        }
    }

    const ModelInfo& model_;
    const FitSamples& samples_;
    std::size_t stride_;
    Metric metric_;
    f64::BsdfParameters start_;
    std::vector<Coordinate> coordinates_;
    std::vector<double> wanted_;
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

}  // namespace

bool can_be_fitted(const ModelInfo& model) { return !coordinates_of(model).empty(); }

Found search_from(const ModelInfo& model,
                  const FitSamples& samples,
                  const f64::BsdfParameters& start,
                  const FitSearch& how,
                  const Progress& progress) {
    Residuals residuals(model, samples, start, how);
    std::vector<double> x = residuals.encoded();
    ceres::Problem::Options ours;
    ours.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(ours);
    problem.AddResidualBlock(&residuals, nullptr, x.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.max_num_iterations = how.steps;
    options.function_tolerance = 1e-6;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    StopWhenAsked stop(progress);
    options.callbacks.push_back(&stop);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    progress.check_stop();
    const f64::BsdfParameters found = residuals.parameters(x.data());
    return {found, residuals.rms(found)};
}

double rms_of(const ModelInfo& model,
              const FitSamples& samples,
              const f64::BsdfParameters& parameters,
              const FitSearch& how) {
    return Residuals(model, samples, parameters, how).rms(parameters);
}

}  // namespace livery
