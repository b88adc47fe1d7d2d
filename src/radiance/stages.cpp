#include "radiance/stages.h"

#include <array>
#include <chrono>
#include <numeric>

#include "radiance/light/environment_filter.h"
#include "radiance/light/mirror_lobes.h"
#include "radiance/light/mirror_quadrature.h"
#include "radiance/surface_map.h"
#include "scene/artwork_coats.h"

namespace livery {

FragmentRays rays_of(const EffectLevels& levels) {
    constexpr std::array kLight{0, 1, 16, 64};
    constexpr std::array<SkyRays, 4> kSky{
        {{0, 0, false}, {8, 0, true}, {16, 128, false}, {64, 256, false}}};
    constexpr std::array kMirror{kNoNodes, 0, 16, 24};
    constexpr std::array kBounces{0, 1, 16};
    const auto at = [&](const auto& table, Effect effect) {
        return table.at(static_cast<std::size_t>(levels[effect]));
    };
    const std::array<TransportDetail, 3> subsurface{{{}, {200, false}, {600, true}}};
    return {at(kLight, Effect::shadows),
            at(kSky, Effect::occlusion),
            at(kMirror, Effect::mirrored_environment),
            at(kBounces, Effect::interreflection),
            at(subsurface, Effect::subsurface)};
}

double StageClock::now_ms() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
}

void count_work(const Scene& whole, const FrameCounts& counts, FramePlan& plan) {
    const Scene scene = at_levels(whole, plan.levels);
    const FragmentRays rays = rays_of(plan.levels);
    const auto set = [&](const PassId& id, double items) {
        if (PlannedPass* pass = find_pass(plan, id)) pass->work_items = items;
    };
    const auto& of_part = counts.fragments_of_part;
    const double fragments = std::accumulate(of_part.begin(), of_part.end(), 0.0);
    set(PassKind::surface_map, counts.covered_pixels * counts.samples_per_pixel);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const bool point = scene.lights[i].angle_rad <= 0.0;
        const int most = static_cast<int>(kSamplesAFragment);
        set(visibility_pass(i), fragments * (point ? std::min(rays.light, most) : rays.light));
    }
    double tilted = 0.0;
    for (const PartArtwork& relief : scene.relief) tilted += of_part[relief.part];
    set(PassKind::relief, tilted);
    set(PassKind::environment_irradiance, fragments);
    set(PassKind::ambient_occlusion, fragments * rays.sky.first);
    set(PassKind::interreflection, fragments);
    double translucent = 0.0;
    for (std::size_t p = 0; p < scene.part_materials.size(); ++p) {
        if (scene.part_materials[p].model == ReflectanceModel::translucent) {
            translucent += of_part[p];
        }
    }
    set(PassKind::subsurface, translucent);
    set(PassKind::environment_filter, static_cast<double>(kFilterTexels));
    double mirroring = 0.0;
    const std::vector<MirrorLayers> mirrored = mirror_layers_of(scene, MirrorMixing::cubic);
    for (std::size_t p = 0; p < mirrored.size(); ++p) {
        if (mirrored[p].any()) mirroring += of_part[p];
    }
    set(PassKind::reflection_occlusion, mirroring * mirror_rays(rays.mirror));
    set(PassKind::mirrored_environment, mirroring * mirror_nodes(rays.mirror));
    set(PassKind::directions, fragments);
    set(PassKind::diffuse_light, fragments);
    set(PassKind::glint_places, fragments);
    for (std::size_t p = 0; p < scene.part_materials.size(); ++p) {
        set(shade_pass(scene, p), of_part[p]);
    }
    double worn = 0.0;
    for (std::size_t k = 0; k < scene.artwork.size(); ++k) {
        worn += of_part[scene.artwork[k].part];
        if (counts.fragments_of_artwork.empty()) continue;
        const auto coats = static_cast<double>(coats_of(scene.artwork[k]).size());
        set(artwork_pass(scene, k), coats * counts.fragments_of_artwork[k]);
    }
    set(PassKind::artwork, worn);
    set(PassKind::resolve, counts.covered_pixels);
}

}  // namespace livery
