// The car body's control cage over its feature lines: a rounded box of quads.
#pragma once

#include "car_lines.h"
#include "subdivision.h"

namespace livery::assets {

/// Which side of the rounded box a face is of.
enum CageRegion { kTop = 0, kSide = 1, kNose = 2, kTail = 3, kFloor = 4 };

/// The whole cage; parameters are (station, row), rows negative on the right.
Cage make_car_cage();

}  // namespace livery::assets
