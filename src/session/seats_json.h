// Seats as documents and commands both write them. Include only where core/json.h may be.
#pragma once

#include <vector>

#include "core/json.h"
#include "scene/seats.h"

namespace livery {

/// {"seat": 4, "eye_mm": [281, 480, 696]}, with "counts": false where it does not.
Json json_of(const EyeSeat& seat);
Json json_of(const std::vector<EyeSeat>& seats);
/// {"of": "hand"}, {"of": "mean"} or {"of": "seat", "seat": 4}.
Json json_of(const EyeChoice& choice);

/// Throw FileError that names the field.
EyeSeat read_seat(const JsonReader& object);
/// In the order of their numbers; only such as can be (seats_problem()).
std::vector<EyeSeat> read_seats(const JsonReader& list);
EyeChoice read_eye_choice(const JsonReader& object);
/// The same of these seats.
EyeChoice read_eye_choice(const JsonReader& object, const std::vector<EyeSeat>& seats);

}  // namespace livery
