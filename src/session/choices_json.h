// Settings that documents and commands both write by name. Include only where core/json.h may be.
#pragma once

#include <stdexcept>
#include <string>

#include "core/json.h"
#include "scene/frame_plan.h"
#include "scene/gamut_mapping.h"

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

}  // namespace livery
