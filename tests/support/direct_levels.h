// Levels to compare with direct light: what parts send to one another is left out.
#pragma once

#include "scene/effects.h"

namespace livery {

inline EffectLevels direct_levels(Quality quality) {
    EffectLevels levels = levels_of(quality);
    levels[Effect::interreflection] = 0;
    return levels;
}

}  // namespace livery
