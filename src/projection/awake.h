// Screens that do not go dark while people look at a mock-up.
#pragma once

#include <memory>

namespace livery {

/// Keeps the desktop's screensaver away while it lives, where a desktop offers that. Asks on a
/// thread of its own; construction returns at once.
class Awake {
  public:
    Awake();
    ~Awake();
    Awake(const Awake&) = delete;
    Awake& operator=(const Awake&) = delete;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace livery
