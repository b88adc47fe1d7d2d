#include "appearance/subsurface/translucent_paint.h"

#include <array>
#include <map>
#include <mutex>
#include <stdexcept>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "appearance/subsurface/exact_totals.h"

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

}  // namespace

Material translucent_paint(const TranslucentMaterial& medium, double alpha) {
    Material paint;
    paint.name = medium.name;
    paint.family = "translucent";
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
