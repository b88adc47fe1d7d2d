#include "live/preview_thread.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/error.h"
#include "core/log.h"
#include "core/time.h"
#include "core/worker.h"
#include "gl/read_back.h"
#include "live/frame_pictures.h"
#include "live/low_priority.h"
#include "live/preview_picture.h"
#include "radiance/light/vertex_light.h"
#include "radiance/raster_preview.h"
#include "tracing/tracer.h"

namespace livery {

namespace {

/// What one product's picture needs besides its paints and view.
struct SolvedLight {
    std::shared_ptr<const Product> product;
    std::shared_ptr<const VertexLight> light;
    std::shared_ptr<const GroundShadow> ground;
};

/// One thread; the newest request wins, a running one is finished first. `on_change` is called on
/// it after each result.
class LightThread {
  public:
    explicit LightThread(std::function<void()> on_change);
    ~LightThread();
    LightThread(const LightThread&) = delete;
    LightThread& operator=(const LightThread&) = delete;

    void solve(std::shared_ptr<const Product> product,
               std::vector<DirectionalLight> lights,
               std::shared_ptr<const Environment> environment);
    void prepare_swatches();  ///< after what solve() asked for

    struct Results {
        SolvedLight solved;
        std::shared_ptr<const SwatchStudio> swatches;
        std::string problem, swatch_problem;  ///< why there is none
    };
    Results newest() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

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

using Clock = std::chrono::steady_clock;

constexpr int kWhileMoving = 1, kAtRest = 2;  // supersampling
/// Descriptions closer than this are a movement; after such a pause it has ended.
constexpr auto kPause = std::chrono::milliseconds(250);

struct Thumbnail {
    Scene scene;
    View view;
};

/// A paint on a sphere, or a look.
struct SwatchRequest {
    Material material;
    int size_px = 0;
    std::function<void(const Image8&)> on_drawn;
    std::optional<Thumbnail> look;
};

void check(const PreviewDescription& description) {
    const Scene& scene = description.scene;
    const View& view = description.view;
    check_argument(scene.product != nullptr, "a preview of no product");
    check_argument(view.width > 0 && view.height > 0 && view.width <= 16384 && view.height <= 16384,
                   fmt::format("a preview of {} x {} pixels", view.width, view.height));
    const auto parts = static_cast<int>(scene.product->mesh.parts.size());
    const int highlighted = description.highlighted_part.value_or(0);
    check_argument(highlighted >= 0 && highlighted < std::max(parts, 1),
                   fmt::format("part {} of {}, counted from 0", highlighted, parts));
}

/// All that lives in the context; made and destroyed with it current.
struct Drawing {
    TexturePool pool{TexelFormat::rgba8};
    PreviewEncoder encoder;
    std::shared_ptr<const GroundShadow> ground;  ///< that the encoder has
    std::unique_ptr<RasterPreview> preview;
    std::shared_ptr<const Product> product;    ///< that `preview` draws
    std::shared_ptr<const VertexLight> light;  ///< that `preview` has
    std::unique_ptr<SwatchPainter> swatches;
};

struct PreviewJobs {
    std::optional<PreviewDescription> newest;
    Clock::time_point asked_at{}, asked_before{};
    bool light_changed = false;
    std::deque<SwatchRequest> swatches;  ///< the newest first
};

}  // namespace

struct PreviewThread::Implementation {
    GlContext& context;
    std::function<void(std::shared_ptr<const PreviewPicture>)> on_finished;

    // Of the thread only
    std::optional<PreviewDescription> shown;
    int drawn_supersampling = 0;  ///< of `shown`; 0: not yet
    bool swatch_light_asked = false;
    bool swatches_wait = false;  ///< for their light
    std::vector<DirectionalLight> asked_lights;
    std::shared_ptr<const Environment> asked_environment;
    std::shared_ptr<const Product> asked_product;
    std::shared_ptr<const PreviewPicture> last_good;

    std::unique_ptr<LightThread> lights;
    Worker<PreviewJobs> worker;

    explicit Implementation(GlContext& its_context) : context(its_context) {}
    void run();
    Worker<PreviewJobs>::Turn next(PreviewJobs& jobs, Drawing& drawing);
    void draw(Drawing& drawing, int supersampling);
    void draw_or_tell(Drawing& drawing, int supersampling);
    void ask_for_light(const Drawing& drawing);
    bool take_light(Drawing& drawing);
    bool answer(Drawing& drawing, const SwatchRequest& request);
    bool answer_look(Drawing& drawing, const SwatchRequest& request);
    void tell(const std::string& problem);
};

void PreviewThread::Implementation::tell(const std::string& problem) {
    auto picture = last_good ? std::make_shared<PreviewPicture>(*last_good)
                             : std::make_shared<PreviewPicture>();
    picture->problem = problem;
    if (shown) picture->number = shown->number;
    on_finished(std::move(picture));
}

/// The light thread's newest, into the preview. True when something changed.
bool PreviewThread::Implementation::take_light(Drawing& drawing) {
    const LightThread::Results results = lights->newest();
    if (!results.problem.empty()) tell("The light could not be solved: " + results.problem);
    if (!drawing.preview || results.solved.product != drawing.product) return false;
    bool changed = false;
    if (results.solved.light != drawing.light) {
        drawing.preview->take(results.solved.light);
        drawing.light = results.solved.light;
        changed = true;
    }
    if (results.solved.ground && results.solved.ground != drawing.ground) {
        drawing.ground = results.solved.ground;
        drawing.encoder.set_ground(drawing.ground.get());
        changed = true;
    }
    return changed;
}

void PreviewThread::Implementation::ask_for_light(const Drawing& drawing) {
    const Scene& scene = shown->scene;
    const VertexLight asked{asked_lights, asked_environment, {}, {}, {}};
    if (asked_product == scene.product &&
        is_solved_for(asked, scene.lights, scene.environment.get())) {
        return;
    }
    if (drawing.light && is_solved_for(*drawing.light, scene.lights, scene.environment.get())) {
        return;
    }
    asked_product = scene.product;
    asked_lights = scene.lights;
    asked_environment = scene.environment;
    lights->solve(scene.product, scene.lights, scene.environment);
}

/// The first time in a guess of the light, so that there is a picture at once.
void PreviewThread::Implementation::draw(Drawing& drawing, int supersampling) {
    const auto start = Clock::now();
    check(*shown);
    if (drawing.product != shown->scene.product) {
        drawing.preview.reset();
        drawing.light.reset();
        drawing.ground.reset();
        drawing.encoder.set_ground(nullptr);
        drawing.preview = std::make_unique<RasterPreview>(shown->scene.product, kAtRest);
        drawing.product = shown->scene.product;
        take_light(drawing);
    }
    const bool guess = !drawing.light;
    if (guess) {
        drawing.light =
            guessed_light(*drawing.product, shown->scene.lights, shown->scene.environment.get());
        drawing.preview->take(drawing.light);
    } else {
        ask_for_light(drawing);
    }
    drawing.preview->set_supersampling(supersampling);
    drawing.preview->set_glint_view(shown->projector);
    const View& view = shown->view;
    const auto slot = drawing.pool.lend(view.width, view.height);
    const auto draw_columns = [&](const Scene& scene, int begin, int end) {
        if (begin >= end) return;
        drawing.preview->draw(scene, view);
        drawing.encoder.encode(*drawing.preview,
                               view,
                               shown->highlighted_part,
                               shown->ground,
                               slot->framebuffer,
                               PixelRect{begin, 0, end - begin, view.height});
    };
    const int column =
        shown->wipe_to
            ? static_cast<int>(std::lround(std::clamp(shown->wipe_at, 0.0, 1.0) * view.width))
            : view.width;
    draw_columns(shown->scene, 0, column);
    if (shown->wipe_to) {
        Scene other = *shown->wipe_to;
        other.lights = shown->scene.lights;
        other.environment = shown->scene.environment;
        draw_columns(other, column, view.width);
    }
    // Waited for here, so that the time is the drawing's own and no reader ever waits.
    finish_gl();
    slot->ready = Fence::after_everything_so_far();

    auto picture = std::make_shared<PreviewPicture>();
    picture->number = shown->number;
    picture->texture = slot->texture.name();
    picture->size_px = {shown->view.width, shown->view.height};
    picture->ready = std::shared_ptr<const Fence>(slot, &slot->ready);
    picture->ms = milliseconds_since(start);
    picture->supersampling = supersampling;
    const bool lit =
        is_solved_for(*drawing.light, shown->scene.lights, shown->scene.environment.get());
    picture->unfinished = !lit || (shown->ground && !drawing.ground);
    picture->owner = slot;
    last_good = picture;
    on_finished(std::move(picture));
    // Rays are traced when there is a picture to look at.
    if (guess) ask_for_light(drawing);
}

void PreviewThread::Implementation::draw_or_tell(Drawing& drawing, int supersampling) {
    // The first picture is what one waits for when the program opens; it takes turns with nothing.
    const bool first = !last_good;
    drawn_supersampling = kAtRest;  // unless it turns out that there is more to do
    try {
        draw(drawing, supersampling);
        drawn_supersampling = supersampling;
    } catch (const std::exception& error) {
        tell(error.what());
    }
    if (first) lower_priority_of_this_thread(Urgency::watched);
}

/// False while there is no light to draw it in.
bool PreviewThread::Implementation::answer_look(Drawing& drawing, const SwatchRequest& request) {
    const auto& [scene, view] = *request.look;
    if (!drawing.light || drawing.product != scene.product) return false;
    Image8 rgba;
    try {
        drawing.preview->set_supersampling(kAtRest);
        drawing.preview->set_glint_view(std::nullopt);
        const auto slot = drawing.pool.lend(view.width, view.height);
        Scene lit = scene;
        lit.lights = drawing.light->lights;
        lit.environment = drawing.light->environment;
        drawing.preview->draw(lit, view);
        drawing.encoder.encode(*drawing.preview, view, std::nullopt, false, slot->framebuffer);
        rgba = read_bytes(slot->texture, 4);
    } catch (const std::exception& error) {
        log_line(LogLevel::warning, fmt::format("no picture of a look: {}", error.what()));
    }
    request.on_drawn(rgba);
    return true;
}

/// False when its light is still being solved.
bool PreviewThread::Implementation::answer(Drawing& drawing, const SwatchRequest& request) {
    if (request.look) return answer_look(drawing, request);
    Image8 swatch;
    try {
        if (const auto kept = kept_swatch(request.material, request.size_px)) {
            swatch = *kept;
        } else {
            if (!drawing.swatches) {
                const LightThread::Results results = lights->newest();
                if (!results.swatch_problem.empty()) {
                    throw std::runtime_error(results.swatch_problem);
                }
                if (!results.swatches) {
                    if (!swatch_light_asked) lights->prepare_swatches();
                    swatch_light_asked = true;
                    return false;
                }
                drawing.swatches = std::make_unique<SwatchPainter>(*results.swatches);
            }
            swatch = drawing.swatches->paint(request.material, request.size_px);
            keep_swatch(request.material, swatch);
        }
    } catch (const std::exception& error) {
        log_line(LogLevel::warning,
                 fmt::format("no swatch of {}: {}", request.material.name, error.what()));
        swatch = Image8();
    }
    request.on_drawn(swatch);
    return true;
}

Worker<PreviewJobs>::Turn PreviewThread::Implementation::next(PreviewJobs& jobs, Drawing& drawing) {
    if (jobs.newest) {
        shown = std::exchange(jobs.newest, std::nullopt);
        const bool moving = jobs.asked_at - jobs.asked_before < kPause;
        return {[this, &drawing, moving] {
            draw_or_tell(drawing, moving || !drawing.light ? kWhileMoving : kAtRest);
        }};
    }
    if (std::exchange(jobs.light_changed, false)) {
        swatches_wait = false;
        return {[this, &drawing] {
            if (take_light(drawing) && shown) {
                draw_or_tell(drawing, std::max(drawn_supersampling, kWhileMoving));
            }
        }};
    }
    if (shown && drawn_supersampling < kAtRest) {
        const auto rested_at = jobs.asked_at + kPause;
        if (Clock::now() < rested_at) return {{}, rested_at};
        return {[this, &drawing] { draw_or_tell(drawing, kAtRest); }};
    }
    if (jobs.swatches.empty() || swatches_wait) return {};
    SwatchRequest request = std::move(jobs.swatches.front());
    jobs.swatches.pop_front();
    return {[this, &drawing, request = std::move(request)] {
        swatches_wait = !answer(drawing, request);
        if (!swatches_wait) return;
        worker.use([&](PreviewJobs& waiting) { waiting.swatches.push_back(request); });
    }};
}

void PreviewThread::Implementation::run() {
    try {
        context.make_current();
        {
            Drawing drawing;
            worker.serve([&](PreviewJobs& jobs) { return next(jobs, drawing); });
        }
        last_good.reset();
        context.release();
    } catch (const std::exception& error) {
        log_line(LogLevel::error, fmt::format("the preview ended: {}", error.what()));
        tell(error.what());
    }
}

PreviewThread::PreviewThread(GlContext& context,
                             std::function<void(std::shared_ptr<const PreviewPicture>)> on_finished)
    : implementation_(std::make_unique<Implementation>(context)) {
    Implementation& it = *implementation_;
    it.on_finished = std::move(on_finished);
    it.lights = std::make_unique<LightThread>(
        [&it] { it.worker.change([](PreviewJobs& jobs) { jobs.light_changed = true; }); });
    it.worker.start([&it] { it.run(); });
}

PreviewThread::~PreviewThread() {
    implementation_->worker.stop();
    implementation_->worker.join();
    implementation_->lights.reset();  // it tells the worker until it ends
}

void PreviewThread::show(PreviewDescription description) {
    implementation_->worker.change([&](PreviewJobs& jobs) {
        jobs.newest = std::move(description);
        jobs.asked_before = std::exchange(jobs.asked_at, Clock::now());
    });
}

void PreviewThread::request_swatch(const Material& material,
                                   int size_px,
                                   std::function<void(const Image8& rgba)> on_drawn) {
    check_argument(size_px >= kSmallestSwatch_px && size_px <= kLargestSwatch_px,
                   fmt::format("a swatch of {} px, {} to {} are possible",
                               size_px,
                               kSmallestSwatch_px,
                               kLargestSwatch_px));
    implementation_->worker.change([&](PreviewJobs& jobs) {
        jobs.swatches.push_front({material, size_px, std::move(on_drawn), std::nullopt});
    });
}

void PreviewThread::request_thumbnail(const Scene& scene,
                                      const View& view,
                                      std::function<void(const Image8& rgba)> on_drawn) {
    check_argument(scene.product != nullptr, "a thumbnail of no product");
    const int largest = std::max(view.width, view.height);
    check_argument(std::min(view.width, view.height) > 0 && largest <= kLargestSwatch_px,
                   fmt::format("a thumbnail of {} x {} px, {} a side are possible",
                               view.width,
                               view.height,
                               kLargestSwatch_px));
    implementation_->worker.change([&](PreviewJobs& jobs) {
        jobs.swatches.push_front({{}, 0, std::move(on_drawn), Thumbnail{scene, view}});
    });
}

struct PartPicker::State {
    std::shared_ptr<const Product> product;
    std::optional<Tracer> tracer;  ///< made for the first click: nobody waits for it at the start
};

PartPicker::PartPicker(std::shared_ptr<const Product> product) {
    check_argument(product != nullptr, "picking parts needs a product");
    state_ = std::make_unique<State>();
    state_->product = std::move(product);
}

PartPicker::~PartPicker() = default;

std::optional<int> PartPicker::part_at(const View& view, const glm::dvec2& pixel) const {
    const auto point = point_at(view, pixel);
    return point ? std::optional(point->part) : std::nullopt;
}

std::optional<PickedPoint> PartPicker::point_at(const View& view, const glm::dvec2& pixel) const {
    if (!(pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < view.width && pixel.y < view.height)) {
        return std::nullopt;
    }
    const Ray ray = ray_through(view, pixel);
    TraceRay traced;
    traced.origin = glm::vec3(ray.origin);
    traced.direction = glm::vec3(ray.direction);
    const Mesh& mesh = state_->product->mesh;
    if (!state_->tracer) state_->tracer.emplace(mesh);
    const Hit hit = state_->tracer->closest(traced);
    if (!hit.valid()) return std::nullopt;
    const SurfacePoint surface = surface_point(mesh, hit);
    PickedPoint point{
        surface.part, glm::dvec3(surface.position_mm), glm::normalize(glm::dvec3(surface.normal))};
    // An open surface is seen from both sides.
    if (glm::dot(surface.geometric_normal, traced.direction) > 0.0f) point.normal = -point.normal;
    return point;
}

}  // namespace livery
