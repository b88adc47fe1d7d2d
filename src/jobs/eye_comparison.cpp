#include "jobs/eye_comparison.h"

#include <glm/geometric.hpp>

#include "core/error.h"

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

ErrorStatistics picture_offset(const View& true_view,
                               const Mesh& true_mesh,
                               const View& believed_view,
                               const Mesh& believed_mesh,
                               const Image8& lit) {
    check_argument(true_mesh.positions_mm.size() == believed_mesh.positions_mm.size(),
                   "picture_offset: two meshes of unequal vertices");
    std::vector<float> off_px;
    for (std::size_t i = 0; i < true_mesh.positions_mm.size(); ++i) {
        const auto there = project(true_view, glm::dvec3(true_mesh.positions_mm[i]));
        const auto drawn = project(believed_view, glm::dvec3(believed_mesh.positions_mm[i]));
        if (!there || !drawn || there->x < 0.0 || there->y < 0.0) continue;
        if (there->x >= lit.width || there->y >= lit.height) continue;
        if (!lit.at(static_cast<int>(there->x), static_cast<int>(there->y))) continue;
        off_px.push_back(static_cast<float>(glm::distance(*there, *drawn)));
    }
    return statistics_of(std::move(off_px));
}

}  // namespace livery
