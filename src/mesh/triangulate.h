// A polygon in space as triangles. Internal to scene/.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace livery {

/// Corners above which a polygon is refused by whoever reads it.
inline constexpr std::size_t kMaxPolygonCorners = 4096;
/// Steps, seconds of them, above which a whole file is: cutting ears looks at every corner that
/// turns inward for each that is cut.
inline constexpr std::size_t kMaxCuttingSteps = 2'000'000'000;

/// Cuts a simple polygon, flat or nearly so, concave or convex, into corner count - 2 triangles of
/// indices into it, wound as it is. One that crosses itself gives as many, some of them
/// overlapping. `steps` grows by what it took.
std::vector<glm::uvec3> triangulate(const std::vector<glm::dvec3>& polygon, std::size_t& steps);

}  // namespace livery
