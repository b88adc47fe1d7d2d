// Settings that documents and commands both write by name. Include only where core/json.h may be.
#pragma once

#include "core/json.h"
#include "scene/frame_plan.h"
#include "scene/gamut_mapping.h"

namespace livery {

inline Quality read_quality(const JsonReader& field) {
    return static_cast<Quality>(field.one_of({"draft", "normal", "high", "reference"}));
}

inline GamutMapping read_gamut_mapping(const JsonReader& field) {
    return static_cast<GamutMapping>(field.one_of({"strict", "preserve"}));
}

}  // namespace livery
