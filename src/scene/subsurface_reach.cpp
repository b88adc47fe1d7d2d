#include "scene/subsurface_reach.h"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>

#include "appearance/subsurface/subsurface_profile.h"
#include "appearance/subsurface/translucent_paint.h"

namespace livery {

namespace {

constexpr double kShare = 0.9;

/// In mean free paths: all that a half space's profile depends on is its albedo, g and index.
double reach_in_paths(const ScatteringMedium& medium) {
    const std::array<double, 3> key{medium.albedo_prime(), medium.g, medium.eta};
    static std::mutex mutex;
    static std::map<std::array<double, 3>, double> known;
    const std::lock_guard lock(mutex);
    if (const auto found = known.find(key); found != known.end()) return found->second;
    constexpr std::size_t kMost = 4096;
    if (known.size() >= kMost) known.clear();
    const SubsurfaceProfile profile =
        subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, medium);
    return known[key] = energy_radius_mm(profile, medium, kShare) / medium.mean_free_path_mm();
}

}  // namespace

double subsurface_reach_mm(const Material& paint, double product_scale) {
    if (!is_translucent(paint)) return 0.0;
    const glm::dvec3 albedo = entering_albedo(*paint.medium);
    double reach = 0.0;
    for (int c = 0; c < 3; ++c) {
        if (albedo[c] < kUnseenAlbedo) continue;
        ScatteringMedium medium = medium_of(*paint.medium, c);
        medium.thickness_mm.reset();
        reach = std::max(reach, reach_in_paths(medium) * medium.mean_free_path_mm());
    }
    return reach / product_scale;
}

bool light_spreads(const Material& paint, double product_scale) {
    return subsurface_reach_mm(paint, product_scale) > kUnseenReach_mm;
}

std::optional<std::size_t> spreading_part(const Scene& scene) {
    std::optional<std::size_t> farthest;
    double reach = kUnseenReach_mm;
    for (std::size_t p = 0; p < scene.part_materials.size(); ++p) {
        const double own =
            subsurface_reach_mm(scene.part_materials[p], scene.product->product_scale);
        if (own <= reach) continue;
        farthest = p;
        reach = own;
    }
    return farthest;
}

}  // namespace livery
