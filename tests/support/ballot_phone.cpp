#include "support/ballot_phone.h"

#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "support/loopback.h"

namespace livery::testing {

namespace {

constexpr const char* kHost = "http://127.0.0.1:";

/// All that a server sends until it hangs up.
std::string exchanged(int port, const std::string& request) {
    const int connection = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    std::string answer;
    const bool sent =
        ::connect(connection, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0 &&
        send_all(connection, request);
    char part[4096];
    for (ssize_t n = 0; sent && (n = ::recv(connection, part, sizeof(part), 0)) > 0;) {
        answer.append(part, static_cast<std::size_t>(n));
    }
    ::close(connection);
    return answer;
}

}  // namespace

BallotPhone::BallotPhone(const std::string& join_url) : port_(port_of(join_url)) {
    const std::size_t path = join_url.find("/join/");
    if (path == std::string::npos) throw std::runtime_error("no address to join at: " + join_url);
    const std::string head = ask("GET", join_url.substr(path)).head;
    const std::string before = "Set-Cookie: ";
    const std::size_t at = head.find(before);
    if (at == std::string::npos) return;
    const std::size_t from = at + before.size();
    cookie_ = head.substr(from, head.find(';', from) - from);
}

nlohmann::json BallotPhone::state() { return nlohmann::json::parse(ask("GET", "/state").body); }

int BallotPhone::vote(int round, int best, int second) {
    const nlohmann::json ballot = {{"round", round}, {"best", best}, {"second", second}};
    return ask("PUT", "/ballot", ballot.dump()).status;
}

int BallotPhone::rate(int round, int look, const std::vector<std::optional<int>>& steps) {
    nlohmann::json answer = {{"round", round}, {"look", look}, {"steps", nlohmann::json::array()}};
    for (const auto& step : steps) {
        answer["steps"].push_back(step ? nlohmann::json(*step) : nlohmann::json());
    }
    return ask("PUT", "/scales", answer.dump()).status;
}

int BallotPhone::port_of(const std::string& url) {
    if (!url.starts_with(kHost)) throw std::runtime_error("no address on loopback: " + url);
    return std::stoi(url.substr(std::string(kHost).size()));
}

BallotPhone::Answer BallotPhone::ask(const std::string& method,
                                     const std::string& path,
                                     const std::string& body) {
    const std::string port = std::to_string(port_);
    std::string request =
        method + " " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + port + "\r\nConnection: close\r\n";
    if (!cookie_.empty()) request += "Cookie: " + cookie_ + "\r\n";
    if (!body.empty()) {
        request +=
            "Origin: " + (kHost + port) +
            "\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
            "\r\n";
    }
    const std::string text = exchanged(port_, request + "\r\n" + body);
    const std::size_t end = text.find("\r\n\r\n");
    if (!text.starts_with("HTTP/1.1 ") || end == std::string::npos) {
        throw std::runtime_error("port " + port + " does not answer " + method + " " + path);
    }
    return {std::stoi(text.substr(9)), text.substr(0, end), text.substr(end + 4)};
}

}  // namespace livery::testing
