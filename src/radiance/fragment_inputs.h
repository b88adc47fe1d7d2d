// What shading reads of each fragment and what does not depend on the paint, solved on the CPU.
// Each value knows what it was made from, is made when a plan asks for it, and is kept while that
// is valid.
#pragma once

#include <array>
#include <memory>
#include <optional>
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
#include "radiance/stages.h"
#include "radiance/subsurface/subsurface_inputs.h"
#include "scene/frame_plan.h"
#include "scene/scene.h"

namespace livery {

struct FrameGeometry;

/// A value and what it was made from. Whatever is made from it keeps its version.
template <typename From, typename Value>
struct Made {
    std::optional<From> from;  ///< none: not made
    Value value{};
    int version = 0;  ///< grows with each other value

    bool is_from(const From& wanted) const { return from && *from == wanted; }
    void take(From its_from, Value its_value) {
        from = std::move(its_from);
        value = std::move(its_value);
        ++version;
    }
    void drop() {
        if (!from) return;
        from.reset();
        value = Value();
        ++version;
    }
};

class FragmentInputs {
  public:
    /// With `keep_better`, what was solved with more rays than the plan's quality asks for stands.
    FragmentInputs(const FrameGeometry& geometry,
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
    /// Hands what solve() changed to the device that shades.
    void upload(const Scene& scene, StageClock& clock);
    /// Of all that a material reads of the device: grows when it must be shaded again.
    int version_for(const Material& material) const;
    /// Of each part, the layers of what it mirrors that are solved in the last solve()'s light; all
    /// where that has no environment.
    SolvedMirror mirrored() const;
    const ShadingInputs& shading() const { return shading_; }
    int layers_made() const { return layers_made_; }

  private:
    /// Of one call of solve().
    struct Solve {
        const Scene& scene;
        const FramePlan& plan;
        StageClock& clock;
        const Progress& progress;
        bool keep_exchange = false;
        FragmentRays rays = rays_of(plan.levels);
        bool plans(const PassId& pass) const { return find_pass(plan, pass) != nullptr; }
    };
    /// Of map_; those for what is looked up while it is dragged have their ends farther apart.
    enum class Runs { fine, dragged, of_rows };
    const SmoothRuns& runs(Runs which);
    struct Light {
        std::size_t index = 0;  ///< in the scene
        DirectionalLight light;
        int rays = 0;
        std::vector<LightAtFragment> at;
    };
    void solve_lights(const Solve& now);
    void solve_sky(const Solve& now);
    void solve_exchange(const Solve& now);
    void solve_subsurface(const Solve& now);
    void solve_mirror(const Solve& now);
    bool mirror_filtered(const std::shared_ptr<const Environment>&, int nodes) const;
    void filter_for_mirror(const std::shared_ptr<const Environment>&, int nodes, const Progress&);
    template <typename Value>
    void upload_packed(InputLayers& input, int layer, const Value& value);
    void upload_eye(const Scene&);
    void upload_lights();
    void upload_sky();
    /// From the environment and other parts, on a white diffuser.
    glm::vec3 surrounding_light(std::size_t fragment) const;
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
    int map_version_ = 0;
    const PackedLayout& layout_;

    const ShadingDevice device_;
    const bool keep_better_;
    const InputLayers::Precision light_precision_;  ///< of `lit`, `sky` and `mirror`

    std::vector<Light> lights_;
    int lights_version_ = 0;
    FilteredEnvironment filtered_;
    std::shared_ptr<const Environment> diffused_;  ///< that filtered_.diffuse was made for
    std::shared_ptr<const Environment> layered_;   ///< that filtered_.gaussians was made for
    std::optional<MirrorLookUp> mirror_look_up_;
    std::shared_ptr<const Environment> look_up_of_;  ///< that mirror_look_up_ was made for
    std::array<std::optional<SmoothRuns>, 3> runs_;  ///< of map_, when they were asked for
    std::optional<SkyVisibility> sky_visibility_;
    struct SkyFrom {
        std::shared_ptr<const Environment> environment;
        int rays = 0;  ///< none: unoccluded
    };
    Made<SkyFrom, std::vector<glm::vec3>> sky_;  ///< at the fragments, on a white diffuser
    MirrorInputs mirror_;

    /// Light that parts send to one another, from one step to the next.
    std::shared_ptr<const NodeExchange> nodes_;
    struct DirectFrom {
        std::vector<DirectionalLight> lights;
        std::shared_ptr<const Environment> environment;
        std::vector<bool> lobes;  ///< parts that it is solved for by ray
        bool operator==(const DirectFrom&) const = default;
    };
    Made<DirectFrom, DirectLight> direct_;  ///< at the nodes
    struct PaintsFrom {
        std::vector<Material> paints;
        std::vector<PartArtwork> artwork;
        bool operator==(const PaintsFrom& other) const;
    };
    Made<PaintsFrom, NodeReflectance> reflectance_;
    struct ExchangeFrom {
        int direct = 0, reflectance = 0;  ///< their versions
        int bounces = 0;
    };
    struct Exchanged {
        ExchangedLight at_nodes;
        std::vector<glm::vec3> on_diffuser;  ///< at the fragments
    };
    Made<ExchangeFrom, Exchanged> exchanged_;
    SubsurfaceInputs subsurface_;

    // What is on the device, by the versions of what it was made from
    using Versions = std::array<int, 4>;
    std::optional<std::pair<int, glm::dvec3>> eye_on_device_;  ///< map, eye
    std::optional<Versions> lights_on_device_, sky_on_device_, diffuse_on_device_,
        places_on_device_;
    int glossy_version_ = 0, diffuse_version_ = 0;
    ShadingInputs shading_;
    std::vector<float> packed_;  ///< what is handed over next, kept for the one after
    int layers_made_ = 0;
};

}  // namespace livery
