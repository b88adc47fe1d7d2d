// Parts of check_signal() that need no server.
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "projection/monitors.h"
#include "projection/outputs.h"

namespace livery {

std::vector<SignalWarning> warnings_of_size(const Output& output, glm::ivec2 calibrated_px);

}  // namespace livery
