// The feature lines that the car's shape is drawn with.
//
// Stations count along the car, rows around half of its section. Rows are feature lines: 0 the
// centre line, 3 and 4 the cant rail (A-pillar, roof edge), 6 the belt under the side windows, 8
// the shoulder, 12 the light catcher, 14 the sill's lower edge. Millimetres, x toward the front, y
// up.
#pragma once

#include <glm/vec3.hpp>

namespace livery::assets {

inline constexpr int kStations = 24;     ///< 0 is the tail's edge, 24 the nose's
inline constexpr int kCowlStation = 16;  ///< where the windscreen meets the bonnet
inline constexpr int kBonnetRow = 3;     ///< in front of the cowl: the bonnet's ridge
inline constexpr int kBeltRow = 6;
inline constexpr int kShoulderRow = 8;  ///< edge between the cage's top and its side
inline constexpr int kCatcherRow = 12;
inline constexpr int kSillRow = 14;

/// Where the surface passes at a station and a row; fractions interpolate.
glm::dvec3 feature_point(double station, double row);

/// A column (0 the centre line, 8 the corner) of the nose's or tail's face; `level` 0 to 6 counts
/// rows down from the shoulder's.
glm::dvec3 end_point(bool nose, int column, int level);

/// How far out the columns of the two ends stand, as a fraction of the corner's.
double end_column(int column);

}  // namespace livery::assets
