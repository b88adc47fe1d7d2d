#include "live/frame_thread.h"

#include <array>
#include <atomic>
#include <exception>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/worker.h"
#include "live/frame_lane.h"

namespace livery {

namespace {

using Newest = std::shared_ptr<const WantedFrame>;

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

/// What both lanes take their work from.
struct FrameJobs {
    std::size_t front = 0;
    bool front_draws = false;
    bool front_held = false;  ///< while the back lane draws the newest and tells
    Newest newest;
    Newest shown;   ///< the last that was finished, whatever is missing of it
    Newest failed;  ///< the last that could not be solved or drawn
    std::shared_ptr<const FinishedFrame> last_good;

    /// What a lane can do, told by its thread.
    struct LaneState {
        SolveKeys solved;
        SolvedMirrors mirrors;
        bool prepared = false;
        /// The newest's light, whatever its quality, and all that its paints mirror of it.
        bool shows_light(const WantedFrame& newest) const {
            return covers_light(solved, newest.keys) && can_draw(solved, mirrors, newest);
        }
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
    std::optional<FrameThread::Solving> solving;
    Newest told_of;  ///< whose task was told last

    std::optional<Task> next_task() const;
    bool front_can_draw(const FrameLane& lane) const;
    bool disturbs(const WantedFrame& frame) const;
    void note(std::size_t index, const FrameLane& lane) {
        lanes[index] = {lane.solved(), lane.mirrors(), lane.is_prepared()};
    }
};

/// Of all that a description has to solve, roughly by time: its draft, and within a task what is
/// solved before what other paints would mirror.
constexpr double kDraftShare = 0.2, kSolvedShare = 0.8;

/// Which part of that a task tells.
struct Told {
    double from = 0.0, to = 1.0;
};

/// What the back lane should do next, if anything: show a new light, or what a new paint mirrors of
/// it, as a draft; then at the quality that is wanted; then catch up with the front, to be as good
/// a start for the next light. A draft leaves out what other paints would mirror: whoever drags a
/// light waits for none of them.
std::optional<FrameJobs::Task> FrameJobs::next_task() const {
    if (!newest || newest == failed || !newest->malformed.empty()) return std::nullopt;
    const SolveKeys& wanted = newest->keys;
    const LaneState& ahead = lanes[front];
    const LaneState& own = lanes[1 - front];
    const bool light_shown = ahead.shows_light(*newest);
    const bool all_shown = light_shown && missing_of(ahead.solved, wanted).empty();
    const bool solved_already = own.shows_light(*newest) && missing_of(own.solved, wanted).empty();
    if (all_shown && ahead.prepared) {
        if (newest->refined || (solved_already && own.prepared)) return std::nullopt;
        return Task{newest, wanted, false, true};
    }
    if (!light_shown && !solved_already) {
        return Task{newest, with_levels(wanted, levels_of(Quality::draft)), true, false};
    }
    return Task{newest, wanted, true, true};
}

bool FrameJobs::front_can_draw(const FrameLane& lane) const {
    if (!newest || newest == shown || front_held) return false;
    // A malformed one is drawn too: that says what is wrong with it.
    return !newest->malformed.empty() || lane.can_draw(*newest);
}

/// Whether a description makes the task that runs worthless, or cannot wait for it. A draft is
/// finished for its light even if a newer light waits, or a light that is dragged would never be
/// seen to move.
bool FrameJobs::disturbs(const WantedFrame& frame) const {
    if (!task || !frame.malformed.empty()) return false;
    const bool draft_of_this_pose =
        task->for_showing && !task->whole && same_pose(*task->wanted[0], *frame.keys[0]);
    if (draft_of_this_pose) return false;
    const LaneState& ahead = lanes[front];
    const bool lacks_mirrors =
        covers_light(ahead.solved, frame.keys) && !can_draw(ahead.solved, ahead.mirrors, frame);
    return lacks_mirrors || !missing_of(task->wanted, frame.keys).empty();
}

}  // namespace

struct FrameThread::Implementation {
    std::array<GlContext*, 2> contexts;
    ShadingDevice device = ShadingDevice::automatic;
    std::function<void(std::shared_ptr<const FinishedFrame>)> on_finished;
    std::shared_ptr<GeometryCache> geometries = std::make_shared<GeometryCache>();
    std::atomic<bool> stop{false};  ///< the task that runs

    Worker<FrameJobs> worker;

    void run(std::size_t lane);
    Worker<FrameJobs>::Turn next(FrameJobs& jobs, std::size_t index, FrameLane& lane);
    void work_behind(const FrameJobs::Task& task,
                     std::optional<Told> told,
                     std::optional<Urgency> urgency,
                     std::size_t index,
                     FrameLane& lane);
    void hold_front();
    bool hand_over(FrameLane& lane);
    void finish(FrameLane& lane, const Newest& description);
    void fail(const Newest& description, const std::exception_ptr& error);
};

/// Draws and tells. Only one lane is in here at a time.
void FrameThread::Implementation::finish(FrameLane& lane, const Newest& description) {
    std::shared_ptr<FinishedFrame> frame;
    try {
        frame = lane.draw(*description);
    } catch (...) {
        fail(description, std::current_exception());
        return;
    }
    const std::string missing = missing_of(lane.solved(), description->keys);
    worker.use([&](FrameJobs& jobs) {
        frame->unfinished = missing.empty() ? "" : missing + ": solving";
        jobs.last_good = frame;
        jobs.shown = description;
    });
    let_helpers_give_way();
    on_finished(std::move(frame));
}

void FrameThread::Implementation::fail(const Newest& description, const std::exception_ptr& error) {
    std::shared_ptr<FinishedFrame> frame;
    worker.use([&](FrameJobs& jobs) {
        frame = jobs.last_good ? std::make_shared<FinishedFrame>(*jobs.last_good)
                               : std::make_shared<FinishedFrame>();
        jobs.shown = jobs.failed = description;
    });
    frame->number = description->number;
    frame->asked_at = description->asked_at;
    frame->done_at = std::chrono::steady_clock::now();
    frame->unfinished.clear();
    frame->problem = reason_of(error);
    on_finished(std::move(frame));
}

void FrameThread::Implementation::work_behind(const FrameJobs::Task& task,
                                              std::optional<Told> told,
                                              std::optional<Urgency> urgency,
                                              std::size_t index,
                                              FrameLane& lane) {
    Progress progress{{}, &stop};
    if (told) {
        progress.report = [this](double fraction, std::string_view stage) {
            worker.use([&](FrameJobs& jobs) {
                jobs.solving = Solving{fraction, std::string(stage)};
            });
        };
        progress = progress.part(told->from, told->to);
    }
    const double solved = task.whole ? kSolvedShare : 1.0;
    std::exception_ptr error;
    try {
        lane.solve(*task.description, task.wanted[0]->levels, urgency, progress.part(0.0, solved));
        // Everything that drawing makes once, before the front is held.
        lane.draw_ahead(*task.description);
        if (task.whole) lane.prepare(*task.description, progress.part(solved, 1.0));
    } catch (const Cancelled&) {
    } catch (...) {
        error = std::current_exception();
    }
    // What failed for an older description is tried again for the newest.
    const bool fails = worker.use([&](FrameJobs& jobs) {
        jobs.task.reset();
        jobs.solving.reset();
        jobs.note(index, lane);
        return error && jobs.newest == task.description;
    });
    if (fails) {
        hold_front();
        fail(task.description, error);
    }
    const bool handed_over = !error && !stop && task.for_showing && hand_over(lane);
    worker.change([&](FrameJobs& jobs) {
        if (handed_over) jobs.front = index;
        jobs.front_held = false;
        jobs.note(index, lane);
    });
}

/// The front draws nothing until front_held is false again: one lane at a time tells.
void FrameThread::Implementation::hold_front() {
    worker.use([](FrameJobs& jobs) { jobs.front_held = true; });
    worker.wait([](const FrameJobs& jobs) { return !jobs.front_draws; });
}

/// True when this lane has drawn the newest, and is to be the front. Leaves the front held.
bool FrameThread::Implementation::hand_over(FrameLane& lane) {
    const auto drawable = [&](const FrameJobs& jobs) {
        return lane.can_draw(*jobs.newest) ? jobs.newest : nullptr;
    };
    // Paints that came meanwhile are drawn before the front is held, or they would wait for two
    // frames; whoever swaps faster than that waits once.
    Newest drawn;
    for (int k = 0; k < 3; ++k) {
        const Newest newest = worker.use(drawable);
        if (!newest || newest == drawn) break;
        drawn = newest;
        try {
            lane.draw_ahead(*drawn);
        } catch (...) {
            // Told when it is drawn for showing, if it fails then, too.
        }
    }
    hold_front();
    const Newest newest = worker.use(drawable);
    if (newest) finish(lane, newest);
    return newest != nullptr;
}

Worker<FrameJobs>::Turn FrameThread::Implementation::next(FrameJobs& jobs,
                                                          std::size_t index,
                                                          FrameLane& lane) {
    if (index == jobs.front) {
        if (!jobs.front_can_draw(lane)) return {};
        jobs.front_draws = true;
        return {[this, description = jobs.newest, index, &lane] {
            finish(lane, description);
            worker.change([&](FrameJobs& after) {
                after.front_draws = false;
                after.note(index, lane);
            });
        }};
    }
    jobs.task = jobs.next_task();
    if (!jobs.task) return {};
    const bool told = !missing_of(jobs.lanes[jobs.front].solved, jobs.task->wanted).empty();
    // The first picture waits for nothing else; what only gets better gives way to everything.
    std::optional<Urgency> urgency;
    if (jobs.last_good) urgency = jobs.task->whole ? Urgency::background : Urgency::watched;
    stop = false;
    std::optional<Told> range;
    if (told) {
        // One count for a draft and what follows it, which never runs backwards
        const bool follows_draft = jobs.task->whole && jobs.told_of == jobs.task->description;
        range = {follows_draft ? kDraftShare : 0.0, jobs.task->whole ? 1.0 : kDraftShare};
        jobs.told_of = jobs.task->description;
        jobs.solving = Solving{range->from, "starting"};
    }
    return {[this, task = *jobs.task, range, urgency, index, &lane] {
        work_behind(task, range, urgency, index, lane);
    }};
}

void FrameThread::Implementation::run(std::size_t index) {
    try {
        contexts[index]->make_current();
        {
            FrameLane lane(geometries, device);
            worker.serve([&](FrameJobs& jobs) { return next(jobs, index, lane); });
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
                         std::function<void(std::shared_ptr<const FinishedFrame>)> on_finished,
                         ShadingDevice device)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& all = *implementation_;
    all.contexts = {&front, &back};
    all.device = device;
    all.on_finished = std::move(on_finished);
    for (std::size_t lane = 0; lane < 2; ++lane) {
        all.worker.start([&all, lane] { all.run(lane); });
    }
}

FrameThread::~FrameThread() {
    implementation_->worker.stop();  // first: the next task would take `stop` back
    implementation_->stop = true;
}

void FrameThread::show(WantedFrame frame) {
    auto next = std::make_shared<const WantedFrame>(std::move(frame));
    implementation_->worker.change([&](FrameJobs& jobs) {
        if (jobs.disturbs(*next)) implementation_->stop = true;
        jobs.newest = std::move(next);
    });
}

std::optional<FrameThread::Solving> FrameThread::solving() const {
    return implementation_->worker.use([](const FrameJobs& jobs) { return jobs.solving; });
}

bool FrameThread::is_idle() const {
    return implementation_->worker.use([](const FrameJobs& jobs) {
        const bool drawn = jobs.newest == jobs.shown && !jobs.front_draws && !jobs.front_held;
        return drawn && !jobs.task && !jobs.next_task();
    });
}

}  // namespace livery
