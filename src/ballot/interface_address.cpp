#include "ballot/interface_address.h"

#include <stdexcept>
#include <vector>

#include "core/paths.h"
#include "evaluation/network_interfaces.h"

namespace livery {

std::string interface_address(const std::string& name) {
    std::vector<std::string> names;
    for (const NetworkInterface& network : network_interfaces()) {
        if (name == network.name) return network.address;
        names.push_back(network.name + " (" + network.address + ")");
    }
    throw std::invalid_argument("--interface: found \"" + name +
                                "\", expected one with an IPv4 address: " + list_of(names));
}

}  // namespace livery
