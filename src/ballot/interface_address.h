// Network interfaces by name.
#pragma once

#include <string>

namespace livery {

/// The first IPv4 address of the interface ("lo", "wlan0"). Throws std::invalid_argument that lists
/// the interfaces that have one.
std::string interface_address(const std::string& name);

}  // namespace livery
