// Where evaluators sit round the mock-up, and whose eye highlights are drawn for.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "mesh/mesh.h"

namespace livery {

struct EyeSeat {
    int number = 1;          ///< as on the ballot, from 1
    glm::dvec3 eye_mm{0.0};  ///< of who sits there, in the world: y is up
    bool counts = true;      ///< in the mean of all seats

    bool operator==(const EyeSeat&) const = default;
};

/// What the session's eye is: a point that was set by hand, one seat's, or the mean of the seats
/// that count.
enum class EyeSource { by_hand, seat, mean };
struct EyeChoice {
    EyeSource source = EyeSource::by_hand;
    int seat = 0;  ///< its number; 0 unless one seat's

    bool operator==(const EyeChoice&) const = default;
};

inline constexpr int kLargestSeatNumber = 999;
inline constexpr std::size_t kMostSeats = 40;
inline constexpr double kFarthestEye_mm = 1e6;
/// Two eye points nearer than that would be in one head.
inline constexpr double kLeastBetweenSeats_mm = 150.0;

const EyeSeat* find_seat(const std::vector<EyeSeat>& seats, int number);
/// Lowest number that no seat has.
int free_seat_number(const std::vector<EyeSeat>& seats);
/// Of the seats that count; nothing where none does.
std::optional<glm::dvec3> mean_eye_mm(const std::vector<EyeSeat>& seats);

/// Why these seats cannot be, in a sentence without its stop: too many, a number twice or out of
/// range, two in one place, an eye that is no place. Nothing: they can.
std::optional<std::string> seats_problem(const std::vector<EyeSeat>& seats);
/// Why the choice means no eye.
std::optional<std::string> choice_problem(const std::vector<EyeSeat>& seats,
                                          const EyeChoice& choice);
/// Throws std::invalid_argument with the choice's problem.
glm::dvec3 eye_in_use_mm(const glm::dvec3& by_hand_mm,
                         const std::vector<EyeSeat>& seats,
                         const EyeChoice& choice);

/// How many count in the mean.
int counting_seats(const std::vector<EyeSeat>& seats);
/// "set by hand", "of seat 4", "in the mean of 5 seats".
std::string in_words(const std::vector<EyeSeat>& seats, const EyeChoice& choice);

// Places that seats have at first. The world's millimetres are those of the room, whatever scale
// the product is shown at: people do not shrink with a model. A mock-up up to 1 m high and 2 m long
// stands on a table of 0.72 m; a larger one on the floor.

inline constexpr double kTable_mm = 720.0;
inline constexpr double kSeatedEye_mm = 1200.0;  ///< above the floor
inline constexpr double kArm_mm = 700.0;         ///< from the mock-up's farthest point to an eye
inline constexpr double kElbow_mm = 650.0;       ///< from one seat to the next

/// World height of the floor under a mock-up with these bounds.
double floor_height_mm(const Bounds& mockup);
/// World height of a seated eye.
double seated_eye_height_mm(const Bounds& mockup);
/// Numbers 1 to `count` from left to right, as who faces the mock-up counts, on an arc about it
/// whose middle is where `toward_mm` lies in the plan (right over the mock-up: +z). The arc never
/// goes more than half round; where an arm's length is too short for that, it is wider.
std::vector<EyeSeat> seats_in_an_arc(const Bounds& mockup, const glm::dvec3& toward_mm, int count);
/// The next free number, in the place on such arcs that is nearest to the middle of the inner one
/// and free.
EyeSeat next_seat(const Bounds& mockup,
                  const glm::dvec3& toward_mm,
                  const std::vector<EyeSeat>& seats);

}  // namespace livery
