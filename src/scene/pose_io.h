// Rotations and poses in JSON files. Internal to scene/.
#pragma once

#include "core/json.h"
#include "scene/view.h"

namespace livery {

/// Nine numbers, row by row, that are a rotation. Throws FileError.
glm::dmat3 read_rotation(const JsonReader& field);

/// {"rotation": [9], "translation_mm": [3]}; both must be there.
Rigid3 read_pose(const JsonReader& object);

}  // namespace livery
