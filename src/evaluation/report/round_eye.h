// Whose eye the looks of a round were shaded for, and what the other seats missed of them.
#pragma once

#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace livery {

class JsonReader;

/// Of one look, by its code: CIEDE2000 of what was projected to what the seat should have seen.
struct SeatMiss {
    int code = 0;
    double de00_median = 0.0, de00_p95 = 0.0;
    double share_over_3 = 0.0;  ///< of the mock-up

    bool operator==(const SeatMiss&) const = default;
};

struct RoundSeat {
    int seat = 0;                      ///< its number, from 1
    glm::dvec3 eye_mm{0.0};            ///< in the mock-up's frame
    bool counts = true;                ///< in the mean
    std::vector<SeatMiss> looks = {};  ///< empty: not known

    bool operator==(const RoundSeat&) const = default;
};

struct RoundEye {
    std::string of = {};  ///< "of seat 4", "in the mean of 5 seats"
    glm::dvec3 eye_mm{0.0};
    std::vector<RoundSeat> seats = {};

    bool operator==(const RoundEye&) const = default;
};

/// Member "eye" of a round's details. Throws FileError that names the field: seats that cannot be,
/// a code that is none of `codes`, a look twice.
RoundEye read_round_eye(const JsonReader& object, const std::vector<int>& codes);

}  // namespace livery
