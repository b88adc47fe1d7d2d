// A simulated bench whose projector is a monitor of the tests' desktop, and a still camera on
// loopback before it: it photographs what the monitor shows.
#pragma once

#include <atomic>
#include <limits>
#include <memory>
#include <mutex>

#include "scene/product.h"
#include "support/desktop.h"
#include "support/ptpip_camera.h"
#include "support/x_server.h"
#include "twin/bench.h"

namespace livery::testing {

class MonitorBench {
  public:
    /// The projector's monitor must be plugged in, and have the pixels of the bench's projector:
    /// std::invalid_argument. `desktop` must outlive this.
    MonitorBench(const Desktop& desktop,
                 const BenchDescription& description,
                 std::shared_ptr<const Product> product);

    /// To be judged by, while nobody photographs.
    const Bench& bench() const { return bench_; }
    PtpIpCamera& camera() { return camera_; }
    /// What any camera that stands there gets of the monitor, as a raw file.
    PtpPicture photograph(const PtpSettings& settings);
    /// In standby from its photograph of that number on: the light of the room is left.
    void sleep_from(int photograph) { asleep_from_ = photograph; }
    void wake() { sleep_from(std::numeric_limits<int>::max()); }

    /// Seconds that it has spent making photographs.
    double shutter_s() const;

  private:
    Rectangle area_;
    XClient screen_;
    Bench bench_;
    BenchPorts ports_;
    std::atomic<int> asleep_from_{std::numeric_limits<int>::max()};
    mutable std::mutex mutex_;
    int photographs_ = 0;
    double shutter_s_ = 0.0;
    PtpIpCamera camera_;  ///< last: its threads use all of the above
};

}  // namespace livery::testing
