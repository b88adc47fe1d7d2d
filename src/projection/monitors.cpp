#include "projection/monitors.h"

#include <algorithm>

#include "projection/outputs.h"
#include "projection/x_connection.h"

namespace livery {

std::vector<Monitor> list_monitors() {
    const XConnection x;
    std::vector<Monitor> monitors;
    for (auto& output : read_outputs(x)) monitors.push_back(std::move(output.monitor));
    return monitors;
}

std::optional<Monitor> find_monitor(const std::vector<Monitor>& monitors, const std::string& id) {
    const auto found = std::find_if(
        monitors.begin(), monitors.end(), [&](const Monitor& m) { return m.id == id; });
    if (found == monitors.end()) return std::nullopt;
    return *found;
}

}  // namespace livery
