#include "projection/window_keeper.h"

#include <array>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include <poll.h>
#include <xcb/randr.h>
#include <xcb/screensaver.h>
#include <xcb/xtest.h>

#include "core/log.h"
#include "projection/desktop_watch.h"
#include "projection/outputs.h"
#include "projection/session_bus.h"

namespace livery {

namespace {

/// Keeps the desktop's screensaver away while it lives, where a desktop offers that. Asks on a
/// thread of its own; construction returns at once.
class Awake {
  public:
    Awake();
    ~Awake();
    Awake(const Awake&) = delete;
    Awake& operator=(const Awake&) = delete;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

struct Awake::Implementation {
    std::mutex mutex;
    std::condition_variable changed;
    bool over = false;
    std::thread thread{[this] { run(); }};

    ~Implementation() {
        {
            const std::lock_guard lock(mutex);
            over = true;
        }
        changed.notify_one();
        thread.join();
    }

    void run() {
        try {
            const auto bus = SessionBus::connect();
            // Without a bus or an answer only the X server blanks screens, and it is told apart.
            const auto inhibition =
                bus ? bus->inhibit_screensaver("a projector is showing a mock-up") : std::nullopt;
            if (!inhibition) return;
            std::unique_lock lock(mutex);
            changed.wait(lock, [&] { return over; });
            lock.unlock();
            bus->allow_screensaver(*inhibition);
        } catch (const std::exception& error) {
            log_line(LogLevel::warning, std::string("keeping the screens on: ") + error.what());
        }
    }
};

Awake::Awake() : implementation_(std::make_unique<Implementation>()) {}

Awake::~Awake() = default;

/// How often a shown window comes to the top again; enough for whatever a person opens.
constexpr int kRaises = 50;

bool same_place(const Monitor& a, const Monitor& b) {
    return a.x == b.x && a.y == b.y && a.width == b.width && a.height == b.height;
}

}  // namespace

struct WindowKeeper::Implementation {
    const XConnection x;
    const std::shared_ptr<DesktopWatch> desktop;
    const xcb_window_t window;
    const xcb_window_t black_cover;  ///< a child of the window
    const Listener listener;
    const bool passes_grabs, has_screensaver;
    std::uint8_t randr_event = 0;

    // Of the keeper's thread.
    std::optional<Output> shown_on;
    std::optional<Awake> awake;
    int raises_left = 0;
    bool is_covered = false;

    mutable std::mutex mutex;
    std::condition_variable caught_up;
    std::optional<std::string> monitor_id;
    std::uint64_t asked = 0, answered = 0;
    bool quit = false, ended = false, cover_wanted = false;
    Place place;

    const Doorbell doorbell;
    std::thread thread;

    Implementation(xcb_window_t window_id, std::shared_ptr<DesktopWatch> watch, Listener listens)
        : desktop(std::move(watch)),
          window(window_id),
          black_cover(xcb_generate_id(x.get())),
          listener(std::move(listens)),
          passes_grabs(x.has(xcb_test_id)),
          has_screensaver(x.has(xcb_screensaver_id)) {
        if (!x.has(xcb_randr_id)) {
            throw std::runtime_error("the X server has no RandR, so nothing tells its monitors");
        }
        auto* c = x.get();
        randr_event = xcb_get_extension_data(c, &xcb_randr_id)->first_event;
        const XReply<xcb_randr_query_version_reply_t> version(
            xcb_randr_query_version_reply(c, xcb_randr_query_version(c, 1, 5), nullptr));
        const std::array<std::uint32_t, 3> values = {
            x.screen().black_pixel,
            1,  // override-redirect
            XCB_EVENT_MASK_EXPOSURE | XCB_EVENT_MASK_VISIBILITY_CHANGE};
        const auto changed = xcb_change_window_attributes_checked(
            c,
            window,
            XCB_CW_BACK_PIXEL | XCB_CW_OVERRIDE_REDIRECT | XCB_CW_EVENT_MASK,
            values.data());
        if (const XReply<xcb_generic_error_t> error{xcb_request_check(c, changed)}) {
            throw std::runtime_error("the projector's window cannot be kept: X error " +
                                     std::to_string(error->error_code));
        }
        constexpr std::uint16_t kLargest = 32767;  // of any window
        xcb_create_window(c,
                          XCB_COPY_FROM_PARENT,
                          black_cover,
                          window,
                          0,
                          0,
                          kLargest,
                          kLargest,
                          0,
                          XCB_WINDOW_CLASS_INPUT_OUTPUT,
                          XCB_COPY_FROM_PARENT,
                          XCB_CW_BACK_PIXEL,
                          values.data());
        const std::uint32_t yes = 1;
        xcb_change_property(c,
                            XCB_PROP_MODE_REPLACE,
                            window,
                            x.atom("_NET_WM_BYPASS_COMPOSITOR"),
                            XCB_ATOM_CARDINAL,
                            32,
                            1,
                            &yes);
        xcb_randr_select_input(c,
                               x.root(),
                               XCB_RANDR_NOTIFY_MASK_SCREEN_CHANGE |
                                   XCB_RANDR_NOTIFY_MASK_CRTC_CHANGE |
                                   XCB_RANDR_NOTIFY_MASK_OUTPUT_CHANGE);
        pass_grabs(true);
        x.synchronise();
        thread = std::thread([this] { run(); });
    }

    ~Implementation() {
        {
            const std::lock_guard lock(mutex);
            quit = true;
        }
        doorbell.ring();
        thread.join();
    }

    void pass_grabs(bool pass) const {
        if (passes_grabs) xcb_test_grab_control(x.get(), pass);
    }

    void hide() {
        if (!shown_on) return;
        xcb_unmap_window(x.get(), window);
        xcb_flush(x.get());
        shown_on.reset();
        if (has_screensaver) xcb_screensaver_suspend(x.get(), false);
        awake.reset();
    }

    void show(const Output& output) {
        const std::array<std::uint32_t, 5> values = {
            static_cast<std::uint32_t>(output.monitor.x),
            static_cast<std::uint32_t>(output.monitor.y),
            static_cast<std::uint32_t>(output.monitor.width),
            static_cast<std::uint32_t>(output.monitor.height),
            XCB_STACK_MODE_ABOVE};
        xcb_configure_window(x.get(),
                             window,
                             XCB_CONFIG_WINDOW_X | XCB_CONFIG_WINDOW_Y | XCB_CONFIG_WINDOW_WIDTH |
                                 XCB_CONFIG_WINDOW_HEIGHT | XCB_CONFIG_WINDOW_STACK_MODE,
                             values.data());
        xcb_map_window(x.get(), window);
        // The end of the connection would take this back, too.
        if (has_screensaver) xcb_screensaver_suspend(x.get(), true);
        x.synchronise();
        shown_on = output;
        awake.emplace();
        raises_left = kRaises;
    }

    void set_cover(bool cover) {
        if (cover) {
            xcb_map_window(x.get(), black_cover);
        } else {
            xcb_unmap_window(x.get(), black_cover);
        }
        x.synchronise();
        is_covered = cover;
        if (cover) listener.covered();
    }

    /// Another program's window came to lie on the picture: no window manager keeps it away, since
    /// none knows of ours.
    void raise_above_foreign_windows() {
        if (!is_covered_by_others(x, window, shown_on->monitor)) return;
        // A screen locker does the same: whoever insists may have the projector.
        if (raises_left == 0) return;
        if (--raises_left == 0) {
            log_line(LogLevel::warning, "another program keeps covering the projector's picture");
        }
        const std::uint32_t above = XCB_STACK_MODE_ABOVE;
        xcb_configure_window(x.get(), window, XCB_CONFIG_WINDOW_STACK_MODE, &above);
        xcb_flush(x.get());
    }

    /// Where the window belongs now, or why nowhere.
    std::optional<Output> wanted(const std::string& id, std::string& why_hidden) const {
        const auto outputs = read_outputs(x, desktop.get());
        const Output* found = nullptr;
        for (const auto& output : outputs) {
            if (output.monitor.id == id) found = &output;
        }
        if (!found) {
            why_hidden = "The projector is unplugged or switched off in the display settings.";
            return std::nullopt;
        }
        for (const auto& output : outputs) {
            if (&output != found && overlap(output.monitor, found->monitor)) {
                why_hidden = "The projector mirrors " + output.monitor.name +
                             "; set the displays to extend the desktop.";
                return std::nullopt;
            }
        }
        return *found;
    }

    /// Puts the window where it belongs.
    void settle() {
        std::optional<std::string> id;
        {
            const std::lock_guard lock(mutex);
            id = monitor_id;
        }
        std::string why_hidden;
        std::optional<Output> target = id ? wanted(*id, why_hidden) : std::nullopt;
        if (shown_on && target && same_place(shown_on->monitor, target->monitor)) {
            shown_on = target;
        } else {
            hide();
            if (target) {
                // Whoever holds the server may still be moving monitors: ask again when it is done.
                pass_grabs(false);
                target = wanted(*id, why_hidden);
                if (target) show(*target);
                pass_grabs(true);
            }
        }
        publish(std::move(why_hidden));
    }

    void publish(std::string why_hidden) {
        Place now;
        if (shown_on) {
            now.size_px = glm::ivec2(shown_on->monitor.width, shown_on->monitor.height);
        } else {
            now.why_hidden = std::move(why_hidden);
        }
        {
            const std::lock_guard lock(mutex);
            if (now.size_px == place.size_px && now.why_hidden == place.why_hidden) return;
            place = now;
        }
        listener.moved(now);
    }

    /// Hides at once where the event says that the window may now be on somebody's screen. True
    /// when settle() has to look.
    bool handle(const xcb_generic_event_t& event) {
        const unsigned type = event.response_type & 0x7Fu;
        if (type == XCB_EXPOSE) {
            const auto& expose = reinterpret_cast<const xcb_expose_event_t&>(event);
            if (expose.count == 0 && shown_on) listener.exposed();
            return false;
        }
        if (type == XCB_VISIBILITY_NOTIFY) {
            const auto& seen = reinterpret_cast<const xcb_visibility_notify_event_t&>(event);
            if (seen.state != XCB_VISIBILITY_UNOBSCURED && shown_on) raise_above_foreign_windows();
            return false;
        }
        if (type == randr_event + XCB_RANDR_SCREEN_CHANGE_NOTIFY) return true;
        if (type != static_cast<unsigned>(randr_event + XCB_RANDR_NOTIFY)) return false;
        const auto& notice = reinterpret_cast<const xcb_randr_notify_event_t&>(event);
        if (!shown_on) return true;
        if (notice.subCode == XCB_RANDR_NOTIFY_CRTC_CHANGE) {
            const auto& crtc = notice.u.cc;
            Monitor area;
            area.x = crtc.x;
            area.y = crtc.y;
            area.width = crtc.mode != 0 ? crtc.width : 0;
            area.height = crtc.mode != 0 ? crtc.height : 0;
            const bool harmless = crtc.crtc == shown_on->crtc ? same_place(area, shown_on->monitor)
                                                              : !overlap(area, shown_on->monitor);
            if (!harmless) hide();
        } else if (notice.subCode == XCB_RANDR_NOTIFY_OUTPUT_CHANGE) {
            const auto& output = notice.u.oc;
            if (output.output == shown_on->output &&
                (output.connection == XCB_RANDR_CONNECTION_DISCONNECTED ||
                 output.crtc != shown_on->crtc)) {
                hide();
            }
        }
        return true;
    }

    Place place_now() const {
        const std::lock_guard lock(mutex);
        return place;
    }

    void run() {
        try {
            for (;;) {
                std::uint64_t answering = 0;
                bool cover = false;
                {
                    const std::lock_guard lock(mutex);
                    if (quit) break;
                    answering = asked;
                    cover = cover_wanted;
                }
                if (cover != is_covered) set_cover(cover);
                bool look = answering != answered;
                // Before the events are taken: flushing reads, too, and what is read then does
                // not end poll() below.
                xcb_flush(x.get());
                while (const XReply<xcb_generic_event_t> event{xcb_poll_for_event(x.get())}) {
                    look = handle(*event) || look;
                }
                if (!x.is_alive()) throw std::runtime_error("the X server is gone");
                if (look) {
                    settle();
                    const std::lock_guard lock(mutex);
                    answered = answering;
                    caught_up.notify_all();
                    continue;  // reading replies may have queued events
                }
                std::array<pollfd, 2> sources = {
                    pollfd{xcb_get_file_descriptor(x.get()), POLLIN, 0},
                    pollfd{doorbell.descriptor(), POLLIN, 0}};
                ::poll(sources.data(), sources.size(), -1);
                doorbell.silence();
            }
            hide();
            x.synchronise();
        } catch (const std::exception& error) {
            log_line(LogLevel::error, std::string("the projector's window: ") + error.what());
        }
        const std::lock_guard lock(mutex);
        ended = true;
        caught_up.notify_all();
    }

    void ask_and_wait() {
        std::unique_lock lock(mutex);
        const std::uint64_t mine = ++asked;
        doorbell.ring();
        caught_up.wait(lock, [&] { return answered >= mine || ended; });
    }
};

WindowKeeper::WindowKeeper(std::uint32_t window,
                           std::shared_ptr<DesktopWatch> desktop,
                           Listener listener)
    : implementation_(
          std::make_unique<Implementation>(window, std::move(desktop), std::move(listener))) {}

WindowKeeper::~WindowKeeper() = default;

void WindowKeeper::follow(std::optional<std::string> monitor_id) {
    {
        const std::lock_guard lock(implementation_->mutex);
        implementation_->monitor_id = std::move(monitor_id);
    }
    implementation_->ask_and_wait();
}

void WindowKeeper::catch_up() { implementation_->ask_and_wait(); }

void WindowKeeper::cover(bool covered) {
    {
        const std::lock_guard lock(implementation_->mutex);
        implementation_->cover_wanted = covered;
    }
    implementation_->doorbell.ring();
}

WindowKeeper::Place WindowKeeper::place() const { return implementation_->place_now(); }

}  // namespace livery
