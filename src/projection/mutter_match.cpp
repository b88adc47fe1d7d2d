#include "projection/mutter_match.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include <glm/common.hpp>

namespace livery {
namespace {

/// A monitor that shows a part of the desktop.
struct Lit {
    const MutterMonitor* monitor = nullptr;
    const MutterLogicalMonitor* logical = nullptr;
    glm::ivec2 size{0};  ///< of its part, in the desktop's units
};

std::vector<Lit> lit_monitors(const MutterState& state) {
    std::vector<Lit> list;
    for (const MutterLogicalMonitor& logical : state.logical_monitors) {
        for (const std::string& connector : logical.connectors) {
            const MutterMonitor& monitor = *state.find(connector);
            glm::dvec2 size = monitor.mode_px;
            if (logical.transform % 2 != 0) std::swap(size.x, size.y);
            if (!state.physical_layout) size /= logical.scale;
            list.push_back({&monitor, &logical, glm::ivec2(glm::round(size))});
        }
    }
    return list;
}

bool has_place(const Output& output, const Lit& lit) {
    const Monitor& m = output.monitor;
    const auto near = [](int a, int b) { return std::abs(a - b) <= 1; };  // sizes are rounded
    return near(m.x, lit.logical->x) && near(m.y, lit.logical->y) && near(m.width, lit.size.x) &&
           near(m.height, lit.size.y);
}

void tell(Output& output, const Lit& lit) {
    const int transform = lit.logical->transform;
    name_output(output, lit.monitor->connector, lit.monitor->identity);
    output.monitor.mode_px = lit.monitor->mode_px;
    output.monitor.refresh_hz = lit.monitor->refresh_hz;
    output.monitor.wayland = WaylandOutput{lit.logical->scale, transform, lit.monitor->colour_mode};
    output.preferred_px = lit.monitor->preferred_px;
    output.turned = transform % 2 != 0;
}

}  // namespace

void name_outputs_after(const MutterState& state,
                        std::vector<Output>& outputs,
                        KnownConnectors& known) {
    const std::vector<Lit> lit = lit_monitors(state);
    std::set<std::string> taken;
    std::vector<Output*> open;
    const auto take = [&](Output& output, const Lit& found) {
        taken.insert(found.monitor->connector);
        tell(output, found);
    };
    const auto find = [&](const std::string& connector) {
        return std::find_if(lit.begin(), lit.end(), [&](const Lit& each) {
            return each.monitor->connector == connector;
        });
    };
    for (Output& output : outputs) {
        const auto before = known.find(output.output);
        auto found = find(output.socket);
        if (found == lit.end() && before != known.end()) found = find(before->second);
        if (found == lit.end()) {
            known.erase(output.output);
            open.push_back(&output);
        } else {
            take(output, *found);
        }
    }
    std::sort(open.begin(), open.end(), [](const Output* a, const Output* b) {
        return a->output < b->output;
    });
    while (!open.empty()) {
        // All that lie where the first one does, and the monitors that do.
        const Monitor place = open.front()->monitor;
        const auto same = std::stable_partition(open.begin(), open.end(), [&](const Output* each) {
            const Monitor& m = each->monitor;
            return m.x != place.x || m.y != place.y || m.width != place.width ||
                   m.height != place.height;
        });
        const std::vector<Output*> there(same, open.end());
        open.erase(same, open.end());
        std::vector<Lit> candidates;
        for (const Lit& each : lit) {
            if (taken.contains(each.monitor->connector)) continue;
            if (has_place(*there.front(), each)) candidates.push_back(each);
        }
        if (candidates.size() != there.size()) continue;
        for (std::size_t i = 0; i < there.size(); ++i) {
            if (there.size() == 1) known[there[i]->output] = candidates[i].monitor->connector;
            take(*there[i], candidates[i]);
        }
    }
}

}  // namespace livery
