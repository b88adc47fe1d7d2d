#include "projection/projector_screen.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <span>
#include <thread>
#include <utility>

#include "core/log.h"
#include "gl/handles.h"
#include "gl/window.h"
#include "projection/window_keeper.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#define GLFW_EXPOSE_NATIVE_X11
#include <GLFW/glfw3native.h>

namespace livery {

namespace {

using Picture = std::shared_ptr<const ProjectorPicture>;
using Clock = std::chrono::steady_clock;

/// How long an unfinished picture may keep a newer picture or the end of the program waiting.
constexpr double kPatience_s = 0.004;
/// Between two steps of a picture that fades in, at least: where nothing waits for the projector.
constexpr auto kFadeStep = std::chrono::milliseconds(16);

/// Where a picture goes in the window: pixel for pixel, or as large as fits when the shape is the
/// window's, else in the middle.
PixelRect placed(glm::ivec2 picture_px, glm::ivec2 window_px) {
    constexpr double kSameShape = 0.01;
    const glm::dvec2 ratio = glm::dvec2(window_px) / glm::dvec2(picture_px);
    if (std::abs(ratio.x / ratio.y - 1.0) <= kSameShape) return {0, 0, window_px.x, window_px.y};
    const double scale = std::min({1.0, ratio.x, ratio.y});
    const glm::ivec2 size(static_cast<int>(std::lround(picture_px.x * scale)),
                          static_cast<int>(std::lround(picture_px.y * scale)));
    return {(window_px.x - size.x) / 2, (window_px.y - size.y) / 2, size.x, size.y};
}

std::unique_ptr<Window> hidden_window(const Window& share) {
    WindowOptions options;
    options.title = "Livery projector";
    options.visible = false;
    options.decorated = false;
    auto window = std::make_unique<Window>(options, &share);
    glfwSetInputMode(window->native(), GLFW_CURSOR, GLFW_CURSOR_HIDDEN);
    // Asks the server something, so that the window exists there before another connection names
    // it.
    int x = 0, y = 0;
    glfwGetWindowPos(window->native(), &x, &y);
    return window;
}

}  // namespace

struct ProjectorScreen::Implementation {
    const std::unique_ptr<Window> window;
    const std::function<void(const ShownPicture&)> on_shown;

    mutable std::mutex mutex;
    std::condition_variable changed;
    Picture newest, wanted;             ///< they differ while frozen
    std::vector<Picture> let_go;        ///< OpenGL objects: dropped where a context is current
    std::optional<glm::ivec2> size_px;  ///< of the window; none: hidden
    bool black = false, frozen = false, exposed = false, quit = false;
    std::optional<std::chrono::steady_clock::time_point> black_since;  ///< not told yet
    ShownPicture shown;

    bool following = false;   ///< main thread
    State told = State::off;  ///< main thread
    std::unique_ptr<WindowKeeper> keeper;
    std::thread thread;

    Implementation(const Window& share,
                   std::shared_ptr<DesktopWatch> desktop,
                   std::function<void(const ShownPicture&)> callback)
        : window(hidden_window(share)), on_shown(std::move(callback)) {
        keeper = std::make_unique<WindowKeeper>(
            static_cast<std::uint32_t>(glfwGetX11Window(window->native())),
            std::move(desktop),
            WindowKeeper::Listener{[this](const WindowKeeper::Place& place) { moved(place); },
                                   [this] { was_exposed(); },
                                   [this] { was_covered(); }});
        thread = std::thread([this] { run(); });
    }

    ~Implementation() {
        keeper.reset();
        {
            const std::lock_guard lock(mutex);
            quit = true;
        }
        changed.notify_one();
        thread.join();
    }

    void moved(const WindowKeeper::Place& place) {
        {
            const std::lock_guard lock(mutex);
            size_px = place.size_px;
            exposed = false;  // no longer, or not yet
        }
        wake_main_thread();
    }

    void was_exposed() {
        {
            const std::lock_guard lock(mutex);
            exposed = true;
        }
        changed.notify_one();
    }

    void was_covered() {
        {
            const std::lock_guard lock(mutex);
            black_since = std::chrono::steady_clock::now();
        }
        changed.notify_one();
    }

    void present(Picture picture) {
        {
            const std::lock_guard lock(mutex);
            let_go.push_back(std::exchange(newest, std::move(picture)));
            if (!frozen) let_go.push_back(std::exchange(wanted, newest));
        }
        changed.notify_one();
    }

    void set_frozen(bool on) {
        {
            const std::lock_guard lock(mutex);
            frozen = on;
            if (!frozen) let_go.push_back(std::exchange(wanted, newest));
        }
        changed.notify_one();
    }

    State state() const {
        if (!following) return State::off;
        const std::lock_guard lock(mutex);
        return size_px ? State::showing : State::waiting_for_monitor;
    }

    void run() {
        try {
            window->make_current();
            glfwSwapInterval(1);
            draw_until_quit();
        } catch (const std::exception& error) {
            log_line(LogLevel::error, std::string("the projector's picture: ") + error.what());
        }
        {
            const std::lock_guard lock(mutex);
            let_go.clear();
            newest.reset();
            wanted.reset();
        }
        window->release();
    }

    /// What the projector's thread knows about its window's content.
    struct Canvas {
        WindowBlit blit;
        glm::ivec2 window_px{0};  ///< of the last frame
        Picture drawn;
        Fence read;  ///< reached when the device has read `drawn` and `coming`

        PictureFade fade;
        Picture coming;  ///< takes the place of `drawn` little by little; none: it is alone
        Clock::time_point began{}, stepped{};

        /// Whether a picture should fade in over the one that is there.
        bool fades_to(const Picture& next) const {
            return next && drawn && next != drawn && next->fade_s > 0.0 &&
                   next->size_px == drawn->size_px;
        }
    };

    void draw_until_quit() {
        Canvas canvas;
        while (auto next = wait_for_work(canvas)) {
            try {
                draw(*next, canvas);
            } catch (const std::exception& error) {
                log_line(LogLevel::error, std::string("the projector's picture: ") + error.what());
                canvas.drawn = next->picture;  // not again and again
            }
        }
        canvas.read.wait_for(1.0);
    }

    struct Work {
        glm::ivec2 window_px{0};
        Picture picture;
        bool exposed = false;  ///< draw something, even if the picture is not finished yet
    };

    /// Nothing: the end. Under the black nothing is drawn; its end exposes the window.
    std::optional<Work> wait_for_work(const Canvas& canvas) {
        for (;;) {
            std::vector<Picture>
                finished_with;  // dropped after the lock: a driver may take a while
            std::unique_lock lock(mutex);
            // What fades in is seen to its end, unless something else than a better picture comes
            const auto must_draw = [&] {
                if (!size_px || black) return false;
                if (exposed || (canvas.coming && !canvas.fades_to(wanted))) return true;
                return canvas.coming ? Clock::now() >= canvas.stepped + kFadeStep
                                     : canvas.drawn != wanted;
            };
            const auto woken = [&] {
                return quit || !let_go.empty() || black_since || must_draw();
            };
            if (canvas.coming && size_px && !black) {
                changed.wait_until(lock, canvas.stepped + kFadeStep, woken);
            } else {
                changed.wait(lock, woken);
            }
            if (quit) return std::nullopt;
            finished_with.swap(let_go);
            if (const auto since = std::exchange(black_since, std::nullopt)) {
                shown.number = 0;
                shown.at = *since;
                tell_shown(lock);
            } else if (must_draw()) {
                return Work{*size_px, wanted, std::exchange(exposed, false)};
            }
            if (lock.owns_lock()) lock.unlock();
        }
    }

    void tell_shown(std::unique_lock<std::mutex>& lock) const {
        const ShownPicture now = shown;
        lock.unlock();
        if (on_shown) on_shown(now);
    }

    /// What is due of a fade: true while it goes on, with the mix of both drawn.
    bool draw_fade(const Work& work, Canvas& canvas) {
        const auto now = Clock::now();
        if (!canvas.coming) {
            if (!canvas.fades_to(work.picture)) return false;
            if (!work.picture->ready || work.picture->ready->wait_for(kPatience_s)) {
                canvas.coming = work.picture;
                canvas.began = now;
            } else if (!work.exposed) {
                return true;
            }
        }
        if (!canvas.coming || !canvas.fades_to(work.picture)) {
            canvas.coming.reset();
            return false;
        }
        canvas.stepped = now;
        const double share =
            std::chrono::duration<double>(now - canvas.began).count() / canvas.coming->fade_s;
        if (share >= 1.0) return false;
        const glm::ivec2 picture_px = canvas.coming->size_px;
        const unsigned mixed = canvas.fade.between(
            canvas.drawn->texture, canvas.coming->texture, static_cast<float>(share), picture_px);
        canvas.blit.show(mixed, picture_px, placed(picture_px, work.window_px), work.window_px);
        window->swap();
        canvas.read.wait_for(1.0);
        canvas.read = Fence::after_everything_so_far();
        const std::lock_guard lock(mutex);
        ++shown.frames;
        return true;
    }

    void draw(const Work& work, Canvas& canvas) {
        if (std::exchange(canvas.window_px, work.window_px) != work.window_px) {
            // Mesa's software renderer learns of a window's new size when it swaps: the frame
            // before is drawn in the old size, and partly or wholly outside.
            canvas.blit.black(work.window_px);
            window->swap();
        }
        if (draw_fade(work, canvas)) return;
        Picture next = canvas.coming ? std::exchange(canvas.coming, nullptr) : work.picture;
        if (next && next != canvas.drawn && next->ready && !next->ready->wait_for(kPatience_s)) {
            if (!work.exposed) return;
            next = canvas.drawn;
        }
        if (next) {
            canvas.blit.show(next->texture,
                             next->size_px,
                             placed(next->size_px, work.window_px),
                             work.window_px);
        } else {
            canvas.blit.black(work.window_px);
        }
        window->swap();
        const auto at = Clock::now();
        // Whoever made the old picture may draw into it again once it is let go.
        canvas.read.wait_for(1.0);
        canvas.read = Fence::after_everything_so_far();
        canvas.drawn = std::move(next);

        std::unique_lock lock(mutex);
        ++shown.frames;
        if (black) return;  // it went under
        shown.number = canvas.drawn ? canvas.drawn->number : 0;
        shown.at = at;
        tell_shown(lock);
    }
};

ProjectorScreen::ProjectorScreen(const Window& share,
                                 std::shared_ptr<DesktopWatch> desktop,
                                 std::function<void(const ShownPicture&)> on_shown)
    : implementation_(
          std::make_unique<Implementation>(share, std::move(desktop), std::move(on_shown))) {}

ProjectorScreen::~ProjectorScreen() = default;

void ProjectorScreen::use_monitor(const std::optional<std::string>& monitor_id) {
    auto& self = *implementation_;
    self.following = monitor_id.has_value();
    self.keeper->follow(monitor_id);
    self.told = self.state();
}

bool ProjectorScreen::monitors_changed() {
    auto& self = *implementation_;
    self.keeper->catch_up();
    return std::exchange(self.told, self.state()) != self.told;
}

ProjectorScreen::State ProjectorScreen::state() const { return implementation_->state(); }

std::string ProjectorScreen::why_waiting() const {
    return implementation_->keeper->place().why_hidden;
}

void ProjectorScreen::present(std::shared_ptr<const ProjectorPicture> picture) {
    implementation_->present(std::move(picture));
}

void ProjectorScreen::set_black(bool black) {
    auto& self = *implementation_;
    {
        const std::lock_guard lock(self.mutex);
        self.black = black;
    }
    self.keeper->cover(black);
    self.changed.notify_one();
}

void ProjectorScreen::set_frozen(bool frozen) { implementation_->set_frozen(frozen); }

bool ProjectorScreen::is_black() const {
    const std::lock_guard lock(implementation_->mutex);
    return implementation_->black;
}

bool ProjectorScreen::is_frozen() const {
    const std::lock_guard lock(implementation_->mutex);
    return implementation_->frozen;
}

ShownPicture ProjectorScreen::shown() const {
    const std::lock_guard lock(implementation_->mutex);
    return implementation_->shown;
}

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kBetweenLooks = std::chrono::milliseconds(2);
constexpr auto kUnusuallyLong = std::chrono::milliseconds(1500);
constexpr auto kTwoRefreshes = std::chrono::milliseconds(34);

}  // namespace

std::uint64_t next_picture_number() {
    static std::atomic<std::uint64_t> number{std::uint64_t{1} << 48u};
    return ++number;
}

std::shared_ptr<const ProjectorPicture> projector_picture(const Image8& rgb, std::uint64_t number) {
    Image8 rgba(rgb.width, rgb.height, 4, 255);
    for (std::size_t i = 0; i < rgb.pixel_count(); ++i)
        std::copy_n(&rgb.values[3 * i], 3, &rgba.values[4 * i]);
    const auto texture = std::make_shared<Texture2D>(rgb.width, rgb.height, TexelFormat::rgba8);
    texture->upload(std::span<const std::uint8_t>(rgba.values));
    auto picture = std::make_shared<ProjectorPicture>();
    picture->number = number;
    picture->texture = texture->name();
    picture->size_px = {rgb.width, rgb.height};
    picture->ready = std::make_shared<const Fence>(Fence::after_everything_so_far());
    picture->owner = texture;
    return picture;
}

ShowPicture show_on(ProjectorAccess projector, const Progress& progress, TellWait on_wait) {
    return [projector = std::move(projector), progress, on_wait = std::move(on_wait)](
               const Image8& drive) {
        const auto picture = projector_picture(drive, next_picture_number());
        projector.present(picture);
        const auto start = Clock::now();
        bool told = false;
        while (projector.shown().number != picture->number) {
            progress.check_stop();
            if (!told && Clock::now() - start > kUnusuallyLong) {
                told = true;
                on_wait({"the projector does not show the picture",
                         "check its cable and that it is chosen, not black and not frozen"});
            }
            std::this_thread::sleep_for(kBetweenLooks);
        }
        if (told) on_wait({});
        std::this_thread::sleep_for(kTwoRefreshes);
    };
}

}  // namespace livery
