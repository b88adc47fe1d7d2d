#include "support/mjpeg_server.h"

#include <chrono>
#include <stdexcept>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace livery::testing {

namespace {

bool send_all(int connection, const std::string& bytes) {
    std::size_t sent = 0;
    while (sent < bytes.size()) {
        const ssize_t n =
            ::send(connection, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
        if (n <= 0) return false;
        sent += static_cast<std::size_t>(n);
    }
    return true;
}

}  // namespace

MjpegServer::MjpegServer(std::function<std::string()> picture, double frames_per_second)
    : picture_(std::move(picture)), frames_per_second_(frames_per_second) {
    listening_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    if (::bind(listening_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0 ||
        ::listen(listening_, 4) != 0 ||
        ::getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
        throw std::runtime_error("no port on loopback");
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
}

MjpegServer::~MjpegServer() {
    stop_ = true;
    thread_.join();
    ::close(listening_);
}

std::string MjpegServer::address() const {
    return "http://127.0.0.1:" + std::to_string(port_) + "/video.mjpg";
}

void MjpegServer::pull_cable(bool gone) { gone_ = gone; }

void MjpegServer::serve() {
    while (!stop_) {
        pollfd waiting{listening_, POLLIN, 0};
        if (::poll(&waiting, 1, 20) <= 0) continue;
        const int connection = ::accept(listening_, nullptr, nullptr);
        if (connection < 0) continue;
        if (!gone_) send_stream(connection);
        ::close(connection);
    }
}

void MjpegServer::send_stream(int connection) {
    char request[4096];
    if (::recv(connection, request, sizeof(request), 0) <= 0) return;
    if (!send_all(connection,
                  "HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=frame\r\n"
                  "\r\n"))
        return;
    auto next = std::chrono::steady_clock::now();
    while (!stop_ && !gone_) {
        if (!frozen_) {
            const std::string jpeg = picture_();
            if (!send_all(connection,
                          "--frame\r\nContent-Type: image/jpeg\r\nContent-Length: " +
                              std::to_string(jpeg.size()) + "\r\n\r\n" + jpeg + "\r\n"))
                return;
        }
        next += std::chrono::microseconds(static_cast<int>(1e6 / frames_per_second_));
        std::this_thread::sleep_until(next);
    }
}

}  // namespace livery::testing
