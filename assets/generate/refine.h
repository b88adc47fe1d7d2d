// Finer triangles where a sheet is to be cut into small things.
#pragma once

#include "sheet.h"

namespace livery::assets {

/// Splits each masked triangle into four, and its neighbours so that no gap opens. New vertices lie
/// on the curve that the normals at the edge's ends imply (Vlachos et al. 2001, curved PN
/// triangles).
void refine(Sheet& sheet, const TriangleMask& mask);

}  // namespace livery::assets
