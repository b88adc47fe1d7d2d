#include "projection/monitors.h"

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <xcb/randr.h>

#include "core/hash.h"
#include "projection/outputs.h"

namespace livery {

namespace {

constexpr std::size_t kEdidBlock = 128;
constexpr std::uint8_t kDisplayName = 0xFC, kSerialNumber = 0xFF;

/// The text of a descriptor; empty where there is none of this kind with a letter in it.
std::string descriptor_text(const std::vector<std::uint8_t>& edid, std::uint8_t kind) {
    constexpr std::size_t kFirst = 54, kBytes = 18, kTextAt = 5;
    for (std::size_t at = kFirst; at + kBytes < kEdidBlock; at += kBytes) {
        if (edid[at] != 0 || edid[at + 1] != 0 || edid[at + 3] != kind) continue;
        std::string text;
        for (std::size_t i = at + kTextAt; i < at + kBytes && edid[i] != '\n'; ++i) {
            if (edid[i] >= 0x20 && edid[i] < 0x7F) text += static_cast<char>(edid[i]);
        }
        while (text.ends_with(' ')) text.pop_back();
        if (!text.empty()) return text;
    }
    return {};
}

/// Three letters of five bits each; empty where they are none.
std::string maker_of(const std::vector<std::uint8_t>& edid) {
    const unsigned packed = static_cast<unsigned>(edid[8]) << 8u | edid[9];
    std::string maker;
    for (const unsigned shift : {10u, 5u, 0u}) {
        const unsigned letter = packed >> shift & 31u;
        if (letter < 1 || letter > 26) return {};
        maker += static_cast<char>('A' + static_cast<int>(letter) - 1);
    }
    return maker;
}

/// A number from its bytes, the lowest first.
unsigned number_at(const std::vector<std::uint8_t>& edid, std::size_t at, unsigned bytes) {
    unsigned number = 0;
    for (unsigned i = 0; i < bytes; ++i) number |= static_cast<unsigned>(edid[at + i]) << 8u * i;
    return number;
}

std::string with_hash(const std::string& socket, const Hasher& hasher) {
    return socket + ":" + hasher.hex().substr(0, 16);
}

}  // namespace

DisplayIdentity identity_of_edid(const std::vector<std::uint8_t>& edid) {
    if (edid.size() < kEdidBlock) return {};
    DisplayIdentity identity{
        maker_of(edid), descriptor_text(edid, kDisplayName), descriptor_text(edid, kSerialNumber)};
    if (identity.product.empty())
        identity.product = fmt::format("0x{:04x}", number_at(edid, 10, 2));
    if (identity.serial.empty()) identity.serial = fmt::format("0x{:08x}", number_at(edid, 12, 4));
    return identity;
}

std::string display_name(const DisplayIdentity& identity) {
    return identity.product.starts_with("0x") ? identity.maker : identity.product;
}

std::string monitor_id(const std::string& socket, const DisplayIdentity& identity) {
    if (identity == DisplayIdentity()) return socket;
    Hasher hasher;
    hasher.add(identity.maker + "\n" + identity.product + "\n" + identity.serial);
    return with_hash(socket, hasher);
}

std::string former_monitor_id(const std::string& socket, const std::vector<std::uint8_t>& edid) {
    if (edid.empty()) return socket;
    Hasher hasher;
    hasher.add(std::span<const std::uint8_t>(edid));
    return with_hash(socket, hasher);
}

bool has_serial(const DisplayIdentity& identity) {
    for (const char* none : {"", "0", "0x00000000", "0x01010101", "0xffffffff"}) {
        if (identity.serial == none) return false;
    }
    return true;
}

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
