#include "projection/awake.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

#include "core/log.h"
#include "projection/session_bus.h"

namespace livery {

struct Awake::Implementation {
    std::mutex mutex;
    std::condition_variable changed;
    bool over = false;
    std::thread thread{[this] { run(); }};

    ~Implementation() {
        {
            const std::lock_guard lock(mutex);
            over = true;
        }
        changed.notify_one();
        thread.join();
    }

    void run() {
        try {
            const auto bus = SessionBus::connect();
            // Without a bus or an answer only the X server blanks screens, and it is told apart.
            const auto inhibition =
                bus ? bus->inhibit_screensaver("a projector is showing a mock-up") : std::nullopt;
            if (!inhibition) return;
            std::unique_lock lock(mutex);
            changed.wait(lock, [&] { return over; });
            lock.unlock();
            bus->allow_screensaver(*inhibition);
        } catch (const std::exception& error) {
            log_line(LogLevel::warning, std::string("keeping the screens on: ") + error.what());
        }
    }
};

Awake::Awake() : implementation_(std::make_unique<Implementation>()) {}

Awake::~Awake() = default;

}  // namespace livery
