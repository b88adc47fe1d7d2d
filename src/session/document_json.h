// The document as JSON. Include only in *_io.cpp.
#pragma once

#include "core/json.h"
#include "session/document.h"

namespace livery {

Json json_of(const Document& document);

/// Throws FileError that names the field (missing, of a wrong type, newer, an id or a name twice).
Document read_document(const JsonReader& root);

}  // namespace livery
