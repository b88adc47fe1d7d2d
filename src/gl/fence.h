// How a finished texture passes from one context's thread to another's.
#pragma once

namespace livery {

/// A point in a context's work. Made by the thread that drew; waited for by the one that reads.
/// Move-only; destroy it with any context of the share group current.
class Fence {
  public:
    Fence() = default;                       ///< nothing to wait for
    static Fence after_everything_so_far();  ///< and flushes, so that it will be reached
    Fence(Fence&& other) noexcept;
    Fence& operator=(Fence&& other) noexcept;
    ~Fence();

    void wait_on_device() const;  ///< later work of the current context waits; this thread does not
    bool is_reached() const;
    /// This thread waits, `seconds` at most; whether it was reached.
    bool wait_for(double seconds) const;

  private:
    void* sync_ = nullptr;
};

}  // namespace livery
