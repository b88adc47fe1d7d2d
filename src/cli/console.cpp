#include "cli/console.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace livery {

namespace {

// A signal handler reaches nothing but globals.
std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_interrupt(int signal) {
    if (stop_asked.exchange(true)) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

using Clock = std::chrono::steady_clock;

struct Console {
    std::mutex mutex;
    Clock::time_point start = Clock::now();
    Clock::time_point last_shown = start;
    bool terminal = ::isatty(STDERR_FILENO) == 1;
    bool shown = false;  ///< anything yet
    bool bar_drawn = false;
};

Console& console() {
    static Console instance;
    return instance;
}

}  // namespace

Progress console_progress() {
    struct sigaction action {};
    action.sa_handler = on_interrupt;
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
    Progress progress;
    progress.stop = &stop_asked;
    progress.report = [](double fraction, std::string_view stage) {
        Console& state = console();
        const std::scoped_lock lock(state.mutex);
        const auto now = Clock::now();
        if (now - state.start < std::chrono::seconds(2)) return;
        const auto pause =
            state.terminal ? std::chrono::milliseconds(100) : std::chrono::seconds(3);
        if (state.shown && now - state.last_shown < pause) return;
        state.shown = true;
        state.last_shown = now;
        if (state.terminal) {
            const int filled = static_cast<int>(24.0 * fraction + 0.5);
            const std::string bar = fmt::format("\r\033[K[{:<24}] {:3.0f}% {}",
                                                std::string(static_cast<std::size_t>(filled), '='),
                                                100.0 * fraction,
                                                stage);
            std::fputs(bar.c_str(), stderr);
            state.bar_drawn = true;
        } else {
            std::fputs(fmt::format("{:3.0f}% {}\n", 100.0 * fraction, stage).c_str(), stderr);
        }
        std::fflush(stderr);
    };
    return progress;
}

void finish_progress_line() {
    Console& state = console();
    const std::scoped_lock lock(state.mutex);
    if (state.bar_drawn) std::fputs("\r\033[K", stderr);
    state.bar_drawn = false;
}

}  // namespace livery
