// A sheet without needles, which cuts leave where they pass close to one another.
#pragma once

#include "sheet.h"

namespace livery::assets {

/// The sheet with triangles of less height than `height_mm` taken out: short edges shrink to a
/// point, and flat corners give way to the triangle across. Borders of panels move by no more.
Sheet without_needles(Sheet sheet, double height_mm);

}  // namespace livery::assets
