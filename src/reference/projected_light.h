// A picture that a projector throws onto the scene, as the path tracer asks for it.
#pragma once

#include <glm/vec3.hpp>

#include "core/image.h"
#include "scene/view.h"

namespace livery {

/// Light from one point: each pixel of a lens sends as much light as it is told, through its own
/// small cone. A pixel is even and has hard edges.
class ProjectedLight {
  public:
    /// `picture_working` has the projector's size and three channels or more: what a white diffuser
    /// in front of the lens that faces it, `distance_mm` along its axis, reflects there. Farther
    /// off it is less by the square. Throws std::invalid_argument for another size, for what is no
    /// light (negative or no number), and a distance that is not above 0.
    ProjectedLight(const View& projector, ImageF picture_working, double distance_mm);

    struct Arriving {
        glm::vec3 direction{0.0f, 1.0f, 0.0f};  ///< toward the projector
        float distance_mm = 0.0f;
        /// On a plane that faces the projector: pi x the radiance of a white diffuser there. 0
        /// beside the picture.
        glm::vec3 irradiance{0.0f};
    };
    Arriving at(const glm::dvec3& point_mm) const;

  private:
    /// Area in the picture of what is small on a plane across the axis, over that of a lens without
    /// distortion.
    double magnified(const glm::dvec3& in_view_mm) const;

    View projector_;
    ImageF picture_;
    glm::dvec3 centre_mm_;
    double distance_mm_;
    bool distorts_;
};

}  // namespace livery
