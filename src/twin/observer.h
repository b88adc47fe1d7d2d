// What somebody at the eye point sees of the bench, in XYZ, and what is true of each pixel of it.
#pragma once

#include "core/image.h"
#include "scene/view.h"
#include "twin/received.h"

namespace livery {

/// Truth about each pixel of an observer, never shown to a calibration.
struct ObserverTruth {
    Image8 lit;          ///< 255 where at least half of the pixel lies on lit mock-up
    Image8 edge;         ///< 255 within 2 px of a silhouette, depth or part edge
    Image8 seen_by_eye;  ///< 255 where the eye sees at least half of the mock-up in the pixel
    ImageF black_xyz;    ///< drive 0 everywhere
    /// 9 channels: full red, green, blue, each minus black, in wide surroundings of the same
    /// drive; without the light that other parts throw on this one.
    ImageF primary_xyz;
};

struct Observer {
    Receivers receivers;
    ObserverTruth truth;
    ImageF clear_xyz;  ///< the clear segment at 1, as primary_xyz
};

/// From the paths on, which outlive it. `dark` is the projector's light at drive 0.
Observer make_observer(const TracedObserver& traced,
                       Factors factors,
                       const Gathers& gathers,
                       const ImageF& dark);

/// XYZ of each pixel under the projector's light, the room's included.
ImageF observe(const Observer& observer, const Gathers& gathers, const ImageF& light, bool ambient);

/// As Bench::reachable(); `clear_strength` is the luminance of the clear segment.
Image8 reachable(const Observer& observer, const ImageF& wanted_xyz, double clear_strength);

/// 255 where at least half of what a pixel gets comes from the projector pixels of `mask` (255).
Image8 mostly_lit_by(const Observer& observer, const Image8& mask);

/// The eye's picture of a mock-up: aimed at its middle, as large as the mock-up needs, and in the
/// middle as fine as the projector's.
View eye_view(const glm::dvec3& eye_mm, const View& projector, const Mesh& mockup);

}  // namespace livery
