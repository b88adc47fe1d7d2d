#include "projection/mutter.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <string_view>

#include <dbus/dbus.h>
#include <fmt/format.h>
#include <glm/common.hpp>

namespace livery {

namespace {

constexpr const char* kSignature = "ua((ssss)a(siiddada{sv})a{sv})a(iiduba(ssss)a{sv})a{sv}";
constexpr int kLargest_px = 1 << 16;

/// Values one after the other. The signature of the whole was compared before: each is there and
/// has its type.
class Fields {
  public:
    explicit Fields(DBusMessage& message) { dbus_message_iter_init(&message, &at_); }

    std::string text() {
        const char* value = "";
        dbus_message_iter_get_basic(&at_, &value);
        dbus_message_iter_next(&at_);
        return value;
    }
    int integer() { return basic<dbus_int32_t>(); }
    std::uint32_t count() { return basic<dbus_uint32_t>(); }
    double number() { return basic<double>(); }
    void skip() { dbus_message_iter_next(&at_); }

    /// What is in an array, a structure or a variant; the next field is the one behind it.
    Fields inside() {
        Fields content;
        dbus_message_iter_recurse(&at_, &content.at_);
        dbus_message_iter_next(&at_);
        return content;
    }
    bool at_end() { return type() == DBUS_TYPE_INVALID; }
    int type() { return dbus_message_iter_get_arg_type(&at_); }

  private:
    Fields() = default;

    template <typename T>
    T basic() {
        T value{};
        dbus_message_iter_get_basic(&at_, &value);
        dbus_message_iter_next(&at_);
        return value;
    }

    DBusMessageIter at_{};
};

/// Calls `take(name, value)` with each property; the value's type is the caller's to check.
template <typename Take>
void for_each_property(Fields properties, const Take& take) {
    while (!properties.at_end()) {
        Fields entry = properties.inside();
        const std::string name = entry.text();
        take(name, entry.inside());
    }
}

bool is_true(Fields& value) {
    if (value.type() != DBUS_TYPE_BOOLEAN) return false;
    return value.count() != 0;  // a boolean has the size of a uint32
}

/// Mutter's words for a field that the EDID lacks.
std::string said(std::string text) {
    while (text.ends_with(' ')) text.pop_back();
    return text == "unknown" ? std::string() : text;
}

glm::ivec2 checked_size(glm::ivec2 size_px, const std::string& connector) {
    if (size_px.x > 0 && size_px.y > 0 && size_px.x < kLargest_px && size_px.y < kLargest_px) {
        return size_px;
    }
    throw std::runtime_error(fmt::format("a mode of {}: found {}x{}, expected 1 to {} pixels each",
                                         connector,
                                         size_px.x,
                                         size_px.y,
                                         kLargest_px - 1));
}

void read_modes(Fields modes, MutterMonitor& monitor) {
    while (!modes.at_end()) {
        Fields mode = modes.inside();
        mode.skip();  // its id
        const int width = mode.integer(), height = mode.integer();
        const double refresh_hz = mode.number();
        mode.skip();  // the scale that Mutter would choose
        mode.skip();  // the scales that it offers
        bool is_current = false, is_preferred = false;
        for_each_property(mode.inside(), [&](std::string_view name, Fields value) {
            if (name == "is-current") is_current = is_true(value);
            if (name == "is-preferred") is_preferred = is_true(value);
        });
        if (is_current) {
            monitor.mode_px = checked_size({width, height}, monitor.connector);
            monitor.refresh_hz = std::isfinite(refresh_hz) ? std::max(refresh_hz, 0.0) : 0.0;
        }
        if (is_preferred) monitor.preferred_px = checked_size({width, height}, monitor.connector);
    }
}

MutterMonitor read_monitor(Fields fields) {
    MutterMonitor monitor;
    Fields names = fields.inside();
    monitor.connector = names.text();
    monitor.identity.maker = said(names.text());
    monitor.identity.product = said(names.text());
    monitor.identity.serial = said(names.text());
    read_modes(fields.inside(), monitor);
    for_each_property(fields.inside(), [&](std::string_view name, Fields value) {
        if (name == "color-mode" && value.type() == DBUS_TYPE_UINT32) {
            monitor.colour_mode = value.count();
        }
    });
    return monitor;
}

MutterLogicalMonitor read_logical_monitor(Fields fields, const MutterState& state) {
    MutterLogicalMonitor logical;
    logical.x = fields.integer();
    logical.y = fields.integer();
    logical.scale = fields.number();
    const std::uint32_t transform = fields.count();
    fields.skip();  // whether it is the primary one
    Fields monitors = fields.inside();
    while (!monitors.at_end()) {
        logical.connectors.push_back(monitors.inside().text());
        if (!state.find(logical.connectors.back())) {
            throw std::runtime_error(fmt::format(
                "a logical monitor: found \"{}\", expected one of the monitors' connectors",
                logical.connectors.back()));
        }
    }
    if (!(logical.scale > 0.0) || !std::isfinite(logical.scale)) {
        throw std::runtime_error(
            fmt::format("scale: found {}, expected a number over 0", logical.scale));
    }
    if (transform > 7) {
        throw std::runtime_error(fmt::format("transform: found {}, expected 0 to 7", transform));
    }
    logical.transform = static_cast<int>(transform);
    return logical;
}

}  // namespace

const MutterMonitor* MutterState::find(const std::string& connector) const {
    const auto found = std::find_if(monitors.begin(), monitors.end(), [&](const MutterMonitor& m) {
        return m.connector == connector;
    });
    return found == monitors.end() ? nullptr : &*found;
}

MutterState read_mutter_state(DBusMessage& answer) {
    if (!dbus_message_has_signature(&answer, kSignature)) {
        throw std::runtime_error(fmt::format("found the types \"{}\", expected \"{}\"",
                                             dbus_message_get_signature(&answer),
                                             kSignature));
    }
    MutterState state;
    Fields fields(answer);
    fields.skip();  // the configuration's serial number
    Fields monitors = fields.inside();
    while (!monitors.at_end()) state.monitors.push_back(read_monitor(monitors.inside()));
    Fields logical = fields.inside();
    while (!logical.at_end()) {
        state.logical_monitors.push_back(read_logical_monitor(logical.inside(), state));
    }
    for_each_property(fields.inside(), [&](std::string_view name, Fields value) {
        constexpr std::uint32_t kPhysical = 2;
        if (name == "layout-mode" && value.type() == DBUS_TYPE_UINT32) {
            state.physical_layout = value.count() == kPhysical;
        }
    });
    return state;
}

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
