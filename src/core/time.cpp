#include "core/time.h"

#include <chrono>
#include <cstdio>
#include <ctime>

namespace livery {

namespace {

using WallClock = std::chrono::system_clock;

std::string seconds_text(WallClock::time_point time) {
    const std::time_t seconds = WallClock::to_time_t(time);
    std::tm parts{};
    ::gmtime_r(&seconds, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &parts);
    return text;
}

}  // namespace

std::string utc_now() { return seconds_text(WallClock::now()) + "Z"; }

std::string utc_now_ms() {
    using namespace std::chrono;
    const auto now = floor<milliseconds>(WallClock::now());
    const auto whole = floor<seconds>(now);
    char fraction[8];
    std::snprintf(fraction, sizeof fraction, ".%03dZ", static_cast<int>((now - whole).count()));
    return seconds_text(whole) + fraction;
}

}  // namespace livery
