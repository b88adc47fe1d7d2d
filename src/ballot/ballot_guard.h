// Who may ask: names of the server, origins, cookies.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ballot/ballot_http.h"

namespace livery {

/// Where the server is, as browsers name it.
struct ServerNames {
    bool tls = false;
    std::vector<std::string> hosts;  ///< "192.168.0.7:8470", lower case
};

/// Whether the request's Host is one of the server's own: a page of somebody else's whose name is
/// made to point here (DNS rebinding) has another.
bool host_is_ours(const BallotRequest& request, const ServerNames& names);

/// Whether a page of this server asks: Origin must be there and be this server, and Sec-Fetch-Site,
/// where a browser sends it, "same-origin".
bool origin_is_ours(const BallotRequest& request, const ServerNames& names);

/// The seat's secret in a Cookie header: 32 lower-case hexadecimal digits. Nothing when there is
/// none, another shape, or more than one.
std::optional<std::string> seat_secret(std::string_view cookies);

/// Set-Cookie for it: for this server alone, out of reach of scripts, for twelve hours.
std::string seat_cookie(const std::string& secret, bool tls);

/// In a time that says nothing about where they differ.
bool same_secret(std::string_view given, std::string_view expected);

}  // namespace livery
