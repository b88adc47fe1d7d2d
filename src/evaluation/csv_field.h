// A cell of a table that other programs read.
#pragma once

#include <string>

namespace livery {

/// A text, quoted where RFC 4180 asks for it. Before one that spreadsheets would take for a formula
/// stands an apostrophe. Not for numbers.
std::string csv_field(const std::string& text);

}  // namespace livery
