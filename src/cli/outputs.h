// Whether what a command is to write can be written, found before the work.
#pragma once

#include "cli/command.h"

namespace livery {

/// Looks at the command's --out, a FILE or a DIR as its help calls it, of FILE|DIR what has no
/// suffix or is a folder. Throws FileError. Leaves nothing behind, and what is there as it is.
void check_outputs(const Command& command);

}  // namespace livery
