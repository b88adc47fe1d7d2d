#include "live/frame_thread.h"

#include <array>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"
#include "live/frame_lane.h"
#include "live/solve_key.h"

namespace livery {

namespace {

using Newest = std::shared_ptr<const FrameDescription>;

std::string reason_of(const std::exception_ptr& error) {
    try {
        std::rethrow_exception(error);
    } catch (const std::bad_alloc&) {
        return "out of memory; close other programs or choose a lower quality";
    } catch (const std::exception& known) {
        return known.what();
    } catch (...) {
        return "an unknown error";
    }
}

/// The description as keys_of() sees it, or nothing when it is malformed: drawing it says why.
std::optional<SolveKeys> wanted_of(const FrameDescription& description) {
    try {
        return keys_of(description);
    } catch (const std::invalid_argument&) {
        return std::nullopt;
    }
}

}  // namespace

struct FrameThread::Implementation {
    std::array<GlContext*, 2> contexts;
    std::function<void(std::shared_ptr<const FinishedFrame>)> on_finished;
    std::shared_ptr<GeometryCache> geometries = std::make_shared<GeometryCache>();

    mutable std::mutex mutex;
    std::condition_variable changed;
    bool quit = false;
    std::size_t front = 0;
    bool front_draws = false;  ///< outside of the mutex
    bool front_held = false;   ///< while the back lane draws the newest and tells
    Newest newest;
    Newest shown;   ///< the last that was finished, whatever is missing of it
    Newest failed;  ///< the last that could not be solved or drawn
    std::shared_ptr<const FinishedFrame> last_good;

    /// What a lane can do, told by its thread.
    struct LaneState {
        SolveKeys solved;
        bool prepared = false;
    };
    std::array<LaneState, 2> lanes;

    /// What the back lane is at.
    struct Task {
        Newest description;
        SolveKeys wanted;  ///< at the quality of this task
        bool for_showing = true;
        bool whole = false;  ///< prepares for other paints, too
    };
    std::optional<Task> task;
    std::atomic<bool> stop{false};
    std::optional<Solving> solving;

    std::array<std::thread, 2> threads;

    void run(std::size_t lane);
    void serve(std::size_t index, FrameLane& lane);
    std::optional<Task> next_task(std::size_t back) const;
    bool front_can_draw(const FrameLane& lane) const;
    void draw_in_front(FrameLane& lane, std::unique_lock<std::mutex>& lock);
    void work_behind(std::size_t index, FrameLane& lane, std::unique_lock<std::mutex>& lock);
    void hold_front(std::unique_lock<std::mutex>& lock);
    void hand_over(std::size_t index, FrameLane& lane, std::unique_lock<std::mutex>& lock);
    void finish(FrameLane& lane, const Newest& description);
    void fail(const Newest& description, const std::exception_ptr& error);
    std::string unfinished_of(const SolveKeys& solved, const SolveKeys& wanted) const;
    bool disturbs(const FrameDescription& description) const;
};

/// What the back lane should do next, if anything: show a new light as a draft; then at the quality
/// that is wanted; then catch up with the front, to be as good a start for the next light.
std::optional<FrameThread::Implementation::Task> FrameThread::Implementation::next_task(
    std::size_t back) const {
    if (!newest || newest == failed) return std::nullopt;
    const auto wanted = wanted_of(*newest);
    if (!wanted) return std::nullopt;
    const LaneState& ahead = lanes[1 - back];
    const LaneState& own = lanes[back];
    const bool light_shown = covers_light(ahead.solved, *wanted);
    const bool all_shown = light_shown && missing_of(ahead.solved, *wanted).empty();
    if (all_shown && ahead.prepared) {
        const bool caught_up =
            own.solved[0] && missing_of(own.solved, *wanted).empty() && own.prepared;
        if (caught_up) return std::nullopt;
        return Task{newest, *wanted, false, true};
    }
    const bool solved_already = own.solved[0] && missing_of(own.solved, *wanted).empty();
    if (!light_shown && !solved_already) {
        return Task{newest, with_quality(*wanted, Quality::draft), true, false};
    }
    return Task{newest, *wanted, true, true};
}

bool FrameThread::Implementation::front_can_draw(const FrameLane& lane) const {
    if (!newest || newest == shown || front_held) return false;
    // A malformed one is drawn too: that says what is wrong with it.
    return !wanted_of(*newest) || lane.can_draw(*newest);
}

/// Whether a description makes the task that runs worthless. A draft is finished for its light even
/// if a newer light waits, or a light that is dragged would never be seen to move.
bool FrameThread::Implementation::disturbs(const FrameDescription& description) const {
    if (!task) return false;
    const auto wanted = wanted_of(description);
    if (!wanted) return false;
    const bool draft_of_this_pose =
        task->for_showing && !task->whole && same_pose(*task->wanted[0], *(*wanted)[0]);
    return !draft_of_this_pose && !missing_of(task->wanted, *wanted).empty();
}

std::string FrameThread::Implementation::unfinished_of(const SolveKeys& solved,
                                                       const SolveKeys& wanted) const {
    const std::string missing = missing_of(solved, wanted);
    if (missing.empty()) return "";
    const double fraction = solving ? solving->fraction : 0.0;
    return fmt::format("{}: solving, {:.0f}%", missing, 100.0 * fraction);
}

/// Draws and tells; with the mutex free. Only one lane is in here at a time.
void FrameThread::Implementation::finish(FrameLane& lane, const Newest& description) {
    std::shared_ptr<FinishedFrame> frame;
    try {
        frame = lane.draw(*description);
    } catch (...) {
        fail(description, std::current_exception());
        return;
    }
    {
        const std::scoped_lock lock(mutex);
        frame->unfinished = unfinished_of(lane.solved(), keys_of(*description));
        last_good = frame;
        shown = description;
    }
    let_helpers_give_way();
    on_finished(std::move(frame));
}

void FrameThread::Implementation::fail(const Newest& description, const std::exception_ptr& error) {
    std::shared_ptr<FinishedFrame> frame;
    {
        const std::scoped_lock lock(mutex);
        frame = last_good ? std::make_shared<FinishedFrame>(*last_good)
                          : std::make_shared<FinishedFrame>();
        shown = failed = description;
    }
    frame->number = description->number;
    frame->asked_at = description->asked_at;
    frame->done_at = std::chrono::steady_clock::now();
    frame->unfinished.clear();
    frame->problem = reason_of(error);
    on_finished(std::move(frame));
}

void FrameThread::Implementation::draw_in_front(FrameLane& lane,
                                                std::unique_lock<std::mutex>& lock) {
    const Newest description = newest;
    front_draws = true;
    lock.unlock();
    finish(lane, description);
    lock.lock();
    front_draws = false;
}

void FrameThread::Implementation::work_behind(std::size_t index,
                                              FrameLane& lane,
                                              std::unique_lock<std::mutex>& lock) {
    const Task its_task = *task;
    const bool told = !missing_of(lanes[front].solved, its_task.wanted).empty();
    // The first picture waits for nothing else; what only gets better gives way to everything.
    std::optional<Urgency> urgency;
    if (last_good) urgency = its_task.whole ? Urgency::background : Urgency::watched;
    stop = false;
    if (told) solving = Solving{0.0, "starting"};
    lock.unlock();
    Progress progress{{}, &stop};
    if (told) {
        progress.report = [this](double fraction, std::string_view stage) {
            const std::scoped_lock guard(mutex);
            solving = Solving{fraction, std::string(stage)};
        };
    }
    std::exception_ptr error;
    try {
        lane.solve(*its_task.description, its_task.wanted[0]->quality, urgency, progress);
        // Everything that drawing makes once, before the front is held.
        lane.draw_ahead(*its_task.description);
        if (its_task.whole) lane.prepare(*its_task.description, progress);
    } catch (const Cancelled&) {
    } catch (...) {
        error = std::current_exception();
    }
    lock.lock();
    task.reset();
    solving.reset();
    lanes[index] = {lane.solved(), lane.is_prepared()};
    // What failed for an older description is tried again for the newest.
    if (error && newest == its_task.description) {
        hold_front(lock);
        lock.unlock();
        fail(its_task.description, error);
        lock.lock();
        front_held = false;
    }
    if (error || stop || !its_task.for_showing) return;
    hand_over(index, lane, lock);
    lanes[index] = {lane.solved(), lane.is_prepared()};
}

/// The front draws nothing until front_held is false again: one lane at a time tells.
void FrameThread::Implementation::hold_front(std::unique_lock<std::mutex>& lock) {
    front_held = true;
    changed.wait(lock, [&] { return !front_draws; });
}

void FrameThread::Implementation::hand_over(std::size_t index,
                                            FrameLane& lane,
                                            std::unique_lock<std::mutex>& lock) {
    const auto drawable = [&] { return wanted_of(*newest) && lane.can_draw(*newest); };
    // Paints that came meanwhile are drawn before the front is held, or they would wait for two
    // frames; whoever swaps faster than that waits once.
    Newest drawn;
    for (int k = 0; k < 3 && newest != drawn && drawable(); ++k) {
        drawn = newest;
        lock.unlock();
        try {
            lane.draw_ahead(*drawn);
        } catch (...) {
            // Told when it is drawn for showing, if it fails then, too.
        }
        lock.lock();
    }
    hold_front(lock);
    if (drawable()) {
        const Newest description = newest;
        lock.unlock();
        finish(lane, description);
        lock.lock();
        front = index;
    }
    front_held = false;
}

void FrameThread::Implementation::serve(std::size_t index, FrameLane& lane) {
    std::unique_lock lock(mutex);
    while (!quit) {
        if (index == front) {
            if (front_can_draw(lane)) {
                draw_in_front(lane, lock);
                lanes[index] = {lane.solved(), lane.is_prepared()};
                changed.notify_all();
                continue;
            }
        } else if ((task = next_task(index))) {
            work_behind(index, lane, lock);
            changed.notify_all();
            continue;
        }
        changed.wait(lock);
    }
}

void FrameThread::Implementation::run(std::size_t index) {
    try {
        contexts[index]->make_current();
        {
            FrameLane lane(geometries);
            serve(index, lane);
        }
        contexts[index]->release();
    } catch (...) {
        auto frame = std::make_shared<FinishedFrame>();
        frame->problem = reason_of(std::current_exception());
        on_finished(std::move(frame));
    }
}

FrameThread::FrameThread(GlContext& front,
                         GlContext& back,
                         std::function<void(std::shared_ptr<const FinishedFrame>)> on_finished)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& all = *implementation_;
    all.contexts = {&front, &back};
    all.on_finished = std::move(on_finished);
    for (std::size_t lane = 0; lane < 2; ++lane) {
        all.threads[lane] = std::thread([&all, lane] { all.run(lane); });
    }
}

FrameThread::~FrameThread() {
    {
        const std::scoped_lock lock(implementation_->mutex);
        implementation_->quit = true;
        implementation_->stop = true;
    }
    implementation_->changed.notify_all();
    for (std::thread& thread : implementation_->threads) thread.join();
}

void FrameThread::show(FrameDescription description) {
    auto next = std::make_shared<const FrameDescription>(std::move(description));
    {
        const std::scoped_lock lock(implementation_->mutex);
        if (implementation_->disturbs(*next)) implementation_->stop = true;
        implementation_->newest = std::move(next);
    }
    implementation_->changed.notify_all();
}

std::optional<FrameThread::Solving> FrameThread::solving() const {
    const std::scoped_lock lock(implementation_->mutex);
    return implementation_->solving;
}

bool FrameThread::is_idle() const {
    const Implementation& all = *implementation_;
    const std::scoped_lock lock(all.mutex);
    const bool drawn = all.newest == all.shown && !all.front_draws && !all.front_held;
    return drawn && !all.task && !all.next_task(1 - all.front);
}

}  // namespace livery
