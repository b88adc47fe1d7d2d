// What shading reads of each fragment and what does not depend on the paint, solved on the CPU and
// kept until the pose, the eye, a light or the environment changes.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radiance/glints.h"
#include "radiance/light/environment_filter.h"
#include "radiance/light/interreflection.h"
#include "radiance/light/light_visibility.h"
#include "radiance/light/mirrored_environment.h"
#include "radiance/light/sky_visibility.h"
#include "radiance/mirror_inputs.h"
#include "radiance/packed_fragments.h"
#include "radiance/shading.h"
#include "radiance/smooth_runs.h"
#include "radiance/subsurface/subsurface_inputs.h"
#include "scene/frame_plan.h"
#include "scene/scene.h"

namespace livery {

/// What the levels of effects mean here; rays are a fragment's.
struct FragmentRays {
    int light = 16;   ///< toward each light with a size; 0: nothing is hidden
    SkyRays sky;      ///< toward the environment; 0: nothing is hidden
    int mirror = 16;  ///< nodes a ring of half vectors' slopes (mirror_rings), or kNoNodes
    int bounces = 1;  ///< of light between parts
    TransportDetail subsurface{};
};
FragmentRays rays_of(const EffectLevels& levels);

/// Runs one stage where the plan lists it and its result does not stand; times it.
class StageClock {
  public:
    /// `progress` hears of each stage that runs, as its place in the plan.
    explicit StageClock(FramePlan& plan, const Progress* progress = nullptr)
        : plan_(&plan), progress_(progress) {}
    template <typename Work>
    bool run(const PassId& pass, bool stale, const Work& work) {
        PlannedPass* planned = find_pass(*plan_, pass);
        if (!planned) return false;
        planned->ms = 0.0;
        if (!stale) return false;
        // Passes do not all run in the plan's order, and progress never goes back
        furthest_ = std::max(furthest_, place_of(*planned));
        if (progress_) progress_->update(furthest_, to_string(pass));
        const double begin = now_ms();
        work();
        planned->ms = now_ms() - begin;
        ++passes_run_;
        return true;
    }
    /// What a pass takes after it ran, listed or not.
    template <typename Work>
    void add(const PassId& pass, const Work& work) {
        PlannedPass* planned = find_pass(*plan_, pass);
        const double begin = now_ms();
        work();
        if (planned) planned->ms = planned->ms.value_or(0.0) + now_ms() - begin;
    }
    int passes_run() const { return passes_run_; }
    static double now_ms();

  private:
    double place_of(const PlannedPass& pass) const {
        return static_cast<double>(&pass - plan_->passes.data()) /
               static_cast<double>(plan_->passes.size());
    }

    FramePlan* plan_;
    const Progress* progress_;
    double furthest_ = 0.0;
    int passes_run_ = 0;
};

class FragmentInputs {
  public:
    /// With `keep_better`, what was solved with more rays than the plan's quality asks for stands.
    FragmentInputs(const Mesh& mesh,
                   const Tracer& tracer,
                   std::shared_ptr<SharedExchange> exchange,
                   std::shared_ptr<SharedTransports> transports,
                   const View& view,
                   const SurfaceMap& map,
                   const PackedLayout& layout,
                   ShadingDevice device,
                   bool keep_better,
                   InputLayers::Precision light_precision);

    /// Another map of the same fragments: nothing that was solved stands.
    void use(const SurfaceMap& map);

    /// Solves everything that the plan lists and that does not stand, without OpenGL. A stop leaves
    /// what was solved until then; what a plan does not list is kept while its light stays. With
    /// `keep_exchange` light between parts stays that of other paints, or none.
    void solve(const Scene& scene,
               const FramePlan& plan,
               StageClock& clock,
               const Progress& progress,
               bool keep_exchange);
    /// Which paints must be shaded again.
    struct Changed {
        bool diffuse = false;  ///< the plain diffuse ones
        bool glossy = false;
    };
    /// Hands what solve() changed to the device that shades.
    Changed upload(const Scene& scene, StageClock& clock);
    /// Of each part, the layers of what it mirrors that are solved in the last solve()'s light; all
    /// where that has no environment.
    SolvedMirror mirrored() const;
    const ShadingInputs& shading() const { return shading_; }
    int layers_made() const { return layers_made_; }

  private:
    /// Of map_; those for what is looked up while it is dragged have their ends farther apart.
    enum class Runs { fine, dragged, of_rows };
    const SmoothRuns& runs(Runs which);
    struct Light {
        std::size_t index = 0;  ///< in the scene
        DirectionalLight light;
        int rays = 0;
        std::vector<LightAtFragment> at;
    };
    void solve_lights(const Scene&, const FramePlan&, StageClock&, const Progress&);
    void solve_sky(const Scene&, const FramePlan&, StageClock&, const Progress&);
    void solve_exchange(const Scene&, const FramePlan&, StageClock&, const Progress&, bool keep);
    void solve_subsurface(const Scene&, const FramePlan&, StageClock&, const Progress&, bool keep);
    void solve_mirror(
        const Scene&, const FramePlan&, StageClock&, const Progress&, bool keep_exchange);
    bool mirror_filtered(const std::shared_ptr<const Environment>&, int nodes) const;
    void filter_for_mirror(const std::shared_ptr<const Environment>&, int nodes, const Progress&);
    void drop_exchange();
    template <typename Value>
    void upload_packed(InputLayers& input, int layer, const Value& value);
    void upload_eye(const Scene&);
    void upload_lights();
    void upload_sky();
    /// What enters a medium at a fragment, in units of what a white diffuser sends.
    /// `share` is entering_share() of the index.
    glm::vec3 entering_at(std::size_t fragment,
                          const EnteredMedium& medium,
                          float share,
                          float curvature_per_mm) const;
    void upload_diffuse_light();
    void upload_places();
    bool enough(int rays, int wanted) const {
        return keep_better_ ? rays >= wanted : rays == wanted;
    }
    void make(InputLayers& input, std::size_t layers, InputLayers::Precision precision);

    const Mesh& mesh_;
    const Tracer& tracer_;
    const std::shared_ptr<SharedExchange> shared_exchange_;
    const PixelSize pixels_;
    const SurfaceMap* map_;
    const PackedLayout& layout_;

    const ShadingDevice device_;
    const bool keep_better_;
    const InputLayers::Precision light_precision_;  ///< of `lit`, `sky` and `mirror`

    std::vector<Light> lights_;
    FilteredEnvironment filtered_;
    std::shared_ptr<const Environment> diffused_;  ///< that filtered_.diffuse was made for
    std::shared_ptr<const Environment> layered_;   ///< that filtered_.gaussians was made for
    std::optional<MirrorLookUp> mirror_look_up_;
    std::shared_ptr<const Environment> look_up_of_;  ///< that mirror_look_up_ was made for
    std::array<std::optional<SmoothRuns>, 3> runs_;  ///< of map_, when they were asked for
    std::optional<SkyVisibility> sky_visibility_;
    std::vector<glm::vec3> sky_;
    MirrorInputs mirror_;

    /// Light that parts send to one another: what it was made of, and from one step to the next.
    struct Exchanged {
        std::shared_ptr<const NodeExchange> nodes;
        std::vector<DirectionalLight> lights;
        std::shared_ptr<const Environment> environment;
        DirectLight direct;           ///< at the nodes; empty: not solved
        std::vector<bool> lobes;      ///< parts that it was solved for by ray
        NodeReflectance reflectance;  ///< of paints and artwork
        std::vector<Material> paints;
        std::vector<PartArtwork> artwork;
        int bounces = 0;
        ExchangedLight at_nodes;             ///< empty: none
        std::vector<glm::vec3> on_diffuser;  ///< at the fragments
        int version = 0;                     ///< of both
    };
    Exchanged exchanged_;
    int arriving_version_ = 0;  ///< of lights_ and sky_
    SubsurfaceInputs subsurface_;

    /// What sky_ was made of. No rays: unoccluded.
    struct Made {
        std::shared_ptr<const Environment> of;
        int rays = 0;
    };
    Made sky_made_;
    std::optional<glm::dvec3> eye_;  ///< that shading_.eye is for
    /// Sticky, so that a stop between two passes loses nothing.
    bool directions_stale_ = true, sky_stale_ = true, diffuse_light_stale_ = true,
         places_stale_ = true;
    Changed changed_;
    ShadingInputs shading_;
    std::vector<float> packed_;  ///< what is handed over next, kept for the one after
    int layers_made_ = 0;
};

}  // namespace livery
