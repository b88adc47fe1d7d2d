#include "live/light_thread.h"

#include <exception>

#include "core/worker.h"
#include "live/low_priority.h"

namespace livery {

namespace {

struct Request {
    std::shared_ptr<const Product> product;
    std::vector<DirectionalLight> lights;
    std::shared_ptr<const Environment> environment;
};

struct LightJobs {
    std::optional<Request> request;
    bool swatches = false;
    LightThread::Results results;
};

}  // namespace

struct LightThread::Implementation {
    std::function<void()> on_change;

    // Of the thread only
    std::shared_ptr<const Product> product;
    std::unique_ptr<VertexLightSolver> solver;

    Worker<LightJobs> worker;

    void answer(const Request& asked);
    void answer_swatches();
    template <typename Change>
    void publish(const Change& change) {
        worker.use([&](LightJobs& asked) { change(asked.results); });
        on_change();
    }
};

void LightThread::Implementation::answer(const Request& asked) {
    Progress progress;
    progress.stop = worker.stopping();
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
    progress.stop = worker.stopping();
    try {
        const auto studio = std::make_shared<const SwatchStudio>(make_swatch_studio(progress));
        publish([&](Results& to) { to.swatches = studio; });
    } catch (const Cancelled&) {
    } catch (const std::exception& error) {
        publish([&](Results& to) { to.swatch_problem = error.what(); });
    }
}

LightThread::LightThread(std::function<void()> on_change)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& it = *implementation_;
    it.on_change = std::move(on_change);
    it.worker.start([&it] {
        lower_priority_of_this_thread(Urgency::watched);
        it.worker.serve([&it](LightJobs& asked) -> Worker<LightJobs>::Turn {
            if (asked.request) {
                return {[&it, request = *std::exchange(asked.request, std::nullopt)] {
                    it.answer(request);
                }};
            }
            if (std::exchange(asked.swatches, false)) return {[&it] { it.answer_swatches(); }};
            return {};
        });
    });
}

LightThread::~LightThread() = default;

void LightThread::solve(std::shared_ptr<const Product> product,
                        std::vector<DirectionalLight> lights,
                        std::shared_ptr<const Environment> environment) {
    implementation_->worker.change([&](LightJobs& asked) {
        asked.request = Request{std::move(product), std::move(lights), std::move(environment)};
    });
}

void LightThread::prepare_swatches() {
    implementation_->worker.change([](LightJobs& asked) { asked.swatches = true; });
}

LightThread::Results LightThread::newest() const {
    return implementation_->worker.use([](const LightJobs& asked) { return asked.results; });
}

}  // namespace livery
