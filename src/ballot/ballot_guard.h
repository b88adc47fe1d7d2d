// One request of a phone and its answer, as values; who may ask (names of the server, origins,
// cookies, secrets), how often a seat may change what it said, and what the process may use that
// faces the network, whatever it is told to do.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// 128 bits from the system, as 32 hexadecimal digits. Throws std::runtime_error without any.
std::string random_secret();

/// Eight characters to be read aloud and typed: digits and capitals without those that look or
/// sound alike, and without vowels, so that no word comes of them. Of 27^8 = 2.8e11 codes, each
/// good for eleven minutes, 10,000 guesses a second find one within two hours with a probability of
/// 3e-4, so wrong codes need not lock anybody out.
std::string random_join_code();

/// What somebody typed, as random_join_code() writes it: capitals, no spaces nor hyphens.
std::string tidy_join_code(std::string_view typed);

/// SHA-256, as 64 hexadecimal digits. What is kept of a phone's secret.
std::string hash_of_secret(std::string_view secret);

/// A token bucket for each seat: sixty changes at once, then thirty a minute. Each change is an
/// entry in the ballots' log for good; a person makes fewer.
class ChangeLimit {
  public:
    bool allowed(int seat, double now_s) const;
    void changed(int seat, double now_s);

  private:
    struct Bucket {
        double left = 0.0, at_s = 0.0;
    };
    Bucket bucket_of(int seat, double now_s) const;
    std::map<int, Bucket> buckets_;
};

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

/// Limits on data (64 MB), open files, and the size of files; no core file, no child process, no
/// new rights. They hold until the end of the process. Throws std::runtime_error.
void limit_this_process();

/// Ends this process with the one that started it. Throws std::runtime_error.
void end_with_parent();

}  // namespace livery
