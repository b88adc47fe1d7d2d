#include "appearance/subsurface/fit_profile.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <ceres/ceres.h>
#include <fmt/format.h>

#include "core/error.h"
#include "core/solve.h"

namespace livery {

namespace {

constexpr double kLogDifference = 1e-4;  // of the logarithms of the parameters
constexpr double kFewestRadii = 6;
/// What calibration leaves at best: a fit without residuals is not one without errors.
constexpr double kLeastNoise = 0.02;
/// Of calibration and model together, alike for neighbouring radii.
constexpr double kSystematic = 0.03;
constexpr double kLargestError = 0.35, kLargestModelError = 0.3, kNotableModelError = 0.1;
constexpr double kLargestSigmaA = 0.5, kLargestSigmaS = 0.25;

/// ln sigma_s' and ln sigma_a.
using Logarithms = std::array<double, 2>;

ScatteringMedium medium_of(const Logarithms& x, const ProfileFitOptions& options) {
    ScatteringMedium medium;
    medium.sigma_s_per_mm = std::exp(std::clamp(x[0], -13.0, 13.0)) / (1.0 - options.g);
    medium.sigma_a_per_mm = std::exp(std::clamp(x[1], -25.0, 13.0));
    medium.g = options.g;
    medium.eta = options.eta;
    medium.thickness_mm = options.thickness_mm;
    return medium;
}

double sigma_tr_of(const ScatteringMedium& medium) {
    return std::sqrt(3.0 * medium.sigma_a_per_mm * medium.sigma_t_prime());
}

struct RadiusWindow {
    double from_mm = 0.0, to_mm = 0.0;
};

/// Point sources are wrong nearer to the beam, where the phase function matters too, and noise
/// rules further away. Where much is absorbed the two ends would meet: five mean free paths at
/// least.
RadiusWindow window_of(const ScatteringMedium& medium, SubsurfaceModel model) {
    const double path = medium.mean_free_path_mm();
    const bool along_beam =
        model == SubsurfaceModel::beam_diffusion || model == SubsurfaceModel::scaled_beam_diffusion;
    const double from = along_beam ? 1.0 : 1.5;
    return {from * path, std::max(3.0 / sigma_tr_of(medium), (from + 5.0) * path)};
}

struct Weighed {
    double r_mm, ln_rd, weight;
};

/// Samples of the window with their shares of ln r, 1 in the mean.
std::vector<Weighed> weighed_samples(const std::vector<ProfileSample>& samples,
                                     const RadiusWindow& window) {
    std::vector<Weighed> found;
    for (const ProfileSample& s : samples) {
        if (s.r_mm >= window.from_mm && s.r_mm <= window.to_mm && s.r_mm > 0.0 && s.rd > 0.0) {
            found.push_back({s.r_mm, std::log(s.rd), 1.0});
        }
    }
    if (found.size() < 3) return found;
    double sum = 0.0;
    for (std::size_t k = 0; k < found.size(); ++k) {
        const double before = found[k > 0 ? k - 1 : 0].r_mm;
        const double after = found[std::min(k + 1, found.size() - 1)].r_mm;
        found[k].weight = std::log(after / before);
        sum += found[k].weight;
    }
    for (Weighed& one : found) one.weight *= static_cast<double>(found.size()) / sum;
    return found;
}

/// ln(model/measured) for each sample.
std::vector<double> residuals_of(const std::vector<Weighed>& samples,
                                 SubsurfaceModel model,
                                 const ScatteringMedium& medium) {
    const SubsurfaceProfile profile = subsurface_profile(model, medium);
    std::vector<double> residuals;
    for (const Weighed& one : samples) {
        const double value = std::max(profile.reflectance(one.r_mm), 1e-300);
        residuals.push_back(std::clamp(std::log(value) - one.ln_rd, -30.0, 30.0));
    }
    return residuals;
}

double weighed_square(const std::vector<Weighed>& samples, const std::vector<double>& residuals) {
    double sum = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        sum += samples[k].weight * residuals[k] * residuals[k];
    }
    return sum / static_cast<double>(samples.size());
}

class ProfileCost : public ceres::CostFunction {
  public:
    ProfileCost(const std::vector<Weighed>& samples, const ProfileFitOptions& options)
        : samples_(samples), options_(options) {
        set_num_residuals(static_cast<int>(samples.size()));
        mutable_parameter_block_sizes()->push_back(2);
    }

    bool Evaluate(const double* const* x, double* residuals, double** jacobians) const override {
        const Logarithms here{x[0][0], x[0][1]};
        const auto values = at(here);
        for (std::size_t i = 0; i < values.size(); ++i) {
            residuals[i] = std::sqrt(samples_[i].weight) * values[i];
        }
        if (!jacobians || !jacobians[0]) return true;
        for (std::size_t k = 0; k < 2; ++k) {
            const std::vector<double> slopes = slope(here, k);
            for (std::size_t i = 0; i < values.size(); ++i) {
                jacobians[0][2 * i + k] = std::sqrt(samples_[i].weight) * slopes[i];
            }
        }
        return true;
    }
    /// The residuals' change by parameter k, without weights.
    std::vector<double> slope(const Logarithms& x, std::size_t k) const {
        Logarithms more = x, less = x;
        more[k] += kLogDifference;
        less[k] -= kLogDifference;
        std::vector<double> change = at(more);
        const std::vector<double> below = at(less);
        for (std::size_t i = 0; i < change.size(); ++i) {
            change[i] = (change[i] - below[i]) / (2.0 * kLogDifference);
        }
        return change;
    }
    std::vector<double> at(const Logarithms& x) const {
        return residuals_of(samples_, options_.model, medium_of(x, options_));
    }

  private:
    const std::vector<Weighed>& samples_;
    const ProfileFitOptions& options_;
};

Logarithms search(const std::vector<Weighed>& samples,
                  const ProfileFitOptions& options,
                  Logarithms x,
                  const Progress& progress) {
    ProfileCost cost(samples, options);
    ceres::Problem::Options ours;
    ours.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(ours);
    problem.AddResidualBlock(&cost, nullptr, x.data());
    ceres::Solver::Options how;
    how.linear_solver_type = ceres::DENSE_QR;
    how.max_num_iterations = 40;
    how.function_tolerance = 1e-9;
    how.parameter_tolerance = 1e-7;
    how.num_threads = 1;
    how.logging_type = ceres::SILENT;
    solved(how, problem, progress);
    return x;
}

/// A model without quadratures over the radius, for a first look at what the answer may be.
SubsurfaceModel quick_model(const ProfileFitOptions& options) {
    if (options.thickness_mm) return SubsurfaceModel::multipole;
    const bool quick =
        options.model == SubsurfaceModel::dipole || options.model == SubsurfaceModel::p3;
    return quick ? options.model : SubsurfaceModel::better_dipole;
}

/// Where to begin: a grid over both parameters.
Logarithms start_of(const std::vector<ProfileSample>& samples, const ProfileFitOptions& options) {
    const SubsurfaceModel quick = quick_model(options);
    Logarithms best{0.0, 0.0};
    double least = 0.0;
    bool found = false;
    for (double ln_s = std::log(0.02); ln_s < std::log(100.0); ln_s += 0.35) {
        for (double ln_ratio = std::log(1e-5); ln_ratio < std::log(20.0); ln_ratio += 0.7) {
            const Logarithms x{ln_s, ln_s + ln_ratio};
            const ScatteringMedium medium = medium_of(x, options);
            const auto inside = weighed_samples(samples, window_of(medium, options.model));
            if (static_cast<double>(inside.size()) < kFewestRadii) continue;
            // A window of few samples is easily fitted.
            const double square = weighed_square(inside, residuals_of(inside, quick, medium)) /
                                  std::log(inside.back().r_mm / inside.front().r_mm);
            if (found && square >= least) continue;
            found = true;
            least = square;
            best = x;
        }
    }
    if (!found) {
        throw Refused(
            "nowhere does the profile have six radii with light between 1.5 mean free "
            "paths and what absorption leaves of them",
            "measure more radii, and further out than the spot is wide");
    }
    return best;
}

/// Standard errors of the logarithms: of the weighed least squares with noise alike everywhere, and
/// of errors that all radii share.
void tell_errors(const ProfileCost& cost,
                 const std::vector<Weighed>& samples,
                 const Logarithms& x,
                 double noise,
                 ProfileFit& fit) {
    const std::array<std::vector<double>, 2> j{cost.slope(x, 0), cost.slope(x, 1)};
    double h[2][2] = {}, m[2][2] = {};
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double w = samples[i].weight;
        for (std::size_t a = 0; a < 2; ++a) {
            for (std::size_t b = 0; b < 2; ++b) {
                h[a][b] += w * j[a][i] * j[b][i];
                m[a][b] += w * w * j[a][i] * j[b][i];
            }
        }
    }
    // One of the two may not change the profile at all.
    constexpr double kUntold = 1e3;
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
        const std::size_t other = 1 - k;
        if (h[k][k] > 1e-8 * h[other][other]) continue;
        FittedParameter& untold = k == 0 ? fit.sigma_s_prime_per_mm : fit.sigma_a_per_mm;
        FittedParameter& told = k == 0 ? fit.sigma_a_per_mm : fit.sigma_s_prime_per_mm;
        untold.relative_standard_error = kUntold;
        told.relative_standard_error = noise * std::sqrt(m[other][other]) / h[other][other];
        return;
    }
    const double determinant = h[0][0] * h[1][1] - h[0][1] * h[1][0];
    const double unit = 1.0 / determinant;
    if (!(determinant > 1e-12 * h[0][0] * h[1][1]) || !std::isfinite(unit)) {
        fit.sigma_s_prime_per_mm.relative_standard_error = kUntold;
        fit.sigma_a_per_mm.relative_standard_error = kUntold;
        return;
    }
    const double inverse[2][2] = {{h[1][1] * unit, -h[0][1] * unit},
                                  {-h[1][0] * unit, h[0][0] * unit}};
    double covariance[2][2] = {};
    for (int a = 0; a < 2; ++a) {
        for (int b = 0; b < 2; ++b) {
            for (int c = 0; c < 2; ++c) {
                for (int d = 0; d < 2; ++d) {
                    covariance[a][b] += noise * noise * inverse[a][c] * m[c][d] * inverse[d][b];
                }
            }
        }
    }
    // What noise does not tell of: all values off together, and one end against the other.
    const double first = std::log(samples.front().r_mm), last = std::log(samples.back().r_mm);
    for (const bool tilted : {false, true}) {
        double slope[2] = {};
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double place = 2.0 * (std::log(samples[i].r_mm) - first) / (last - first) - 1.0;
            const double off = kSystematic * (tilted ? place : 1.0);
            for (std::size_t a = 0; a < 2; ++a) slope[a] += samples[i].weight * j[a][i] * off;
        }
        const double moved[2] = {inverse[0][0] * slope[0] + inverse[0][1] * slope[1],
                                 inverse[1][0] * slope[0] + inverse[1][1] * slope[1]};
        for (int a = 0; a < 2; ++a) {
            for (int b = 0; b < 2; ++b) covariance[a][b] += moved[a] * moved[b];
        }
    }
    fit.sigma_s_prime_per_mm.relative_standard_error = std::sqrt(covariance[0][0]);
    fit.sigma_a_per_mm.relative_standard_error = std::sqrt(covariance[1][1]);
    fit.correlation = covariance[0][1] / std::sqrt(covariance[0][0] * covariance[1][1]);
}

void refuse_what_is_not_told(const ProfileFit& fit, const ProfileFitOptions& options) {
    refuse_wide_spot(options.spot_mm, fit.half_energy_radius_mm);
    if (fit.error > kLargestError) {
        throw Refused(
            fmt::format("no half space or slab of {} comes nearer to the profile than a factor of "
                        "{:.2f} in the mean",
                        info_of(options.model).name,
                        std::exp(fit.error)),
            "give R_d per mm^2 and unit power that enters (absolute, not scaled to 1), and the "
            "sample's --eta and --thickness-mm");
    }
    if (fit.model_error > kLargestModelError) {
        throw Refused(fmt::format("{} is off by a factor of {:.2f} in the mean for the medium that "
                                  "it finds (albedo {:.3f}): its parameters are not the sample's",
                                  info_of(options.model).name,
                                  std::exp(fit.model_error),
                                  fit.medium(options.thickness_mm).albedo_prime()),
                      "fit with --model best");
    }
    const auto refuse = [&](const char* name, double error, const char* fix) {
        throw Refused(fmt::format("the profile does not tell {}: its standard error is {:.0f}% "
                                  "from {} radii between {:.3g} and {:.3g} mm",
                                  name,
                                  std::min(100.0 * error, 1e5),
                                  fit.used,
                                  fit.from_mm,
                                  fit.to_mm),
                      fix);
    };
    const double of_s = fit.sigma_s_prime_per_mm.relative_standard_error;
    const double of_a = fit.sigma_a_per_mm.relative_standard_error;
    if (!(of_s <= kLargestSigmaS)) {
        refuse("sigma_s'", of_s, "measure more radii, nearer to the beam, with less noise");
    }
    if (!(of_a <= kLargestSigmaA)) {
        refuse("sigma_a",
               of_a,
               "measure further out, where absorption shows (to three times 1/sigma_tr)");
    }
}

/// How far the model is from the best one in the window, for the medium that it finds.
double model_error_of(const std::vector<Weighed>& samples,
                      const ProfileFitOptions& options,
                      const ScatteringMedium& medium) {
    if (options.model == kBestSubsurfaceModel) return 0.0;
    std::vector<double> off = residuals_of(samples, options.model, medium);
    const std::vector<double> truth = residuals_of(samples, kBestSubsurfaceModel, medium);
    for (std::size_t k = 0; k < off.size(); ++k) off[k] -= truth[k];
    return std::sqrt(weighed_square(samples, off));
}

void warn(const ScatteringMedium& medium, double last_mm, ProfileFit& fit) {
    if (fit.model_error > kNotableModelError) {
        fit.warnings.push_back(
            fmt::format("the model itself is off by {:.0f}% in the mean for such "
                        "a medium, and the parameters with it: --model best is "
                        "nearer",
                        100.0 * std::expm1(fit.model_error)));
    }
    if (medium.albedo_prime() > 0.998) {
        fit.warnings.push_back(
            "sigma_a is weakly told above an albedo of .998: a calibration off "
            "by 1% changes it by a multiple");
    }
    if (fit.sigma_a_per_mm.relative_standard_error > 0.15) {
        fit.warnings.push_back("sigma_a is weakly told by this profile");
    }
    const double wanted = 3.0 / sigma_tr_of(medium);
    if (last_mm < 0.5 * wanted) {
        fit.warnings.push_back(fmt::format(
            "measured to {:.3g} mm, while absorption shows up to {:.3g} mm", last_mm, wanted));
    }
}

}  // namespace

void refuse_wide_spot(double spot_mm, double half_energy_radius_mm) {
    if (!(spot_mm > half_energy_radius_mm / 3.0)) return;
    throw Refused(
        fmt::format("the spot is {:.3g} mm wide, more than a third of the {:.3g} mm within "
                    "which half the light comes back: the profile is the spot's",
                    spot_mm,
                    half_energy_radius_mm),
        fmt::format("project a spot of at most {:.2g} mm", half_energy_radius_mm / 3.0));
}

ScatteringMedium ProfileFit::medium(std::optional<double> thickness_mm) const {
    return {sigma_a_per_mm.value, sigma_s_prime_per_mm.value / (1.0 - g), g, eta, thickness_mm};
}

ProfileFit fit_profile(const std::vector<ProfileSample>& samples,
                       const ProfileFitOptions& options,
                       const Progress& progress) {
    check_medium({1.0, 1.0, options.g, options.eta, options.thickness_mm});
    check_argument(std::isfinite(options.spot_mm) && options.spot_mm >= 0.0,
                   fmt::format("spot: found {} mm, expected 0 or more", options.spot_mm));

    // The window follows the parameters, and the parameters the window.
    Logarithms x = start_of(samples, options);
    std::vector<Weighed> inside;
    RadiusWindow window;
    for (int round = 0; round < 8; ++round) {
        progress.update(round / 8.0, "fit");
        window = window_of(medium_of(x, options), options.model);
        auto next = weighed_samples(samples, window);
        const bool same = next.size() == inside.size() && !inside.empty() &&
                          next.front().r_mm == inside.front().r_mm &&
                          next.back().r_mm == inside.back().r_mm;
        if (same) break;
        inside = std::move(next);
        if (static_cast<double>(inside.size()) < kFewestRadii) {
            throw Refused(fmt::format("only {} radii lie between {:.3g} and {:.3g} mm, where the "
                                      "profile tells of the medium",
                                      inside.size(),
                                      window.from_mm,
                                      window.to_mm),
                          "measure six or more radii there");
        }
        x = search(inside, options, x, progress);
    }

    const ScatteringMedium medium = medium_of(x, options);
    ProfileCost cost(inside, options);
    ProfileFit fit;
    fit.sigma_s_prime_per_mm.value = medium.sigma_s_prime();
    fit.sigma_a_per_mm.value = medium.sigma_a_per_mm;
    fit.g = options.g;
    fit.eta = options.eta;
    fit.error = std::sqrt(weighed_square(inside, cost.at(x)));
    fit.from_mm = window.from_mm;
    fit.to_mm = std::min(window.to_mm, inside.back().r_mm);
    fit.used = inside.size();
    fit.not_positive = static_cast<std::size_t>(
        std::count_if(samples.begin(), samples.end(), [](auto& s) { return s.rd <= 0.0; }));
    fit.half_energy_radius_mm =
        energy_radius_mm(subsurface_profile(options.model, medium), medium, 0.5);
    fit.model_error = model_error_of(inside, options, medium);
    tell_errors(cost, inside, x, std::max(fit.error, kLeastNoise), fit);
    refuse_what_is_not_told(fit, options);
    warn(medium, samples.back().r_mm, fit);
    progress.update(1.0, "fit");
    return fit;
}

}  // namespace livery
