#include "ballot/http_server.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <list>
#include <map>
#include <stdexcept>
#include <string_view>

#include <arpa/inet.h>
#include <microhttpd.h>
#include <sys/socket.h>
#include <unistd.h>

namespace livery {

namespace {

using Clock = std::chrono::steady_clock;
constexpr int kWait_ms = 250;

Clock::time_point in(double seconds) {
    return Clock::now() +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

/// An open connection, from libmicrohttpd's notice that it has begun to that of its end.
struct OpenConnection {
    int socket = -1;
    std::string client;
    Clock::time_point deadline;
    bool asks = false;  ///< between its headers and its answer
    bool cut_off = false;
    std::list<OpenConnection>::iterator place;
};

/// A request on its way.
struct Exchange {
    BallotRequest request;
};

std::string header(MHD_Connection* connection, const char* name) {
    const char* value = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
    return value ? value : "";
}

/// A socket that listens at an address. Ours, since not every version of libmicrohttpd leaves errno
/// as the reason why it could not listen.
int listening_socket(const HttpSettings& settings) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(settings.port);
    if (::inet_pton(AF_INET, settings.address.c_str(), &address.sin_addr) != 1) {
        throw std::runtime_error("found address " + settings.address + ", expected an IPv4 one");
    }
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    // A port that connections of an ended server still hold is free to use.
    const int reuse = 1;
    if (socket >= 0 && ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof reuse) == 0 &&
        ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
        ::listen(socket, SOMAXCONN) == 0) {
        return socket;
    }
    const int reason = errno;
    if (socket >= 0) ::close(socket);
    const std::string place = settings.address + ":" + std::to_string(settings.port);
    throw std::runtime_error(
        reason == EADDRINUSE
            ? "found " + place + " in use, expected a free port; choose another with --port"
            : "cannot listen on " + place + " (" + std::strerror(reason) + ")");
}

OpenConnection* open_connection(MHD_Connection* connection) {
    const auto* info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    return info ? static_cast<OpenConnection*>(info->socket_context) : nullptr;
}

std::string client_of(MHD_Connection* connection) {
    const auto* info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
    if (!info || !info->client_addr || info->client_addr->sa_family != AF_INET) return "";
    const auto* address = reinterpret_cast<const sockaddr_in*>(info->client_addr);
    return std::to_string(address->sin_addr.s_addr);
}

BallotRequest request_of(MHD_Connection* connection, const char* path, const char* method) {
    BallotRequest request;
    request.method = method;
    request.path = path;
    request.host = header(connection, "Host");
    request.origin = header(connection, "Origin");
    request.fetch_site = header(connection, "Sec-Fetch-Site");
    request.purpose = header(connection, "Sec-Purpose") + header(connection, "Purpose");
    request.content_type = header(connection, "Content-Type");
    request.cookies = header(connection, "Cookie");
    request.client = client_of(connection);
    return request;
}

/// What is wrong with a body before any of it is read; 0: nothing.
int refused_body(MHD_Connection* connection) {
    if (!header(connection, "Transfer-Encoding").empty()) return 411;
    const std::string length = header(connection, "Content-Length");
    if (length.empty()) return 0;
    if (length.size() > 9 || length.find_first_not_of("0123456789") != std::string::npos) {
        return 413;
    }
    return std::stoul(length) > kLongestBody ? 413 : 0;
}

MHD_Result send(MHD_Connection* connection, const BallotResponse& answer) {
    MHD_Response* response =
        MHD_create_response_from_buffer(answer.body.size(),
                                        const_cast<char*>(answer.body.data()),  // copied
                                        MHD_RESPMEM_MUST_COPY);
    if (!response) return MHD_NO;
    const auto add = [&](const char* name, const std::string& value) {
        MHD_add_response_header(response, name, value.c_str());
    };
    add("Content-Type", answer.content_type);
    add("Content-Security-Policy",
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
    add("Cache-Control", "no-store");
    add("Referrer-Policy", "no-referrer");
    add("X-Content-Type-Options", "nosniff");
    add("X-Frame-Options", "DENY");
    add("Cross-Origin-Resource-Policy", "same-origin");
    if (answer.cookie) add("Set-Cookie", *answer.cookie);
    if (answer.location) add("Location", *answer.location);
    if (answer.allow) add("Allow", *answer.allow);
    const MHD_Result queued =
        MHD_queue_response(connection, static_cast<unsigned>(answer.status), response);
    MHD_destroy_response(response);
    return queued;
}

BallotResponse refusal(int status) {
    BallotResponse response;
    response.status = status;
    response.body = R"({"problem":"found a body that is too long, or without a length"})";
    return response;
}

}  // namespace

struct HttpServer::State {
    HttpSettings settings;
    Answer answer;
    std::list<OpenConnection> connections;
    MHD_Daemon* daemon = nullptr;
    std::uint16_t port = 0;

    ~State() {
        if (daemon) MHD_stop_daemon(daemon);
    }

    static void on_connection(void* self,
                              MHD_Connection* connection,
                              void** context,
                              MHD_ConnectionNotificationCode code) {
        State& state = *static_cast<State*>(self);
        if (code == MHD_CONNECTION_NOTIFY_CLOSED) {
            if (auto* open = static_cast<OpenConnection*>(*context)) {
                state.connections.erase(open->place);
            }
            *context = nullptr;
            return;
        }
        const auto* info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
        const std::string client = client_of(connection);
        state.make_room_for(client);
        OpenConnection& open = state.connections.emplace_back();
        open.place = std::prev(state.connections.end());
        open.socket = info ? info->connect_fd : -1;
        open.client = client;
        open.deadline = in(state.settings.limits.headers_s);
        *context = &open;
    }

    static void on_completed(void* self,
                             MHD_Connection* connection,
                             void** context,
                             MHD_RequestTerminationCode) {
        delete static_cast<Exchange*>(*context);
        *context = nullptr;
        // The next request, headers and all.
        if (auto* open = open_connection(connection)) {
            open->deadline = in(static_cast<State*>(self)->settings.limits.idle_s);
            open->asks = false;
        }
    }

    static MHD_Result on_request(void* self,
                                 MHD_Connection* connection,
                                 const char* path,
                                 const char* method,
                                 const char* /*version*/,
                                 const char* data,
                                 std::size_t* data_size,
                                 void** context) {
        State& state = *static_cast<State*>(self);
        auto* exchange = static_cast<Exchange*>(*context);
        try {
            if (!exchange) {
                // Its headers are there.
                if (auto* open = open_connection(connection)) {
                    open->deadline = in(state.settings.limits.request_s);
                    open->asks = true;
                }
                exchange = new Exchange{request_of(connection, path, method)};
                *context = exchange;
                // Answered now, the body is not read at all and the connection ends.
                const int refused = refused_body(connection);
                return refused != 0 ? send(connection, refusal(refused)) : MHD_YES;
            }
            if (*data_size > 0) {
                if (exchange->request.body.size() + *data_size > kLongestBody) return MHD_NO;
                exchange->request.body.append(data, *data_size);
                *data_size = 0;
                return MHD_YES;
            }
            return send(connection, state.answer(exchange->request));
        } catch (const std::exception&) {
            return MHD_NO;  // ends the connection
        }
    }

    void cut_off_the_late() {
        const auto now = Clock::now();
        for (OpenConnection& open : connections) {
            if (now >= open.deadline) cut_off(open);
        }
    }

    static void cut_off(OpenConnection& open) {
        if (open.cut_off || open.socket < 0) return;
        // libmicrohttpd sees its end and closes it.
        ::shutdown(open.socket, SHUT_RDWR);
        open.cut_off = true;
    }

    /// Who comes is let in: where an address, or all together, would hold too many connections, an
    /// old one ends. Idle ones first, so that nobody's request is lost to those who only wait.
    void make_room_for(const std::string& client) {
        std::map<std::string, unsigned> held;
        unsigned all = 0;
        for (const OpenConnection& open : connections) {
            if (open.cut_off) continue;
            ++held[open.client];
            ++all;
        }
        std::string from = client;
        if (held[client] < settings.limits.connections_an_address) {
            if (all < settings.limits.connections) return;
            from = std::max_element(held.begin(), held.end(), [](const auto& a, const auto& b) {
                       return a.second < b.second;
                   })->first;
        }
        OpenConnection* oldest = nullptr;
        for (OpenConnection& open : connections) {
            if (open.cut_off || open.client != from) continue;
            if (!oldest || (oldest->asks && !open.asks)) oldest = &open;
        }
        if (oldest) cut_off(*oldest);
    }
};

HttpServer::HttpServer(const HttpSettings& settings, Answer answer)
    : state_(std::make_unique<State>()) {
    state_->settings = settings;
    state_->answer = std::move(answer);
    const HttpLimits& limits = settings.limits;
    const bool tls = !settings.certificate.empty();
    const MHD_OptionItem certificates[] = {
        {MHD_OPTION_HTTPS_MEM_CERT, 0, const_cast<char*>(settings.certificate.c_str())},
        {MHD_OPTION_HTTPS_MEM_KEY, 0, const_cast<char*>(settings.key.c_str())},
        {MHD_OPTION_END, 0, nullptr}};
    const MHD_OptionItem none[] = {{MHD_OPTION_END, 0, nullptr}};
    unsigned flags = MHD_USE_EPOLL;
    if (tls) flags |= MHD_USE_TLS;
    state_->daemon = MHD_start_daemon(flags,
                                      settings.port,
                                      nullptr,
                                      nullptr,
                                      &State::on_request,
                                      state_.get(),
                                      MHD_OPTION_LISTEN_SOCKET,
                                      listening_socket(settings),
                                      MHD_OPTION_CONNECTION_MEMORY_LIMIT,
                                      limits.connection_memory_bytes,
                                      MHD_OPTION_CONNECTION_LIMIT,
                                      // Those that were just cut off are still to be closed.
                                      limits.connections + 64,
                                      MHD_OPTION_CONNECTION_TIMEOUT,
                                      limits.idle_s,
                                      MHD_OPTION_STRICT_FOR_CLIENT,
                                      1,
                                      MHD_OPTION_NOTIFY_CONNECTION,
                                      &State::on_connection,
                                      state_.get(),
                                      MHD_OPTION_NOTIFY_COMPLETED,
                                      &State::on_completed,
                                      state_.get(),
                                      MHD_OPTION_ARRAY,
                                      tls ? certificates : none,
                                      MHD_OPTION_END);
    if (!state_->daemon) {
        throw std::runtime_error(
            tls ? "found a certificate and key that do not fit, expected PEM files of both"
                : "cannot answer requests (libmicrohttpd does not start)");
    }
    const auto* info = MHD_get_daemon_info(state_->daemon, MHD_DAEMON_INFO_BIND_PORT);
    state_->port = info ? info->port : settings.port;
}

HttpServer::~HttpServer() = default;

std::uint16_t HttpServer::port() const { return state_->port; }

void HttpServer::run(const std::atomic<bool>& stop, const std::function<void()>& now_and_then) {
    auto next = Clock::now();
    while (!stop) {
        if (MHD_run_wait(state_->daemon, kWait_ms) != MHD_YES) {
            throw std::runtime_error("cannot wait for connections any longer");
        }
        if (Clock::now() < next) continue;
        next = Clock::now() + std::chrono::milliseconds(kWait_ms);
        state_->cut_off_the_late();
        now_and_then();
    }
}

}  // namespace livery
