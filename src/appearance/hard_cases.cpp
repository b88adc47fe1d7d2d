#include "appearance/hard_cases.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <utility>

#include "appearance/model_table.h"
#include "core/parallel.h"
#include "core/worst_error.h"

namespace livery {

namespace {

constexpr double kLowestCosine = 1.745e-4;  // of 89.99 degrees
constexpr double kLargestExponent = 1e6;

bool goes_by_exponent(ReflectanceModel model) {
    const Lobe lobe = model_info(model).lobe;
    return lobe == Lobe::half_exponent || lobe == Lobe::mirror_exponent;
}

glm::dvec3 direction_at(double mu, double phi) {
    const double s = std::sqrt(std::max(0.0, (1.0 - mu) * (1.0 + mu)));
    return {s * std::cos(phi), s * std::sin(phi), mu};
}

glm::dvec3 random_direction(Random& random) {
    const double u = random.uniform();
    const double mu = random.uniform() < 0.5 ? kLowestCosine + (1.0 - kLowestCosine) * u
                                             : std::pow(kLowestCosine, u);
    return direction_at(mu, 2.0 * std::numbers::pi * random.uniform());
}

/// Not inlined: GCC 12's vectoriser otherwise drops a rounding to float whose result is widened
/// again at once, and the two precisions would be fed different directions.
[[gnu::noinline]] glm::vec3 rounded_direction(const glm::dvec3& direction) {
    return glm::vec3(direction);
}

std::vector<glm::vec3> make_adversarial() {
    const float tiny = std::numeric_limits<float>::denorm_min();
    const float least = std::numeric_limits<float>::min();
    std::vector<glm::vec3> directions;
    for (const float z : {0.0f, -0.0f, tiny, least, 1e-30f, 1e-20f, 1e-10f, 1e-7f, 1e-4f, 1e-3f}) {
        directions.push_back({1.0f, 0.0f, z});
        directions.push_back({-1.0f, 0.0f, z});
        directions.push_back({0.0f, 1.0f, z});
        directions.push_back({0.0f, -1.0f, -z});
        directions.push_back({std::sqrt(0.5f), -std::sqrt(0.5f), z});
    }
    directions.push_back({0.0f, 0.0f, 1.0f});
    directions.push_back({0.0f, 0.0f, -1.0f});
    directions.push_back({tiny, -tiny, 1.0f});
    directions.push_back({1e-4f, 0.0f, 1.0f});
    return directions;
}

bool good(float value) { return std::isfinite(value) && value >= 0.0f; }

}  // namespace

double relative_error(double value, double truth) {
    if (truth <= kLeastComparedValue) return worst_if_nan(0.0 * value);
    return worst_if_nan(std::abs(value / truth - 1.0));
}

double exponent_of(double alpha) { return 2.0 / (alpha * alpha) - 2.0; }

std::vector<double> ledger_alphas(ReflectanceModel model) {
    std::vector<double> alphas = {1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 1.0};
    if (!goes_by_exponent(model)) return alphas;
    const double narrowest = std::sqrt(2.0 / (kLargestExponent + 2.0));
    std::erase_if(alphas, [&](double alpha) { return alpha < narrowest; });
    alphas.insert(alphas.begin(), narrowest);
    return alphas;
}

std::vector<double> ledger_stretches(ReflectanceModel model) {
    return model_info(model).anisotropic ? std::vector<double>{1.0, 10.0, 100.0}
                                         : std::vector<double>{1.0};
}

f64::BsdfParameters ledger_parameters(double alpha, double stretch) {
    const double across = std::min(alpha * stretch, 1.0);
    f64::BsdfParameters p{};
    p.diffuse = {0.8, 0.3, 0.05};
    p.diffuse_roughness = 0.7;
    p.f0 = {0.7, 0.25, 0.03};
    p.specular = {0.5, 0.2, 0.1};
    p.alpha_x = alpha;
    p.alpha_y = across;
    p.exponent_x = exponent_of(alpha);
    p.exponent_y = exponent_of(across);
    p.flake_f0 = {0.1, 0.4, 0.6};
    p.flake_alpha = std::min(2.5 * alpha, 1.0);
    p.coat_alpha = alpha;
    p.coat_f0 = 0.04;
    p.coat_transmittance = {0.95, 0.7, 0.3};
    return widened(rounded(p));
}

std::vector<RoundedPair> ledger_directions(double alpha, std::size_t count, Random& random) {
    std::vector<RoundedPair> pairs;
    for (std::size_t k = 0; k < count; ++k) {
        const glm::dvec3 wo = random_direction(random);
        glm::dvec3 wi = random_direction(random);
        if (random.uniform() < 0.7) {
            const double width = 3.0 * alpha;
            const glm::dvec3 h =
                glm::normalize(glm::dvec3(width * random.normal(), width * random.normal(), 1.0));
            const glm::dvec3 mirrored = h * (2.0 * glm::dot(wo, h)) - wo;
            if (mirrored.z > kLowestCosine) wi = mirrored;
        }
        pairs.push_back({rounded_direction(wi), rounded_direction(wo)});
    }
    return pairs;
}

f32::BsdfParameters extreme_parameters(Random& random) {
    f32::BsdfParameters p{};
    for (const ParameterInfo& parameter : parameter_table()) {
        const Components<float> components = parameter.in_f32(p);
        const auto low = static_cast<float>(parameter.low);
        const auto high = static_cast<float>(parameter.high);
        for (int k = 0; k < parameter.count(); ++k) {
            const float u = random.uniform_float();
            const float t = random.uniform_float();
            const bool by_ratios = parameter.logarithmic && low > 0.0f;
            const float between =
                by_ratios ? low * std::pow(high / low, t) : low + (high - low) * t;
            *components[static_cast<std::size_t>(k)] = u < 0.25f  ? low
                                                       : u < 0.5f ? high
                                                                  : std::clamp(between, low, high);
        }
    }
    return p;
}

RoundedPair extreme_directions(Random& random) {
    static const std::vector<glm::vec3> adversarial = make_adversarial();
    const auto any = [&]() -> glm::vec3 {
        if (random.uniform() < 0.3) {
            return adversarial[random.below(static_cast<std::uint32_t>(adversarial.size()))];
        }
        return glm::vec3(random_direction(random));
    };
    RoundedPair pair{any(), any()};
    const double kind = random.uniform();
    if (kind < 0.15) {
        pair.wi = {-pair.wo.x, -pair.wo.y, pair.wo.z};
    } else if (kind < 0.25) {
        pair.wi = pair.wo;
    } else if (kind < 0.3) {
        pair.wi = -pair.wo;
    }
    return pair;
}

InvalidValues count_invalid(ReflectanceModel model, std::size_t inputs, std::uint64_t seed) {
    constexpr std::size_t kBatch = 1 << 14;
    const std::size_t batches = (inputs + kBatch - 1) / kBatch;
    std::atomic<std::size_t> invalid{0};
    parallel_for(batches, 1, [&](std::size_t begin, std::size_t end) {
        std::size_t bad = 0;
        for (std::size_t batch = begin; batch < end; ++batch) {
            Random random(seed, batch);
            for (std::size_t k = 0; k < std::min(kBatch, inputs - batch * kBatch); ++k) {
                const f32::BsdfParameters p = extreme_parameters(random);
                const RoundedPair d = extreme_directions(random);
                const glm::vec3 value = evaluate(model, p, d.wi, d.wo);
                const float density = pdf(model, p, d.wi, d.wo);
                const bool through = (d.wi.z <= 0.0f || d.wo.z <= 0.0f) && value != glm::vec3(0.0f);
                if (!good(value.x) || !good(value.y) || !good(value.z) || !good(density) ||
                    through) {
                    ++bad;
                }
            }
        }
        invalid += bad;
    });
    return {inputs, invalid};
}

std::vector<PrecisionError> precision_errors(ReflectanceModel model,
                                             std::size_t pairs_each,
                                             std::uint64_t seed) {
    const std::vector<double> alphas = ledger_alphas(model);
    std::vector<PrecisionError> rows(alphas.size());
    parallel_for(alphas.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t a = begin; a < end; ++a) {
            PrecisionError& row = rows[a];
            row.alpha = alphas[a];
            row.allowed = std::max(1e-4, 4e-7 / row.alpha);
            Random random(seed, a);
            for (const double stretch : ledger_stretches(model)) {
                const f64::BsdfParameters wide = ledger_parameters(row.alpha, stretch);
                const f32::BsdfParameters narrow = rounded(wide);
                for (const RoundedPair& d : ledger_directions(row.alpha, pairs_each, random)) {
                    const glm::dvec3 wi(d.wi), wo(d.wo);
                    const glm::dvec3 truth = evaluate(model, wide, wi, wo);
                    const glm::dvec3 value(evaluate(model, narrow, d.wi, d.wo));
                    for (int c = 0; c < 3; ++c) {
                        row.float_worst =
                            worse_of(row.float_worst, relative_error(value[c], truth[c]));
                    }
                    const double density =
                        relative_error(static_cast<double>(pdf(model, narrow, d.wi, d.wo)),
                                       pdf(model, wide, wi, wo));
                    row.float_density_worst = worse_of(row.float_density_worst, density);
                }
            }
        }
    });
    return rows;
}

double reciprocity_error(ReflectanceModel model, std::size_t pairs_each, std::uint64_t seed) {
    double worst = 0.0;
    Random random(seed);
    for (const double alpha : ledger_alphas(model)) {
        const f32::BsdfParameters p = rounded(ledger_parameters(alpha, 1.7));
        for (const RoundedPair& d : ledger_directions(alpha, pairs_each, random)) {
            const glm::dvec3 there(evaluate(model, p, d.wi, d.wo));
            const glm::dvec3 back(evaluate(model, p, d.wo, d.wi));
            for (int c = 0; c < 3; ++c) {
                worst = worse_of(worst, relative_error(back[c], there[c]));
            }
        }
    }
    return worst;
}

WorstAlbedo worst_albedo(ReflectanceModel model, int points) {
    struct Case {
        double alpha, stretch, coat_alpha, coat_f0, f0, flake_f0, flake_alpha, mu;
    };
    std::vector<Case> cases;
    // Slope parameter and reflectance of coats, reflectance and slope parameter of flakes.
    std::vector<std::pair<double, double>> coats{{0.001, 0.04}}, flakes{{0.0, 0.1}};
    const bool has_flakes = model_info(model).has("flake_alpha");
    if (model_info(model).has("coat_alpha")) {
        coats = {{0.001, 0.04}, {0.1, 0.04}, {0.6, 0.04}, {0.1, 0.0}};
    }
    if (has_flakes) {
        flakes = {{0.0, 0.1}, {0.3, 0.3}, {1.0, 0.02}, {1.0, 1.0}};
    }
    for (const double alpha : {1e-4, 0.01, 0.03, 0.1, 0.2, 0.5, 1.0}) {
        for (const double stretch : ledger_stretches(model)) {
            if (stretch > 1.0 && alpha > 0.2) continue;
            for (const auto& [coat_alpha, coat_f0] : coats) {
                for (const double f0 : {0.0, 0.01, 0.04, 0.3, 1.0}) {
                    // A lobe of one colour has no edge between 0 and 0.04.
                    if (has_flakes && f0 > 0.0 && f0 < 0.3) continue;
                    for (const auto& [flake_f0, flake_alpha] : flakes) {
                        for (const double mu : {1e-3, 0.01, 0.03, 0.1, 0.2, 0.4, 0.7, 1.0}) {
                            cases.push_back({alpha,
                                             stretch,
                                             coat_alpha,
                                             coat_f0,
                                             f0,
                                             flake_f0,
                                             flake_alpha,
                                             mu});
                        }
                    }
                }
            }
        }
    }
    // A diffuse model has edges and is quick.
    if (model_info(model).lobe == Lobe::none) points *= 4;
    WorstAlbedo worst;
    std::mutex mutex;
    parallel_for(cases.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Case& one = cases[k];
            f64::BsdfParameters p = ledger_parameters(one.alpha, one.stretch);
            const bool scaled = model_info(model).has("specular");
            p.specular = glm::dvec3(one.f0);
            p.diffuse = glm::dvec3(scaled ? 1.0 - one.f0 : 1.0);
            p.diffuse_roughness = 1.0 - one.f0;
            p.f0 = glm::dvec3(one.f0);
            p.flake_f0 = glm::dvec3(one.flake_f0);
            p.flake_alpha = one.flake_alpha;
            p.coat_alpha = one.coat_alpha;
            p.coat_f0 = one.coat_f0;
            p.coat_transmittance = glm::dvec3(1.0);
            const double albedo =
                worst_if_nan(directional_albedo(model, p, direction_at(one.mu, 0.3), points).x);
            const std::scoped_lock lock(mutex);
            if (albedo > worst.albedo) worst = {albedo, one.alpha, one.mu, one.f0};
        }
    });
    return worst;
}

}  // namespace livery
