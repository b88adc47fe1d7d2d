// What the lighting panel remembers between frames. Owns a texture: destroyed with the window's
// context current.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gl/handles.h"
#include "scene/look.h"
#include "scene/product.h"
#include "studio/kit/widgets.h"

namespace livery {

struct LightingPanelState {
    Held<Look> held;  ///< lights and environment
    Held<glm::dvec3> held_eye_mm;
    Held<double> held_ev;
    int lit_look = -1;  ///< whose lights are held
    std::shared_ptr<const Product> centre_of;
    glm::dvec3 centre_mm{0.0};  ///< of that product
    std::string observer_of;    ///< the bench
    std::optional<glm::dvec3> observer_mm;
    std::string thumbnail_of;
    Texture2D thumbnail;
    std::string thumbnail_problem;
    std::vector<std::string> shipped_environments;
    bool listed = false;
    double budget_s = 0.0;       ///< 0: not moved yet
    std::string budget_problem;  ///< why no levels fit it
};

}  // namespace livery
