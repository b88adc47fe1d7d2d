// What shading reads of each fragment and what does not depend on the paint, solved on the CPU and
// kept until the pose, the eye, a light or the environment changes.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radiance/environment_filter.h"
#include "radiance/light_visibility.h"
#include "radiance/packed_fragments.h"
#include "radiance/shading.h"
#include "radiance/sky_visibility.h"
#include "scene/frame_plan.h"
#include "scene/scene.h"

namespace livery {

/// How much is spent on what a level of quality solves; rays are a fragment's.
struct QualityRays {
    int light = 16;  ///< toward each light with a size
    int sky = 16;    ///< toward the environment
    int mirror = 8;  ///< over each wide mirror lobe (MirrorVisibility)
};
QualityRays rays_of(Quality quality);

/// Runs one stage where the plan lists it and its result does not stand; times it.
class StageClock {
  public:
    explicit StageClock(FramePlan& plan) : plan_(&plan) {}
    template <typename Work>
    bool run(const std::string& pass, bool stale, const Work& work) {
        PlannedPass* planned = find_pass(*plan_, pass);
        if (!planned) return false;
        planned->ms = 0.0;
        if (!stale) return false;
        const double begin = now_ms();
        work();
        planned->ms = now_ms() - begin;
        ++passes_run_;
        return true;
    }
    int passes_run() const { return passes_run_; }
    static double now_ms();

  private:
    FramePlan* plan_;
    int passes_run_ = 0;
};

class FragmentInputs {
  public:
    FragmentInputs(const Mesh& mesh,
                   const Tracer& tracer,
                   const SurfaceMap& map,
                   const PackedLayout& layout);

    /// Brings everything that the plan lists up to date; true when shading must follow.
    bool update(const Scene& scene,
                const FramePlan& plan,
                StageClock& clock,
                const Progress& progress);
    const ShadingInputs& shading() const { return shading_; }
    int textures_made() const { return textures_made_; }

  private:
    struct Light {
        std::size_t index = 0;  ///< in the scene
        DirectionalLight light;
        int rays = 0;
        std::vector<LightAtFragment> at;
    };
    bool update_lights(const Scene&, const FramePlan&, StageClock&, const Progress&);
    bool update_sky(const Scene&, const FramePlan&, StageClock&, const Progress&);
    bool update_mirror(const Scene&, const FramePlan&, StageClock&, const Progress&);
    bool update_directions(const Scene&, const FramePlan&, StageClock&, bool changed);
    bool update_diffuse_light(const FramePlan&, StageClock&, bool changed);
    void upload_directions(const Scene&);
    void upload_mirror(const Scene&);
    void make(Texture2D& texture, TextureShape shape, TexelFormat format);

    const Mesh& mesh_;
    const Tracer& tracer_;
    const SurfaceMap& map_;
    const PackedLayout& layout_;

    std::vector<Light> lights_;
    std::shared_ptr<const Environment> environment_;  ///< that sky_ was made for
    std::shared_ptr<const Environment> layered_;      ///< that filtered_.mirrored was made for
    std::shared_ptr<const Environment> mirrored_;     ///< that shading_.mirror was made for
    FilteredEnvironment filtered_;
    std::optional<SkyVisibility> sky_visibility_;
    bool sky_occluded_ = false;
    std::vector<glm::vec3> sky_;
    std::optional<MirrorVisibility> mirror_visibility_;
    bool mirror_occluded_ = false;
    std::optional<glm::dvec3> visibility_eye_, mirror_eye_, eye_;
    ShadingInputs shading_;
    int textures_made_ = 0;
};

}  // namespace livery
