// What OpenGL says of itself, for reports.
#pragma once

#include <string>

namespace livery {

/// Vendor, renderer, versions and limits of the context that is current on this thread, a line
/// each.
std::string context_facts();

}  // namespace livery
