#include "evaluation/network_interfaces.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include <arpa/inet.h>
#include <ifaddrs.h>

namespace livery {

std::vector<NetworkInterface> network_interfaces() {
    ifaddrs* first = nullptr;
    if (::getifaddrs(&first) != 0) throw std::runtime_error("cannot list network interfaces");
    const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(first, &::freeifaddrs);
    std::vector<NetworkInterface> found;
    for (const ifaddrs* entry = first; entry; entry = entry->ifa_next) {
        if (!entry->ifa_addr || entry->ifa_addr->sa_family != AF_INET) continue;
        const auto* address = reinterpret_cast<const sockaddr_in*>(entry->ifa_addr);
        char text[INET_ADDRSTRLEN] = {};
        if (!::inet_ntop(AF_INET, &address->sin_addr, text, sizeof text)) continue;
        const bool known = std::any_of(found.begin(), found.end(), [&](const auto& other) {
            return other.name == entry->ifa_name;
        });
        if (!known) found.push_back({entry->ifa_name, text});
    }
    return found;
}

}  // namespace livery
