// Catmull-Clark subdivision of a control cage to its limit surface.
#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace livery::assets {

struct CageFace {
    glm::ivec4 corners{0};  ///< counter-clockwise seen from outside
    int region = 0;
};

struct CageCrease {
    glm::ivec2 edge{0};
    double sharpness = 0.0;
};

/// A closed cage of quads. `surface_points` is where the limit surface shall pass; the control
/// points follow from it.
struct Cage {
    std::vector<glm::dvec3> surface_points;
    std::vector<glm::dvec2> parameters;  ///< carried along and interpolated
    std::vector<CageFace> faces;
    std::vector<CageCrease> creases;
};

struct LimitVertex {
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0};  ///< unit, outside
    glm::dvec2 parameters{0.0};
};

/// Uniformly refined quads with vertices on the limit surface.
struct LimitMesh {
    std::vector<LimitVertex> vertices;
    std::vector<CageFace> quads;
};

/// Refines `levels` times. `fit_iterations` steps of progressive-iterative approximation (Chen et
/// al. 2008, Catmull-Clark interpolation) pull the limit surface to the cage's surface points; few
/// steps leave small features of the points smoothed.
LimitMesh limit_surface(const Cage& cage, int levels, int fit_iterations);

}  // namespace livery::assets
