// A file's picture on a projector, for the path tracer to light a product with.
#pragma once

#include <filesystem>
#include <memory>

#include "mesh/mesh.h"
#include "reference/projected_light.h"

namespace livery {

/// Floats are light in linear Rec.709, what they do not cover dark; integers are sRGB. 1 is what
/// makes white of a white diffuser that faces the projector at the middle of the mesh. Throws
/// FileError (another size than the projector's, channels, a negative value or no number, a product
/// behind the projector).
std::shared_ptr<const ProjectedLight> read_projected_picture(const std::filesystem::path& file,
                                                             const View& projector,
                                                             const Mesh& mesh);

/// From the eye, of that size, by a lens that has all of the mesh in the picture.
View view_of_all(const Mesh& mesh, const glm::dvec3& eye_mm, int width, int height);

}  // namespace livery
