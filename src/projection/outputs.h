// The X server as this folder uses it: a connection of its own, RandR's outputs that show
// something, and what lies above the projector's window.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <xcb/xcb.h>

#include "projection/monitors.h"

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

struct Output {
    Monitor monitor;
    std::string socket;                  ///< "HDMI-1"
    std::uint32_t output = 0, crtc = 0;  ///< RandR's
    glm::ivec2 preferred_px{0};          ///< what the monitor asks for; 0: nobody tells
    bool turned = false;                 ///< by a quarter
    bool transformed = false;            ///< scaled or warped by the server
    bool behind_wayland = false;         ///< Xwayland's: a compositor decides what is shown
};

/// Connected and lit, ordered and numbered by position: left to right, then top to bottom. What
/// the server knows, well under a millisecond; it looks at the hardware only where that cannot be.
/// Behind Xwayland `desktop` names them; null: the server alone is asked.
std::vector<Output> read_outputs(const XConnection& x, DesktopWatch* desktop);

/// A property of an output as bytes; empty where there is none.
std::vector<std::uint8_t> output_property(const XConnection& x,
                                          std::uint32_t output,
                                          std::string_view name);

/// Gives it the socket, the display's identity, and the id and the name that come of them.
void name_output(Output& output, const std::string& socket, const DisplayIdentity& identity);

bool overlap(const Monitor& a, const Monitor& b);

/// A window of ours that may lie above the picture.
void mark_as_overlay(const XConnection& x, std::uint32_t window);

/// Whether a window that was not marked so lies above `window` in that area.
bool is_covered_by_others(const XConnection& x, std::uint32_t window, const Monitor& area);

}  // namespace livery
