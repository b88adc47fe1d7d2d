// How far light goes in a translucent paint, as a table that transports are weighed with.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/subsurface/translucent_material.h"

namespace livery {

/// Distances are told in steps that are finer near the beam, where the profile is steep.
inline constexpr std::uint32_t kDistanceSteps = 2048;
std::uint16_t distance_code(float distance_mm, float reach_mm);

/// The best analytic profile (SubsurfaceModel::scaled_beam_diffusion) of each channel, in the
/// working space: a reflectance at each distance.
struct SubsurfaceKernel {
    float reach_mm = 0.0f;  ///< beyond, a hundredth of what leaves does so
    glm::vec3 total{0.0f};  ///< of what enters, over the whole plane
    /// Linear Rec.709: that total, the decay sqrt(sigma_a/D) of what is far, and how much of the
    /// fluence at a plane goes on into it over what leaves it, 2 A D decay (diffusion theory).
    glm::dvec3 albedo{0.0}, decay_per_mm{0.0}, inward{0.0};
    std::vector<glm::vec3> per_mm2;  ///< at each code
    std::vector<glm::vec3> within;   ///< of what enters, within the distance of each code
};
/// Throws std::invalid_argument for a medium out of range.
SubsurfaceKernel subsurface_kernel(const TranslucentMaterial& on_mock_up);

/// The total where the surface has that mean curvature, 1 over the radius of a ball: of what enters
/// a convex body less is lost in it, for less of it lies behind. Diffusion in a ball takes coth x -
/// 1/x of what a plane does, x = radius times decay; around a hollow 1 + 1/x.
glm::vec3 total_at(const SubsurfaceKernel& kernel, float curvature_per_mm);

}  // namespace livery
