#include "ledger/desktop_times.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "appearance/material_library.h"
#include "core/error.h"
#include "core/random.h"
#include "jobs/calibrate/bench_calibration.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/synthetic_calibration.h"
#include "live/frame_thread.h"
#include "live/low_priority.h"
#include "radiance/renderer.h"
#include "scene/library.h"
#include "session/session.h"
#include "twin/description.h"

namespace livery {

namespace {

using Clock = std::chrono::steady_clock;
using FramePointer = std::shared_ptr<const FinishedFrame>;

double milliseconds(Clock::duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}

/// A folder of this run's own, gone with the object.
class ScratchFolder {
  public:
    ScratchFolder() {
        std::string name =
            (std::filesystem::temp_directory_path() / "livery-bench-XXXXXX").string();
        if (!::mkdtemp(name.data())) {
            throw FileError(name, "", "no folder can be made", "a writable folder TMPDIR");
        }
        path_ = name;
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    std::filesystem::path operator/(const char* name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

/// Three contexts that share, as the desktop's windows and lanes do.
struct Contexts {
    explicit Contexts(GlDevice device)
        : window(device), front(device, &window), back(device, &window) {
        for (HeadlessContext* context : {&window, &front, &back}) context->release();
    }
    HeadlessContext window, front, back;
};

/// The newest finished frame, waited for.
class Finished {
  public:
    void add(FramePointer frame) {
        const std::scoped_lock lock(mutex_);
        newest_ = std::move(frame);
        changed_.notify_all();
    }
    /// Of this number or a later one, and as it is `wanted`. Throws what the frame's problem says.
    FramePointer wait_for(
        std::uint64_t number,
        const Progress& progress,
        const std::function<bool(const FinishedFrame&)>& wanted = [](const FinishedFrame&) {
            return true;
        }) {
        std::unique_lock lock(mutex_);
        while (!newest_ || newest_->number < number ||
               (newest_->problem.empty() && !wanted(*newest_))) {
            progress.check_stop();
            changed_.wait_for(lock, std::chrono::milliseconds(200));
        }
        if (!newest_->problem.empty()) throw std::runtime_error(newest_->problem);
        return newest_;
    }

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    FramePointer newest_;
};

/// Work that repeats on a thread that gives way, from now until the object ends.
class BackgroundWork {
  public:
    BackgroundWork(int at_least, std::function<void(const Progress&)> work) : least_(at_least) {
        if (!work) return;
        thread_ = std::thread([this, work = std::move(work)] {
            lower_priority_of_this_thread(Urgency::background);
            try {
                while (!stop_) {
                    work(Progress{{}, &stop_});
                    ++done_;
                }
            } catch (const Cancelled&) {
            } catch (...) {
                error_ = std::current_exception();
                failed_ = true;
            }
        });
    }
    ~BackgroundWork() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
    }
    BackgroundWork(const BackgroundWork&) = delete;
    BackgroundWork& operator=(const BackgroundWork&) = delete;
    bool done_enough() const {
        if (failed_) std::rethrow_exception(error_);
        return !thread_.joinable() || done_ >= least_;
    }

  private:
    int least_;
    std::atomic<bool> stop_{false}, failed_{false};
    std::atomic<int> done_{0};
    std::exception_ptr error_;
    std::thread thread_;
};

/// The session, the frame thread and what they draw: the desktop less its windows.
struct MeasuredDesktop {
    std::shared_ptr<const Product> product;
    std::shared_ptr<const ProjectorSetup> setup;
    Session session;
    Contexts contexts;
    Finished finished;
    FrameThread thread;
    std::uint64_t number = 0;

    MeasuredDesktop(GlDevice device,
                    const std::filesystem::path& session_file,
                    const std::filesystem::path& calibration)
        : product(find_product("car")),
          setup(load_setup(calibration, 20.0, product->mesh)),
          session(Session::open(session_file)),
          contexts(device),
          thread(contexts.front, contexts.back, [this](FramePointer frame) {
              finished.add(std::move(frame));
          }) {}

    int look() const { return session.document().looks.front().id; }
    /// Asks for a scene's frame; its number.
    std::uint64_t show(const Scene& scene, Clock::time_point asked_at) {
        FrameDescription frame;
        frame.number = ++number;
        frame.scene = scene;
        frame.setup = setup;
        frame.library = session.document().library;
        frame.asked_at = asked_at;
        thread.show(std::move(frame));
        return number;
    }
    /// Its frame in its own light and for its own eye: one in another comes before.
    FramePointer wait_for_light_of(const Scene& scene, const Progress& progress) {
        return finished.wait_for(number, progress, [&](const FinishedFrame& frame) {
            return frame.scene.eye_in_world_mm == scene.eye_in_world_mm &&
                   frame.scene.lights == scene.lights &&
                   frame.scene.environment == scene.environment;
        });
    }
    /// The newest, with nothing left to solve.
    FramePointer settled(const Progress& progress) {
        return finished.wait_for(
            number, progress, [](const FinishedFrame& frame) { return frame.unfinished.empty(); });
    }
    void wait_until_idle(const Progress& progress) {
        while (!thread.is_idle()) {
            progress.check_stop();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    }
};

/// Paints on the car's largest part, one after the other as a designer clicks: the time from before
/// the command to the finished frame with the new paint.
struct Swaps {
    MeasuredDesktop& desktop;
    std::vector<Material> paints;
    Scene scene;  ///< as last shown
    bool saving = false;

    std::vector<double> run(int count,
                            const BackgroundWork& beside,
                            const std::function<void(int, Scene&)>& change,
                            const Progress& progress) {
        std::vector<double> ms;
        for (int k = 0; k < count || !beside.done_enough(); ++k) {
            const auto start = Clock::now();
            const Material& paint = paints[static_cast<std::size_t>(k) % paints.size()];
            if (saving) {
                desktop.session.execute(SetPaint{desktop.look(), "body", paint.name});
            }
            const auto body = static_cast<std::size_t>(part_index(*desktop.product, "body"));
            scene.part_materials[body] = paint;
            change(k, scene);
            const std::uint64_t number = desktop.show(scene, start);
            const FramePointer shown = desktop.finished.wait_for(number, progress);
            ms.push_back(milliseconds(shown->done_at - start));
            std::this_thread::sleep_for(std::chrono::milliseconds(60));
        }
        return ms;
    }
};

/// What the mouse drags of a finished picture, step by step: the time from each to its frame, and
/// from the last one to the frame with nothing left to solve.
void measure_drags(MeasuredDesktop& desktop,
                   Scene scene,
                   LedgerEffect& steps,
                   LedgerEffect& let_go,
                   const Progress& progress) {
    const Scene before = scene;
    const auto measure = [&](const char* what, const std::function<void()>& move) {
        constexpr int kSteps = 40;
        progress.update(0.0, fmt::format("timing what is dragged: {}", what));
        std::vector<double> ms;
        Clock::time_point start;
        for (int k = 0; k < kSteps; ++k) {
            move();
            start = Clock::now();
            desktop.show(scene, start);
            const FramePointer shown = desktop.wait_for_light_of(scene, progress);
            ms.push_back(milliseconds(shown->done_at - start));
        }
        steps.levels.push_back(waited_level_of(what, ms));
        let_go.levels.push_back(
            waited_level_of(what, {milliseconds(desktop.settled(progress)->done_at - start)}));
    };
    measure("exposure", [&] { scene.exposure_ev += 0.01; });
    measure("eye", [&] { scene.eye_in_world_mm.x += 20.0; });
    measure("light", [&] {
        glm::dvec3& to_light = scene.lights.front().direction;
        to_light = glm::normalize(to_light + glm::dvec3(0.005, 0.0, 0.0));
    });
    measure("environment", [&] {
        auto turned = std::make_shared<Environment>(*scene.environment);
        turned->rotation_rad += 0.02;
        scene.environment = std::move(turned);
    });
    desktop.show(before, Clock::now());
    desktop.wait_for_light_of(before, progress);
    desktop.settled(progress);
    desktop.wait_until_idle(progress);
}

/// One of each finish that the shipped looks have.
std::vector<Material> usual_paints(const PaintLibrary& library) {
    std::vector<Material> paints;
    for (const char* name : {"solid red", "silver metallic", "solid ivory", "blue metallic"}) {
        paints.push_back(find_material(name, library));
    }
    return paints;
}

/// All shipped paints in an order that jumps between families.
std::vector<Material> whole_library(const PaintLibrary& library) {
    std::vector<Material> paints = library.shipped;
    Random random(1);
    shuffle(paints, random);
    return paints;
}

/// A calibration that opens, as big as a real one.
void write_calibration_of(const Product& product, const std::filesystem::path& folder) {
    const View view = read_bench_file("default").projector.view;
    const auto shared = std::make_shared<Product>(product);
    const FrameGeometry geometry(shared, view);
    ColourCalibration calibration = synthetic_calibration(geometry.map.coverage);
    seal(calibration);
    write_setup(folder, calibration, view);
}

}  // namespace

std::vector<LedgerEffect> measure_desktop(GlDevice device, const Progress& progress) {
    progress.update(0.0, "timing the desktop");
    const ScratchFolder folder;
    write_calibration_of(*find_product("car"), folder / "calibration");

    LedgerEffect start_effect{"desktop: start to first frame, with a saved calibration", {}};
    LedgerEffect whole_effect{"desktop: start to the frame at normal quality", {}};
    LedgerEffect swap_effect{"desktop: paint swap to finished frame", {}};

    const auto start = Clock::now();
    MeasuredDesktop desktop(device, folder / "session.livery", folder / "calibration");
    Swaps swaps{desktop, usual_paints(*desktop.session.document().library), {}};
    swaps.scene = scene_of(desktop.session.document(), desktop.look(), desktop.product, nullptr);
    desktop.show(swaps.scene, Clock::now());
    FramePointer frame = desktop.finished.wait_for(1, progress);
    start_effect.levels.push_back(waited_level_of("draft", {milliseconds(frame->done_at - start)}));
    frame = desktop.settled(progress);
    whole_effect.levels.push_back(
        waited_level_of("normal", {milliseconds(frame->done_at - start)}));
    desktop.wait_until_idle(progress);

    LedgerEffect drag_effect{"desktop: step of what is dragged to finished frame", {}};
    LedgerEffect let_go_effect{"desktop: let go to the frame at normal quality", {}};
    measure_drags(desktop, swaps.scene, drag_effect, let_go_effect, progress);

    constexpr int kSwaps = 80;
    const auto nothing = [](int, Scene&) {};
    const auto measure = [&](const std::string& name,
                             const BackgroundWork& beside,
                             const std::function<void(int, Scene&)>& change) {
        progress.update(0.0, "timing paint swaps, " + name);
        swap_effect.levels.push_back(
            waited_level_of(name, swaps.run(kSwaps, beside, change, progress)));
        desktop.wait_until_idle(progress);
    };
    measure("alone", {0, {}}, nothing);
    swaps.paints = whole_library(*desktop.session.document().library);
    progress.update(0.0, "timing every paint of the library");
    swap_effect.levels.push_back(waited_level_of(
        "every paint of the library, twice",
        swaps.run(2 * static_cast<int>(swaps.paints.size()), {0, {}}, nothing, progress)));
    swaps.paints = usual_paints(*desktop.session.document().library);
    {
        Bench bench(read_bench_file("default"), desktop.product, progress);
        const auto calibrate = [&](const Progress& stop) {
            calibrate_through_ports(
                bench.ports(), settings_of(bench.description(), desktop.product), stop);
        };
        measure("while the bench calibrates", {1, calibrate}, nothing);
    }
    {
        // Two of them in turn, so that a new one is always being solved.
        const auto studio = swaps.scene.environment;
        auto other = std::make_shared<Environment>(*studio);
        other->rotation_rad += 1.0;
        measure("while an environment is solved", {0, {}}, [&](int k, Scene& scene) {
            if (k % 20 == 0) scene.environment = k % 40 == 0 ? other : studio;
        });
    }
    swaps.saving = true;
    measure("while the session is saved", {0, {}}, nothing);
    swaps.saving = false;
    measure("while a product loads", {3, [](const Progress&) { find_product("car"); }}, nothing);
    return {start_effect, whole_effect, drag_effect, let_go_effect, swap_effect};
}

}  // namespace livery
