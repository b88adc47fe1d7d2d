// A connection to the X server of this folder's own. Errors stay with the connection that made them
// (Xlib would end the program over an output that vanished between two requests), and no other
// thread's requests queue in front of these.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <xcb/xcb.h>

namespace livery {

struct FreeReply {
    void operator()(void* reply) const { std::free(reply); }
};
/// What xcb's *_reply functions give; null where the server answered with an error.
template <typename T>
using XReply = std::unique_ptr<T, FreeReply>;

class XConnection {
  public:
    XConnection();  ///< to DISPLAY; throws std::runtime_error
    ~XConnection();
    XConnection(const XConnection&) = delete;
    XConnection& operator=(const XConnection&) = delete;

    xcb_connection_t* get() const { return connection_; }
    const xcb_screen_t& screen() const { return *screen_; }
    xcb_window_t root() const { return screen_->root; }
    bool is_alive() const { return xcb_connection_has_error(connection_) == 0; }

    xcb_atom_t atom(std::string_view name) const;
    std::string atom_name(xcb_atom_t atom) const;  ///< empty: no such atom
    bool has(xcb_extension_t& extension) const;
    /// Returns when the server has done everything asked so far; what failed is not told.
    void synchronise() const;

  private:
    xcb_connection_t* connection_ = nullptr;
    xcb_screen_t* screen_ = nullptr;
};

}  // namespace livery
