// Rotations, poses and data sheets in JSON files. Internal to scene/ and twin/.
#pragma once

#include "core/json.h"
#include "scene/data_sheet.h"
#include "scene/view.h"

namespace livery {

/// Nine numbers, row by row, that are a rotation. Throws FileError.
glm::dmat3 read_rotation(const JsonReader& field);

/// {"rotation": [9], "translation_mm": [3]}; both must be there.
Rigid3 read_pose(const JsonReader& object);
Json json_of(const Rigid3& pose);

/// The fields `matrix` (fx, 0, cx, 0, fy, cy, 0, 0, 1; pixel centres at integers) and, where it is
/// there, `distortion`.
void read_lens(const JsonReader& object, View& view);

/// A camera file's fields (docs/files.md) within an object.
View read_camera_fields(const JsonReader& object);
Json json_of(const View& view);

/// Throws FileError where a field is missing or beyond what is built.
DataSheets read_data_sheets(const JsonReader& json);
Json json_of(const DataSheets& sheets);

}  // namespace livery
