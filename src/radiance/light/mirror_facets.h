// The normals of a pixel that mirror, and where each sends the eye's direction.
#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "radiance/light/mirror_quadrature.h"
#include "radiance/surface_map.h"

namespace livery {

static_assert(MirrorQuadrature::kFacets == kSamplesAFragment);

/// One of the normals of a pixel and the nodes around it.
struct Facet {
    glm::vec3 x, y, normal, wo;
    MirrorQuadrature::Row row;
    float variance = 0.0f;  ///< that its own spread of normals adds to its nodes'

    Facet(const Fragment& fragment,
          const glm::vec3& its_normal,
          float slope_variance,
          const glm::dvec3& eye_mm,
          const MirrorQuadrature& quadrature);

    /// Where the eye's direction is mirrored to by a node.
    glm::vec3 mirrored(std::size_t node) const;
};

using Facets = std::array<Facet, kSamplesAFragment>;

/// Every one the fragment's mean.
Facets even_facets(const Fragment& f, const glm::dvec3& eye_mm, const MirrorQuadrature& nodes);

/// One a sub-sample, moved together so that their mean is the fragment's: that is a mean over more
/// samples, and goes on more smoothly from pixel to pixel.
Facets facets_of(const Mesh& mesh,
                 const SurfaceMap& map,
                 std::size_t index,
                 const glm::dvec3& eye_mm,
                 const MirrorQuadrature& nodes);

}  // namespace livery
