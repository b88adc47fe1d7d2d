// --patterns: what photographs without a manifest of their own show.
#pragma once

#include <string>

#include "cli/command.h"

namespace livery {

Option patterns_option(std::string& target);

}  // namespace livery
