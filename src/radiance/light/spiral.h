// Vogel's spirals: points that fill a disc, a cap or a hemisphere evenly, turned for each fragment
// by an angle of its own so that neighbours make different errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>

#include <glm/vec3.hpp>

namespace livery {

/// From one point of a spiral to the next.
inline constexpr double kGoldenAngle_rad = std::numbers::pi * 0.76393202250021030;

/// Two unit vectors that make a right-handed frame with unit `n` (Duff et al. 2017).
struct Basis {
    glm::vec3 s, t;
};
Basis basis_around(const glm::vec3& n);

/// A fragment's angle in [0, 2 pi): hashes of different purposes have nothing in common.
double turn_of_fragment_rad(std::size_t fragment, std::uint32_t purpose, std::uint32_t salt);

/// Points around the z axis, put around `axis` (whose basis_around() is `basis`) and turned about
/// it; as many directions as points.
void turn_around(std::span<const glm::vec3> points,
                 const glm::vec3& axis,
                 const Basis& basis,
                 double turn_rad,
                 std::span<glm::vec3> directions);

}  // namespace livery
