// A session bus of the test's own, with what a desktop offers on it.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "support/child_process.h"
#include "support/temporary_folder.h"

struct DBusConnection;

namespace livery {

/// Sets DBUS_SESSION_BUS_ADDRESS while it lives. Throws std::runtime_error with what is missing.
class FakeDesktopBus {
  public:
    /// `service`: the name under which it answers.
    explicit FakeDesktopBus(const std::string& service);
    ~FakeDesktopBus();
    FakeDesktopBus(const FakeDesktopBus&) = delete;
    FakeDesktopBus& operator=(const FakeDesktopBus&) = delete;

    std::atomic<bool> property{false};  ///< what every property reads
    std::atomic<bool> answers{true};    ///< false: takes every question and says nothing
    std::atomic<int> inhibitions{0};    ///< asked for and not taken back

  private:
    void serve();
    bool answer_next();

    TemporaryFolder folder_;
    std::unique_ptr<ChildProcess> daemon_;
    DBusConnection* connection_ = nullptr;
    std::atomic<bool> over_{false};
    std::thread thread_;
};

}  // namespace livery
