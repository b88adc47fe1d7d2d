#include "cli/evaluate/typed_lines.h"

#include <utility>

#include <poll.h>
#include <unistd.h>

namespace livery {

std::optional<std::string> TypedLines::next() {
    constexpr int wait_ms = 500;
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (waiting_.find('\n') == std::string::npos) {
        const int ready = ::poll(&input, at_end_ ? 0 : 1, wait_ms);
        char bytes[256];
        if (ready > 0) {
            const ssize_t got = ::read(STDIN_FILENO, bytes, sizeof bytes);
            if (got > 0) {
                waiting_.append(bytes, static_cast<std::size_t>(got));
            } else {
                at_end_ = true;
            }
        }
    }
    const std::size_t end = waiting_.find('\n');
    if (end == std::string::npos) {
        if (!at_end_ || waiting_.empty()) return std::nullopt;
        return std::exchange(waiting_, {});
    }
    std::string line = waiting_.substr(0, end);
    waiting_.erase(0, end + 1);
    return line;
}

}  // namespace livery
