#include "studio/projector.h"

#include <algorithm>
#include <utility>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "core/log.h"
#include "projection/desktop_watch.h"
#include "projection/projector_screen.h"
#include "studio/studio.h"

namespace livery {

namespace {

std::shared_ptr<const ProjectorPicture> picture_of(
    const std::shared_ptr<const FinishedFrame>& frame) {
    auto picture = std::make_shared<ProjectorPicture>();
    picture->number = frame->number;
    picture->texture = frame->drive_texture;
    picture->size_px = frame->size_px;
    picture->ready = frame->ready;
    picture->owner = frame;
    picture->fade_s = frame->fade_s;
    return picture;
}

}  // namespace

void Results::take(std::shared_ptr<const FinishedFrame> finished) {
    trace_->write("frame-done", finished->number, finished->problem);
    {
        const std::lock_guard lock(mutex_);
        frame_ = finished;
        if (finished->problem.empty()) {
            drawn_ = std::move(finished);
            if (!instead_) present_locked();
        }
    }
    wake_main_thread();
}

void Results::take(std::shared_ptr<const PreviewPicture> finished) {
    {
        const std::lock_guard lock(mutex_);
        preview_ = std::move(finished);
    }
    wake_main_thread();
}

void Results::shown(const ShownPicture& picture) const {
    trace_->write("shown", picture.number, {}, picture.at);
    wake_main_thread();
}

void Results::use(ProjectorScreen* screen) {
    const std::lock_guard lock(mutex_);
    projector_ = screen;
    present_locked();
}

void Results::show_instead(std::shared_ptr<const ProjectorPicture> picture) {
    const std::lock_guard lock(mutex_);
    instead_ = std::move(picture);
    present_locked();
}

void Results::present_locked() {
    if (!projector_) return;
    if (instead_) {
        projector_->present(instead_);
    } else if (drawn_) {
        projector_->present(picture_of(drawn_));
    }
}

bool Results::awaits_projector() const {
    const std::lock_guard lock(mutex_);
    if (!projector_ || instead_ || !drawn_) return false;
    return projector_->state() == ProjectorScreen::State::showing && !projector_->is_black() &&
           !projector_->is_frozen() && projector_->shown().number < drawn_->number;
}

std::shared_ptr<const FinishedFrame> Results::newest_frame() const {
    const std::lock_guard lock(mutex_);
    return frame_;
}

std::shared_ptr<const FinishedFrame> Results::newest_drawn() const {
    const std::lock_guard lock(mutex_);
    return drawn_;
}

std::shared_ptr<const PreviewPicture> Results::newest_preview() const {
    const std::lock_guard lock(mutex_);
    return preview_;
}

void Results::clear() {
    const std::lock_guard lock(mutex_);
    instead_.reset();
    frame_.reset();
    drawn_.reset();
    preview_.reset();
}

// --- words ---

long count_of_warnings(const std::vector<SignalWarning>& list) {
    return std::count_if(list.begin(), list.end(), [](const SignalWarning& warning) {
        return warning.severity != SignalWarning::Severity::note;
    });
}

ProjectorWords projector_words(const ProjectorFacts& facts) {
    using enum ProjectorWords::Mood;
    if (facts.only_screen) {
        return {"dark: it is the only screen now",
                warning,
                "The projector's picture never covers the only screen that you have."};
    }
    if (facts.state == ProjectorScreen::State::off) {
        return {"Works without a projector: look at Photograph.", quiet, ""};
    }
    if (facts.state == ProjectorScreen::State::waiting_for_monitor) {
        return {"dark, comes back by itself",
                warning,
                facts.why_waiting + " Until then its picture is shown nowhere."};
    }
    if (facts.monitor_numbers) return {"showing the monitors' numbers", quiet, ""};
    if (facts.black) return {"black", warning, "B shows the picture again."};
    if (!facts.instead.text.empty()) return facts.instead;
    const bool behind = facts.shown != facts.wanted;
    if (facts.frozen) {
        return {behind ? "frozen: not what you work on" : "frozen",
                warning,
                "It keeps its picture. F shows the newest again."};
    }
    if (!facts.not_drawn.empty()) {
        return {"not this look: keeps the last picture", error, facts.not_drawn};
    }
    if (!facts.other_product.empty()) {
        return {"showing, corrected for another product", error, facts.other_product};
    }
    if (behind && facts.waited_s >= kUnspokenWait_s) return {"drawing…", quiet, ""};
    return {"showing", good, ""};
}

const ImVec4& colour_of(SignalWarning::Severity severity) {
    using enum SignalWarning::Severity;
    return severity == error     ? colours::error
           : severity == warning ? colours::warning
                                 : colours::dim_text;
}

// --- the monitor, and what goes to it ---

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
std::optional<std::string> usable_monitor(const Studio& studio) {
    if (studio.projector_monitor.empty()) return {};
    const auto& monitors = studio.monitors;
    const auto chosen = find_monitor(monitors, studio.projector_monitor);
    if (chosen && (monitors.size() < 2 || twin_of(monitors, *chosen))) return {};
    return studio.projector_monitor;
}

void keep_projector(Studio& studio, const std::string& id) {
    studio.projector_monitor = id;
    studio.session.set_workspace(kMonitorKey, id);
    keep_setting(studio.settings, kProjectorSetting, id);
}

void apply(Studio& studio) {
    const auto usable = usable_monitor(studio);
    studio.only_screen_is_projector = !studio.projector_monitor.empty() && !usable;
    if (studio.projector) studio.projector->use_monitor(usable);
    check_projector_signal(studio);
}

}  // namespace

void use_projector_monitor(Studio& studio, const std::string& id) {
    const auto monitor = find_monitor(studio.monitors, id);
    if (monitor && studio.monitors.size() < 2) {
        tell_warning(studio,
                     monitor->name + " is the only monitor, so it does not become the projector.",
                     "The projector's picture would cover this window.",
                     "Plug the projector in as a second monitor, or look at its picture in the "
                     "Projector view.");
        return;
    }
    if (const Monitor* twin = monitor ? twin_of(studio.monitors, *monitor) : nullptr) {
        tell_warning(studio,
                     monitor->name + " does not become the projector.",
                     "It shows the same part of the desktop as " + twin->name + ".",
                     "Extend the desktop to the projector instead of mirroring it.");
        return;
    }
    keep_projector(studio, id);
    studio.projector_was_there = true;
    log_line(LogLevel::info, "projector: " + (monitor ? monitor->name : "none"));
    apply(studio);
    studio.window_must_move = true;
}

void read_monitors(Studio& studio) {
    studio.monitors = list_monitors(studio.desktop.get());
    // One that was there is found by its id alone: another of its kind is not it.
    if (studio.projector_was_there) return;
    const auto remembered = find_remembered_monitor(studio.monitors, studio.projector_monitor);
    if (!remembered) return;
    studio.projector_was_there = true;
    if (remembered->id != studio.projector_monitor) keep_projector(studio, remembered->id);
}

void monitors_changed(Studio& studio) {
    read_monitors(studio);
    for (const Monitor& m : studio.monitors) {
        log_line(LogLevel::info,
                 "monitor " + std::to_string(m.number) + ": " + m.name + " " +
                     std::to_string(m.width) + "x" + std::to_string(m.height) + " at " +
                     std::to_string(m.x) + "," + std::to_string(m.y));
    }
    studio.monitor_numbers.reset();
    if (studio.projector) studio.projector->monitors_changed();
    apply(studio);
    studio.window_must_move = true;
}

void check_projector_signal(Studio& studio) {
    studio.signal_warnings.clear();
    const auto usable = usable_monitor(studio);
    const auto monitor = usable ? find_monitor(studio.monitors, *usable) : std::nullopt;
    if (!monitor || !studio.desktop) return;
    glm::ivec2 calibrated_px{0};
    if (studio.setup && studio.setup->calibration) {
        calibrated_px = {studio.setup->view.width, studio.setup->view.height};
    }
    studio.signal_warnings = check_signal(*monitor, calibrated_px, *studio.desktop);
    for (const SignalWarning& warning : studio.signal_warnings) {
        const bool note = warning.severity == SignalWarning::Severity::note;
        log_line(note ? LogLevel::info : LogLevel::warning,
                 warning.what + " " + warning.cause + " " + warning.fix);
    }
}

void show_monitor_numbers(Studio& studio) {
    studio.monitor_numbers.reset();
    studio.monitor_numbers = std::make_unique<MonitorNumbers>(studio.monitors);
    studio.monitor_numbers_until_s = studio.now_s + kNumbersShown_s;
}

void show_instead(Studio& studio, ShownInstead instead) {
    studio.instead = std::move(instead);
    if (studio.results) studio.results->show_instead(studio.instead.picture);
}

void show_signal_test(Studio& studio, bool shown) {
    if (shown) show_panel(studio, "nudge", false);
    studio.signal_test_open = shown;
    if (!shown) return show_instead(studio, {});
    const auto monitor = find_monitor(studio.monitors, studio.projector_monitor);
    const Image8 picture =
        signal_test_picture(monitor ? monitor->width : 1280, monitor ? monitor->height : 800);
    show_instead(studio,
                 {projector_picture(picture, 0),
                  "",
                  {"showing the test picture",
                   ProjectorWords::Mood::warning,
                   "Projector > Test picture ends it."}});
}

ProjectorFacts projector_facts(const Studio& studio) {
    const ProjectorScreen& screen = *studio.projector;
    ProjectorFacts facts;
    facts.state = screen.state();
    if (facts.state == ProjectorScreen::State::waiting_for_monitor) {
        facts.why_waiting = screen.why_waiting();
    }
    facts.only_screen = studio.only_screen_is_projector;
    facts.black = studio.black;
    facts.frozen = studio.frozen;
    facts.monitor_numbers = studio.monitor_numbers != nullptr;
    facts.instead = studio.instead.words;
    facts.wanted = studio.frame_number;
    facts.shown = screen.shown().number;
    facts.waited_s = studio.now_s - studio.frame_asked_s;
    facts.other_product = studio.other_product;
    facts.not_drawn = studio.not_drawn;
    const auto newest = studio.results->newest_frame();
    if (facts.not_drawn.empty() && newest && newest->number == studio.frame_number) {
        facts.not_drawn = newest->problem;
    }
    return facts;
}

void set_black(Studio& studio, bool black) {
    studio.black = black;
    if (studio.projector) studio.projector->set_black(black);
    log_line(LogLevel::info, black ? "projector: black" : "projector: not black");
}

void set_frozen(Studio& studio, bool frozen) {
    studio.frozen = frozen;
    if (studio.projector) studio.projector->set_frozen(frozen);
    log_line(LogLevel::info, frozen ? "projector: frozen" : "projector: not frozen");
}

namespace {

void turn_black(Studio& studio) { set_black(studio, !studio.black); }
bool is_black(const Studio& studio) { return studio.black; }
void freeze(Studio& studio) { set_frozen(studio, !studio.frozen); }
bool is_frozen(const Studio& studio) { return studio.frozen; }
void test_signal(Studio& studio) { show_signal_test(studio, !studio.signal_test_open); }
bool is_testing(const Studio& studio) { return studio.signal_test_open; }

std::vector<Action> projector_actions() {
    const std::vector black{key(GLFW_KEY_B), ctrl(GLFW_KEY_B)};
    const std::vector frozen{key(GLFW_KEY_F), ctrl(GLFW_KEY_F)};
    const char *menu = "Projector", *numbers = "Show numbers on the monitors";
    return {in_dialogs({"black", menu, "Black", black, turn_black, {}, is_black}),
            in_dialogs({"freeze", menu, "Freeze", frozen, freeze, {}, is_frozen}),
            line_above({"monitor-numbers", menu, numbers, {}, show_monitor_numbers}),
            {"signal-test", menu, "Test picture for the signal", {}, test_signal, {}, is_testing}};
}

}  // namespace

Panel projector_panel() { return {.name = "projector", .actions = projector_actions}; }

}  // namespace livery
