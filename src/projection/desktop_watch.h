// What the desktop says over D-Bus, and no X server knows: its night light, and behind Xwayland
// what its monitors are and how it shows itself on them.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "projection/mutter.h"

namespace livery {

struct Output;

enum class NightLight { unknown, off, on };

struct DesktopState {
    /// Behind Xwayland: the newest that Mutter told.
    std::optional<MutterState> mutter;
    /// Behind Xwayland: why there is nothing newer, a sentence; empty: there is not.
    std::string problem;
    NightLight night_light = NightLight::unknown;
    std::string night_light_of;  ///< "GNOME", "KDE Plasma"; empty while unknown
    bool operator==(const DesktopState&) const = default;
};

/// Asks on a thread of its own, and again whenever the desktop says that something changed. Any
/// thread may ask this.
class DesktopWatch {
  public:
    /// `xwayland`: is_xwayland(). `on_change` is called on the watch's thread when state() is no
    /// longer what it was.
    explicit DesktopWatch(bool xwayland, std::function<void()> on_change = {});
    ~DesktopWatch();
    DesktopWatch(const DesktopWatch&) = delete;
    DesktopWatch& operator=(const DesktopWatch&) = delete;

    /// Waits for the first answer, until 0.2 s after the construction at most.
    DesktopState state() const;
    /// Behind Xwayland: the names, identities, modes and scales of X's outputs as far as they are
    /// known, no modes where they are not. On Xorg: nothing, since X knows better.
    void name_outputs(std::vector<Output>& outputs);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace livery
