#include "appearance/lobe_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "appearance/paint_bsdf.h"

namespace livery {

namespace {

constexpr double kHorizon_rad = 0.4999 * std::numbers::pi;
constexpr double kEvenStep_rad = 0.5 * std::numbers::pi / 90.0;
/// A lobe of slope parameter 1e-4 still has some points.
constexpr double kNearest_rad = 2e-5;
constexpr double kGrowth = 1.15;

std::vector<double> angles_around(double mirror_rad) {
    std::vector<double> angles{mirror_rad};
    const auto add = [&](double angle) {
        if (std::abs(angle) <= kHorizon_rad) angles.push_back(angle);
    };
    for (double away = kNearest_rad; away < 0.2; away *= kGrowth) {
        add(mirror_rad - away);
        add(mirror_rad + away);
    }
    for (int k = -90; k <= 90; ++k) add(std::clamp(k * kEvenStep_rad, -kHorizon_rad, kHorizon_rad));
    std::sort(angles.begin(), angles.end());
    return angles;
}

}  // namespace

std::vector<LobePoint> lobe_curve(const Material& material, double theta_i_rad) {
    const ReflectanceFunction value = reflectance_of(material);
    const double light_rad = std::clamp(theta_i_rad, 0.0, kHorizon_rad);
    const glm::dvec3 wi(-std::sin(light_rad), 0.0, std::cos(light_rad));
    std::vector<LobePoint> curve;
    for (const double angle : angles_around(light_rad)) {
        curve.push_back({angle, value(wi, {std::sin(angle), 0.0, std::cos(angle)})});
    }
    return curve;
}

}  // namespace livery
