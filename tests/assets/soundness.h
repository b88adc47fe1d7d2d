// What makes a product's parts solid, asked of its triangles alone.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/product.h"

namespace livery {

/// A product with equal positions made one vertex. Triangles keep their part, and the shell of that
/// part that they belong to.
struct Solids {
    std::vector<std::string> part_names;
    std::vector<glm::dvec3> points_mm;
    std::vector<glm::uvec3> triangles;
    std::vector<int> part, shell;
    std::vector<glm::dvec3> least_normal_dot;  ///< face normal against each corner's normal
    int shells = 0;
};
Solids solids_of(const Mesh& mesh);

/// Something wrong, with the part and the place where it is.
struct Fault {
    int part_a = 0, part_b = 0;
    glm::dvec3 at_mm{0.0};
    bool one_shell = false;
};
std::string to_text(const Solids& solids, const std::vector<Fault>& faults);

/// Edges that are not shared by exactly two triangles of their part with opposite directions.
std::vector<Fault> open_edges(const Solids& solids);

/// Shells that enclose no positive volume.
std::vector<Fault> inside_out_shells(const Solids& solids);

/// Triangles whose least height is below `height_mm`.
std::vector<Fault> slivers(const Solids& solids, double height_mm);

/// Triangles that look away from a normal at one of their corners.
std::vector<Fault> inverted_faces(const Solids& solids);

/// Pairs of triangles that meet elsewhere than in their common corners and edges; exact.
std::vector<Fault> crossings(const Solids& solids);

/// Pairs of triangles of different parts that look the same way, lie in each other's plane within
/// `distance_mm` and overlap: which of them is seen would be chance.
std::vector<Fault> coincident_faces(const Solids& solids, double distance_mm);

}  // namespace livery
