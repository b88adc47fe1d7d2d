// A network camera on loopback: a stream of JPEG pictures over HTTP, as cheap ones send it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace livery::testing {

class MjpegServer {
  public:
    /// `picture` makes the next JPEG; it is called on the server's thread, one after the other.
    explicit MjpegServer(std::function<std::string()> picture, double frames_per_second = 60.0);
    ~MjpegServer();
    MjpegServer(const MjpegServer&) = delete;
    MjpegServer& operator=(const MjpegServer&) = delete;

    std::string address() const;  ///< http://127.0.0.1:PORT/video.mjpg
    /// Ends the connections that there are; while `gone` no new one is answered.
    void pull_cable(bool gone);
    /// Sends nothing, but stays connected.
    void freeze(bool frozen) { frozen_ = frozen; }

  private:
    void serve();
    void send_stream(int connection);

    std::function<std::string()> picture_;
    double frames_per_second_;
    int listening_ = -1;
    int port_ = 0;
    std::atomic<bool> stop_{false}, gone_{false}, frozen_{false};
    std::thread thread_;
};

}  // namespace livery::testing
