// Sees what the operator's monitor shows, even in the middle of a change of monitors.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "projection/outputs.h"
#include "support/desktop.h"

namespace livery {

/// Looks as often as it can, wherever the monitor is at the time. A server that another program
/// holds answers it all the same, so that no intermediate state of one xrandr call is missed.
class OperatorWatch {
  public:
    /// `forbidden`: no pixel of this colour may ever be there.
    OperatorWatch(const std::string& output, const Rgb& forbidden);
    ~OperatorWatch();
    OperatorWatch(const OperatorWatch&) = delete;
    OperatorWatch& operator=(const OperatorWatch&) = delete;

    int looks() const { return looks_; }
    int wrong() const { return wrong_; }
    int places() const { return places_; }  ///< different ones of the monitor

  private:
    void look();

    const XConnection x_;
    const std::string output_;
    const Rgb forbidden_;
    std::uint32_t crtc_ = 0;
    Rectangle last_;
    std::atomic<int> looks_{0}, wrong_{0}, places_{0};
    std::atomic<bool> over_{false};
    std::thread thread_;
};

}  // namespace livery
