#include "projection/desktop_watch.h"

#include <array>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include <poll.h>

#include "core/log.h"
#include "projection/mutter.h"
#include "projection/outputs.h"
#include "projection/session_bus.h"

namespace livery {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kFirstAnswer = std::chrono::milliseconds(200);
/// A compositor that sets modes answers late; nobody but this thread waits for it.
constexpr auto kMutterMay = std::chrono::seconds(2);
/// Until somebody who did not answer is asked again.
constexpr int kAgain_ms = 1000;

constexpr SessionBus::Object kMutter = {"org.gnome.Mutter.DisplayConfig",
                                        "/org/gnome/Mutter/DisplayConfig",
                                        "org.gnome.Mutter.DisplayConfig"};

struct KnownNightLight {
    const char* desktop;
    SessionBus::Object object;
    const char* property;
};
constexpr KnownNightLight kNightLights[] = {
    {"GNOME",
     {"org.gnome.SettingsDaemon.Color",
      "/org/gnome/SettingsDaemon/Color",
      "org.gnome.SettingsDaemon.Color"},
     "NightLightActive"},
    {"KDE Plasma",
     {"org.kde.KWin", "/org/kde/KWin/NightLight", "org.kde.KWin.NightLight"},
     "running"},
    {"KDE Plasma", {"org.kde.KWin", "/ColorCorrect", "org.kde.kwin.ColorCorrect"}, "running"},
};

void listen(const SessionBus& bus) {
    bus.listen(std::string("type='signal',member='MonitorsChanged',interface='") +
               kMutter.interface + "'");
    const auto comes_and_goes = [&](const char* service) {
        bus.listen(std::string("type='signal',member='NameOwnerChanged',"
                               "sender='org.freedesktop.DBus',arg0='") +
                   service + "'");
    };
    comes_and_goes(kMutter.service);
    for (const KnownNightLight& known : kNightLights) {
        comes_and_goes(known.object.service);
        bus.listen(std::string("type='signal',member='PropertiesChanged',path='") +
                   known.object.path + "'");
    }
}

void ask_night_light(const SessionBus& bus, DesktopState& state) {
    for (const KnownNightLight& known : kNightLights) {
        const auto on = bus.read_bool(known.object, known.property);
        if (!on) continue;
        state.night_light = *on ? NightLight::on : NightLight::off;
        state.night_light_of = known.desktop;
        if (*on) return;
    }
}

/// What went wrong is in `state.problem`. True: asking again may help.
bool ask_mutter(SessionBus& bus, const std::function<bool()>& is_over, DesktopState& state) {
    const SessionBus::Answer answer = bus.call(kMutter, "GetCurrentState", kMutterMay, is_over);
    if (!answer.message) {
        state.problem =
            answer.offered
                ? "GNOME does not tell its monitors (" + std::string(kMutter.service) + ": " +
                      answer.error + ")."
                : "This Wayland desktop is not GNOME's, and tells no program how it shows its "
                  "monitors.";
        return answer.offered;
    }
    try {
        state.mutter = read_mutter_state(*answer.message);
        state.problem.clear();
    } catch (const std::exception& error) {
        state.problem = "GNOME's answer about its monitors cannot be read (" +
                        std::string(kMutter.service) + ".GetCurrentState: " + error.what() + ").";
    }
    return false;
}

}  // namespace

struct DesktopWatch::Implementation {
    const bool xwayland;
    const std::function<void()> on_change;
    const Clock::time_point began = Clock::now();

    mutable std::mutex mutex;
    std::condition_variable answered;
    DesktopState newest;
    bool has_answer = false, over = false;
    bool is_read = false;  ///< somebody has what `newest` was

    std::mutex naming;  ///< who names outputs; not held while the bus is asked
    KnownConnectors known;

    const Doorbell doorbell;
    std::thread thread;

    Implementation(bool is_xwayland, std::function<void()> changed)
        : xwayland(is_xwayland), on_change(std::move(changed)), thread([this] { run(); }) {}

    ~Implementation() {
        {
            const std::lock_guard lock(mutex);
            over = true;
        }
        doorbell.ring();
        thread.join();
    }

    bool is_over() const {
        const std::lock_guard lock(mutex);
        return over;
    }

    void publish(DesktopState state) {
        bool tell = false;
        {
            const std::lock_guard lock(mutex);
            tell = is_read && state != newest;
            newest = std::move(state);
            has_answer = true;
        }
        answered.notify_all();
        if (tell && on_change) on_change();
    }

    /// True: the bus has something to say, or it is time to ask again; false: it is over, or the
    /// bus is gone.
    bool wait_for_news(SessionBus& bus, bool ask_again) {
        const auto until = Clock::now() + std::chrono::milliseconds(kAgain_ms);
        while (!is_over()) {
            if (bus.heard()) return true;
            if (!bus.is_connected()) return false;
            std::array<pollfd, 2> sources = {pollfd{bus.descriptor(), POLLIN, 0},
                                             pollfd{doorbell.descriptor(), POLLIN, 0}};
            const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
            if (ask_again && left.count() <= 0) return true;
            ::poll(sources.data(), sources.size(), ask_again ? static_cast<int>(left.count()) : -1);
            doorbell.silence();
        }
        return false;
    }

    void run() {
        try {
            DesktopState state;
            while (!is_over()) {
                const auto bus = SessionBus::connect();
                if (bus) {
                    listen(*bus);
                    bool ask_again = false;
                    do {
                        state.night_light = NightLight::unknown;
                        state.night_light_of.clear();
                        ask_again = xwayland && ask_mutter(
                                                    *bus, [this] { return is_over(); }, state);
                        if (is_over()) return;
                        ask_night_light(*bus, state);
                        publish(state);
                    } while (wait_for_news(*bus, ask_again));
                    state.night_light = NightLight::unknown;
                    state.night_light_of.clear();
                }
                if (is_over()) break;
                if (xwayland) {
                    state.problem =
                        "Nothing tells how this Wayland desktop shows its monitors: there is no "
                        "session bus (D-Bus) that answers.";
                }
                publish(state);
                pollfd source{doorbell.descriptor(), POLLIN, 0};
                ::poll(&source, 1, xwayland ? kAgain_ms : -1);
                doorbell.silence();
            }
        } catch (const std::exception& error) {
            log_line(LogLevel::error, std::string("asking the desktop: ") + error.what());
        }
    }
};

DesktopWatch::DesktopWatch(bool xwayland, std::function<void()> on_change)
    : implementation_(std::make_unique<Implementation>(xwayland, std::move(on_change))) {}

DesktopWatch::~DesktopWatch() = default;

DesktopState DesktopWatch::state() const {
    Implementation& self = *implementation_;
    std::unique_lock lock(self.mutex);
    self.answered.wait_until(lock, self.began + kFirstAnswer, [&] { return self.has_answer; });
    self.is_read = true;
    DesktopState state = self.newest;
    if (!self.has_answer && self.xwayland) {
        state.problem = "The desktop has not told yet how it shows its monitors.";
    }
    return state;
}

void DesktopWatch::name_outputs(std::vector<Output>& outputs) {
    Implementation& self = *implementation_;
    if (!self.xwayland) return;
    for (Output& output : outputs) {
        output.behind_wayland = true;
        output.monitor.former_id.clear();
        output.monitor.mode_px = output.preferred_px = {0, 0};
    }
    const DesktopState now = state();
    if (!now.mutter) return;
    const std::lock_guard lock(self.naming);
    name_outputs_after(*now.mutter, outputs, self.known);
}

}  // namespace livery
