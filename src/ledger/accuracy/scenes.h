// What the price of accuracy is measured on: looks that together call for every effect, in two
// lights on the whole car and a sphere, and under lamps alone on the car.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "scene/effects.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

struct AccuracyScene {
    std::string name;  ///< "car, pearl, overcast"
    Scene scene;
    View view;
    int mean_px = 1;  ///< pictures are compared in means over squares of such a side
    /// What it alone is for: its truth is too coarse to judge others by.
    std::optional<Effect> only{};
};

/// `quick`: one look on the car in one light.
std::vector<AccuracyScene> accuracy_scenes(bool quick, const Progress& progress = {});

/// The same scene in a picture of another size.
AccuracyScene resized(const AccuracyScene& scene, int width, int height);

}  // namespace livery
