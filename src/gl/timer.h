// How long OpenGL worked, by its own clock.
#pragma once

#include <cstdint>

#include "gl/handles.h"

namespace livery {

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

}  // namespace livery
