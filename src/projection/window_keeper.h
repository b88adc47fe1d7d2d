// Keeps a window exactly over one monitor and never anywhere else.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <glm/vec2.hpp>

namespace livery {

class DesktopWatch;

/// Listens to RandR on a connection and a thread of its own, so that a window is hidden before a
/// busy program could have read that its monitor went. Its requests are served even while another
/// program holds the server, which is when xrandr and desktops move the monitors about; to show
/// the window it waits until they are done.
class WindowKeeper {
  public:
    struct Place {
        std::optional<glm::ivec2> size_px;  ///< of the window while it is shown
        std::string why_hidden;             ///< for the operator; empty while shown or not wanted
    };

    /// Both run on the keeper's thread and must not call back.
    struct Listener {
        std::function<void(const Place&)> moved;  ///< shown or hidden
        std::function<void()> exposed;            ///< shown, and black where it was not drawn since
        std::function<void()> covered;            ///< black now, wherever it is shown
    };

    /// `window` is unmapped; it becomes override-redirect, and black until drawn into. `desktop`
    /// names monitors behind Xwayland, as in list_monitors(). Throws std::runtime_error without X
    /// or RandR.
    WindowKeeper(std::uint32_t window, std::shared_ptr<DesktopWatch> desktop, Listener listener);
    ~WindowKeeper();  ///< hides
    WindowKeeper(const WindowKeeper&) = delete;
    WindowKeeper& operator=(const WindowKeeper&) = delete;

    // Any thread. These two return when the window is where it should be.
    void follow(std::optional<std::string> monitor_id);  ///< none: hidden
    void catch_up();  ///< with everything that the server knows now

    Place place() const;
    /// Black over whatever is in the window, from the X server itself: it waits for no drawing.
    /// Returns at once.
    void cover(bool covered);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace livery
