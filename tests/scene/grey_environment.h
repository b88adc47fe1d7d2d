// The same light from everywhere.
#pragma once

#include <memory>

#include "scene/look.h"

namespace livery {

inline std::shared_ptr<const Environment> grey_environment() {
    auto environment = std::make_shared<Environment>();
    environment->radiance_working = ImageF(8, 4, 3, 0.5f);
    return environment;
}

}  // namespace livery
