// A place of the mock-up that a ray met, in double precision.
#pragma once

#include <glm/vec3.hpp>

#include "mesh/mesh.h"
#include "tracing/tracer.h"

namespace livery {

struct MeshPlace {
    glm::dvec3 position_mm{0.0};
    glm::dvec3 normal{0.0}, geometric_normal{0.0};  ///< unit; interpolated, and the triangle's
    std::uint16_t part = 0;
};
MeshPlace mesh_place(const Mesh& mesh, const Hit& hit);

/// From a place toward a point, starting on the side of the surface that faces the point.
TraceRay shadow_ray(const glm::dvec3& position_mm,
                    const glm::dvec3& geometric_normal,
                    const glm::dvec3& toward_mm);

/// Whether a place faces a point and nothing of the mock-up lies between them.
bool sees(const Tracer& tracer,
          const glm::dvec3& position_mm,
          const glm::dvec3& geometric_normal,
          const glm::dvec3& point_mm);

}  // namespace livery
