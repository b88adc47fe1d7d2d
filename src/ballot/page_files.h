// The phone page, compiled in: nothing is read from a folder, and no request leaves it.
#pragma once

#include <string_view>

namespace livery {

std::string_view page_html();
std::string_view page_css();
std::string_view page_js();

}  // namespace livery
