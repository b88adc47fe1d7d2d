// Which Livery this is.
#pragma once

#include <string>

namespace livery {

/// "livery 0.1.0 (3f2a9c1)" and lines that say what built it and under which licence it is.
std::string version_text();

/// "0.1.0".
std::string version_number();

/// "GNU 12.2.0; embree 3.13.5, fmt 9.1.0": the compiler, and the libraries as the build found them.
std::string built_with();

/// The day of this version's last change as its change log has it, "2026-11-21".
std::string version_date();

}  // namespace livery
