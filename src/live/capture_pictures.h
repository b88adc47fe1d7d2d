// Photographs made small, for people, and what a calibration's stages found, marked in them.
#pragma once

#include <glm/vec3.hpp>

#include "core/bench_ports.h"
#include "core/image.h"
#include "live/capture_thread.h"
#include "mesh/mesh.h"
#include "scene/colour_calibration.h"
#include "scene/view.h"

namespace livery {

/// sRGB, `width` pixels wide at most, full scale a little over white.
Image8 small_photograph(const Photograph& photograph,
                        int width,
                        const glm::dvec3& balance = glm::dvec3(1.0));
/// Every so many pixels of it, so that it is `width` wide at most.
Image8 small_picture(const Image8& picture, int width);

CaptureHistogram histogram_of(const Photograph& photograph);
CaptureHistogram histogram_of(const Image8& srgb);

/// A photograph with the mesh's outline where the camera must see it; sRGB, `width` pixels wide at
/// most.
Image8 outline_on_photograph(const Photograph& photograph,
                             const View& camera,
                             const Mesh& mesh,
                             int width);

/// The projector's pixels by what they can correct: measured green, predicted blue, the mock-up's
/// others (`mockup`: one channel, non-zero) red; sRGB.
Image8 status_picture(const ColourCalibration& calibration, const Image8& mockup, int width);

}  // namespace livery
