#include "ballot/ballot_guard.h"

#include <algorithm>

namespace livery {

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

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

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

}  // namespace livery
