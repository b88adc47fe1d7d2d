#include "appearance/subsurface/translucent_paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "appearance/subsurface/exact_totals.h"
#include "core/error.h"

namespace livery {

namespace {

/// Totals of a half space know no length: sigma_a over sigma_t', g and the index say all.
double total_of(const ScatteringMedium& medium) {
    if (!(medium.sigma_s_prime() > 0.0)) return 0.0;
    if (medium.sigma_a_per_mm == 0.0) return 1.0;
    const std::array<double, 3> key{
        medium.sigma_a_per_mm / medium.sigma_t_prime(), medium.g, medium.eta};
    static std::mutex mutex;
    static std::map<std::array<double, 3>, double> known;
    const std::lock_guard lock(mutex);
    if (const auto found = known.find(key); found != known.end()) return found->second;
    constexpr std::size_t kMost = 4096;  // a colour that is dragged must not fill the memory
    if (known.size() >= kMost) known.clear();
    return known[key] = exact_totals(medium).reflectance;
}

/// sigma_a/sigma_t' of a half space with that total, of the medium's g and index.
double lost_for(const TranslucentMaterial& medium, double total) {
    if (total >= 1.0) return 0.0;
    if (total <= 0.0) return 1.0;
    ScatteringMedium channel = medium_of(medium, 0);
    channel.thickness_mm.reset();
    const auto off = [&](double root) {
        channel.sigma_a_per_mm = root * root;
        channel.sigma_s_per_mm = (1.0 - root * root) / (1.0 - channel.g);
        return exact_totals(channel).reflectance - total;
    };
    double low = 0.0, high = 1.0, above = 1.0 - total, below = -total;
    double root = 0.5;
    constexpr int kSteps = 40;
    for (int step = 0; step < kSteps && high - low > 1e-7; ++step) {
        // Secants between the ends, halves where one end does not move (Illinois)
        root = (low * below - high * above) / (below - above);
        const double here = off(root);
        if (std::abs(here) < 1e-5) break;
        if (here > 0.0) {
            low = root;
            above = here;
            below *= 0.5;
        } else {
            high = root;
            below = here;
            above *= 0.5;
        }
    }
    return root * root;
}

}  // namespace

Material translucent_paint(const TranslucentMaterial& medium, double alpha) {
    Material paint;
    paint.name = medium.name;
    paint.family = medium.family;
    paint.model = ReflectanceModel::translucent;
    paint.alpha = glm::dvec2(alpha);
    paint.provenance = medium.provenance;
    paint.medium = std::make_shared<const TranslucentMaterial>(medium);
    return paint;
}

glm::dvec3 entering_albedo(const TranslucentMaterial& medium) {
    glm::dvec3 total;
    for (int c = 0; c < 3; ++c) {
        ScatteringMedium channel = medium_of(medium, c);
        channel.thickness_mm.reset();
        total[c] = total_of(channel);
    }
    return glm::clamp(total, 0.0, 1.0);
}

double mean_free_path_mm(const TranslucentMaterial& medium) {
    const glm::dvec3 all = medium.sigma_a_per_mm + medium.sigma_s_prime_per_mm;
    return 3.0 / (all.x + all.y + all.z);
}

TranslucentMaterial with_mean_free_path(TranslucentMaterial medium, double mm) {
    check_argument(mm > 0.0 && std::isfinite(mm),
                   fmt::format("mean free path: found {} mm, expected a length above 0", mm));
    const double before = mean_free_path_mm(medium);
    if (!std::isfinite(before)) return medium;
    medium.sigma_a_per_mm *= before / mm;
    medium.sigma_s_prime_per_mm *= before / mm;
    return medium;
}

TranslucentMaterial with_entering_albedo(TranslucentMaterial medium, const glm::dvec3& albedo) {
    const double usual = mean_free_path_mm(medium);
    for (int c = 0; c < 3; ++c) {
        double all = medium.sigma_a_per_mm[c] + medium.sigma_s_prime_per_mm[c];
        if (!(all > 0.0)) all = std::isfinite(usual) ? 1.0 / usual : 1.0;
        const double lost = lost_for(medium, std::clamp(albedo[c], 0.0, 1.0));
        medium.sigma_a_per_mm[c] = all * lost;
        medium.sigma_s_prime_per_mm[c] = all * (1.0 - lost);
    }
    return medium;
}

double boundary_f0(double eta) {
    const double r = (eta - 1.0) / (eta + 1.0);
    return r * r;
}

Material albedo_paint(Material paint) {
    if (paint.model != ReflectanceModel::translucent) return paint;
    if (!paint.medium) {
        throw std::invalid_argument(
            fmt::format("paint '{}' is translucent, but has no medium", paint.name));
    }
    paint.model = ReflectanceModel::ggx;
    paint.diffuse = entering_albedo(*paint.medium);
    paint.f0 = glm::dvec3(boundary_f0(paint.medium->eta));
    paint.alpha.y = paint.alpha.x;
    paint.medium.reset();
    return paint;
}

TranslucentMaterial on_mock_up(TranslucentMaterial medium, double product_scale) {
    medium.sigma_a_per_mm *= product_scale;
    medium.sigma_s_prime_per_mm *= product_scale;
    if (medium.thickness_mm) *medium.thickness_mm /= product_scale;
    return medium;
}

}  // namespace livery
