// Where the phone page is served: said by the server, read by the program that started it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace livery {

constexpr int kBallotPort = 8470;

struct BallotServerPlace {
    std::string address;  ///< IPv4
    std::uint16_t port = 0;
    bool tls = false;
    std::string interface;                ///< "lo": this machine alone
    std::vector<std::string> hosts = {};  ///< further names; the first is the one that is shown
};

/// One line of JSON, and back. Throws FileError for anything else.
std::string text_of(const BallotServerPlace& place);
BallotServerPlace parse_ballot_place(const std::string& line);

/// "http://192.168.0.7:8470/", by the first further name where there is one.
std::string url_of(const BallotServerPlace& place);
/// What the QR code holds.
std::string join_url(const BallotServerPlace& place, const std::string& token);

/// Where it listens, and who can see votes on their way. Lines for people.
std::string words_for(const BallotServerPlace& place);

}  // namespace livery
