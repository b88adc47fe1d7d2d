// The manual page, from the same table as help and the parser.
#pragma once

#include <string>
#include <vector>

#include "cli/command.h"

namespace livery {

/// livery(1) in the man macros: every command with its options, files, environment, exit status.
std::string man_page(const std::vector<Command>& commands);

}  // namespace livery
