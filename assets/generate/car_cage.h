// The car body's control cage, from the feature lines that a designer would draw.
//
// The cage is a rounded box of quads: stations along the car, rows around half of its section,
// mirrored. Rows are feature lines: 0 the centre line, 3 and 4 the cant rail (A-pillar, roof edge),
// 6 the belt under the side windows, 8 the shoulder, 9 the widest line, 13 the sill's lower edge.
#pragma once

#include <glm/vec3.hpp>

#include "subdivision.h"

namespace livery::assets {

inline constexpr int kStations = 20;    ///< 0 is the tail's edge, 20 the nose's
inline constexpr int kShoulderRow = 8;  ///< edge between the cage's top and its side
inline constexpr int kSillRow = 13;

/// Which side of the rounded box a face is of.
enum CageRegion { kTop = 0, kSide = 1, kNose = 2, kTail = 3, kFloor = 4 };

/// A point of the feature lines in millimetres; fractions of a station or row interpolate.
glm::dvec3 feature_point(double station, double row);

/// The whole cage; parameters are (station, row) on top and side, rows negative on the right.
Cage make_car_cage();

}  // namespace livery::assets
