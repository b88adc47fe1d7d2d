// GNOME's compositor without a screen, for tests: Mutter with two monitors, Xwayland, and a session
// bus of its own.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <glm/vec2.hpp>

#include "support/child_process.h"
#include "support/temporary_folder.h"

struct DBusConnection;

namespace livery {

/// An operator's monitor and a projector right of it. One thread.
class WaylandDesktop {
  public:
    static constexpr const char* operator_connector = "Meta-0";
    static constexpr const char* projector_connector = "Meta-1";

    /// What is missing for it on this machine, in words; empty: nothing.
    static std::string what_is_missing();
    /// Throws std::runtime_error with Mutter's own words when it does not come up.
    WaylandDesktop(glm::ivec2 operator_px, glm::ivec2 projector_px);
    ~WaylandDesktop();
    WaylandDesktop(const WaylandDesktop&) = delete;
    WaylandDesktop& operator=(const WaylandDesktop&) = delete;

    /// What a program needs to open its windows there.
    std::map<std::string, std::string> environment() const;
    /// As GNOME's settings do it. Throws std::runtime_error with what Mutter refuses.
    void set_projector(double scale, int transform = 0);

  private:
    glm::ivec2 operator_px_, projector_px_;
    TemporaryFolder folder_;
    std::unique_ptr<ChildProcess> bus_, mutter_;
    std::string display_, authority_;
    DBusConnection* connection_ = nullptr;
};

}  // namespace livery
