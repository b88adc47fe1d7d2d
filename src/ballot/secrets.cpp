#include "ballot/secrets.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <stdexcept>

#include <gnutls/crypto.h>
#include <gnutls/gnutls.h>
#include <sys/random.h>

namespace livery {

namespace {

constexpr std::string_view kCharacters = "23456789BCDFGHJKMNPQRSTVWXZ";
constexpr std::size_t kCodeLength = 8;

template <std::size_t Count>
std::array<std::uint8_t, Count> random_bytes() {
    std::array<std::uint8_t, Count> bytes{};
    ssize_t got = 0;
    do {
        got = ::getrandom(bytes.data(), bytes.size(), 0);
    } while (got < 0 && errno == EINTR);
    if (got != static_cast<ssize_t>(bytes.size())) {
        throw std::runtime_error("found no random numbers, expected some of the system");
    }
    return bytes;
}

template <typename Bytes>
std::string hexadecimal(const Bytes& bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (const std::uint8_t byte : bytes) {
        text += digits[byte >> 4u];
        text += digits[byte & 15u];
    }
    return text;
}

}  // namespace

std::string random_secret() { return hexadecimal(random_bytes<16>()); }

std::string random_join_code() {
    std::string code;
    // Bytes beyond the last whole multiple would make some characters likelier.
    const std::size_t most = 256 - 256 % kCharacters.size();
    while (code.size() < kCodeLength) {
        for (const std::uint8_t byte : random_bytes<16>()) {
            if (byte < most && code.size() < kCodeLength) {
                code += kCharacters[byte % kCharacters.size()];
            }
        }
    }
    return code;
}

std::string tidy_join_code(std::string_view typed) {
    std::string code;
    for (const char c : typed) {
        if (c == ' ' || c == '-') continue;
        code += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
    return code;
}

std::string hash_of_secret(std::string_view secret) {
    std::array<std::uint8_t, 32> digest{};
    if (gnutls_hash_fast(GNUTLS_DIG_SHA256, secret.data(), secret.size(), digest.data()) < 0) {
        throw std::runtime_error("found no SHA-256 in GnuTLS, expected one");
    }
    return hexadecimal(digest);
}

}  // namespace livery
