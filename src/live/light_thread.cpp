#include "live/light_thread.h"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "live/low_priority.h"

namespace livery {

namespace {

struct Request {
    std::shared_ptr<const Product> product;
    std::vector<DirectionalLight> lights;
    std::shared_ptr<const Environment> environment;
};

}  // namespace

struct LightThread::Implementation {
    std::function<void()> on_change;
    std::atomic<bool> stop{false};
    mutable std::mutex mutex;
    std::condition_variable wake;
    std::optional<Request> request;
    bool swatches_wanted = false;
    Results results;
    std::thread thread;

    // Of the thread only
    std::shared_ptr<const Product> product;
    std::unique_ptr<VertexLightSolver> solver;

    void run();
    void answer(const Request& asked);
    void answer_swatches();
    void publish(const std::function<void(Results&)>& change);
};

void LightThread::Implementation::publish(const std::function<void(Results&)>& change) {
    {
        const std::scoped_lock lock(mutex);
        change(results);
    }
    on_change();
}

void LightThread::Implementation::answer(const Request& asked) {
    Progress progress;
    progress.stop = &stop;
    try {
        if (asked.product != product) {
            solver = std::make_unique<VertexLightSolver>(asked.product);
            product = asked.product;
        }
        const auto light = solver->solve(asked.lights, asked.environment, progress);
        std::shared_ptr<const GroundShadow> ground;
        publish([&](Results& to) {
            if (to.solved.product == asked.product) ground = to.solved.ground;
            to.solved = {asked.product, light, ground};
            to.problem.clear();
        });
        if (ground) return;
        progress.check_stop();
        ground = std::make_shared<const GroundShadow>(
            ground_shadow(*asked.product, Tracer(asked.product->mesh)));
        publish([&](Results& to) { to.solved.ground = ground; });
    } catch (const Cancelled&) {
    } catch (const std::exception& error) {
        product = nullptr;
        publish([&](Results& to) { to.problem = error.what(); });
    }
}

void LightThread::Implementation::answer_swatches() {
    Progress progress;
    progress.stop = &stop;
    try {
        const auto studio = std::make_shared<const SwatchStudio>(make_swatch_studio(progress));
        publish([&](Results& to) { to.swatches = studio; });
    } catch (const Cancelled&) {
    } catch (const std::exception& error) {
        publish([&](Results& to) { to.swatch_problem = error.what(); });
    }
}

void LightThread::Implementation::run() {
    lower_priority_of_this_thread(Urgency::watched);
    std::unique_lock lock(mutex);
    while (true) {
        wake.wait(lock, [&] { return stop || request || swatches_wanted; });
        if (stop) return;
        if (request) {
            const Request asked = std::move(*request);
            request.reset();
            lock.unlock();
            answer(asked);
        } else {
            swatches_wanted = false;
            lock.unlock();
            answer_swatches();
        }
        lock.lock();
    }
}

LightThread::LightThread(std::function<void()> on_change)
    : implementation_(std::make_unique<Implementation>()) {
    implementation_->on_change = std::move(on_change);
    implementation_->thread = std::thread([this] { implementation_->run(); });
}

LightThread::~LightThread() {
    {
        const std::scoped_lock lock(implementation_->mutex);
        implementation_->stop = true;
    }
    implementation_->wake.notify_all();
    implementation_->thread.join();
}

void LightThread::solve(std::shared_ptr<const Product> product,
                        std::vector<DirectionalLight> lights,
                        std::shared_ptr<const Environment> environment) {
    {
        const std::scoped_lock lock(implementation_->mutex);
        implementation_->request =
            Request{std::move(product), std::move(lights), std::move(environment)};
    }
    implementation_->wake.notify_all();
}

void LightThread::prepare_swatches() {
    {
        const std::scoped_lock lock(implementation_->mutex);
        implementation_->swatches_wanted = true;
    }
    implementation_->wake.notify_all();
}

LightThread::Results LightThread::newest() const {
    const std::scoped_lock lock(implementation_->mutex);
    return implementation_->results;
}

}  // namespace livery
