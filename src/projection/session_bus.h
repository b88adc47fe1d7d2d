// The desktop's session bus (D-Bus), where there is one. Every question has a short timeout: a
// desktop that does not answer must not hold up a picture.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

struct DBusConnection;

namespace livery {

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
    /// Nothing where nobody offers it.
    std::optional<bool> read_bool(const Object& object, const char* property) const;
    /// Asks the desktop not to blank the screens; the answer is what takes it back.
    std::optional<std::uint32_t> inhibit_screensaver(const char* reason) const;
    void allow_screensaver(std::uint32_t inhibition) const;

  private:
    explicit SessionBus(DBusConnection* connection) : connection_(connection) {}

    DBusConnection* connection_ = nullptr;
};

}  // namespace livery
