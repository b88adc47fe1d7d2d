// HTTP for the phone page: libmicrohttpd with limits, in one thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "ballot/ballot_guard.h"

namespace livery {

/// What one client, and all together, may use. A connection beyond them ends an older one, of the
/// same address or of the address that holds most.
struct HttpLimits {
    unsigned connections = 512;
    unsigned connections_an_address = 48;  ///< a whole room may sit behind one
    std::size_t connection_memory_bytes = 16 * 1024;
    double headers_s = 2.0;   ///< from connecting to the last header
    unsigned idle_s = 5;      ///< without a byte; also between two requests, headers included
    double request_s = 10.0;  ///< from the last header to the answer's last byte
};

struct HttpSettings {
    std::string address = "127.0.0.1";  ///< IPv4
    std::uint16_t port = 0;             ///< 0: one of the system's choice
    std::string certificate, key;       ///< PEM; both empty: plain HTTP
    HttpLimits limits;
};

/// Answers requests while run() runs. Limits that libmicrohttpd has (memory, connections, idle
/// time) are its own; deadlines, which a client that sends a byte now and then would outlive, are
/// kept here: whoever is late is cut off. Nothing is logged.
class HttpServer {
  public:
    using Answer = std::function<BallotResponse(const BallotRequest&)>;

    /// Listens. Throws std::runtime_error with what helps: port in use, address not of this
    /// machine, certificate and key that do not fit.
    HttpServer(const HttpSettings& settings, Answer answer);
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    std::uint16_t port() const;
    /// Until `stop` is true; `now_and_then` is called about four times a second.
    void run(const std::atomic<bool>& stop, const std::function<void()>& now_and_then);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
