// What happens in the room while photographs are taken, and that nobody tells the calibration.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "twin/description.h"

namespace livery {

bool has_room_light(const std::vector<MishapDescription>& mishaps);

/// The light on the camera's pixels at this photograph. `room_light`: a room light of 1 on them;
/// empty where there is none.
ImageF with_mishaps(ImageF units_per_s,
                    const ImageF& room_light,
                    const std::vector<MishapDescription>& mishaps,
                    std::uint32_t photograph);

/// How long the camera exposes when it says `exposure_s`.
double true_exposure_s(double exposure_s,
                       const CameraDescription& camera,
                       const ImageF& units_per_s,
                       const std::vector<MishapDescription>& mishaps,
                       std::uint32_t photograph);

}  // namespace livery
