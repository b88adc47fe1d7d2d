// How well the lenses of a camera and a projector and the pose between them are known, together.
#pragma once

#include <array>
#include <cstddef>

namespace livery {

/// A lens changes in its relative focal length, its principal point (pixels) and its distortion k1,
/// k2, p1, p2, k3; the pose between the two in a small turn (rad), then a shift (mm), of
/// camera_from_projector.
inline constexpr int kLensTerms = 8, kPoseTerms = 6;
inline constexpr int kPairTerms = 2 * kLensTerms + kPoseTerms;

/// Inverse covariance of those changes, row by row: projector's lens, camera's lens, pose between
/// them.
using PairInformation = std::array<double, static_cast<std::size_t>(kPairTerms* kPairTerms)>;

}  // namespace livery
