// A cell of a table that other programs read.
#pragma once

#include <string>

namespace livery {

/// Quoted where RFC 4180 asks for it.
std::string csv_field(const std::string& text);

}  // namespace livery
