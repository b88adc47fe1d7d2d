// Where light comes from, as the path tracer asks for it: sample a direction, or judge one; and a
// picture that a projector throws onto the scene.
#pragma once

#include <optional>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "scene/look.h"
#include "scene/view.h"

namespace livery {

struct LightSample {
    glm::vec3 direction{0.0f, 1.0f, 0.0f};
    glm::vec3 radiance{0.0f};
    float pdf = 0.0f;  ///< over solid angle; 0: no light here
};

/// A disc of uniform radiance around a direction, or a point at infinity.
class DiscLight {
  public:
    explicit DiscLight(const DirectionalLight& light);

    bool is_point() const { return solid_angle_ == 0.0; }
    glm::vec3 direction() const { return glm::vec3(world_from_light_[2]); }
    /// On a plane that faces the light: pi x the radiance of a white diffuser there.
    glm::vec3 irradiance() const { return irradiance_; }

    LightSample sample(glm::vec2 u) const;                ///< discs only
    LightSample along(const glm::vec3& direction) const;  ///< pdf 0 beside the disc

  private:
    glm::dmat3 world_from_light_{1.0};
    double one_minus_cos_ = 0.0;  ///< of the disc's radius; cos itself rounds for small discs
    double solid_angle_ = 0.0;
    glm::vec3 irradiance_{0.0f};
    glm::vec3 radiance_{0.0f};
};

/// An environment map, constant over each of its pixels, sampled in proportion to radiance.
class EnvironmentSampler {
  public:
    explicit EnvironmentSampler(const Environment* environment);

    bool empty() const { return total_ <= 0.0; }
    LightSample sample(glm::vec2 u) const;
    LightSample along(const glm::vec3& direction) const;

  private:
    LightSample of_pixel(int x, int y) const;
    double importance(int x, int y) const;

    const Environment* environment_;
    std::vector<double> row_sum_;     ///< running, over rows
    std::vector<double> column_sum_;  ///< running within each row
    double total_ = 0.0;
};

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
