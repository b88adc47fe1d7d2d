#include "appearance/measured/measured_paint.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/colour.h"
#include "core/hash.h"
#include "core/parallel.h"

namespace livery {

namespace {

constexpr int kRings = 64;
constexpr int kRingAzimuths = 48;
constexpr int kAlbedoPoints = 96;
constexpr float kLobeShare = 0.7f;  ///< of the samples; the rest is even in the cosine
constexpr auto kPiF = std::numbers::pi_v<float>;

float luminance(const glm::vec3& working) {
    return static_cast<float>((xyz_from_working() * glm::dvec3(working)).y);
}

/// Each ring's share of the luminance that leaves along several directions, under uniform light.
MeasuredRings rings_of(const MeasuredPaint& paint) {
    MeasuredRings rings;
    std::vector<double> shares(kRings, 0.0);
    for (int k = 0; k <= kRings; ++k) {
        const double root = static_cast<double>(k) / kRings;
        const double s = std::sin(0.25 * std::numbers::pi * root * root);
        rings.versines.push_back(static_cast<float>(2.0 * s * s));
    }
    for (const double mu : {0.1, 0.3, 0.5, 0.7, 0.9, 1.0}) {
        const glm::vec3 wo(
            static_cast<float>(std::sqrt(1.0 - mu * mu)), 0.0f, static_cast<float>(mu));
        for (int ring = 0; ring < kRings; ++ring) {
            const auto k = static_cast<std::size_t>(ring);
            const float area = 2.0f * kPiF * (rings.versines[k + 1] - rings.versines[k]);
            const float v = 0.5f * (rings.versines[k] + rings.versines[k + 1]);
            const float sine = std::sqrt(v * (2.0f - v));
            for (int turn = 0; turn < kRingAzimuths; ++turn) {
                const float phi = 2.0f * kPiF * (static_cast<float>(turn) + 0.5f) / kRingAzimuths;
                const glm::vec3 h(sine * std::cos(phi), sine * std::sin(phi), 1.0f - v);
                const float along = glm::dot(wo, h);
                const glm::vec3 wi = h * (2.0f * along) - wo;
                if (along <= 0.0f || wi.z <= 0.0f) continue;
                shares[k] +=
                    static_cast<double>(luminance(evaluate(paint, wi, wo)) * wi.z * along * area);
            }
        }
    }
    double total = 0.0;
    for (const double share : shares) total += share;
    double sum = 0.0;
    rings.cumulative.push_back(0.0f);
    for (const double share : shares) {
        // Black in all directions: any ring will do.
        sum += total > 0.0 ? share / total : 1.0 / kRings;
        rings.cumulative.push_back(static_cast<float>(std::min(sum, 1.0)));
    }
    rings.cumulative.back() = 1.0f;
    return rings;
}

/// The value at theta_h, for light 30 degrees from the half vector, mean over phi_d.
glm::vec3 profile(const MeasuredPaint& paint, float theta_h) {
    glm::vec3 sum(0.0f);
    constexpr int kTurns = 16;
    const glm::vec3 h(std::sin(theta_h), 0.0f, std::cos(theta_h));
    const glm::vec3 t(std::cos(theta_h), 0.0f, -std::sin(theta_h));
    const float side = 0.5f, along = std::sqrt(0.75f);
    for (int k = 0; k < kTurns; ++k) {
        const float phi = kPiF * (static_cast<float>(k) + 0.5f) / kTurns;
        const glm::vec3 across = side * (std::cos(phi) * t + glm::vec3(0.0f, std::sin(phi), 0.0f));
        sum += evaluate(paint, along * h + across, along * h - across);
    }
    return sum / static_cast<float>(kTurns);
}

/// What is left of the value away from the lobe, times pi: the albedo of a diffuser that has it.
glm::vec3 diffuse_part(const MeasuredPaint& paint) {
    glm::vec3 lowest = profile(paint, 0.0f);
    for (int k = 1; k <= 10;
         ++k) {  // to 50 degrees; beyond, half of the pairs lie below the horizon
        lowest = glm::min(lowest, profile(paint, kPiF / 36.0f * static_cast<float>(k)));
    }
    return kPiF * lowest;
}

/// Half of a GGX lobe's light, D cos(theta_h), lies where the tangent is below alpha. Of two lobes
/// this takes the one that matters: a varnish's narrow one is bright, but holds little.
float lobe_alpha(const MeasuredPaint& paint, const glm::vec3& diffuse) {
    constexpr int kSteps = 200;
    constexpr float kWidest = 50.0f / 180.0f * kPiF;
    const float base = luminance(diffuse) / kPiF;
    std::vector<float> below(1, 0.0f);
    for (int k = 0; k < kSteps; ++k) {
        const float root = (static_cast<float>(k) + 0.5f) / kSteps;
        const float theta_h = kWidest * root * root;
        const float light = std::max(luminance(profile(paint, theta_h)) - base, 0.0f);
        below.push_back(below.back() + light * std::cos(theta_h) * std::sin(theta_h) * root);
    }
    if (below.back() <= 0.0f) return 1.0f;
    const auto half = std::lower_bound(below.begin(), below.end(), 0.5f * below.back());
    const float root = static_cast<float>(half - below.begin()) / kSteps;
    return std::clamp(std::tan(kWidest * root * root), 1e-3f, 1.0f);
}

/// Everything that follows from the grid.
MeasuredPaint paint_of(MeasuredGrid grid, const std::filesystem::path& file) {
    MeasuredPaint paint;
    paint.file = file;
    paint.grid = std::move(grid);
    Hasher hasher;
    hasher.add(std::span<const float>(paint.grid.texels));
    paint.id = hasher.hex();
    paint.rings = rings_of(paint);
    const glm::vec3 diffuse = diffuse_part(paint);
    paint.lobe_alpha = lobe_alpha(paint, diffuse);
    parallel_for(paint.environment.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const double root = std::max(static_cast<double>(k), 0.1) /
                                static_cast<double>(paint.environment.size() - 1);
            const double mu = root * root;
            const glm::dvec3 wo(std::sqrt((1.0 - mu) * (1.0 + mu)), 0.0, mu);
            glm::dvec3 albedo(0.0);
            for (const auto& [wi, weight] : directions_by_half_vector(wo, kAlbedoPoints)) {
                albedo += weight * glm::dvec3(evaluate(paint, glm::vec3(wi), glm::vec3(wo)));
            }
            f32::BsdfEnvironment& e = paint.environment[k];
            e.diffuse = glm::min(diffuse, glm::vec3(albedo));
            e.specular = glm::vec3(albedo) - e.diffuse;
            e.coat = glm::vec3(0.0f);
        }
    });
    return paint;
}

}  // namespace

MeasuredPaint measured_paint(const MeasuredReflectance& measured, const Progress& progress) {
    return paint_of(resampled(measured, {}, progress), measured.file);
}

std::shared_ptr<const MeasuredPaint> read_measured_paint(const std::filesystem::path& file) {
    return std::make_shared<const MeasuredPaint>(
        measured_paint(read_measured_file(std::filesystem::absolute(file))));
}

std::shared_ptr<const MeasuredPaint> blank_measured_paint() {
    static const auto blank = [] {
        MeasuredGrid grid;
        grid.size = {2, 2, 1};
        grid.texels.assign(16, std::log2(kMeasuredGridFloor));
        return std::make_shared<const MeasuredPaint>(paint_of(std::move(grid), "blank"));
    }();
    return blank;
}

std::shared_ptr<const MeasuredPaint> unread_measured_paint(const std::filesystem::path& file) {
    auto paint = std::make_shared<MeasuredPaint>(*blank_measured_paint());
    paint->file = std::filesystem::absolute(file);
    paint->unread = true;
    return paint;
}

std::shared_ptr<const MeasuredPaint> failed_measured_paint(const std::filesystem::path& file,
                                                           const std::string& problem) {
    auto paint = std::make_shared<MeasuredPaint>(*blank_measured_paint());
    paint->file = file;
    paint->problem = problem;
    return paint;
}

glm::vec3 evaluate(const MeasuredPaint& paint, glm::vec3 wi, glm::vec3 wo) {
    return glm::max(evaluate(paint.grid, wi, wo), glm::vec3(0.0f));
}

glm::vec3 sample(const MeasuredPaint& paint, glm::vec3 wo, glm::vec3 u) {
    if (u.z >= kLobeShare) return f32::cosine_sample(glm::vec2(u.x, u.y));
    const auto& [versines, cumulative] = paint.rings;
    const auto above = std::upper_bound(cumulative.begin(), cumulative.end() - 1, u.x);
    const auto edge = static_cast<std::size_t>(above - cumulative.begin());
    const float share = cumulative[edge] - cumulative[edge - 1];
    const float t = share > 0.0f ? std::min((u.x - cumulative[edge - 1]) / share, 1.0f) : 0.5f;
    const float v = glm::mix(versines[edge - 1], versines[edge], t);
    const float sine = std::sqrt(v * (2.0f - v));
    const float phi = 2.0f * kPiF * u.y;
    const glm::vec3 h(sine * std::cos(phi), sine * std::sin(phi), 1.0f - v);
    return h * (2.0f * glm::dot(wo, h)) - wo;
}

float pdf(const MeasuredPaint& paint, glm::vec3 wi, glm::vec3 wo) {
    if (!(wi.z > 0.0f && wo.z > 0.0f)) return 0.0f;
    const glm::vec3 sum = wi + wo;
    const float length = std::sqrt(glm::dot(sum, sum));
    const glm::vec3 h = sum / length;
    // 1 - cos without cancellation.
    const float v = (h.x * h.x + h.y * h.y) / (1.0f + h.z);
    const auto& [versines, cumulative] = paint.rings;
    const auto above = std::upper_bound(versines.begin() + 1, versines.end() - 1, v);
    const auto edge = static_cast<std::size_t>(above - versines.begin());
    const float of_half_vector = (cumulative[edge] - cumulative[edge - 1]) /
                                 (2.0f * kPiF * (versines[edge] - versines[edge - 1]));
    // wo.h is half the sum's length.
    return kLobeShare * of_half_vector / (2.0f * length) + (1.0f - kLobeShare) * wi.z / kPiF;
}

f32::BsdfEnvironment environment_weights(const MeasuredPaint& paint, float mu) {
    const auto last = static_cast<float>(paint.environment.size() - 1);
    const float at = std::sqrt(std::clamp(mu, 0.0f, 1.0f)) * last;
    const auto below = static_cast<std::size_t>(std::min(at, last - 1.0f));
    const float share = at - static_cast<float>(below);
    const f32::BsdfEnvironment& a = paint.environment[below];
    const f32::BsdfEnvironment& b = paint.environment[below + 1];
    f32::BsdfEnvironment e;
    e.diffuse = glm::mix(a.diffuse, b.diffuse, share);
    e.specular = glm::mix(a.specular, b.specular, share);
    e.coat = glm::vec3(0.0f);
    return e;
}

}  // namespace livery
