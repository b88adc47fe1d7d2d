#include "studio/trace.h"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "core/error.h"
#include "core/json.h"

namespace livery {

Trace::Trace(const std::filesystem::path& file)
    : file_(std::fopen(file.c_str(), "w"), &std::fclose) {
    if (!file_) throw FileError(file, "", std::strerror(errno), "a file that can be written");
    std::setvbuf(file_.get(), nullptr, _IOLBF, 0);
}

void Trace::write(std::string_view event,
                  std::uint64_t number,
                  std::string_view what,
                  std::chrono::steady_clock::time_point at) {
    if (!file_) return;
    std::string line = fmt::format(
        R"({{"t_s": {:.6f}, "event": "{}", "number": {})", seconds_of(at), event, number);
    if (!what.empty()) line += ", \"what\": " + Json(what).dump();
    line += "}\n";
    const std::lock_guard lock(mutex_);
    std::fputs(line.c_str(), file_.get());
}

double seconds_of(std::chrono::steady_clock::time_point at) {
    return std::chrono::duration<double>(at.time_since_epoch()).count();
}

double now_s() { return seconds_of(std::chrono::steady_clock::now()); }

std::chrono::steady_clock::time_point time_of(double seconds) {
    using Clock = std::chrono::steady_clock;
    return Clock::time_point(
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds)));
}

}  // namespace livery
