#include "support/monitor_bench.h"

#include <chrono>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "support/dng.h"
#include "support/kept_light.h"

namespace livery::testing {

using Clock = std::chrono::steady_clock;

MonitorBench::MonitorBench(const Desktop& desktop,
                           const BenchDescription& description,
                           std::shared_ptr<const Product> product)
    : area_(desktop.projector_area()),
      screen_(desktop.display()),
      bench_(bench_on_kept_light(description, std::move(product))),
      ports_(bench_.ports()),
      camera_([this](const PtpSettings& settings) { return photograph(settings); }) {
    const View& projector = description.projector.view;
    if (area_.width != projector.width || area_.height != projector.height)
        throw std::invalid_argument(
            fmt::format("a monitor of {}x{} for a bench whose projector has {}x{}",
                        area_.width,
                        area_.height,
                        projector.width,
                        projector.height));
}

PtpPicture MonitorBench::photograph(const PtpSettings& settings) {
    const std::lock_guard lock(mutex_);
    const auto start = Clock::now();
    const int number = photographs_++;
    if (number >= asleep_from_) {
        ports_.show(Image8(area_.width, area_.height, 3));
    } else if (const auto shown = screen_.read(area_.x, area_.y, area_.width, area_.height)) {
        ports_.show(*shown);
    } else {
        throw std::logic_error("the projector's monitor is not on the screen any more");
    }
    const std::string file = dng_of(ports_.photograph(settings.exposure_s));
    shutter_s_ += std::chrono::duration<double>(Clock::now() - start).count();
    return {fmt::format("IMG_{:04}.DNG", number % 10000), file};
}

double MonitorBench::shutter_s() const {
    const std::lock_guard lock(mutex_);
    return shutter_s_;
}

}  // namespace livery::testing
