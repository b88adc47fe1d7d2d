#include "ledger/accuracy/chain_halves.h"

#include <algorithm>

#include "core/error.h"
#include "core/pictures/colour_differences.h"
#include "core/statistics.h"
#include "ledger/accuracy/chain_steps.h"
#include "radiance/renderer.h"
#include "scene/frame_plan.h"

namespace livery {

namespace {

constexpr int kHalvesSwaps = 5;

AccuracyScene scene_named(const std::string& name, const Progress& progress = {}) {
    std::vector<AccuracyScene> scenes = accuracy_scenes(true, progress);
    if (scenes.front().name != name) scenes = accuracy_scenes(false, progress);
    const auto found = std::find_if(
        scenes.begin(), scenes.end(), [&](const auto& scene) { return scene.name == name; });
    check_argument(found != scenes.end(), "no scene of the ledger is called " + name);
    return *found;
}

ChainPart part_of(const std::string& scene_name, bool slow) {
    ChainPart part;
    part.slow = slow;
    for (const char* level :
         {"light, shaded fragments and picture", "light that reaches fragments"}) {
        part.rows.push_back({"half floats, " + scene_name, level, "full floats"});
    }
    part.inputs = [scene_name] { return hash_of(scene_named(scene_name)); };
    part.measure = [scene_name](std::vector<ChainRow>& rows, const Progress& progress) {
        const AccuracyScene scene = scene_named(scene_name, progress);
        const auto geometry =
            std::make_shared<const FrameGeometry>(scene.scene.product, scene.view, progress);
        const StoredPicture full = stored_picture(scene, geometry, StoredHalves::none, progress);
        const StoredHalves halves[] = {StoredHalves::all, StoredHalves::inputs};
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const StoredPicture stored = stored_picture(scene, geometry, halves[k], progress);
            set_errors(rows[k], colour_differences(stored.working, full.working));
            rows[k].ms = stored.swap_ms;
        }
    };
    return part;
}

}  // namespace

StoredPicture stored_picture(const AccuracyScene& scene,
                             const std::shared_ptr<const FrameGeometry>& geometry,
                             StoredHalves halves,
                             const Progress& progress) {
    RadianceRenderer renderer(geometry, false, ShadingDevice::gl, halves);
    const auto drawn = [&](const Scene& its) {
        FramePlan plan = plan_frame(its, Quality::normal, FrameStage::radiance);
        return milliseconds_of([&] {
            renderer.render(its, plan, progress);
            renderer.picture();
        });
    };
    StoredPicture stored;
    drawn(scene.scene);
    stored.working = renderer.read_back();
    std::vector<double> swaps;
    Scene again = scene.scene;
    for (int k = 0; k < kHalvesSwaps; ++k) {
        progress.check_stop();
        // Another exposure shades every part anew, and nothing else
        again.exposure_ev += 0.01;
        swaps.push_back(drawn(again));
    }
    stored.swap_ms = median(swaps);
    return stored;
}

std::vector<ChainPart> half_float_parts(const AccuracyOptions&) {
    return {part_of("car, solid red, studio", false),
            part_of("car, pearl with a film, overcast", true)};
}

}  // namespace livery
