// (3) projector input -> the projector's screen, and nowhere else.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/bench_ports.h"
#include "core/image.h"
#include "core/progress.h"
#include "gl/timer.h"
#include "gl/window.h"
#include "projection/monitors.h"

namespace livery {

/// One finished picture for the projector: immutable once presented. The texture (RGBA8, row 0 on
/// top) belongs to the share group; whoever made it keeps it alive through `owner` until the last
/// reference goes.
struct ProjectorPicture {
    std::uint64_t number = 0;  ///< of the frame description that it shows
    unsigned texture = 0;
    glm::ivec2 size_px{0};
    std::shared_ptr<const Fence> ready;
    std::shared_ptr<const void> owner;
    /// It shows the same as the one before it, only better: takes its place little by little, for
    /// so long, or at once where the two have different sizes.
    double fade_s = 0.0;
};

/// What is on the projector now, for the operator's window and for the trace.
struct ShownPicture {
    std::uint64_t number = 0;                    ///< the picture's; 0: black
    std::chrono::steady_clock::time_point at{};  ///< when the swap returned, or black was there
    std::uint64_t frames = 0;                    ///< drawn since the start: idle adds none
};

/// The projector's window with its own context and thread. Borderless, without pointer, never
/// focused, out of the window manager's reach (override-redirect), so that nothing moves it to
/// another monitor; hidden at once when its monitor goes and shown again when it is back, with the
/// picture it should then have. Keeps the screens from blanking while it is shown. Draws only when
/// something changed.
class ProjectorScreen {
  public:
    /// Main thread. `share` is the share group of the pictures; `desktop` names monitors behind
    /// Xwayland, as in list_monitors(). `on_shown` is called on the projector's thread after every
    /// swap, and when black came.
    ProjectorScreen(const Window& share,
                    std::shared_ptr<DesktopWatch> desktop = nullptr,
                    std::function<void(const ShownPicture&)> on_shown = {});
    ~ProjectorScreen();
    ProjectorScreen(const ProjectorScreen&) = delete;
    ProjectorScreen& operator=(const ProjectorScreen&) = delete;

    // Main thread.
    void use_monitor(const std::optional<std::string>& monitor_id);  ///< none: hidden
    /// The window follows its monitor by itself; this waits until it has, so that state() tells
    /// what is so now. True when that changed since the last call of this or of use_monitor().
    bool monitors_changed();
    enum class State { off, waiting_for_monitor, showing };
    State state() const;
    /// While waiting_for_monitor: what is in the way and what to do, a sentence; else empty.
    std::string why_waiting() const;

    // Any thread. The newest picture wins; none: black.
    void present(std::shared_ptr<const ProjectorPicture> picture);
    /// Comes from the X server, before anything else: it waits for no picture and no drawing.
    void set_black(bool black);
    void set_frozen(bool frozen);  ///< keeps the newest so far; thawing shows the newest then
    bool is_black() const;
    bool is_frozen() const;
    ShownPicture shown() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Shows each monitor's number, large, on every monitor for as long as it lives. Main thread.
class MonitorNumbers {
  public:
    explicit MonitorNumbers(const std::vector<Monitor>& monitors);
    ~MonitorNumbers();
    MonitorNumbers(const MonitorNumbers&) = delete;
    MonitorNumbers& operator=(const MonitorNumbers&) = delete;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Device values, RGB, as a picture for the projector: uploaded in the current context.
std::shared_ptr<const ProjectorPicture> projector_picture(const Image8& rgb, std::uint64_t number);

/// Above all frames' numbers, and no two alike: for pictures that are shown instead of frames. Any
/// thread.
std::uint64_t next_picture_number();

/// How a capture reaches the projector; all of it from any thread.
struct ProjectorAccess {
    std::function<void(std::shared_ptr<const ProjectorPicture>)> present;
    std::function<ShownPicture()> shown;
};

/// The projector as a port, for a thread that has a context of its share group current. Returns
/// when the picture was swapped in and two refreshes of a projector have passed. While it does not
/// appear (cable pulled, black, frozen) `on_wait` is told and it is waited for, until a stop is
/// asked for (Cancelled).
ShowPicture show_on(ProjectorAccess projector, const Progress& progress, TellWait on_wait);

}  // namespace livery
