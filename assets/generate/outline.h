// Closed outlines in a plane and their signed distance: what windows, lamps and doors are cut by.
#pragma once

#include <vector>

#include <glm/vec2.hpp>

namespace livery::assets {

class Outline {
  public:
    /// Corners in order; each is rounded with a curve that leaves the edges `radius` before it (at
    /// most 45% of the shorter edge).
    Outline(const std::vector<glm::dvec2>& corners, double radius);

    /// Negative inside, in the unit of the corners.
    double signed_distance(const glm::dvec2& point) const;

  private:
    std::vector<glm::dvec2> points_;
};

}  // namespace livery::assets
