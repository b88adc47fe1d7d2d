#include "outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace livery::assets {

Outline::Outline(const std::vector<glm::dvec2>& corners, double radius) {
    const std::size_t n = corners.size();
    constexpr int kSteps = 6;
    for (std::size_t k = 0; k < n; ++k) {
        const auto& corner = corners[k];
        const auto before = corners[(k + n - 1) % n] - corner;
        const auto after = corners[(k + 1) % n] - corner;
        const double leave =
            std::min({radius, 0.45 * glm::length(before), 0.45 * glm::length(after)});
        const auto from = corner + glm::normalize(before) * leave;
        const auto to = corner + glm::normalize(after) * leave;
        for (int step = 0; step <= kSteps; ++step) {
            const double t = static_cast<double>(step) / kSteps;
            points_.push_back(from * ((1 - t) * (1 - t)) + corner * (2 * t * (1 - t)) +
                              to * (t * t));
        }
    }
}

double Outline::signed_distance(const glm::dvec2& point) const {
    double nearest2 = std::numeric_limits<double>::max();
    bool inside = false;
    for (std::size_t k = 0, last = points_.size() - 1; k < points_.size(); last = k++) {
        const auto& a = points_[last];
        const auto& b = points_[k];
        const auto edge = b - a;
        const double length2 = glm::dot(edge, edge);
        const double t =
            length2 > 0.0 ? std::clamp(glm::dot(point - a, edge) / length2, 0.0, 1.0) : 0.0;
        const auto away = point - (a + edge * t);
        nearest2 = std::min(nearest2, glm::dot(away, away));
        if ((a.y > point.y) != (b.y > point.y) &&
            point.x < a.x + edge.x * (point.y - a.y) / edge.y) {
            inside = !inside;
        }
    }
    const double distance = std::sqrt(nearest2);
    return inside ? -distance : distance;
}

}  // namespace livery::assets
