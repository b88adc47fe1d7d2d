// Gamut mapping: what is worked out of a table once, and what runs for a block of pixels.
#pragma once

#include <glm/mat3x3.hpp>

#include "compensation/compensation.h"
#include "compensation/kernel.h"

namespace livery {

/// What GamutMapping::preserve needs to know of a table that is otherwise complete.
GamutBoundary make_gamut_boundary(const CompensationTable& table);

/// Oklab from the working space and back, as the mapping goes through it.
struct OklabMatrices {
    glm::dmat3 cones;  ///< from working RGB
    glm::dmat3 lab;    ///< from the cones' cube roots
    glm::dmat3 roots;  ///< the inverse of lab
    glm::dmat3 rgb;    ///< the inverse of cones
};
OklabMatrices oklab_matrices();

/// The block of a table's pixels that begins at `begin`.
kernel::GamutJob gamut_job(const CompensationTable& table, std::size_t begin);

}  // namespace livery
