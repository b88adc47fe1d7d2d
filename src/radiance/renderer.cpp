#include "radiance/renderer.h"

#include <algorithm>
#include <deque>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "gl/draw.h"
#include "gl/read_back.h"
#include "gl/timer.h"
#include "radiance/environment_filter.h"
#include "radiance/fragment_inputs.h"
#include "radiance/packed_fragments.h"
#include "radiance/resolve.h"
#include "radiance/shading.h"

namespace livery {
namespace {

constexpr int kSubSamples = 16;

void check_fits(const Scene& scene, const FramePlan& plan, const Product* product) {
    check_argument(scene.product.get() == product, "the scene shows another product");
    for (std::size_t i = 0; i < scene.part_materials.size(); ++i) {
        const std::string pass = shade_pass(scene, i);
        check_argument(find_pass(plan, pass) != nullptr,
                       fmt::format("the plan has no pass \"{}\": it is of another scene", pass));
    }
}

}  // namespace

FrameGeometry::FrameGeometry(std::shared_ptr<const Product> its_product,
                             const View& its_view,
                             const Progress& progress)
    : product(std::move(its_product)),
      view(its_view),
      tracer((check_argument(product != nullptr, "a renderer needs a product"), product->mesh)) {
    const double begin_ms = StageClock::now_ms();
    map = build_surface_map(product->mesh, tracer, view, kSubSamples, progress);
    ms = StageClock::now_ms() - begin_ms;
}

struct RadianceRenderer::State {
    std::shared_ptr<const FrameGeometry> geometry;
    const SurfaceMap& map;
    bool map_reported = false;

    PackedLayout layout;
    FragmentInputs inputs;
    ShadingPrograms programs;
    std::optional<ResolvePass> resolve;
    Texture2D shaded, target;
    Framebuffer shaded_framebuffer, target_framebuffer;

    struct Shaded {
        Material material;
        double exposure_ev = 0.0;
    };
    std::vector<std::optional<Shaded>> parts;  ///< as last shaded
    std::deque<GlTimer> timers;
    int own_textures = 0;
    Counters counters;

    State(std::shared_ptr<const FrameGeometry> its_geometry, bool keep_better)
        : geometry(std::move(its_geometry)),
          map(geometry->map),
          layout(layout_of(map)),
          inputs(geometry->product->mesh, geometry->tracer, map, layout, keep_better),
          target(map.width, map.height, TexelFormat::rgba16f),
          target_framebuffer({&target}),
          parts(geometry->product->mesh.parts.size()) {
        target.clear();
        own_textures = 1;
    }

    void solve(const Scene& scene, FramePlan& plan, StageClock& clock, const Progress& progress);
    void make_shaded();
    /// Shades the parts that need it; their timers are read when all is drawn.
    void shade(const Scene& scene, FramePlan& plan);
    void upload(const Scene& scene, StageClock& clock);
    void run_resolve(FramePlan& plan, bool any_shaded);
    void read_timers();

    std::vector<std::pair<PlannedPass*, GlTimer*>> running;
    GlTimer& timer_for(PlannedPass* pass) {
        if (timers.size() <= running.size()) timers.emplace_back();
        GlTimer& timer = timers[running.size()];
        running.emplace_back(pass, &timer);
        return timer;
    }
};

void RadianceRenderer::State::solve(const Scene& scene,
                                    FramePlan& plan,
                                    StageClock& clock,
                                    const Progress& progress) {
    rays_of(plan.quality);
    check_fits(scene, plan, geometry->product.get());
    if (PlannedPass* pass = find_pass(plan, kSurfaceMapPass)) {
        pass->ms = map_reported ? 0.0 : geometry->ms;
        if (!map_reported) ++counters.passes_run;
        map_reported = true;
    }
    const int before = clock.passes_run();
    inputs.solve(scene, plan, clock, progress);
    counters.passes_run += clock.passes_run() - before;
    progress.check_stop();
}

void RadianceRenderer::State::make_shaded() {
    if (shaded) return;
    shaded = Texture2D(kPackedWidth, layout.rows, TexelFormat::rgba16f);
    shaded_framebuffer = Framebuffer({&shaded});
    ++own_textures;
}

/// What is shaded in another light now does not stand.
void RadianceRenderer::State::upload(const Scene& scene, StageClock& clock) {
    const FragmentInputs::Changed changed = inputs.upload(scene, clock);
    for (std::optional<Shaded>& part : parts) {
        if (!part) continue;
        const bool diffuse = part->material.model == ReflectanceModel::lambert;
        if (diffuse ? changed.diffuse : changed.glossy) part.reset();
    }
}

void RadianceRenderer::State::shade(const Scene& scene, FramePlan& plan) {
    make_shaded();
    for (std::size_t p = 0; p < parts.size(); ++p) {
        PlannedPass* pass = find_pass(plan, shade_pass(scene, p));
        pass->ms = 0.0;
        const Material& material = scene.part_materials[p];
        const bool stands = parts[p] && same_paint(parts[p]->material, material) &&
                            parts[p]->exposure_ev == scene.exposure_ev;
        if (stands) continue;
        parts[p] = Shaded{material, scene.exposure_ev};
        const PixelRect rectangle = layout.rectangle(p);
        if (rectangle.height == 0) continue;
        GlTimer& timer = timer_for(pass);
        timer.start();
        programs.shade(
            material, inputs.shading(), scene.exposure_ev, rectangle, shaded_framebuffer);
        timer.stop();
        ++counters.passes_run;
        counters.fragments_shaded += static_cast<int>(layout.fragments(p));
    }
}

void RadianceRenderer::State::run_resolve(FramePlan& plan, bool any_shaded) {
    PlannedPass* pass = find_pass(plan, kResolvePass);
    check_argument(pass != nullptr, "the plan has no resolve pass");
    pass->ms = 0.0;
    if (!any_shaded) return;
    if (!resolve) {
        resolve.emplace(map, layout);
        own_textures += ResolvePass::kTextures;
    }
    GlTimer& timer = timer_for(pass);
    timer.start();
    resolve->run(shaded, target_framebuffer);
    timer.stop();
    ++counters.passes_run;
}

void RadianceRenderer::State::read_timers() {
    for (const auto& [pass, timer] : running) pass->ms = *pass->ms + timer->milliseconds();
    running.clear();
}

RadianceRenderer::RadianceRenderer(std::shared_ptr<const Product> product,
                                   const View& view,
                                   const Progress& progress)
    : RadianceRenderer(std::make_shared<const FrameGeometry>(std::move(product), view, progress)) {}

RadianceRenderer::RadianceRenderer(std::shared_ptr<const FrameGeometry> geometry,
                                   bool keep_better) {
    check_argument(geometry != nullptr, "a renderer needs a geometry");
    state_ = std::make_unique<State>(std::move(geometry), keep_better);
}

RadianceRenderer::~RadianceRenderer() = default;

void RadianceRenderer::solve(const Scene& scene, FramePlan& plan, const Progress& progress) {
    StageClock clock(plan, &progress);
    const Progress silent{{}, progress.stop};
    state_->solve(scene, plan, clock, silent);
}

void RadianceRenderer::prepare(const Scene& scene, FramePlan& plan, const Progress& progress) {
    State& s = *state_;
    StageClock clock(plan);
    s.solve(scene, plan, clock, progress);
    s.upload(scene, clock);
    for (const Material& material : scene.part_materials) {
        progress.check_stop();
        s.programs.compile(material, s.inputs.shading());
    }
}

void RadianceRenderer::render(const Scene& scene, FramePlan& plan, const Progress& progress) {
    State& s = *state_;
    StageClock clock(plan);
    s.solve(scene, plan, clock, progress);
    count_work(scene, plan);
    const int before = clock.passes_run();
    s.upload(scene, clock);
    s.counters.passes_run += clock.passes_run() - before;
    s.running.clear();
    s.shade(scene, plan);
    s.run_resolve(plan, !s.running.empty());
    s.read_timers();
}

void RadianceRenderer::count_work(const Scene& scene, FramePlan& plan) const {
    const State& s = *state_;
    const auto fragments = static_cast<double>(s.map.fragments.size());
    const QualityRays rays = rays_of(plan.quality);
    const auto set = [&](const std::string& name, double items) {
        if (PlannedPass* pass = find_pass(plan, name)) pass->work_items = items;
    };
    set(kSurfaceMapPass, static_cast<double>(s.map.covered_pixels) * s.map.samples_per_pixel);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const bool point = scene.lights[i].angle_rad <= 0.0;
        const int most = static_cast<int>(kSamplesAFragment);
        set(visibility_pass(i), fragments * (point ? std::min(rays.light, most) : rays.light));
    }
    set(kIrradiancePass, fragments);
    set(kOcclusionPass, fragments * rays.sky);
    set(kFilterPass, static_cast<double>(kFilterTexels));
    set(kReflectionPass, fragments * mirror_rays(rays.mirror));
    set(kMirrorPass, fragments * static_cast<double>(kMirrorAlphas.size()));
    set(kDirectionsPass, fragments);
    set(kDiffuseLightPass, fragments);
    for (std::size_t p = 0; p < scene.part_materials.size(); ++p) {
        set(shade_pass(scene, p), static_cast<double>(s.layout.fragments(p)));
    }
    set(kResolvePass, static_cast<double>(s.map.covered_pixels));
}

ImageF RadianceRenderer::read_back() const { return read_floats(state_->target); }

void RadianceRenderer::read_back_into(ImageF* picture) const {
    read_floats_into(state_->target, picture);
}

unsigned RadianceRenderer::texture() const { return state_->target.name(); }

const SurfaceMap& RadianceRenderer::surface_map() const { return state_->map; }

const std::shared_ptr<const FrameGeometry>& RadianceRenderer::geometry() const {
    return state_->geometry;
}

RadianceRenderer::Counters RadianceRenderer::counters() const {
    Counters counters = state_->counters;
    counters.programs = state_->programs.compiled() + (state_->resolve ? 1 : 0);
    counters.textures = state_->own_textures + state_->inputs.textures_made();
    return counters;
}

}  // namespace livery
