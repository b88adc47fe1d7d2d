// How much of a product that is to be a projector's picture reaches. Values without a window.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/product.h"

namespace livery {

/// A place on a mesh; all of a mesh's stand for the same area.
struct MeshSample {
    glm::vec3 position, normal;  ///< the normal on either side, unit
};
/// So many, spread evenly over the mesh's area, in the mesh's own numbers; the same every time.
/// None of a mesh without area.
std::vector<MeshSample> mesh_samples(const Mesh& mesh, std::size_t count = 4000);

/// The share of what the projector has before it of the product, by solid angle, that lies in its
/// picture, 0 to 1. `product` says where the mesh stands and how large; nothing hides anything.
/// None without samples.
std::optional<double> lit_share(const std::vector<MeshSample>& samples,
                                const ProductFile& product,
                                const View& projector);

/// What a person reads of it: a sentence.
std::string lit_share_text(double share);

}  // namespace livery
