// Photographs made small, for people.
#pragma once

#include <glm/vec3.hpp>

#include "core/bench_ports.h"
#include "core/image.h"
#include "live/capture_thread.h"

namespace livery {

/// sRGB, `width` pixels wide at most, full scale a little over white.
Image8 small_photograph(const Photograph& photograph,
                        int width,
                        const glm::dvec3& balance = glm::dvec3(1.0));
/// Every so many pixels of it, so that it is `width` wide at most.
Image8 small_picture(const Image8& picture, int width);

CaptureHistogram histogram_of(const Photograph& photograph);
CaptureHistogram histogram_of(const Image8& srgb);

}  // namespace livery
