// One request of a phone and its answer, as values: what decides knows no socket.
#pragma once

#include <optional>
#include <string>

namespace livery {

constexpr std::size_t kLongestBody = 1024;  ///< bytes of a request's body

/// Empty where the request has no such header.
struct BallotRequest {
    std::string method, path;
    std::string host, origin, fetch_site, purpose, content_type, cookies;
    std::string body;
    /// Tells clients apart, for the rate of wrong join codes; kept nowhere else.
    std::string client;
};

struct BallotResponse {
    int status = 200;
    std::string content_type = "application/json";
    std::string body;
    std::optional<std::string> cookie = {};    ///< Set-Cookie
    std::optional<std::string> location = {};  ///< of a redirect
    std::optional<std::string> allow = {};     ///< methods, where another was used
};

}  // namespace livery
