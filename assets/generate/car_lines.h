// The feature lines that the car's shape is drawn with.
//
// Stations count along the car, rows around half of its section. Rows are feature lines: 0 the
// centre line, 3 and 4 the cant rail (A-pillar, roof edge), 6 the belt under the side windows, 8
// the shoulder, 9 the widest line, 13 the sill's lower edge. Millimetres, x toward the front, y up.
#pragma once

#include <glm/vec3.hpp>

namespace livery::assets {

inline constexpr int kStations = 20;    ///< 0 is the tail's edge, 20 the nose's
inline constexpr int kShoulderRow = 8;  ///< edge between the cage's top and its side
inline constexpr int kSillRow = 13;

/// Where the surface passes at a station and a row; fractions interpolate.
glm::dvec3 feature_point(double station, double row);

/// A column (0 the centre line, 8 the corner) of the nose's or tail's face; `level` 0 to 5 counts
/// rows down from the shoulder's.
glm::dvec3 end_point(bool nose, int column, int level);

/// How far out the columns of the two ends stand, as a fraction of the corner's.
double end_column(int column);

}  // namespace livery::assets
