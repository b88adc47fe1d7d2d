#include "radiance/light/mirror_facets.h"

#include <glm/geometric.hpp>

#include "radiance/light/sky_visibility.h"
#include "radiance/light/spiral.h"

namespace livery {

Facet::Facet(const Fragment& fragment,
             const glm::vec3& its_normal,
             float slope_variance,
             const glm::dvec3& eye_mm,
             const MirrorQuadrature& quadrature)
    : normal(its_normal) {
    Fragment part;
    part.position_mm = fragment.position_mm;
    part.normal = normal;
    wo = toward_eye(part, eye_mm);
    const float mu = glm::dot(wo, normal);
    const glm::vec3 along = wo - mu * normal;
    const float length = glm::length(along);
    x = length > 1e-5f ? along / length : basis_around(normal).s;
    y = glm::cross(normal, x);
    row = quadrature.seen_under(length);
    // Half of the mean squared slope along each axis; mirrored, twice that angle in the eye's
    // plane, and 2 mu times across it
    variance = 2.0f * mu * slope_variance;
}

glm::vec3 Facet::mirrored(std::size_t node) const {
    const glm::vec3 v = row.half_vector(node);
    const glm::vec3 h = v.x * x + v.y * y + v.z * normal;
    return 2.0f * glm::dot(wo, h) / glm::dot(h, h) * h - wo;
}

Facets even_facets(const Fragment& f, const glm::dvec3& eye_mm, const MirrorQuadrature& nodes) {
    const Facet facet(f, f.normal, f.normal_variance, eye_mm, nodes);
    return {facet, facet, facet, facet};
}

Facets facets_of(const Mesh& mesh,
                 const SurfaceMap& map,
                 std::size_t index,
                 const glm::dvec3& eye_mm,
                 const MirrorQuadrature& nodes) {
    const Fragment& f = map.fragments[index];
    std::array<glm::vec3, kSamplesAFragment> normal;
    glm::vec3 away = f.normal;
    for (std::size_t k = 0; k < normal.size(); ++k) {
        normal[k] = sample_normal(mesh, map, index, k);
        away -= normal[k] / static_cast<float>(normal.size());
    }
    const auto facet = [&](std::size_t k) {
        // Four quarters of a pixel each keep a quarter of its spread
        return Facet(f,
                     glm::normalize(normal[k] + away),
                     f.normal_variance / static_cast<float>(normal.size()),
                     eye_mm,
                     nodes);
    };
    return {facet(0), facet(1), facet(2), facet(3)};
}

}  // namespace livery
