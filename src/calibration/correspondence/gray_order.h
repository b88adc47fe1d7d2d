// Which stripe photographs were exchanged, when a decoded map is torn.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/correspondence/gray_code.h"

namespace livery {

/// Names the two stripe photographs (or the two bits) whose exchange explains why the decoded
/// places jump from camera pixel to camera pixel: with them put right, the places run on smoothly.
/// Nothing where the places run on smoothly, or no exchange helps. Photographs of one channel or
/// more; roles of other kinds are ignored.
std::optional<std::string> exchanged_stripes(const std::vector<RoledPhotograph>& photographs,
                                             int projector_width,
                                             int projector_height);

}  // namespace livery
