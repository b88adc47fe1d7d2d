// Whether projector and camera stand as they did, by what stands around the mock-up.
#pragma once

#include "calibration/registration/repose.h"

namespace livery {

/// Fewer places than these say nothing.
inline constexpr std::size_t kLeastAround = 100;

/// Borders of stripes off the mock-up, of then and of now, where `around` knows where they were
/// seen; none without it. A place that is found again lies within half a camera pixel: the map's
/// and the crossing's error, three times.
AroundEvidence evidence_around(const Mesh& mesh,
                               const Tracer& tracer,
                               const ReposeInput& input,
                               const StripeSight& sight,
                               const Rigid3& then_from_now);

/// Throws Refused where enough places are known and fewer than half are seen where they were. A
/// table that was bumped is refused like a camera: stripes one way do not tell a camera that nods
/// from a table that tips with the mock-up on it.
void check_pair(const AroundEvidence& around);

}  // namespace livery
