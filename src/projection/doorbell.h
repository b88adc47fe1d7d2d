// A thread that waits for descriptors hears other threads through this.
#pragma once

#include <array>
#include <stdexcept>

#include <fcntl.h>
#include <unistd.h>

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

}  // namespace livery
