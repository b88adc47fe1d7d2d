// A paint's fields as JSON, for material files, for whatever holds paints, and for answers in JSON.
// Not for headers.
#pragma once

#include "appearance/material.h"
#include "core/json.h"

namespace livery {

/// What becomes of a paint whose measured file cannot be read.
enum class UnreadMeasured {
    refused,  ///< FileError
    kept      ///< it is black, and its MeasuredPaint says why; written, it names its file again
};

/// The fields of a material file without its `format_version`. Which others the object may have is
/// the caller's to check. Throws FileError (unknown model or parameter, out of range).
Material read_material(const JsonReader& object, UnreadMeasured unread = UnreadMeasured::refused);
/// Throws std::invalid_argument for parameters out of range.
Json json_of(const Material& material);

}  // namespace livery
