#include "ballot/ballot_guard.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include <gnutls/crypto.h>
#include <gnutls/gnutls.h>
#include <sys/prctl.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <unistd.h>

#include "core/utf8.h"

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

namespace {

constexpr double kAtOnce = 60.0;
constexpr double kRefill_per_s = 30.0 / 60.0;

}  // namespace

ChangeLimit::Bucket ChangeLimit::bucket_of(int seat, double now_s) const {
    const auto found = buckets_.find(seat);
    if (found == buckets_.end()) return {kAtOnce, now_s};
    // A clock that is set back gives nothing, and goes on from there.
    const double since_s = std::max(0.0, now_s - found->second.at_s);
    return {std::min(kAtOnce, found->second.left + since_s * kRefill_per_s), now_s};
}

bool ChangeLimit::allowed(int seat, double now_s) const {
    return bucket_of(seat, now_s).left >= 1.0;
}

void ChangeLimit::changed(int seat, double now_s) {
    Bucket bucket = bucket_of(seat, now_s);
    bucket.left -= 1.0;
    buckets_[seat] = bucket;
}

namespace {

constexpr std::string_view kCookieName = "livery-seat";
constexpr std::size_t kSecretDigits = 32;

std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return lower;
}

bool is_digit(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); }

}  // namespace

bool host_is_ours(const BallotRequest& request, const ServerNames& names) {
    const std::string host = lower_case(request.host);
    return std::find(names.hosts.begin(), names.hosts.end(), host) != names.hosts.end();
}

bool origin_is_ours(const BallotRequest& request, const ServerNames& names) {
    if (!request.fetch_site.empty() && request.fetch_site != "same-origin") return false;
    const std::string scheme = names.tls ? "https://" : "http://";
    return lower_case(request.origin) == scheme + lower_case(request.host);
}

std::optional<std::string> seat_secret(std::string_view cookies) {
    std::optional<std::string> secret;
    while (!cookies.empty()) {
        const std::size_t end = std::min(cookies.find(';'), cookies.size());
        const std::string_view pair = trimmed(cookies.substr(0, end));
        cookies.remove_prefix(std::min(end + 1, cookies.size()));
        const std::size_t equals = pair.find('=');
        if (equals == std::string_view::npos || trimmed(pair.substr(0, equals)) != kCookieName) {
            continue;
        }
        const std::string_view value = trimmed(pair.substr(equals + 1));
        if (secret || value.size() != kSecretDigits ||
            !std::all_of(value.begin(), value.end(), is_digit)) {
            return std::nullopt;
        }
        secret = value;
    }
    return secret;
}

std::string seat_cookie(const std::string& secret, bool tls) {
    return std::string(kCookieName) + "=" + secret +
           "; Path=/; Max-Age=43200; HttpOnly; SameSite=Strict" + (tls ? "; Secure" : "");
}

bool same_secret(std::string_view given, std::string_view expected) {
    if (given.size() != expected.size()) return false;
    unsigned different = 0;
    for (std::size_t k = 0; k < given.size(); ++k) {
        different |= static_cast<unsigned>(given[k]) ^ static_cast<unsigned>(expected[k]);
    }
    return different == 0;
}

namespace {

constexpr rlim_t kData_bytes = 64u << 20u;
constexpr rlim_t kFile_bytes = 256u << 20u;
constexpr rlim_t kFiles = 640;  ///< 576 connections, the database's, and some

#if defined(LIVERY_SANITIZED)
constexpr bool kSanitized = true;  // whose shadow is larger than any limit
#else
constexpr bool kSanitized = false;
#endif

void set_limit(int resource, rlim_t most, const char* what) {
    rlimit limit{};
    ::getrlimit(static_cast<__rlimit_resource>(resource), &limit);
    if (limit.rlim_max != RLIM_INFINITY && limit.rlim_max < most) most = limit.rlim_max;
    limit = {most, most};
    if (::setrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0) {
        throw std::runtime_error(std::string("cannot limit ") + what + " (" + std::strerror(errno) +
                                 ")");
    }
}

}  // namespace

void limit_this_process() {
    // A file that may grow no further is an error, not the end.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    if (!kSanitized) set_limit(RLIMIT_DATA, kData_bytes, "memory");
    set_limit(RLIMIT_FSIZE, kFile_bytes, "files");
    set_limit(RLIMIT_NOFILE, kFiles, "open files");
    set_limit(RLIMIT_CORE, 0, "core files");
    set_limit(RLIMIT_NPROC, 0, "processes");
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
        throw std::runtime_error("cannot give up new rights");
    }
}

void end_with_parent() {
    const pid_t parent = ::getppid();
    if (::prctl(PR_SET_PDEATHSIG, SIGTERM) != 0) {
        throw std::runtime_error("cannot watch the parent process");
    }
    if (::getppid() != parent) ::raise(SIGTERM);
}

}  // namespace livery
