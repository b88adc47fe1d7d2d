// The desktop's session bus (D-Bus), where there is one, and how threads that wait for descriptors
// hear others. Every question has a short timeout: nothing waits for a desktop.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <unistd.h>

struct DBusConnection;
struct DBusMessage;

namespace livery {

class Doorbell {
  public:
    Doorbell() {
        if (::pipe2(ends_.data(), O_CLOEXEC | O_NONBLOCK) != 0) {
            throw std::runtime_error("no pipe: too many files are open");
        }
    }
    ~Doorbell() {
        ::close(ends_[0]);
        ::close(ends_[1]);
    }
    Doorbell(const Doorbell&) = delete;
    Doorbell& operator=(const Doorbell&) = delete;

    void ring() const {
        const char byte = 0;
        // A full pipe has rung already.
        [[maybe_unused]] const auto written = ::write(ends_[1], &byte, 1);
    }
    void silence() const {
        std::array<char, 64> bytes{};
        while (::read(ends_[0], bytes.data(), bytes.size()) > 0) {
        }
    }
    int descriptor() const { return ends_[0]; }

  private:
    std::array<int, 2> ends_{-1, -1};
};

struct ReleaseBusMessage {
    void operator()(DBusMessage* message) const;
};
using BusMessage = std::unique_ptr<DBusMessage, ReleaseBusMessage>;

class SessionBus {
  public:
    /// Null where there is no bus, or none that answers. Never starts one.
    static std::unique_ptr<SessionBus> connect();
    ~SessionBus();
    SessionBus(const SessionBus&) = delete;
    SessionBus& operator=(const SessionBus&) = delete;

    struct Object {
        const char *service, *path, *interface;
    };
    /// What a method without arguments answers; or why it does not.
    struct Answer {
        BusMessage message;   ///< null: none came
        bool offered = true;  ///< false: nobody on the bus has that name
        std::string error;    ///< the bus's or the service's own words
    };
    /// For who may wait longer than the other questions do; until `is_over` says so.
    Answer call(const Object& object,
                const char* method,
                std::chrono::milliseconds patience,
                const std::function<bool()>& is_over);
    /// Nothing where nobody offers it.
    std::optional<bool> read_bool(const Object& object, const char* property) const;
    /// Asks the desktop not to blank the screens; the answer is what takes it back.
    std::optional<std::uint32_t> inhibit_screensaver(const char* reason) const;
    void allow_screensaver(std::uint32_t inhibition) const;

    /// Asks for the signals that a match rule names; heard() tells of them.
    void listen(const std::string& rule) const;
    /// Whether one came since the last call. Takes what descriptor() has for reading.
    bool heard();
    bool is_connected() const;
    int descriptor() const;

  private:
    explicit SessionBus(DBusConnection* connection) : connection_(connection) {}

    /// Takes the next message that came; null: none. Notes whether it was a signal.
    BusMessage next_message();

    DBusConnection* connection_ = nullptr;
    bool heard_ = false;
};

}  // namespace livery
