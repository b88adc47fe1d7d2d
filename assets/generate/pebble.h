// A slab with rounded corners and soft edges, as half a sheet (z >= 0).
#pragma once

#include "sheet.h"

namespace livery::assets {

/// Flat in the middle; around it the distance to the flat part in plan, e, and the height obey
/// e^3 + |x / half_thickness|^3 = 1 with a superellipse's corners in plan: curvature has no jumps.
struct Pebble {
    double half_height_mm = 52.0;    ///< along y
    double half_width_mm = 31.0;     ///< along z
    double half_thickness_mm = 5.5;  ///< along x
    double edge_mm = 14.0;           ///< width of the rounded edge in plan
};

enum PebbleRegion { kFront = 0, kBehind = 1 };

/// Triangles of about `spacing_mm`; parameters are unused.
Sheet pebble_sheet(const Pebble& pebble, double spacing_mm);

}  // namespace livery::assets
