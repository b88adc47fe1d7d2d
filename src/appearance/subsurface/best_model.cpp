#include <fmt/format.h>

#include "appearance/subsurface/subsurface_profile.h"

namespace livery {

ModelChoice best_model(const ScatteringMedium&) {
    return {SubsurfaceModel::scaled_beam_diffusion, ""};
}

}  // namespace livery
