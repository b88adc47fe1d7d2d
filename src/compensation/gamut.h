// Gamut mapping: what is worked out of a table once, and what runs for a block of pixels.
#pragma once

#include "compensation/compensation.h"
#include "compensation/kernel.h"

namespace livery {

/// What GamutMapping::preserve needs to know of a table that is otherwise complete.
GamutBoundary make_gamut_boundary(const CompensationTable& table);

/// The block of a table's pixels that begins at `begin`.
kernel::GamutJob gamut_job(const CompensationTable& table, std::size_t begin);

}  // namespace livery
