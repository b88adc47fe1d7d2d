// Lists of numbers in JSON, each within a stated range. Include only where core/json.h may be.
#pragma once

#include <vector>

#include "core/json.h"

namespace livery {

/// Places and sizes end here: a thousand kilometres, in which float still tells a tenth of a metre.
inline constexpr double kFarthest_mm = 1e9;
/// Directions, of any length but none.
inline constexpr double kLongestDirection = 1e6;

/// Exactly `count` numbers between the two. Throws FileError that names the element.
inline std::vector<double> numbers_between(const JsonReader& list,
                                           std::size_t count,
                                           double low,
                                           double high) {
    if (!list.is_array() || list.size() != count) return list.numbers(count);  // says so
    std::vector<double> values(count);
    for (std::size_t k = 0; k < count; ++k) values[k] = list.at(k).number_between(low, high);
    return values;
}

/// A vector of which no component is larger in size.
inline glm::dvec3 vec3_within(const JsonReader& list, double largest) {
    const auto values = numbers_between(list, 3, -largest, largest);
    return {values[0], values[1], values[2]};
}

/// A place in the world, mm.
inline glm::dvec3 place_mm(const JsonReader& list) { return vec3_within(list, kFarthest_mm); }

}  // namespace livery
