// The light from all around: which map, how it is turned, how strong.
#pragma once

#include <functional>

#include "scene/look.h"
#include "studio/studio.h"

namespace livery {

/// Edits `environment` (the held one of the look shown); commits and tries by itself.
void draw_environment_choice(Studio& studio,
                             EnvironmentReference& environment,
                             const std::function<void()>& after_item);

}  // namespace livery
