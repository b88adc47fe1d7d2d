#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "appearance/subsurface/subsurface_profile.h"

namespace livery {

namespace {

/// By how much of all light the profile was off in the media of docs/subsurface.md that are like
/// this one, in per cent; for slabs the worse of both sides. The test of compared_media() holds it
/// against Monte Carlo.
int measured_error(const ScatteringMedium& medium) {
    const double forward = std::abs(medium.g);
    const bool no_step = std::abs(medium.eta - 1.0) < 0.1;
    if (medium.thickness_mm) return forward > 0.5 ? 25 : 9;
    if (forward > 0.85) return 25;
    if (forward > 0.5 || no_step || medium.eta > 1.8) return 8;
    return 4;
}

/// The same of compared_stacks(): what crosses a layer without being scattered is no narrow beam's
/// light any more, and of what comes out below several layers a seventh lies elsewhere.
int measured_error(const ScatteringStack& stack) {
    const bool clear =
        std::any_of(stack.layers.begin(), stack.layers.end(), [](const ScatteringMedium& layer) {
            const double depth = layer.thickness_mm.value_or(0.0) * layer.sigma_s_prime();
            return layer.thickness_mm && depth < 0.3;
        });
    return stack.is_slab() || clear ? 16 : 5;
}

}  // namespace

ModelChoice best_model(const ScatteringMedium& medium) {
    constexpr auto kBest = SubsurfaceModel::scaled_beam_diffusion;
    if (!(medium.sigma_s_prime() > 0.0)) {
        return {kBest, "nothing scatters here, which every model knows"};
    }
    return {kBest,
            fmt::format("no model is measurably nearer to Monte Carlo in any medium compared than "
                        "single scattering and beam diffusion scaled to the exact total: within "
                        "{}% of the light in those like this one",
                        measured_error(medium))};
}

ModelChoice best_model(const ScatteringStack& given) {
    const ScatteringStack stack = merged(given);
    if (stack.layers.size() == 1) return best_model(stack.layers.front());
    constexpr auto kBest = SubsurfaceModel::scaled_beam_diffusion;
    if (!stack.scatters()) return {kBest, "nothing scatters here, which every model knows"};
    return {kBest,
            fmt::format("nearer to Monte Carlo than the multipole in every stack compared, within "
                        "{}% of the light",
                        measured_error(stack))};
}

}  // namespace livery
