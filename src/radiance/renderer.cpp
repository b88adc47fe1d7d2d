#include "radiance/renderer.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "appearance/model_table.h"
#include "core/error.h"
#include "core/recycler.h"
#include "gl/context.h"
#include "gl/draw.h"
#include "gl/read_back.h"
#include "gl/timer.h"
#include "radiance/artwork_inputs.h"
#include "radiance/fragment_inputs.h"
#include "radiance/lanes/processor_shading.h"
#include "radiance/packed_fragments.h"
#include "radiance/shading.h"
#include "radiance/stages.h"

namespace livery {

int sub_samples_of(const EffectLevels& levels) {
    constexpr std::array kSubSamples{4, 16, 64};
    return kSubSamples.at(static_cast<std::size_t>(levels[Effect::sub_samples]));
}

int sub_samples_of(Quality quality) { return sub_samples_of(levels_of(quality)); }

FrameGeometry::FrameGeometry(std::shared_ptr<const Product> its_product,
                             const View& its_view,
                             const Progress& progress,
                             int sub_samples)
    : product(std::move(its_product)), view(its_view) {
    check_argument(product != nullptr, "a renderer needs a product");
    const double begin_ms = StageClock::now_ms();
    tracer = std::make_shared<const Tracer>(product->mesh);
    exchange = std::make_shared<SharedExchange>();
    transports = std::make_shared<SharedTransports>();
    tracer_ms = StageClock::now_ms() - begin_ms;
    map = build_surface_map(product->mesh, *tracer, view, sub_samples, progress);
    ms = StageClock::now_ms() - begin_ms;
}

FrameGeometry::FrameGeometry(const FrameGeometry& other, int sub_samples, const Progress& progress)
    : product(other.product),
      view(other.view),
      tracer(other.tracer),
      exchange(other.exchange),
      transports(other.transports) {
    const double begin_ms = StageClock::now_ms();
    map = build_surface_map(product->mesh, *tracer, view, sub_samples, progress);
    ms = StageClock::now_ms() - begin_ms;
}

namespace {

void check_fits(const Scene& scene, const FramePlan& plan, const Product* product) {
    check_argument(scene.product.get() == product, "the scene shows another product");
    const auto check = [&](const PassId& pass) {
        check_argument(
            find_pass(plan, pass) != nullptr,
            fmt::format("the plan has no pass \"{}\": it is of another scene", to_string(pass)));
    };
    for (std::size_t i = 0; i < scene.part_materials.size(); ++i) check(shade_pass(scene, i));
    for (std::size_t k = 0; k < scene.artwork.size(); ++k) check(artwork_pass(scene, k));
    if (!scene.relief.empty()) check(PassKind::relief);
}

/// What a part was shaded with.
struct Shaded {
    Material material;
    std::vector<Material> artwork;
    double exposure_ev = 0.0;
    int light = 0, cover = 0;  ///< versions of what they read and of how artwork lies

    bool operator==(const Shaded& other) const {
        return exposure_ev == other.exposure_ev && light == other.light && cover == other.cover &&
               same_reflectance(material, other.material) &&
               std::equal(artwork.begin(),
                          artwork.end(),
                          other.artwork.begin(),
                          other.artwork.end(),
                          same_reflectance);
    }
};

/// Adds to `sum` what is asked of OpenGL while it lives.
class CountGl {
  public:
    explicit CountGl(GlCounters& sum) : sum_(sum), before_(gl_counters() - sum) {}
    ~CountGl() { sum_ = gl_counters() - before_; }
    CountGl(const CountGl&) = delete;
    CountGl& operator=(const CountGl&) = delete;

  private:
    GlCounters& sum_;
    const GlCounters before_;
};

}  // namespace

struct RadianceRenderer::State {
    std::shared_ptr<const FrameGeometry> geometry;
    const SurfaceMap& map;
    bool map_reported = false;

    const ShadingDevice device;
    const TexelFormat picture_format;
    PackedLayout layout;
    SurfaceMap tilted;  ///< the map with a relief, where the scene has one
    std::vector<PartArtwork> relief;
    FragmentInputs inputs;
    ArtworkInputs artwork;
    std::optional<ShadingPrograms> programs;  ///< none on the processor, which needs no OpenGL
    std::optional<ResolvePass> resolve;
    Texture2D shaded, target;
    Framebuffer shaded_framebuffer, target_framebuffer;
    std::optional<ProcessorShading> processor;

    /// Of this view alone: where the product is not, each of them is black already.
    Recycler<ImageF> pictures;
    std::shared_ptr<const ImageF> picture;  ///< the last frame; null: still in OpenGL, if at all
    bool target_stale = true;

    std::vector<std::optional<Shaded>> parts;  ///< as last shaded
    std::deque<GlTimer> timers;
    Counters counters;

    State(std::shared_ptr<const FrameGeometry> its_geometry,
          bool keep_better,
          ShadingDevice its_device,
          StoredHalves halves)
        : geometry(std::move(its_geometry)),
          map(geometry->map),
          device(its_device),
          picture_format(halves == StoredHalves::all ? TexelFormat::rgba16f : TexelFormat::rgba32f),
          layout(layout_of(map)),
          inputs(*geometry,
                 layout,
                 device,
                 keep_better,
                 halves == StoredHalves::none ? InputLayers::Precision::full
                                              : InputLayers::Precision::half),
          artwork(geometry->product->mesh, geometry->view, map, layout, device),
          parts(geometry->product->mesh.parts.size()) {
        if (device == ShadingDevice::gl) programs.emplace();
    }

    void solve(const Scene& scene,
               FramePlan& plan,
               StageClock& clock,
               const Progress& progress,
               LightBetweenParts exchanged);
    void make_shading();
    void make_target();
    std::shared_ptr<ImageF> blank_picture();
    /// Shades the parts that need it; their timers are read when all is drawn.
    void shade(const Scene& scene, FramePlan& plan);
    Shaded wanted_of(const Scene& scene, std::size_t part) const;
    template <typename OnProcessor, typename InOpenGl>
    void time_shading(PlannedPass& pass,
                      std::size_t fragments,
                      const OnProcessor& on_processor,
                      const InOpenGl& in_open_gl);
    void shade_part(FramePlan& plan, const Scene& scene, std::size_t part);
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
                                    const Progress& progress,
                                    LightBetweenParts exchanged) {
    check_argument(plan.quality != Quality::reference, "the reference level is the path tracer's");
    check_fits(scene, plan, geometry->product.get());
    if (PlannedPass* pass = find_pass(plan, PassKind::surface_map)) {
        pass->ms = map_reported ? 0.0 : geometry->ms;
        if (!map_reported) ++counters.passes_run;
        map_reported = true;
    }
    const int before = clock.passes_run();
    const bool other_relief = !same_relief(relief, scene.relief);
    clock.run(
        PassKind::relief, other_relief, [&] { tilted = relieved(map, scene, geometry->view); });
    if (other_relief) {
        inputs.use(scene.relief.empty() ? map : tilted);
        relief = scene.relief;
    }
    inputs.solve(scene, plan, clock, progress, exchanged == LightBetweenParts::kept);
    if (!clock.run(PassKind::artwork, !artwork.stands(scene), [&] { artwork.solve(scene); })) {
        artwork.solve(scene);  // what is there no more
    }
    counters.passes_run += clock.passes_run() - before;
    progress.check_stop();
}

void RadianceRenderer::State::make_shading() {
    if (shaded || processor) return;
    if (device == ShadingDevice::processor) {
        processor.emplace(map, layout);
    } else {
        shaded = Texture2D(kPackedWidth, layout.rows, picture_format);
        shaded_framebuffer = Framebuffer({&shaded});
    }
}

void RadianceRenderer::State::make_target() {
    if (target) return;
    target = Texture2D(map.width, map.height, picture_format);
    target_framebuffer = Framebuffer({&target});
    target.clear();
}

std::shared_ptr<ImageF> RadianceRenderer::State::blank_picture() {
    auto blank = pictures.take();
    if (blank->empty()) *blank = ImageF(map.width, map.height, 4);
    return blank;
}

Shaded RadianceRenderer::State::wanted_of(const Scene& scene, std::size_t part) const {
    Shaded wanted{scene.part_materials[part], {}, scene.exposure_ev};
    wanted.light = inputs.version_for(wanted.material);
    wanted.cover = artwork.version(part);
    for (const PartArtwork& over : scene.artwork) {
        if (over.part != part) continue;
        wanted.artwork.push_back(over.material);
        wanted.light += inputs.version_for(over.material);
    }
    return wanted;
}

void RadianceRenderer::State::shade(const Scene& scene, FramePlan& plan) {
    make_shading();
    parts_shaded = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) find_pass(plan, shade_pass(scene, p))->ms = 0.0;
    for (std::size_t k = 0; k < scene.artwork.size(); ++k) {
        find_pass(plan, artwork_pass(scene, k))->ms = 0.0;
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
        Shaded wanted = wanted_of(scene, p);
        if (parts[p] == wanted) continue;
        parts[p] = std::move(wanted);
        if (layout.fragments(p) == 0) continue;
        shade_part(plan, scene, p);
        ++parts_shaded;
    }
}

template <typename OnProcessor, typename InOpenGl>
void RadianceRenderer::State::time_shading(PlannedPass& pass,
                                           std::size_t fragments,
                                           const OnProcessor& on_processor,
                                           const InOpenGl& in_open_gl) {
    ++counters.passes_run;
    counters.fragments_shaded += static_cast<int>(fragments);
    if (processor) {
        const double begin = StageClock::now_ms();
        on_processor();
        pass.ms = *pass.ms + StageClock::now_ms() - begin;
        return;
    }
    GlTimer& timer = timer_for(&pass);
    timer.start();
    in_open_gl();
    timer.stop();
}

void RadianceRenderer::State::shade_part(FramePlan& plan, const Scene& scene, std::size_t part) {
    const ShadingInputs& shading = inputs.shading();
    const double exposure_ev = scene.exposure_ev;
    const PixelRect rectangle = layout.rectangle(part);
    const Material& material = scene.part_materials[part];
    time_shading(
        *find_pass(plan, shade_pass(scene, part)),
        layout.fragments(part),
        [&] { processor->shade(material, shading, exposure_ev, part); },
        [&] { programs->shade(material, shading, exposure_ev, rectangle, shaded_framebuffer); });
    for (std::size_t k = 0; k < scene.artwork.size(); ++k) {
        if (scene.artwork[k].part != part || artwork.covered(k) == 0) continue;
        const InputLayers& means = artwork.layers(k);
        const std::vector<ArtworkCoat> coats = coats_of(scene.artwork[k]);
        time_shading(
            *find_pass(plan, artwork_pass(scene, k)),
            coats.size() * artwork.covered(k),
            [&] {
                for (const ArtworkCoat& coat : coats) {
                    processor->shade(coat, means, shading, exposure_ev, part);
                }
            },
            [&] {
                for (const ArtworkCoat& coat : coats) {
                    programs->shade(
                        coat, means, shading, exposure_ev, rectangle, shaded_framebuffer);
                }
            });
    }
}

void RadianceRenderer::State::run_resolve(FramePlan& plan) {
    PlannedPass* pass = find_pass(plan, PassKind::resolve);
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
    if (!resolve) resolve.emplace(map, layout);
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
                                   ShadingDevice device,
                                   StoredHalves halves) {
    check_argument(geometry != nullptr, "a renderer needs a geometry");
    const ShadingDevice chosen = chosen_device(device);
    check_argument(chosen == ShadingDevice::gl || halves == StoredHalves::all,
                   "the processor's lanes read half floats: full ones are OpenGL's");
    state_ = std::make_unique<State>(std::move(geometry), keep_better, chosen, halves);
}

RadianceRenderer::~RadianceRenderer() = default;

void RadianceRenderer::solve(const Scene& whole,
                             FramePlan& plan,
                             const Progress& progress,
                             LightBetweenParts exchanged) {
    const Scene scene = at_levels(whole, plan.levels);
    StageClock clock(plan, &progress);
    const Progress silent{{}, progress.stop};
    state_->solve(scene, plan, clock, silent, exchanged);
}

SolvedMirror RadianceRenderer::mirrored() const { return state_->inputs.mirrored(); }

void RadianceRenderer::prepare(const Scene& whole,
                               FramePlan& plan,
                               const Progress& progress,
                               LightBetweenParts exchanged) {
    const Scene scene = at_levels(whole, plan.levels);
    State& s = *state_;
    const CountGl count(s.counters.gl);
    StageClock clock(plan, &progress);
    const Progress silent{{}, progress.stop};
    s.solve(scene, plan, clock, silent, exchanged);
    s.inputs.upload(scene, clock);
    s.artwork.upload();
    if (s.device == ShadingDevice::processor) return;
    for (const Material& material : scene.part_materials) {
        progress.check_stop();
        s.programs->compile(material, s.inputs.shading());
        if (!scene.artwork.empty()) s.programs->compile(material, s.inputs.shading(), true);
    }
    for (const PartArtwork& artwork : scene.artwork) {
        progress.check_stop();
        s.programs->compile(artwork.material, s.inputs.shading(), true);
    }
}

void RadianceRenderer::render(const Scene& whole,
                              FramePlan& plan,
                              const Progress& progress,
                              LightBetweenParts exchanged) {
    const Scene scene = at_levels(whole, plan.levels);
    State& s = *state_;
    const CountGl count(s.counters.gl);
    StageClock clock(plan);
    s.solve(scene, plan, clock, progress, exchanged);
    count_work(scene, plan);
    const int before = clock.passes_run();
    s.inputs.upload(scene, clock);
    s.artwork.upload();
    s.counters.passes_run += clock.passes_run() - before;
    s.running.clear();
    s.shade(scene, plan);
    s.run_resolve(plan);
    s.read_timers();
}

void RadianceRenderer::count_work(const Scene& scene, FramePlan& plan) const {
    const State& s = *state_;
    FrameCounts counts;
    counts.covered_pixels = static_cast<double>(s.map.covered_pixels);
    counts.samples_per_pixel = s.map.samples_per_pixel;
    for (std::size_t p = 0; p < scene.part_materials.size(); ++p) {
        counts.fragments_of_part.push_back(static_cast<double>(s.layout.fragments(p)));
    }
    if (s.artwork.stands(at_levels(scene, plan.levels))) {
        for (std::size_t k = 0; k < scene.artwork.size(); ++k) {
            counts.fragments_of_artwork.push_back(static_cast<double>(s.artwork.covered(k)));
        }
    }
    livery::count_work(scene, counts, plan);
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
    const CountGl count(s.counters.gl);
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
    counters.programs = static_cast<int>(counters.gl.programs);
    counters.textures = static_cast<int>(counters.gl.textures);
    if (state_->device == ShadingDevice::processor) {
        counters.textures += (state_->processor ? 1 : 0) + state_->inputs.layers_made() +
                             state_->artwork.layers_made();
    }
    return counters;
}

}  // namespace livery
