// What a seat misses: the look is shaded for one eye, and who sits elsewhere should see another.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "radiance/renderer.h"
#include "scene/frame_plan.h"
#include "scene/scene.h"
#include "scene/seats.h"
#include "scene/view.h"

namespace livery {

/// CIEDE2000 of what is projected for the eye in use to what a seat should see, over the pixels of
/// the mock-up.
struct SeatError {
    double de00_median = 0.0, de00_p95 = 0.0;
    double share_over = 0.0;  ///< of the mock-up that is more than kFairSeatDe00 off

    bool operator==(const SeatError&) const = default;
};

/// As for what a projector cannot reach: differences under 3 are hard to see, and a fifth of a look
/// is no detail.
inline constexpr double kFairSeatDe00 = 3.0, kFairSeatShare = 0.2;
inline bool is_fair(const SeatError& error) { return error.share_over <= kFairSeatShare; }

/// The view of a projector with half of its pixels in each direction: highlights are wider than
/// that, and it takes a quarter of the time.
View seat_error_view(const View& projector);

/// Looks on one product in one view, shaded for any eye; on the processor, without OpenGL.
class SeatPictures {
  public:
    SeatPictures(std::shared_ptr<const Product> product,
                 const View& view,
                 const EffectLevels& levels,
                 const Progress& progress = {});

    /// The scene as it is projected for this eye: R, G, B in the working space, and coverage.
    /// Channels end at 1, the design white, beyond which no projector goes: two highlights that it
    /// clips alike look alike.
    ImageF drawn_for(const Scene& scene, const glm::dvec3& eye_mm, const Progress& progress = {});

  private:
    EffectLevels levels_;
    RadianceRenderer renderer_;
};

/// The levels that looks are compared at: the session's, the path tracer's apart.
EffectLevels seat_error_levels(Quality quality, const std::optional<EffectLevels>& levels);

/// `de00` is colour_difference_map() of what both eyes should see.
SeatError seat_error(const ImageF& de00);

/// One a seat, in their order, of a scene that is shaded for its own eye.
std::vector<SeatError> seat_errors(SeatPictures& pictures,
                                   const Scene& scene,
                                   const std::vector<EyeSeat>& seats,
                                   const Progress& progress = {});

}  // namespace livery
