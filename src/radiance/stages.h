// The stages of a renderer: what the levels of effects mean in rays, what each pass has to do, and
// how long it took.
#pragma once

#include <algorithm>
#include <vector>

#include "core/progress.h"
#include "radiance/light/sky_visibility.h"
#include "radiance/subsurface/subsurface_transport.h"
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

/// Of a picture, drawn or only estimated.
struct FrameCounts {
    double covered_pixels = 0.0;
    int samples_per_pixel = 1;                 ///< of the surface map
    std::vector<double> fragments_of_part;     ///< as the product's parts
    std::vector<double> fragments_of_artwork;  ///< that it covers, as the scene's; empty: not known
};

/// Fills work_items of all passes but the correction's: rays, nodes, fragments or pixels.
void count_work(const Scene& scene, const FrameCounts& counts, FramePlan& plan);

}  // namespace livery
