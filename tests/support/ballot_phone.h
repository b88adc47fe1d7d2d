// An evaluator's phone without a screen: a cookie, and requests as the page sends them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace livery::testing {

class BallotPhone {
  public:
    /// By the QR code's address, http://127.0.0.1:PORT/join/TOKEN. Throws std::runtime_error when
    /// nobody answers.
    explicit BallotPhone(const std::string& join_url);

    bool has_seat() const { return !cookie_.empty(); }
    int seat() { return state()["seat"]; }
    /// As docs/voting.md has it.
    nlohmann::json state();
    /// The status of the answer: 200 where the ballot is kept.
    int vote(int round, int best, int second);
    /// The same for a look's steps on the round's scales; nothing: left open, or taken back.
    int rate(int round, int look, const std::vector<std::optional<int>>& steps);
    /// The server has come back elsewhere; the seat is the same.
    void move_to(const std::string& url) { port_ = port_of(url); }

  private:
    struct Answer {
        int status = 0;
        std::string head, body;
    };
    static int port_of(const std::string& url);
    Answer ask(const std::string& method, const std::string& path, const std::string& body = "");

    int port_ = 0;
    std::string cookie_;
};

}  // namespace livery::testing
