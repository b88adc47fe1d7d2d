#include "support/mjpeg_server.h"

#include <chrono>
#include <utility>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "support/loopback.h"

namespace livery::testing {

MjpegServer::MjpegServer(std::function<std::string()> picture, double frames_per_second)
    : picture_(std::move(picture)), frames_per_second_(frames_per_second) {
    listening_ = listen_on_loopback(port_);
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
