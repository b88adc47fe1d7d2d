#include "studio/projector_control.h"

#include <algorithm>

#include "core/log.h"
#include "projection/desktop_watch.h"
#include "projection/projector_screen.h"
#include "studio/calibration_panel.h"
#include "studio/nudge/nudge_panel.h"
#include "studio/presenting/presenting.h"
#include "studio/results.h"
#include "studio/window/shell.h"
#include "studio/window/shell_state.h"

namespace livery {

namespace {

constexpr double kNumbersShown_s = 4.0;

/// Two outputs that show the same part of the desktop: what is on one is on both.
const Monitor* twin_of(const std::vector<Monitor>& monitors, const Monitor& monitor) {
    const auto twin = std::find_if(monitors.begin(), monitors.end(), [&](const Monitor& other) {
        return other.id != monitor.id && other.x < monitor.x + monitor.width &&
               monitor.x < other.x + other.width && other.y < monitor.y + monitor.height &&
               monitor.y < other.y + other.height;
    });
    return twin == monitors.end() ? nullptr : &*twin;
}

/// The chosen monitor unless that would take the operator's only screen.
std::optional<std::string> usable_monitor(const Shell& shell) {
    if (shell.projector_monitor.empty()) return {};
    const auto& monitors = shell.studio.monitors;
    const auto chosen = find_monitor(monitors, shell.projector_monitor);
    if (chosen && (monitors.size() < 2 || twin_of(monitors, *chosen))) return {};
    return shell.projector_monitor;
}

void keep_projector(Shell& shell, const std::string& id) {
    shell.projector_monitor = id;
    shell.studio.session.set_workspace(kMonitorKey, id);
    keep_setting(shell.studio.settings, kProjectorSetting, id);
}

void apply(Shell& shell) {
    const auto usable = usable_monitor(shell);
    shell.only_screen_is_projector = !shell.projector_monitor.empty() && !usable;
    if (shell.studio.projector) shell.studio.projector->use_monitor(usable);
    check_projector_signal(shell);
}

}  // namespace

void use_projector_monitor(Shell& shell, const std::string& id) {
    Studio& studio = shell.studio;
    const auto monitor = find_monitor(studio.monitors, id);
    if (monitor && studio.monitors.size() < 2) {
        notify(studio,
               {Notice::Level::warning,
                monitor->name + " is the only monitor, so it does not become the projector.",
                "The projector's picture would cover this window.",
                "Plug the projector in as a second monitor, or look at its picture in the "
                "Projector view."});
        return;
    }
    if (const Monitor* twin = monitor ? twin_of(studio.monitors, *monitor) : nullptr) {
        notify(studio,
               {Notice::Level::warning,
                monitor->name + " does not become the projector.",
                "It shows the same part of the desktop as " + twin->name + ".",
                "Extend the desktop to the projector instead of mirroring it."});
        return;
    }
    keep_projector(shell, id);
    shell.projector_was_there = true;
    log_line(LogLevel::info, "projector: " + (monitor ? monitor->name : "none"));
    apply(shell);
    shell.window_must_move = true;
}

void read_monitors(Shell& shell) {
    Studio& studio = shell.studio;
    studio.monitors = list_monitors(studio.desktop.get());
    // One that was there is found by its id alone: another of its kind is not it.
    if (shell.projector_was_there) return;
    const auto remembered = find_remembered_monitor(studio.monitors, shell.projector_monitor);
    if (!remembered) return;
    shell.projector_was_there = true;
    if (remembered->id != shell.projector_monitor) keep_projector(shell, remembered->id);
}

void monitors_changed(Shell& shell) {
    Studio& studio = shell.studio;
    read_monitors(shell);
    for (const Monitor& m : studio.monitors) {
        log_line(LogLevel::info,
                 "monitor " + std::to_string(m.number) + ": " + m.name + " " +
                     std::to_string(m.width) + "x" + std::to_string(m.height) + " at " +
                     std::to_string(m.x) + "," + std::to_string(m.y));
    }
    shell.monitor_numbers.reset();
    if (studio.projector) studio.projector->monitors_changed();
    apply(shell);
    shell.window_must_move = true;
}

void check_projector_signal(Shell& shell) {
    const Studio& studio = shell.studio;
    shell.signal_warnings.clear();
    const auto usable = usable_monitor(shell);
    const auto monitor = usable ? find_monitor(studio.monitors, *usable) : std::nullopt;
    if (!monitor || !studio.desktop) return;
    glm::ivec2 calibrated_px{0};
    if (studio.setup && studio.setup->calibration) {
        calibrated_px = {studio.setup->view.width, studio.setup->view.height};
    }
    shell.signal_warnings = check_signal(*monitor, calibrated_px, *studio.desktop);
    for (const SignalWarning& warning : shell.signal_warnings) {
        const bool note = warning.severity == SignalWarning::Severity::note;
        log_line(note ? LogLevel::info : LogLevel::warning,
                 warning.what + " " + warning.cause + " " + warning.fix);
    }
}

void show_monitor_numbers(Shell& shell) {
    shell.monitor_numbers.reset();
    shell.monitor_numbers = std::make_unique<MonitorNumbers>(shell.studio.monitors);
    shell.monitor_numbers_until_s = shell.studio.now_s + kNumbersShown_s;
}

void show_signal_test(Shell& shell, bool shown) {
    if (shown) show_nudge(shell, false);
    shell.signal_test_open = shown;
    if (!shell.results) return;
    if (!shown) {
        shell.results->show_instead(nullptr);
        return;
    }
    const auto monitor = find_monitor(shell.studio.monitors, shell.projector_monitor);
    shell.results->show_instead(projector_picture(
        signal_test_picture(monitor ? monitor->width : 1280, monitor ? monitor->height : 800), 0));
}

ProjectorFacts projector_facts(const Shell& shell) {
    const ProjectorScreen& screen = *shell.studio.projector;
    ProjectorFacts facts;
    facts.state = screen.state();
    if (facts.state == ProjectorScreen::State::waiting_for_monitor) {
        facts.why_waiting = screen.why_waiting();
    }
    facts.only_screen = shell.only_screen_is_projector;
    facts.black = shell.black;
    facts.frozen = shell.frozen;
    facts.monitor_numbers = shell.monitor_numbers != nullptr;
    facts.signal_test = shell.signal_test_open;
    facts.nudge = shell.nudge_open;
    facts.freezing = presenting(shell.studio).freezing.has_value();
    facts.voting = presenting(shell.studio).presented.has_value();
    facts.wanted = shell.frame_number;
    facts.shown = screen.shown().number;
    facts.waited_s = shell.studio.now_s - shell.frame_asked_s;
    facts.other_product = other_product(shell.studio);
    facts.not_drawn = shell.not_drawn;
    const auto newest = shell.results->newest_frame();
    if (facts.not_drawn.empty() && newest && newest->number == shell.frame_number) {
        facts.not_drawn = newest->problem;
    }
    return facts;
}

void set_black(Shell& shell, bool black) {
    shell.black = black;
    if (shell.studio.projector) shell.studio.projector->set_black(black);
    log_line(LogLevel::info, black ? "projector: black" : "projector: not black");
}

void set_frozen(Shell& shell, bool frozen) {
    shell.frozen = frozen;
    if (shell.studio.projector) shell.studio.projector->set_frozen(frozen);
    log_line(LogLevel::info, frozen ? "projector: frozen" : "projector: not frozen");
}

bool is_black(const Shell& shell) { return shell.black; }
bool is_frozen(const Shell& shell) { return shell.frozen; }

}  // namespace livery
