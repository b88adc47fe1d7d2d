#include "projection/monitors.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include <xcb/randr.h>

#include "projection/outputs.h"
#include "projection/x_connection.h"

namespace livery {

namespace {

bool belongs_to_wayland(const XConnection& x) {
    constexpr std::string_view kName = "XWAYLAND";
    const XReply<xcb_query_extension_reply_t> extension(xcb_query_extension_reply(
        x.get(), xcb_query_extension(x.get(), kName.size(), kName.data()), nullptr));
    if (extension && extension->present != 0) return true;
    // Before version 23.1 only the names of its outputs tell.
    const XReply<xcb_randr_get_screen_resources_current_reply_t> resources(
        xcb_randr_get_screen_resources_current_reply(
            x.get(), xcb_randr_get_screen_resources_current(x.get(), x.root()), nullptr));
    if (!resources) return false;
    const auto* ids = xcb_randr_get_screen_resources_current_outputs(resources.get());
    for (int i = 0; i < resources->num_outputs; ++i) {
        const XReply<xcb_randr_get_output_info_reply_t> info(xcb_randr_get_output_info_reply(
            x.get(),
            xcb_randr_get_output_info(x.get(), ids[i], resources->config_timestamp),
            nullptr));
        if (!info) continue;
        const std::string_view name(
            reinterpret_cast<const char*>(xcb_randr_get_output_info_name(info.get())),
            info->name_len);
        if (name.starts_with(kName)) return true;
    }
    return false;
}

}  // namespace

bool is_xwayland() {
    try {
        return belongs_to_wayland(XConnection());
    } catch (const std::runtime_error&) {
        return false;
    }
}

std::vector<Monitor> list_monitors(DesktopWatch* desktop) {
    const XConnection x;
    std::vector<Monitor> monitors;
    for (auto& output : read_outputs(x, desktop)) monitors.push_back(std::move(output.monitor));
    return monitors;
}

std::optional<Monitor> find_monitor(const std::vector<Monitor>& monitors, const std::string& id) {
    const auto found = std::find_if(
        monitors.begin(), monitors.end(), [&](const Monitor& m) { return m.id == id; });
    if (found == monitors.end()) return std::nullopt;
    return *found;
}

std::optional<Monitor> find_remembered_monitor(const std::vector<Monitor>& monitors,
                                               const std::string& id) {
    if (auto found = find_monitor(monitors, id)) return found;
    const auto hash_of = [](const std::string& of) {
        const auto colon = of.rfind(':');
        return colon == std::string::npos ? std::string() : of.substr(colon);
    };
    const Monitor* elsewhere = nullptr;
    int count = 0;
    for (const Monitor& monitor : monitors) {
        if (!id.empty() && monitor.former_id == id) return monitor;
        if (hash_of(monitor.id).empty() || hash_of(monitor.id) != hash_of(id)) continue;
        elsewhere = &monitor;
        ++count;
    }
    if (count != 1 || !has_serial(elsewhere->identity)) return std::nullopt;
    return *elsewhere;
}

}  // namespace livery
