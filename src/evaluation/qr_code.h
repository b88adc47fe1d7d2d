// QR codes, as modules: for the panel, the projector and the terminal.
#pragma once

#include <string>
#include <vector>

namespace livery {

struct QrCode {
    int size = 0;                 ///< modules a side, the quiet zone not among them
    std::vector<bool> dark;       ///< row by row
    bool at(int x, int y) const;  ///< false outside: the quiet zone
};

constexpr int kQrQuietZone = 4;  ///< light modules that must stand around it (ISO/IEC 18004)

/// Of level M: 15% of it may be hidden. Throws std::invalid_argument for a text that is empty or
/// too long.
QrCode qr_code(const std::string& text);

/// Two rows of modules a line, with the quiet zone, light on dark: for dark terminals and light
/// ones alike, since its light modules are set as such.
std::string qr_text(const QrCode& code);

}  // namespace livery
