// The boundary of a translucent part, as walks in it meet it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "reference/subsurface_walk.h"
#include "tracing/tracer.h"

namespace livery {

/// Of a part that is closed: its triangles, from inside. What else stands in there takes all light.
class PartBoundary final : public Boundary {
  public:
    PartBoundary(const Mesh& mesh, const Tracer& tracer, std::uint16_t part)
        : mesh_(mesh), tracer_(tracer), part_(part) {}
    std::optional<BoundaryPoint> first(const glm::dvec3& origin,
                                       const glm::dvec3& direction,
                                       double farthest) const override;
    glm::dvec3 inside_of(const BoundaryPoint& at) const override;

  private:
    const Mesh& mesh_;
    const Tracer& tracer_;
    std::uint16_t part_;
};

/// Of a part that is open, and so has no inside: what lies under the plane that touches it where
/// light enters, a sheet of that thickness or a half space.
class PlaneBoundary final : public Boundary {
  public:
    PlaneBoundary(const glm::dvec3& point,
                  const glm::dvec3& normal,
                  std::optional<double> thickness_mm = {})
        : point_(point), normal_(normal), thickness_mm_(thickness_mm) {}
    std::optional<BoundaryPoint> first(const glm::dvec3& origin,
                                       const glm::dvec3& direction,
                                       double farthest) const override;
    glm::dvec3 inside_of(const BoundaryPoint& at) const override;

  private:
    glm::dvec3 point_, normal_;
    std::optional<double> thickness_mm_;
};

}  // namespace livery
