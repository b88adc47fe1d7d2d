// Where light comes from, as the path tracer asks for it: sample a direction, or judge one.
#pragma once

#include <optional>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scene/look.h"

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

}  // namespace livery
