// What a calibration's stages found, marked in pictures for people.
#pragma once

#include "core/bench_ports.h"
#include "core/image.h"
#include "mesh/mesh.h"
#include "scene/colour_calibration.h"
#include "scene/view.h"

namespace livery {

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
