// (1) scene x projector view -> linear radiance. Shaded for the eye point, in OpenGL, or on the
// processor where OpenGL would be software.
#pragma once

#include <memory>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "gl/timer.h"
#include "radiance/lanes/input_layers.h"
#include "radiance/light/interreflection.h"
#include "radiance/light/mirror_lobes.h"
#include "radiance/subsurface/subsurface_transport.h"
#include "radiance/surface_map.h"
#include "scene/effects.h"
#include "scene/frame_plan.h"
#include "scene/product.h"
#include "scene/scene.h"
#include "scene/view.h"
#include "tracing/tracer.h"

namespace livery {

/// Rays a pixel of the surface map that a level is worth: few for the first picture of a pose.
int sub_samples_of(const EffectLevels& levels);
int sub_samples_of(Quality quality);

/// What a product and a view fix, whatever it is painted and lit with: rays through the product and
/// its surface map. Immutable: renderers of the same product and view share it.
struct FrameGeometry {
    FrameGeometry(std::shared_ptr<const Product> its_product,
                  const View& its_view,
                  const Progress& progress = {},
                  int sub_samples = 16);
    /// The same product and view with another number of sub-samples.
    FrameGeometry(const FrameGeometry& other, int sub_samples, const Progress& progress = {});

    std::shared_ptr<const Product> product;
    View view;
    std::shared_ptr<const Tracer> tracer;  ///< shared with maps of other numbers of sub-samples
    SurfaceMap map;
    std::shared_ptr<SharedExchange> exchange;      ///< the same
    std::shared_ptr<SharedTransports> transports;  ///< the same
    double ms = 0.0;                               ///< that making it took
    double tracer_ms = 0.0;                        ///< of it: the tree of the product's triangles
};

/// Light that parts send to one another, when paints have changed: solved anew, or left as it is of
/// the paints before, so that a new one need not wait for the light that it sends on.
enum class LightBetweenParts { solved, kept };

/// Draws one product from one view; needs a current OpenGL context, the same for its whole life
/// (the processor for texture() alone). What does not change between frames (surface map,
/// visibility, environment, programs) is kept and made only when the plan asks for it.
class RadianceRenderer {
  public:
    RadianceRenderer(std::shared_ptr<const Product> product,
                     const View& view,
                     const Progress& progress = {});
    /// With `keep_better`, what was solved with more rays than a plan's quality asks for stands, so
    /// that a draft of a new light keeps the environment of a better level. Throws
    /// std::invalid_argument for the processor with other than StoredHalves::all: its lanes read
    /// halves.
    explicit RadianceRenderer(std::shared_ptr<const FrameGeometry> geometry,
                              bool keep_better = false,
                              ShadingDevice device = ShadingDevice::automatic,
                              StoredHalves halves = StoredHalves::all);
    ~RadianceRenderer();
    RadianceRenderer(const RadianceRenderer&) = delete;
    RadianceRenderer& operator=(const RadianceRenderer&) = delete;

    /// The part of render() that needs no OpenGL, ahead of it: on any thread, while no other call
    /// runs. Stopped by `progress`, it keeps what it has solved until then.
    void solve(const Scene& scene,
               FramePlan& plan,
               const Progress& progress = {},
               LightBetweenParts exchanged = LightBetweenParts::solved);

    /// Of each part, what it mirrors that is solved, in the light of the last solve(); all of it
    /// where that has no environment.
    SolvedMirror mirrored() const;

    /// Everything that render() would need for this scene, programs included, without drawing.
    void prepare(const Scene& scene,
                 FramePlan& plan,
                 const Progress& progress = {},
                 LightBetweenParts exchanged = LightBetweenParts::solved);

    /// Shades whatever changed since the last call, and nothing else. Fills in the plan's measured
    /// milliseconds (0 for a pass whose result still stood) and work items. `plan` must be
    /// plan_frame() of this scene; passes of other stages (compensation) are left alone. Throws
    /// std::invalid_argument for another product or the path tracer's level.
    void render(const Scene& scene,
                FramePlan& plan,
                const Progress& progress = {},
                LightBetweenParts exchanged = LightBetweenParts::solved);

    /// Fills in `work_items`, what each pass's cost is linear in (rays, texels, fragments, pixels),
    /// without drawing.
    void count_work(const Scene& scene, FramePlan& plan) const;

    /// The last frame in the working space: R, G, B, coverage. Colour is the mean over the covered
    /// part of a pixel, 0 where nothing is covered.
    ImageF read_back() const;
    /// The same without a copy, shared with the renderer until it draws the next one.
    std::shared_ptr<const ImageF> picture() const;

    /// OpenGL name of the texture that holds the last frame, for the compensation pass: RGBA16F,
    /// but RGBA32F where pictures are not stored in halves.
    unsigned texture() const;
    const SurfaceMap& surface_map() const;
    const std::shared_ptr<const FrameGeometry>& geometry() const;

    ShadingDevice device() const;  ///< gl or processor

    /// What this renderer did so far. What it asked of OpenGL is counted there, at the calls.
    struct Counters {
        int programs = 0;  ///< linked
        int textures = 0;  ///< made; with the processor's arrays in their place
        int passes_run = 0, fragments_shaded = 0;
        GlCounters gl{};
    };
    Counters counters() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
