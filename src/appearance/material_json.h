// A paint's fields as JSON, for material files, for whatever holds paints, and for answers in JSON.
// Not for headers.
#pragma once

#include <string>

#include "appearance/material.h"
#include "core/json.h"

namespace livery {

/// The fields of a material file without its `format_version`. Which others the object may have is
/// the caller's to check. A measured paint's file is named, not read (MeasuredPaint::unread).
/// Throws FileError (unknown model or parameter, out of range).
Material read_material(const JsonReader& object);
/// Throws std::invalid_argument for parameters out of range.
Json json_of(const Material& material);
/// The text of a material file in one line.
std::string text_of(const Material& material);

}  // namespace livery
