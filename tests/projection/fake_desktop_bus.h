// A session bus of the test's own, with what a desktop offers on it.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "mutter_messages.h"
#include "support/child_process.h"
#include "support/temporary_folder.h"

struct DBusConnection;

namespace livery {

/// Sets DBUS_SESSION_BUS_ADDRESS while it lives. Throws std::runtime_error with what is missing.
class FakeDesktopBus {
  public:
    /// The names under which it answers.
    explicit FakeDesktopBus(const std::string& service, const std::string& another = {});
    ~FakeDesktopBus();
    FakeDesktopBus(const FakeDesktopBus&) = delete;
    FakeDesktopBus& operator=(const FakeDesktopBus&) = delete;

    std::atomic<bool> property{false};  ///< what every property reads
    std::atomic<bool> answers{true};    ///< false: takes every question and says nothing
    std::atomic<int> inhibitions{0};    ///< asked for and not taken back

    /// What GetCurrentState answers from now on, and a signal that it is another; none: an error.
    void tell_monitors(const std::optional<SaidState>& state);
    void send_signal(const char* path, const char* interface, const char* member);

  private:
    void serve();
    bool answer_next();
    DBusMessage* monitors_answer(DBusMessage* question);

    TemporaryFolder folder_;
    std::unique_ptr<ChildProcess> daemon_;
    DBusConnection* connection_ = nullptr;
    std::mutex mutex_;
    std::optional<SaidState> monitors_;
    std::atomic<bool> over_{false};
    std::thread thread_;
};

}  // namespace livery
