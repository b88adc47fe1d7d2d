// What a display says of itself, from its EDID or from a Wayland compositor that read it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace livery {

/// In the words of Mutter, GNOME's compositor, which reads the same EDID: X11 and Wayland then
/// agree on a display. All empty where there is no EDID.
struct DisplayIdentity {
    std::string maker;    ///< three letters: "EPS"
    std::string product;  ///< "EPSON PJ", or its code as "0x1a2b"
    std::string serial;   ///< "X4KF123", or its number as "0x00000001"
    bool operator==(const DisplayIdentity&) const = default;
};

/// Empty for less than a whole block.
DisplayIdentity identity_of_edid(const std::vector<std::uint8_t>& edid);

/// "EPSON PJ", else the maker's letters; empty for neither.
std::string display_name(const DisplayIdentity& identity);

/// What a monitor is remembered by: "HDMI-1:0123456789abcdef", or the socket alone where the
/// display says nothing.
std::string monitor_id(const std::string& socket, const DisplayIdentity& identity);

/// As version 0.1 wrote it: by every byte of the EDID.
std::string former_monitor_id(const std::string& socket, const std::vector<std::uint8_t>& edid);

/// Whether the serial number tells the display from others of its kind: makers who do not count
/// write 0 or 0x01010101.
bool has_serial(const DisplayIdentity& identity);

}  // namespace livery
