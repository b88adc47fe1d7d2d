#include "radiance/renderer.h"

#include <algorithm>
#include <deque>
#include <optional>

#include <fmt/format.h>

#include "appearance/model_table.h"
#include "core/error.h"
#include "core/recycler.h"
#include "gl/context.h"
#include "gl/draw.h"
#include "gl/read_back.h"
#include "gl/timer.h"
#include "radiance/environment_filter.h"
#include "radiance/fragment_inputs.h"
#include "radiance/packed_fragments.h"
#include "radiance/processor_shading.h"
#include "radiance/resolve.h"
#include "radiance/shading.h"

namespace livery {
namespace {

void check_fits(const Scene& scene, const FramePlan& plan, const Product* product) {
    check_argument(scene.product.get() == product, "the scene shows another product");
    for (std::size_t i = 0; i < scene.part_materials.size(); ++i) {
        const std::string pass = shade_pass(scene, i);
        check_argument(find_pass(plan, pass) != nullptr,
                       fmt::format("the plan has no pass \"{}\": it is of another scene", pass));
    }
}

}  // namespace

int sub_samples_of(Quality quality) { return quality == Quality::draft ? 4 : 16; }

FrameGeometry::FrameGeometry(std::shared_ptr<const Product> its_product,
                             const View& its_view,
                             const Progress& progress,
                             int sub_samples)
    : product(std::move(its_product)), view(its_view) {
    check_argument(product != nullptr, "a renderer needs a product");
    const double begin_ms = StageClock::now_ms();
    tracer = std::make_shared<const Tracer>(product->mesh);
    tracer_ms = StageClock::now_ms() - begin_ms;
    map = build_surface_map(product->mesh, *tracer, view, sub_samples, progress);
    ms = StageClock::now_ms() - begin_ms;
}

FrameGeometry::FrameGeometry(const FrameGeometry& other, int sub_samples, const Progress& progress)
    : product(other.product), view(other.view), tracer(other.tracer) {
    const double begin_ms = StageClock::now_ms();
    map = build_surface_map(product->mesh, *tracer, view, sub_samples, progress);
    ms = StageClock::now_ms() - begin_ms;
}

struct RadianceRenderer::State {
    std::shared_ptr<const FrameGeometry> geometry;
    const SurfaceMap& map;
    bool map_reported = false;

    const ShadingDevice device;
    PackedLayout layout;
    FragmentInputs inputs;
    ShadingPrograms programs;
    std::optional<ResolvePass> resolve;
    Texture2D shaded, target;
    Framebuffer shaded_framebuffer, target_framebuffer;
    std::optional<ProcessorShading> processor;

    /// Of this view alone: where the product is not, each of them is black already.
    Recycler<ImageF> pictures;
    std::shared_ptr<const ImageF> picture;  ///< the last frame; null: still in OpenGL, if at all
    bool target_stale = true;

    struct Shaded {
        Material material;
        double exposure_ev = 0.0;
    };
    std::vector<std::optional<Shaded>> parts;  ///< as last shaded
    std::deque<GlTimer> timers;
    int own_textures = 0;
    Counters counters;

    State(std::shared_ptr<const FrameGeometry> its_geometry,
          bool keep_better,
          ShadingDevice its_device)
        : geometry(std::move(its_geometry)),
          map(geometry->map),
          device(its_device),
          layout(layout_of(map)),
          inputs(geometry->product->mesh, *geometry->tracer, map, layout, device, keep_better),
          parts(geometry->product->mesh.parts.size()) {}

    void solve(const Scene& scene, FramePlan& plan, StageClock& clock, const Progress& progress);
    void make_shading();
    void make_target();
    std::shared_ptr<ImageF> blank_picture();
    /// Shades the parts that need it; their timers are read when all is drawn.
    void shade(const Scene& scene, FramePlan& plan);
    void upload(const Scene& scene, StageClock& clock);
    void shade_part(PlannedPass& pass, const Scene& scene, std::size_t part);
    void run_resolve(FramePlan& plan);
    void read_timers();

    int parts_shaded = 0;  ///< for this frame
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

void RadianceRenderer::State::make_shading() {
    if (shaded || processor) return;
    if (device == ShadingDevice::processor) {
        processor.emplace(map, layout);
    } else {
        shaded = Texture2D(kPackedWidth, layout.rows, TexelFormat::rgba16f);
        shaded_framebuffer = Framebuffer({&shaded});
    }
    ++own_textures;
}

void RadianceRenderer::State::make_target() {
    if (target) return;
    target = Texture2D(map.width, map.height, TexelFormat::rgba16f);
    target_framebuffer = Framebuffer({&target});
    target.clear();
    ++own_textures;
}

std::shared_ptr<ImageF> RadianceRenderer::State::blank_picture() {
    auto blank = pictures.take();
    if (blank->empty()) *blank = ImageF(map.width, map.height, 4);
    return blank;
}

/// What is shaded in another light now does not stand.
void RadianceRenderer::State::upload(const Scene& scene, StageClock& clock) {
    const FragmentInputs::Changed changed = inputs.upload(scene, clock);
    for (std::optional<Shaded>& part : parts) {
        if (!part) continue;
        const bool plain = model_info(part->material.model).same_from_all_sides;
        if (plain ? changed.diffuse : changed.glossy) part.reset();
    }
}

void RadianceRenderer::State::shade(const Scene& scene, FramePlan& plan) {
    make_shading();
    parts_shaded = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        PlannedPass* pass = find_pass(plan, shade_pass(scene, p));
        pass->ms = 0.0;
        const Material& material = scene.part_materials[p];
        const bool stands = parts[p] && same_reflectance(parts[p]->material, material) &&
                            parts[p]->exposure_ev == scene.exposure_ev;
        if (stands) continue;
        parts[p] = Shaded{material, scene.exposure_ev};
        if (layout.fragments(p) == 0) continue;
        shade_part(*pass, scene, p);
        ++parts_shaded;
        ++counters.passes_run;
        counters.fragments_shaded += static_cast<int>(layout.fragments(p));
    }
}

void RadianceRenderer::State::shade_part(PlannedPass& pass, const Scene& scene, std::size_t part) {
    const Material& material = scene.part_materials[part];
    if (processor) {
        const double begin = StageClock::now_ms();
        processor->shade(material, inputs.shading(), scene.exposure_ev, part);
        pass.ms = *pass.ms + StageClock::now_ms() - begin;
        return;
    }
    GlTimer& timer = timer_for(&pass);
    timer.start();
    programs.shade(
        material, inputs.shading(), scene.exposure_ev, layout.rectangle(part), shaded_framebuffer);
    timer.stop();
}

void RadianceRenderer::State::run_resolve(FramePlan& plan) {
    PlannedPass* pass = find_pass(plan, kResolvePass);
    check_argument(pass != nullptr, "the plan has no resolve pass");
    pass->ms = 0.0;
    if (parts_shaded == 0) return;
    ++counters.passes_run;
    if (processor) {
        const double begin = StageClock::now_ms();
        const auto next = blank_picture();
        processor->resolve(next.get());
        picture = next;
        target_stale = true;
        pass->ms = StageClock::now_ms() - begin;
        return;
    }
    if (!resolve) {
        resolve.emplace(map, layout);
        own_textures += ResolvePass::kTextures;
    }
    make_target();
    GlTimer& timer = timer_for(pass);
    timer.start();
    resolve->run(shaded, target_framebuffer);
    timer.stop();
    picture = nullptr;
    target_stale = false;
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
                                   bool keep_better,
                                   ShadingDevice device) {
    check_argument(geometry != nullptr, "a renderer needs a geometry");
    if (device == ShadingDevice::automatic) {
        device = current_context_is_software() ? ShadingDevice::processor : ShadingDevice::gl;
    }
    state_ = std::make_unique<State>(std::move(geometry), keep_better, device);
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
    if (s.device == ShadingDevice::processor) return;
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
    s.run_resolve(plan);
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

ImageF RadianceRenderer::read_back() const { return *picture(); }

std::shared_ptr<const ImageF> RadianceRenderer::picture() const {
    State& s = *state_;
    if (!s.picture) {
        const auto next = s.blank_picture();
        if (s.target) read_floats_into(s.target, next.get());
        s.picture = next;
    }
    return s.picture;
}

unsigned RadianceRenderer::texture() const {
    State& s = *state_;
    s.make_target();
    if (s.picture && s.target_stale) {
        s.target.upload(std::span<const float>(s.picture->values));
        s.target_stale = false;
    }
    return s.target.name();
}

ShadingDevice RadianceRenderer::device() const { return state_->device; }

const SurfaceMap& RadianceRenderer::surface_map() const { return state_->map; }

const std::shared_ptr<const FrameGeometry>& RadianceRenderer::geometry() const {
    return state_->geometry;
}

RadianceRenderer::Counters RadianceRenderer::counters() const {
    Counters counters = state_->counters;
    counters.programs = state_->programs.compiled() + (state_->resolve ? 1 : 0);
    counters.textures = state_->own_textures + state_->inputs.layers_made();
    return counters;
}

}  // namespace livery
