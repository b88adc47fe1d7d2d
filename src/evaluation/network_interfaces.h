// The networks of this machine.
#pragma once

#include <string>
#include <vector>

namespace livery {

struct NetworkInterface {
    std::string name;     ///< "lo", "wlan0"
    std::string address;  ///< IPv4; the first
};

/// Those that have an IPv4 address, in the system's order. Throws std::runtime_error.
std::vector<NetworkInterface> network_interfaces();

}  // namespace livery
