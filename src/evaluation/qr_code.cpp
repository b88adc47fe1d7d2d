#include "evaluation/qr_code.h"

#include <memory>

#include <qrencode.h>

#include "core/error.h"

namespace livery {

bool QrCode::at(int x, int y) const {
    return x >= 0 && y >= 0 && x < size && y < size &&
           dark[static_cast<std::size_t>(y) * static_cast<std::size_t>(size) +
                static_cast<std::size_t>(x)];
}

QrCode qr_code(const std::string& text) {
    const std::unique_ptr<QRcode, void (*)(QRcode*)> made(
        QRcode_encodeString(text.c_str(), 0, QR_ECLEVEL_M, QR_MODE_8, 1), &QRcode_free);
    check_argument(
        made != nullptr,
        "qr_code: found " + std::to_string(text.size()) + " bytes, expected 1 to about 2300");
    QrCode code;
    code.size = made->width;
    const std::size_t modules =
        static_cast<std::size_t>(code.size) * static_cast<std::size_t>(code.size);
    for (std::size_t k = 0; k < modules; ++k) code.dark.push_back((made->data[k] & 1u) != 0);
    return code;
}

std::string qr_text(const QrCode& code) {
    std::string text;
    for (int y = -kQrQuietZone; y < code.size + kQrQuietZone; y += 2) {
        // Black on white, whatever the terminal's colours.
        text += "\x1b[30;107m";
        for (int x = -kQrQuietZone; x < code.size + kQrQuietZone; ++x) {
            const bool upper = code.at(x, y), lower = code.at(x, y + 1);
            text += upper && lower ? "█" : upper ? "▀" : lower ? "▄" : " ";
        }
        text += "\x1b[0m\n";
    }
    return text;
}

}  // namespace livery
