#include "studio/window/app.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <future>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <imgui.h>
#include <imgui_internal.h>

#include "core/log.h"
#include "core/memory.h"
#include "core/paths.h"
#include "projection/desktop_watch.h"
#include "scene/library.h"
#include "studio/drawing.h"
#include "studio/kit/running_window.h"
#include "studio/presenting/presenting.h"
#include "studio/product/new_session.h"
#include "studio/studio.h"
#include "studio/window/glfw_window.h"
#include "studio/window/imgui_window.h"
#include "studio/window/layout.h"

namespace livery {

namespace {

/// Keeps a projector dark while one session's window goes and the next one's comes.
struct DarkProjector {
    Window context;
    ProjectorScreen screen;

    DarkProjector(const std::string& monitor, std::shared_ptr<DesktopWatch> desktop)
        : context({"Livery (dark)", {16, 16}, false, true}), screen(context, std::move(desktop)) {
        screen.set_black(true);
        screen.use_monitor(monitor);
        screen.monitors_changed();
    }
};

/// What one session's window hands to the next one's.
struct Handover {
    std::shared_ptr<OpenedSession> opened;
    std::unique_ptr<DarkProjector> dark;  ///< none: there was no projector
    std::shared_ptr<Trace> trace;         ///< shared as in the studio
    std::shared_ptr<DesktopWatch> desktop;
    bool black = false;                 ///< it was so before
    ImGuiWindow::HandedOut handed_out;  ///< counts go on: who drives the program waits for them
    int frames_drawn = 0;
};

// Dear ImGui settles within this many frames after an input.
constexpr int kFramesAfterInput = 3;
constexpr double kShortestFrame_s = 1.0 / 60.0;
constexpr double kLongestFrame_s = 0.1;  // While input comes in faster than it can be drawn.
constexpr double kLongestOpening_s = 1.2;
// What waits for the opening's end loads libraries, which holds up every thread that draws.
constexpr double kOnItsWayToTheScreen_s = 0.15;
constexpr double kGiveWay_s = 0.004;

// Set by GLFW's callbacks, which carry no pointer, and by the desktop's watch.
std::atomic<bool> monitors_have_changed{false};
std::vector<std::filesystem::path> dropped_files;

std::filesystem::path session_file(const DesktopOptions& options) {
    return options.session.empty() ? default_session_file() : options.session;
}

Session open_session(const DesktopOptions& options) {
    const auto file = session_file(options);
    const std::string product = options.product.empty() ? "car" : options.product;
    const auto unit = options.new_product.empty() ? options.unit : std::nullopt;
    try {
        Session session = Session::open(file, product, unit);
        if (!options.product.empty() && session.document().product != product_reference(product)) {
            throw Refused(fmt::format("the session {} shows the product {}, not {}",
                                      file.string(),
                                      session.document().product,
                                      options.product),
                          "name another file with --session, which will be made");
        }
        return session;
    } catch (const FileError& error) {
        log_line(LogLevel::error, std::string("session: ") + error.what());
        return Session::unsaved(new_document(product, unit), error.what());
    }
}

void tell_product_notes(Studio& studio) {
    std::string notes;
    for (const std::string& note : studio.product->notes) {
        notes += (notes.empty() ? "" : "\n") + note;
    }
    if (notes.empty()) return;
    tell_warning(studio, "The product's file was not used as it is:", notes);
}

void tell_drawing_problems(Studio& studio) {
    for (const std::string& problem : drawing_problems(studio.session.document())) {
        tell_warning(
            studio,
            problem,
            "",
            "Put the file back, or choose another; then change something to draw it again.");
    }
}

/// The earliest moment at which something on the window changes by itself.
std::optional<double> next_change_s(Studio& studio) {
    std::optional<double> next;
    const auto consider = [&](double when_s) {
        if (when_s > 0.0 && (!next || when_s < *next)) next = when_s;
    };
    for (const Notice& notice : studio.notices) consider(notice.shown_until_s);
    consider(studio.layout_rests_at_s);
    if (studio.glowing_part) consider(studio.glowing_until_s);
    if (studio.monitor_numbers) consider(studio.monitor_numbers_until_s);
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    if (g.HoveredId != 0 && g.HoveredIdTimer < kTooltipAfter_s) {
        consider(studio.now_s + static_cast<double>(kTooltipAfter_s - g.HoveredIdTimer) + 0.02);
    }
    if (studio.save_again_at_s > 0.0) consider(studio.save_again_at_s);
    consider(next_refinement_s(studio));
    for (const Panel& panel : all_panels()) {
        if (panel.next_change_s) consider(panel.next_change_s(studio));
    }
    if (studio.opening) consider(studio.now_s + kOnItsWayToTheScreen_s);
    if (studio.preview_waits_until_s > 0.0) consider(studio.preview_waits_until_s);
    if (studio.preview) {
        const auto behind_since = behind_since_s(studio.preview_lag, studio.preview->number);
        const double told_s = behind_since.value_or(0.0) + kTellsLag_s;
        if (behind_since && told_s > studio.now_s) consider(told_s);
    }
    const double spoken_of_s = studio.frame_asked_s + kUnspokenWait_s;
    if (spoken_of_s > studio.now_s) consider(spoken_of_s);
    // A blinking text cursor.
    if (ImGui::GetIO().WantTextInput) consider(studio.now_s + 0.4);
    // Progress is read, not told.
    if (studio.frames->solving()) consider(studio.now_s + kProgress_s);
    return next;
}

class Desktop {
  public:
    Desktop(const DesktopOptions& options, Session session)
        : options_(options), studio_(std::move(session)) {
        studio_.desktop = std::make_shared<DesktopWatch>(is_xwayland(), [] {
            monitors_have_changed = true;
            wake_main_thread();
        });
        // Beside the making of windows, which takes as long.
        const Document& document = studio_.session.document();
        product_ =
            std::async(std::launch::async, [name = document.product, unit = document.product_unit] {
                return find_product(name, unit);
            });
    }

    Desktop(const DesktopOptions& options, Handover before)
        : options_(options),
          dark_(std::move(before.dark)),
          studio_(std::move(before.opened->session)) {
        std::promise<std::shared_ptr<const Product>> read;
        read.set_value(before.opened->product);
        product_ = read.get_future();
        studio_.trace = std::move(before.trace);
        studio_.desktop = std::move(before.desktop);
        studio_.black = before.black;
        handed_out_before_ = before.handed_out;
        frames_drawn_ = before.frames_drawn;
    }

    /// What to go on with; nothing: the program ends.
    std::optional<Handover> run() {
        prepare();
        while (!studio_.next_session && !ends()) {
            wait_for_something();
            draw_frame();
        }
        std::optional<Handover> next;
        if (studio_.next_session && !studio_.quit) next = hand_over();
        finish();
        return next;
    }

  private:
    bool ends() {
        if (glfwWindowShouldClose(window_->native())) {
            glfwSetWindowShouldClose(window_->native(), GLFW_FALSE);
            studio_.quit = true;
        }
        if (studio_.quit && !may_quit(studio_)) studio_.quit = false;
        return studio_.quit;
    }

    void prepare() {
        Studio& studio = studio_;
        if (!options_.trace.empty()) studio_.trace = std::make_shared<Trace>(options_.trace);
        if (!options_.ui_map.empty()) ui_map_.emplace(options_.ui_map);
        studio_.fixed_scale = options_.ui_scale;
        studio.settings = read_user_settings();
        restore_workspace(studio_);
        read_monitors(studio_);
        const WindowPlace place = first_place(studio_, options_.size_px);
        WindowOptions window_options;
        window_options.size_px = place.size_px;
        window_options.visible = false;
        window_ = std::make_unique<Window>(window_options);
        studio_.window = window_.get();
        put_window(window_->native(), place);
        window_->make_current();
        glfwSwapInterval(0);
        log_line(LogLevel::info, "drawing with " + window_->renderer());
        imgui_ = std::make_unique<ImGuiWindow>(*window_, handed_out_before_);
        glfwSetMonitorCallback([](GLFWmonitor*, int) { monitors_have_changed = true; });
        glfwSetDropCallback(window_->native(), [](GLFWwindow*, int count, const char** paths) {
            dropped_files.assign(paths, paths + count);
        });
        studio.product = product_.get();
        studio_.product_bounds = bounds_of(studio.product->mesh);
        studio.picker = std::make_unique<PartPicker>(studio.product);
        studio.file_dialog = std::make_unique<FileDialog>(studio.settings);
        // What is told before the first frame is shown for as long as the rest.
        studio.now_s = now_s();
        keep_shown_looks_valid(studio);
        contexts_ = start_threads(studio_, *window_, options_.shading);
        if (studio_.black) set_black(studio_, true);
        tell_product_notes(studio);
        tell_drawing_problems(studio);
        tell_unsaved(studio_);
        monitors_changed(studio_);
        glfwShowWindow(window_->native());
        if (const auto file = studio.session.file()) {
            remember_recent_session(studio.settings, *file);
            running_window_.emplace(*file, [this] {
                asked_for_ = true;
                wake_main_thread();
            });
        }
        if (!options_.new_product.empty())
            begin_new_session(studio_, options_.new_product, options_.new_session, options_.unit);
        frames_to_draw_ = kFramesAfterInput;
    }

    /// The next session's window stands where this one does, with the same projector.
    Handover hand_over() {
        Handover next;
        next.opened = std::move(studio_.next_session);
        next.trace = studio_.trace;
        next.desktop = studio_.desktop;
        next.black = studio_.black;
        next.handed_out = imgui_->handed_out();
        next.frames_drawn = frames_drawn_;
        Session& session = next.opened->session;
        session.set_workspace(kWindowKey, text_of(place_of(window_->native())));
        session.set_workspace(kMonitorKey, studio_.projector_monitor);
        if (studio_.projector->state() == ProjectorScreen::State::showing) {
            next.dark = std::make_unique<DarkProjector>(studio_.projector_monitor, next.desktop);
        }
        log_line(LogLevel::info, "goes on with " + session.file().value_or("").string());
        return next;
    }

    void wait_for_something() {
        if (frames_to_draw_ > 0 || imgui_->has_input()) {
            // Not faster than a screen can show; input comes in while waiting.
            double rest = last_drawn_s_ + kShortestFrame_s - now_s();
            // Whoever is given way to has this processor as well.
            if (std::exchange(gave_way_, false)) rest = std::max(rest, kGiveWay_s);
            if (rest > 0.0 && !imgui_->has_input()) {
                glfwWaitEventsTimeout(rest);
            } else {
                glfwPollEvents();
            }
        } else if (const auto next = next_change_s(studio_)) {
            glfwWaitEventsTimeout(std::max(0.001, *next - now_s()));
            frames_to_draw_ = 1;
        } else {
            glfwWaitEvents();
            frames_to_draw_ = 1;  // A thread's result; input adds its own below.
        }
        if (imgui_->has_input()) frames_to_draw_ = kFramesAfterInput;
        if (!imgui_->has_input()) {
            auto places = places_of_monitors();
            if (places != monitor_places_) monitors_have_changed = true;
            monitor_places_ = std::move(places);
        }
        if (monitors_have_changed.exchange(false)) {
            monitors_changed(studio_);
            frames_to_draw_ = kFramesAfterInput;
        }
        if (!dropped_files.empty()) {
            auto files = std::exchange(dropped_files, {});
            if (!refuse_editing(studio_)) take_dropped_files(studio_, std::move(files));
            frames_to_draw_ = kFramesAfterInput;
        }
    }

    void draw_frame() {
        Studio& studio = studio_;
        const double start_s = now_s();
        studio.now_s = start_s;
        GLFWwindow* native = window_->native();
        studio.ui_scale = static_cast<float>(studio_.fixed_scale.value_or(
            screen_scale(native, studio.monitors) * studio_.user_scale));
        imgui_->use_scale(studio.ui_scale);
        limit_size();
        if (asked_for_.exchange(false)) come_to_the_front();
        const auto frame_before = studio.frame;  // Until this frame is drawn: textures are read.
        const auto preview_before = studio.preview;
        take_results(studio_);
        if (studio.opening && has_opened()) {
            studio.opening = false;
            dark_.reset();
            give_icon(studio, native);
        }
        save_again_now_and_then(studio_);
        if (studio_.monitor_numbers && studio.now_s >= studio_.monitor_numbers_until_s) {
            studio_.monitor_numbers.reset();
        }
        const std::uint64_t revision_before = studio.session.revision();
        begin_trials(studio);
        start_naming_items(ui_map_.has_value());
        const bool had_input = imgui_->has_input();
        studio_.input_at = imgui_->begin_frame(
            [this](const InputEvent& event) { return handle_key(studio_, event); });
        if (had_input) {
            studio_.trace->write("input", 0, {}, studio_.input_at);
            tell_unrest();
        }
        draw_everything();
        end_trials(studio);
        if (const int step = std::exchange(studio_.tab_step, 0)) move_focus(step);
        imgui_->end_frame();
        if (studio.session.revision() != revision_before) {
            studio_.trace->write("commit", studio.session.revision());
            frames_to_draw_ = std::max(frames_to_draw_, 2);
        }
        // Before anything is drawn here: the mock-up comes first.
        // The program was started with a mesh: what stands behind its page may never be wanted.
        const bool only_page = is_open(studio, "new-session") && !studio.asked_frame;
        ask_for_changes(studio_, !only_page);
        // Input that waits is taken first, so that it does not wait for pictures of what was
        // before.
        // Where one processor draws everything, the mock-up has it first.
        const bool mock_up_first = studio_.draws_in_software && !preview_goes_first(studio_) &&
                                   (studio.opening || is_frame_under_way(studio_));
        const bool patient = last_drawn_s_ == 0.0 ? studio.opening && !studio.frame
                                                  : start_s - last_drawn_s_ < kLongestFrame_s;
        gave_way_ = (imgui_->has_input() || mock_up_first) && patient;
        if (gave_way_) return;
        imgui_->draw();
        --frames_to_draw_;
        last_drawn_s_ = now_s();
        studio_.frame_ms = 1000.0 * (last_drawn_s_ - start_s);
        if (studio_.window_must_move) move_off_projector(studio_, native);
        remember_workspace(studio_, text_of(place_of(native)), false);
        write_ui_map();
    }

    /// Nothing overlaps in the least size; a screen that is smaller than that sets its own.
    void limit_size() {
        GLFWwindow* native = window_->native();
        const glm::ivec2 position = place_of(native).position;
        glm::ivec2 least(glm::vec2(kLeastSize_px) * studio_.ui_scale);
        for (const Monitor& m : studio_.monitors) {
            const bool here = position.x >= m.x && position.y >= m.y &&
                              position.x < m.x + m.width && position.y < m.y + m.height;
            if (here) least = glm::min(least, glm::ivec2(m.width, m.height));
        }
        if (std::exchange(least_size_px_, least) == least) return;
        glfwSetWindowSizeLimits(native, least.x, least.y, GLFW_DONT_CARE, GLFW_DONT_CARE);
    }

    /// The program was started again on this session.
    void come_to_the_front() {
        GLFWwindow* native = window_->native();
        if (glfwGetWindowAttrib(native, GLFW_ICONIFIED) != 0) glfwRestoreWindow(native);
        glfwFocusWindow(native);
        // For a window manager that does not let windows come to the front by themselves.
        if (glfwGetWindowAttrib(native, GLFW_FOCUSED) == 0) glfwRequestWindowAttention(native);
        log_line(LogLevel::info, "the window was asked for by another start");
    }

    /// The mock-up's first picture is on the projector, or takes too long.
    bool has_opened() const {
        const Studio& studio = studio_;
        if (preview_goes_first(studio_)) return false;
        const double limit_s = studio_.opened_s + kLongestOpening_s;
        if (!studio.frame) return studio.now_s >= limit_s;
        const double shown_s = seconds_of(studio.frame->done_at) + kOnItsWayToTheScreen_s;
        return studio.now_s >= std::min(limit_s, shown_s);
    }

    void draw_everything() {
        draw_layout(studio_);
        draw_notices(studio_);
        for (const Panel& panel : all_panels()) {
            if (panel.place == PanelPlace::page) panel.draw(studio_);
        }
        studio_.file_dialog->draw();
        if (!studio_.file_dialog->is_open()) draw_question(studio_.question);
    }

    void write_ui_map() {
        if (!ui_map_) return;
        const WindowPlace place = place_of(window_->native());
        MapState state = state_of_window(studio_);
        state["clicks"] = std::to_string(imgui_->handed_out().clicks);
        state["notches"] = std::to_string(imgui_->handed_out().notches);
        state["keys"] = std::to_string(imgui_->handed_out().keys);
        state["frame"] = std::to_string(++frames_drawn_);
        state["at_rest"] = frames_to_draw_ <= 0 && !imgui_->has_input() ? "true" : "false";
        mapped_ = {take_named_items(),
                   state,
                   {place.position.x, place.position.y, place.size_px.x, place.size_px.y}};
        ui_map_->update(mapped_.items, mapped_.state, mapped_.window);
    }

    /// Before the mock-up answers to input, so that nobody takes the map for what came of it.
    void tell_unrest() {
        if (!ui_map_ || mapped_.state.empty()) return;
        mapped_.state["at_rest"] = "false";
        ui_map_->update(mapped_.items, mapped_.state, mapped_.window);
    }

    void finish() {
        log_line(LogLevel::info, "closing");
        running_window_.reset();
        remember_workspace(studio_, text_of(place_of(window_->native())), true);
        glfwSetMonitorCallback(nullptr);
        glfwHideWindow(window_->native());
        window_->make_current();
        studio_.monitor_numbers.reset();
        stop_threads(studio_);
        studio_.stage.photograph_texture = {};
        studio_.panels.clear();  // their textures go
        imgui_.reset();
    }

    DesktopOptions options_;
    std::unique_ptr<DarkProjector> dark_;  ///< until the mock-up has its first picture
    std::future<std::shared_ptr<const Product>> product_;
    std::unique_ptr<Window> window_;
    Contexts contexts_;
    std::unique_ptr<ImGuiWindow> imgui_;
    Studio studio_;
    std::optional<UiMapFile> ui_map_;
    struct Mapped {
        ItemPlaces items;
        MapState state;
        ItemPlace window;
    };
    Mapped mapped_;  ///< as last written
    glm::ivec2 least_size_px_{0};
    std::atomic<bool> asked_for_{false};  ///< by another start
    std::optional<RunningWindow> running_window_;
    ImGuiWindow::HandedOut handed_out_before_;
    int frames_drawn_ = 0;
    int frames_to_draw_ = 0;
    std::vector<std::array<int, 4>> monitor_places_;
    double last_drawn_s_ = 0.0;
    bool gave_way_ = false;  ///< the last frame of the window was not drawn
};

}  // namespace

/// The session, or nothing where another start has it open and has shown its window.
std::optional<Session> session_or_running_window(const DesktopOptions& options) {
    try {
        return open_session(options);
    } catch (const Refused& refused) {
        if (!options.new_product.empty()) {
            throw Refused(refused.why(),
                          "drop " + options.new_product.filename().string() +
                              " on its window, or name a session with --session");
        }
        if (!ask_running_window(session_file(options))) throw;
        log_line(LogLevel::info, "the session is open already; its window was asked for");
        return std::nullopt;
    }
}

int run_desktop(const DesktopOptions& options) {
    keep_large_blocks_apart();
    // Everything is saved as it happens, so Ctrl-C in the terminal may end the program at once.
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    const WindowSystem window_system;
    open_log(user_folder() / "log" / "livery.log");
    log_line(LogLevel::info, "Livery " LIVERY_VERSION " opens");
    auto session = session_or_running_window(options);
    if (!session) return 0;
    auto next = Desktop(options, std::move(*session)).run();
    DesktopOptions later = options;
    later.size_px.reset();  // as the window was left
    later.new_product.clear();
    later.trace.clear();  // handed over
    while (next) next = Desktop(later, std::move(*next)).run();
    return 0;
}

}  // namespace livery
