// How long OpenGL worked, by its own clock, what was asked of it, counted at its calls, and points
// in a context's work that other threads wait for.
#pragma once

#include <cstdint>

#include "gl/handles.h"

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

namespace gl_detail {
void delete_query(unsigned name);
}

/// One timestamp query (64-bit nanoseconds).
class Query {
  public:
    Query();
    void stamp();                   ///< when everything asked for before is done
    bool is_ready() const;          ///< false before the first stamp, too
    std::uint64_t time_ns() const;  ///< waits; 0 before the first stamp

  private:
    GlName<gl_detail::delete_query> name_;
    bool stamped_ = false;
};

/// The time between start() and stop(). Reading early waits for OpenGL; read last frame's timer
/// to wait for nothing.
class GlTimer {
  public:
    void start() { begin_.stamp(); }
    void stop() { end_.stamp(); }
    bool is_ready() const { return begin_.is_ready() && end_.is_ready(); }
    double milliseconds() const;  ///< waits

  private:
    Query begin_, end_;
};

struct GlCounters {
    std::uint64_t programs = 0;       ///< linked
    std::uint64_t shader_bytes = 0;   ///< of source, compiled
    std::uint64_t textures = 0;       ///< made
    std::uint64_t texture_bytes = 0;  ///< of all their layers and levels
    std::uint64_t buffers = 0;        ///< made
    std::uint64_t buffer_bytes = 0;
    std::uint64_t framebuffers = 0;  ///< made
    std::uint64_t upload_bytes = 0;  ///< to textures and buffers
    std::uint64_t draws = 0;
    std::uint64_t dispatches = 0;  ///< of compute programs

    bool operator==(const GlCounters&) const = default;
};
GlCounters operator-(const GlCounters& later, const GlCounters& earlier);

/// Of this thread so far: a context is current on one thread only.
const GlCounters& gl_counters();

namespace gl_detail {
GlCounters& counted();
}

}  // namespace livery
