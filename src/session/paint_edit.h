// Paints by name, and what becomes of one that is edited.
#pragma once

#include <string>

#include "session/commands.h"

namespace livery {

/// How the document calls that paint: its own and the library's by their names, a file by its whole
/// path. Throws std::invalid_argument with the nearest names.
std::string known_paint(const Document& document, const std::string& name);

/// EditPaint on a look and a part that there are. Throws std::invalid_argument.
void edit_paint(Document& document, const EditPaint& command);

/// Everything that wears the paint goes on wearing it. Throws std::invalid_argument for a paint
/// that is not the session's own, and for a name that another paint has.
void rename_paint(Document& document, const RenamePaint& command);

/// The paint as it comes back from a file: only what its model reads. Throws std::invalid_argument
/// for what a file cannot hold, by name.
Material kept_paint(const Material& paint);

}  // namespace livery
