#include "studio/product/lit_share.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace livery {

namespace {

/// Below it a rim is cut off that nobody sees.
constexpr double kAll = 0.995;

}  // namespace

std::vector<MeshSample> mesh_samples(const Mesh& mesh, std::size_t count) {
    std::vector<double> area_up_to;
    double area = 0.0;
    const auto corner = [&](std::uint32_t k) { return glm::dvec3(mesh.positions_mm[k]); };
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = corner(t.x);
        area += glm::length(glm::cross(corner(t.y) - a, corner(t.z) - a));
        area_up_to.push_back(area);
    }
    std::vector<MeshSample> samples;
    if (!(area > 0.0)) return samples;
    for (std::size_t k = 0; k < count; ++k) {
        const auto number = static_cast<double>(k);
        const double at = (number + 0.5) / static_cast<double>(count) * area;
        const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end(), at);
        const auto last = static_cast<std::ptrdiff_t>(area_up_to.size()) - 1;
        const auto& t =
            mesh.triangles[static_cast<std::size_t>(std::min(found - area_up_to.begin(), last))];
        // Multiples of the plastic number's powers fill the plane evenly (Roberts' R2 sequence).
        double u = std::fmod(0.5 + 0.7548776662466927 * number, 1.0),
               v = std::fmod(0.5 + 0.5698402909980532 * number, 1.0);
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        const glm::dvec3 a = corner(t.x), ab = corner(t.y) - a, ac = corner(t.z) - a;
        samples.push_back({a + u * ab + v * ac, glm::normalize(glm::cross(ab, ac))});
    }
    return samples;
}

std::optional<double> lit_share(const std::vector<MeshSample>& samples,
                                const ProductFile& product,
                                const View& projector) {
    const double mm = mm_per(product.unit.value_or(LengthUnit::mm)) * product.mesh_scale;
    const Rigid3 world_from_mesh = product.world_from_mesh.value_or(Rigid3{});
    const glm::dvec3 from = centre_in_world(projector);
    double all = 0.0, lit = 0.0;
    for (const MeshSample& sample : samples) {
        const glm::dvec3 position = world_from_mesh * (mm * glm::dvec3(sample.position));
        const glm::dvec3 normal = world_from_mesh.rotation * glm::dvec3(sample.normal);
        const glm::dvec3 way = position - from;
        const double distance = glm::length(way);
        // Scans are open and turned over in places: either side counts.
        const double angle = std::abs(glm::dot(normal, way)) / (distance * distance * distance);
        if (!std::isfinite(angle)) continue;
        all += angle;
        const auto pixel = project(projector, position);
        if (pixel && pixel->x >= 0.0 && pixel->y >= 0.0 && pixel->x <= projector.width &&
            pixel->y <= projector.height) {
            lit += angle;
        }
    }
    if (!(all > 0.0)) return std::nullopt;
    return lit / all;
}

std::string lit_share_text(double share) {
    if (share >= kAll) return "The simulated bench's projector lights all of it.";
    return fmt::format(
        "The simulated bench's projector lights {:.0f}% of it. A smaller model lies "
        "in its picture as a whole.",
        std::floor(100.0 * share));
}

}  // namespace livery
