#include "ballot/interface_address.h"

#include <memory>
#include <stdexcept>
#include <vector>

#include <arpa/inet.h>
#include <ifaddrs.h>

#include "core/paths.h"

namespace livery {

std::string interface_address(const std::string& name) {
    ifaddrs* first = nullptr;
    if (::getifaddrs(&first) != 0) throw std::runtime_error("cannot list network interfaces");
    const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(first, &::freeifaddrs);
    std::vector<std::string> names;
    for (const ifaddrs* entry = first; entry; entry = entry->ifa_next) {
        if (!entry->ifa_addr || entry->ifa_addr->sa_family != AF_INET) continue;
        const auto* address = reinterpret_cast<const sockaddr_in*>(entry->ifa_addr);
        char text[INET_ADDRSTRLEN] = {};
        if (!::inet_ntop(AF_INET, &address->sin_addr, text, sizeof text)) continue;
        if (name == entry->ifa_name) return text;
        names.push_back(std::string(entry->ifa_name) + " (" + text + ")");
    }
    throw std::invalid_argument("--interface: found \"" + name +
                                "\", expected one with an IPv4 address: " + list_of(names));
}

}  // namespace livery
