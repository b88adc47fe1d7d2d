#include "jobs/seat_errors.h"

#include <algorithm>

#include "core/pictures/picture_means.h"
#include "core/statistics.h"

namespace livery {

View seat_error_view(const View& projector) {
    return resized(projector, std::max(1, projector.width / 2), std::max(1, projector.height / 2));
}

EffectLevels seat_error_levels(Quality quality, const std::optional<EffectLevels>& levels) {
    if (levels) return *levels;
    return levels_of(quality == Quality::reference ? Quality::high : quality);
}

SeatPictures::SeatPictures(std::shared_ptr<const Product> product,
                           const View& view,
                           const EffectLevels& levels,
                           const Progress& progress)
    : levels_(levels),
      renderer_(std::make_shared<const FrameGeometry>(
                    std::move(product), view, progress, sub_samples_of(levels)),
                false,
                ShadingDevice::processor) {}

ImageF SeatPictures::drawn_for(const Scene& scene,
                               const glm::dvec3& eye_mm,
                               const Progress& progress) {
    Scene seen = scene;
    seen.eye_in_world_mm = eye_mm;
    FramePlan plan = plan_frame(seen, levels_, FrameStage::radiance);
    renderer_.render(seen, plan, progress);
    ImageF picture = renderer_.read_back();
    for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
        float* v = picture.values.data() + 4 * i;
        for (int c = 0; c < 3; ++c) v[c] = std::min(v[c], 1.0f);
    }
    return picture;
}

SeatError seat_error(const ImageF& de00) {
    const std::vector<float> all = covered_differences(de00);
    SeatError error;
    if (all.empty()) return error;
    error.de00_median = static_cast<double>(median(all));
    error.de00_p95 = static_cast<double>(quantile(all, 0.95));
    const auto over = std::count_if(all.begin(), all.end(), [](float difference) {
        return static_cast<double>(difference) > kFairSeatDe00;
    });
    error.share_over = static_cast<double>(over) / static_cast<double>(all.size());
    return error;
}

std::vector<SeatError> seat_errors(SeatPictures& pictures,
                                   const Scene& scene,
                                   const std::vector<EyeSeat>& seats,
                                   const Progress& progress) {
    std::vector<SeatError> errors;
    if (seats.empty()) return errors;
    const ImageF projected = pictures.drawn_for(scene, scene.eye_in_world_mm, progress);
    for (std::size_t k = 0; k < seats.size(); ++k) {
        progress.update(static_cast<double>(k) / static_cast<double>(seats.size()),
                        "shading for each seat");
        const ImageF own = pictures.drawn_for(scene, seats[k].eye_mm, progress);
        errors.push_back(seat_error(colour_difference_map(projected, own)));
    }
    return errors;
}

}  // namespace livery
