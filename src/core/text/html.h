// Text from elsewhere in an HTML or SVG file.
#pragma once

#include <string>
#include <string_view>

namespace livery {

/// Fit for an element's text and for an attribute between double quotation marks.
std::string html_escaped(std::string_view text);

}  // namespace livery
