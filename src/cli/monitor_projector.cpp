#include "cli/monitor_projector.h"

#include <cstdio>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "cli/console.h"
#include "gl/window.h"
#include "projection/desktop_watch.h"
#include "projection/projector_screen.h"

namespace livery {

void say(const std::string& line) {
    finish_progress_line();
    std::fputs((line + "\n").c_str(), stderr);
}

void say_wait(const CaptureWait& wait) {
    say(wait.why.empty() ? "it goes on" : fmt::format("waiting: {}; {}", wait.why, wait.fix));
}

struct MonitorProjector::Implementation {
    WindowSystem window_system;
    std::shared_ptr<DesktopWatch> desktop = std::make_shared<DesktopWatch>(is_xwayland());
    std::optional<Monitor> monitor;
    std::unique_ptr<Window> context;
    std::unique_ptr<ProjectorScreen> screen;
};

MonitorProjector::MonitorProjector(const std::string& wanted)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& it = *implementation_;
    for (const Monitor& each : list_monitors(it.desktop.get())) {
        if (std::to_string(each.number) == wanted || each.id == wanted || each.name == wanted)
            it.monitor = each;
    }
    if (!it.monitor)
        throw std::invalid_argument(fmt::format(
            "--monitor: found \"{}\", expected one that livery capture --list names", wanted));
    WindowOptions hidden;
    hidden.title = "Livery (capture)";
    hidden.size_px = {16, 16};
    hidden.visible = false;
    it.context = std::make_unique<Window>(hidden);
    it.screen = std::make_unique<ProjectorScreen>(*it.context, it.desktop);
    it.context->make_current();
    it.screen->use_monitor(it.monitor->id);
}

MonitorProjector::~MonitorProjector() = default;

const Monitor& MonitorProjector::monitor() const { return *implementation_->monitor; }

std::vector<SignalWarning> MonitorProjector::signal_warnings() const {
    return check_signal(monitor(), {0, 0}, *implementation_->desktop);
}

std::string MonitorProjector::words() const {
    return fmt::format("{} at {}x{}", monitor().name, monitor().width, monitor().height);
}

ShowPicture MonitorProjector::port(const Progress& progress) {
    ProjectorScreen* screen = implementation_->screen.get();
    return show_on({[screen](auto picture) { screen->present(std::move(picture)); },
                    [screen] { return screen->shown(); }},
                   progress,
                   say_wait);
}

}  // namespace livery
