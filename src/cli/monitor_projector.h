// A projector on a monitor, for commands without a window of their own.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/bench_ports.h"
#include "core/progress.h"
#include "projection/monitors.h"

namespace livery {

/// A line that is read while the work goes on.
void say(const std::string& line);
void say_wait(const CaptureWait& wait);

/// For as long as the object lives.
class MonitorProjector {
  public:
    /// By the monitor's number, name or id. Throws std::invalid_argument where there is none.
    explicit MonitorProjector(const std::string& wanted);
    ~MonitorProjector();
    MonitorProjector(const MonitorProjector&) = delete;
    MonitorProjector& operator=(const MonitorProjector&) = delete;

    const Monitor& monitor() const;
    /// What would change its picture: check_signal().
    std::vector<SignalWarning> signal_warnings() const;
    std::string words() const;  ///< "HDMI-1 at 1920x1080"
    ShowPicture port(const Progress& progress);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace livery
