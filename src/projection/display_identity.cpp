#include "projection/display_identity.h"

#include <span>

#include <fmt/format.h>

#include "core/hash.h"

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

}  // namespace livery
