#include <cmath>

#include "fuzz/fuzz.h"
#include "scene/view.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    const View view = parse_camera(text, "a.json");
    // Whatever the lens, a point has a finite pixel or none.
    for (const glm::dvec3& point : {glm::dvec3(0.0), glm::dvec3(10.0, -20.0, 300.0)}) {
        const auto pixel = project(view, point);
        fuzz::require(!pixel || (std::isfinite(pixel->x) && std::isfinite(pixel->y)),
                      "a pixel is finite");
    }
}
