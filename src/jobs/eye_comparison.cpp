#include "jobs/eye_comparison.h"

namespace livery {

Image8 corrected_pixels(const ColourCalibration& calibration, bool predicted_only) {
    Image8 mask(calibration.width, calibration.height, 1);
    for (std::size_t i = 0; i < mask.values.size(); ++i) {
        const auto status = static_cast<PixelStatus>(calibration.status.values[i]);
        const bool holds = predicted_only ? status == PixelStatus::predicted : is_valid(status);
        mask.values[i] = holds ? 255 : 0;
    }
    return mask;
}

ComparisonMasks masks_of_eye(const Bench& bench,
                             const Image8& valid,
                             const Image8& predicted,
                             const ImageF& wanted_eye_xyz) {
    const Observer& eye = bench.eye().observer;
    ComparisonMasks masks{eye.truth.lit,
                          mostly_lit_by(eye, bench.truth().edge),
                          mostly_lit_by(eye, valid),
                          bench.reachable_from_eye(wanted_eye_xyz),
                          mostly_lit_by(eye, predicted)};
    for (std::size_t i = 0; i < masks.edge.values.size(); ++i) {
        masks.edge.values[i] |= eye.truth.edge.values[i];
    }
    return masks;
}

}  // namespace livery
