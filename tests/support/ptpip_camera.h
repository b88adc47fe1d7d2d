// A still camera on loopback that speaks PTP/IP (ISO 15740, CIPA DC-005), as libgphoto2 drives it
// over a network or, with the same packets, over USB.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace livery::testing {

/// What the camera is set to when it photographs.
struct PtpSettings {
    double exposure_s = 0.125;  ///< the shutter is open; what it says is a round number near it
    int iso = 100;
    double f_number = 8.0;
    bool raw = true;  ///< its image format
};

struct PtpPicture {
    std::string name;  ///< "IMG_0001.DNG"
    std::string bytes;
};

/// What goes wrong, from now on.
enum class PtpMishap {
    none,
    unplugged,          ///< connections end and none is answered
    asleep,             ///< a connection is made, and nothing is ever answered on it
    never_photographs,  ///< says yes to a capture; no event ever comes
    card_full,
    busy,
    automatic_exposure,  ///< its dial stands on automatic: no time can be set
    half_a_file,         ///< the photograph ends in the middle
};

class PtpIpCamera {
  public:
    /// `shoot` makes the photograph; called on a thread of the camera's own.
    explicit PtpIpCamera(std::function<PtpPicture(const PtpSettings&)> shoot);
    ~PtpIpCamera();
    PtpIpCamera(const PtpIpCamera&) = delete;
    PtpIpCamera& operator=(const PtpIpCamera&) = delete;

    std::string port() const;  ///< "ptpip:127.0.0.1:PORT"
    void set(PtpMishap mishap);
    PtpSettings settings() const;
    int photographs() const { return photographs_; }
    std::size_t on_card() const;  ///< photographs that nobody has deleted

  private:
    struct Connection;
    void listen();
    void serve(const std::shared_ptr<Connection>& connection);
    void answer(Connection& connection,
                std::uint16_t operation,
                std::uint32_t transaction,
                const std::vector<std::uint32_t>& parameters,
                const std::string& data);
    void photograph(std::uint32_t transaction);
    void send_event(std::uint16_t code,
                    std::uint32_t transaction,
                    const std::vector<std::uint32_t>& parameters);
    void hang_up();

    std::function<PtpPicture(const PtpSettings&)> shoot_;
    int listening_ = -1, port_ = 0;
    std::atomic<bool> stop_{false};
    std::atomic<PtpMishap> mishap_{PtpMishap::none};
    std::atomic<int> photographs_{0};
    mutable std::mutex mutex_;
    PtpSettings settings_;
    std::map<std::uint32_t, PtpPicture> objects_;
    std::uint32_t next_handle_ = 1;
    std::vector<std::shared_ptr<Connection>> connections_;
    std::shared_ptr<Connection> events_;
    std::vector<std::thread> threads_;
    std::thread listener_;
};

}  // namespace livery::testing
