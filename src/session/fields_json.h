// Settings and seats that documents and commands both write. Include only where core/json.h may be.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "core/json.h"
#include "scene/frame_plan.h"
#include "scene/gamut_mapping.h"
#include "scene/seats.h"

namespace livery {

inline Quality read_quality(const JsonReader& field) {
    return static_cast<Quality>(field.one_of({"draft", "normal", "high", "reference"}));
}

/// As --levels has them; what it does not name is as in the normal quality.
inline EffectLevels read_levels(const JsonReader& field) {
    try {
        return parse_levels(field.text(), levels_of(Quality::normal));
    } catch (const std::invalid_argument& error) {
        field.fail(field.found(), std::string("levels of effects; ") + error.what());
    }
}

inline GamutMapping read_gamut_mapping(const JsonReader& field) {
    return static_cast<GamutMapping>(field.one_of({"strict", "preserve"}));
}

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
