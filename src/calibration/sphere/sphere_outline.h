// Where a sphere stands, from its outline in photographs.
#pragma once

#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "calibration/captures/exposure_merge.h"
#include "calibration/sphere/tangent_cone.h"
#include "scene/view.h"

namespace livery {

/// A sphere in the light of one lamp.
struct LitSphere {
    MergedPhotographs picture;
    glm::dvec3 light_mm{0.0};
};

struct OutlineFit {
    Sphere sphere;
    double rms_px = 0.0;         ///< of the edges to the outline
    double seen_fraction = 0.0;  ///< of the outline's directions in which an edge was found
};

/// Moves the centre across the line of sight and changes the diameter until the outline lies on the
/// edges. An outline cannot tell a larger sphere from a nearer one: the distance stays `start`'s.
/// `view` sees what the pictures show. Throws Refused when there is no such outline.
OutlineFit fit_outline(const View& view, const Sphere& start, std::span<const LitSphere> lit);

/// The box around a sphere's outline, in pixels; may reach outside of the picture. Nothing for a
/// sphere that is not wholly in front of the view.
struct OutlineBox {
    double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
};
std::optional<OutlineBox> outline_box(const View& view, const Sphere& sphere);

}  // namespace livery
