// How far light goes in a translucent paint, as tables that transports are weighed with.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/subsurface/translucent_material.h"

namespace livery {

/// Distances are told in steps that are finer near the beam, where the profile is steep.
inline constexpr std::uint32_t kDistanceSteps = 2048;
std::uint16_t distance_code(float distance_mm, float reach_mm);

/// The mean of `value(distance)` over a disc of that radius, whose middle is that far away.
template <typename Value>
auto mean_over_disc(double distance_mm, double radius_mm, const Value& value) {
    constexpr int kRings = 4, kSpokes = 8;
    using Mean = decltype(value(distance_mm));
    Mean sum(0);
    for (int ring = 0; ring < kRings; ++ring) {
        const double r = radius_mm * std::sqrt((ring + 0.5) / kRings);
        for (int spoke = 0; spoke < kSpokes; ++spoke) {
            const double angle = (spoke + 0.5) * 2.0 * std::numbers::pi / kSpokes;
            sum += value(std::hypot(distance_mm + r * std::cos(angle), r * std::sin(angle)));
        }
    }
    return sum / static_cast<Mean>(kRings * kSpokes);
}

/// Of what is near, in cells of the nodes' grid: sums over nodes of what begins that softly are as
/// good as integrals.
inline constexpr double kNearCells = 2.0;

/// Beyond, three thousandths of what leaves the plane do so; or of what leaves a sheet that thick.
float kernel_reach_mm(const TranslucentMaterial& on_mock_up, std::optional<float> sheet_mm = {});

/// The same model where the body is a slab of that thickness: what goes farther than near_mm on the
/// side where it entered, and what comes out on the other.
struct SlabKernel {
    float thickness_mm = 0.0f;
    glm::vec3 near_share{0.0f}, far_share{0.0f}, through_share{0.0f};
    std::vector<glm::vec3> far_per_mm2;      ///< at codes of the kernel's reach_mm
    std::vector<glm::vec3> through_per_mm2;  ///< at codes of the distance along the slab
};

/// The best analytic profile (SubsurfaceModel::scaled_beam_diffusion) of each channel in the
/// working space, a reflectance at each distance, in two parts: what goes no farther than `near_mm`
/// falls off smoothly to nothing there, the rest begins as smoothly and has no peak at the beam.
struct SubsurfaceKernel {
    float reach_mm = 0.0f;
    float near_mm = 0.0f;
    glm::vec3 total{0.0f};  ///< of what enters, over the whole plane
    /// Linear Rec.709: that total, the decay sqrt(sigma_a/D) of what is far, and how much of the
    /// fluence at a plane goes on into it over what leaves it, 2 A D decay (diffusion theory).
    glm::dvec3 albedo{0.0}, decay_per_mm{0.0}, inward{0.0};
    /// The same of bodies that light crosses in few mean free paths: 1 over one, and what
    /// leaves slabs that are twelve, six, three and so on of them thick.
    glm::dvec3 extinction_per_mm{0.0};
    std::vector<glm::dvec3> thin_totals;
    /// How far diffusion may be believed, from 0 to 1: light that scatters four times and less
    /// before it is absorbed knows nothing of the body's shape.
    glm::dvec3 diffuses{0.0};

    std::vector<glm::vec3> near_per_mm2;  ///< at codes of near_mm
    /// At codes of reach_mm; and what a curvature of 1 per mm adds to it, to first order.
    std::vector<glm::vec3> far_per_mm2, bent_per_mm2;
    glm::vec3 near_share{0.0f};  ///< of the total, what is not far
    glm::vec3 bent_share{0.0f};  ///< of what is added
    std::vector<SlabKernel> slabs;
};
/// `most_bent_per_mm`: the largest curvature that total_at() will be asked for. Throws
/// std::invalid_argument for a medium out of range.
SubsurfaceKernel subsurface_kernel(const TranslucentMaterial& on_mock_up,
                                   float reach_mm,
                                   float near_mm,
                                   std::span<const float> slabs_mm = {},
                                   float most_bent_per_mm = 0.0f);

/// The total where the surface has that mean curvature, 1 over the radius of a ball: of what enters
/// a convex body less is lost in it, for less of it lies behind. Diffusion in a ball takes coth x -
/// 1/x of what a plane does, x = radius times decay; around a hollow 1 + 1/x. Where a ball's mean
/// chord, 4/3 of its radius, is few mean free paths long, light goes through that diffusion knows
/// nothing of: there the total is what leaves a slab of that thickness on both sides; and where
/// light does not scatter often it is the plane's.
glm::vec3 total_at(const SubsurfaceKernel& kernel, float curvature_per_mm);

/// Where light leaves that much bent a surface: the part of its total that comes from near, and how
/// much of `bent_per_mm2` the far part takes.
struct BentShares {
    glm::vec3 near{0.0f}, far{0.0f};
    float bend_per_mm = 0.0f;
    float anywhere = 0.0f;  ///< of the total, as much as crosses the body straight: leaves wherever
};
BentShares shares_at(const SubsurfaceKernel& kernel, float curvature_per_mm);

}  // namespace livery
