// Rays through sub-samples of a view's pixels, and the places of the mock-up that they meet, in
// double precision.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "core/image.h"
#include "mesh/mesh.h"
#include "scene/view.h"
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

/// The pixels that can see the mesh: the box around its projected vertices, `margin_px` wider and
/// inside the picture. All of them where a vertex lies behind the view.
PixelRectangle pixels_that_see(const View& view, const Mesh& mesh, int margin_px = 2);

/// The lens is undone at the pixels' corners and interpolated inside a pixel, where distortion is
/// linear to 1e-6 px.
class PixelRays {
  public:
    PixelRays(const View& view, const PixelRectangle& rectangle, int samples_a_side);

    /// Appends the rays of one pixel, row by row of a grid, jittered inside each cell so that no
    /// edge of another device's pixels aligns with it.
    void add(int x, int y, std::vector<TraceRay>& rays) const;

  private:
    glm::vec3 origin_;
    PixelRectangle rectangle_;
    std::size_t stride_;
    int samples_;
    std::vector<glm::vec3> corners_;
};

}  // namespace livery
