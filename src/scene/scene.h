// One immutable description of what to draw: everything that the renderers are handed.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/material.h"
#include "scene/artwork_coats.h"
#include "scene/look.h"
#include "scene/product.h"

namespace livery {

struct Scene {
    /// Shared: previews, the projector's thread and the tracer read the same big immutable values
    /// while a paint swap makes a new Scene.
    std::shared_ptr<const Product> product;
    std::shared_ptr<const Environment> environment;  ///< null: none

    std::vector<Material> part_materials;  ///< one a part of the product
    std::vector<PartArtwork> artwork;      ///< over them, each over those before it on its part
    std::vector<PartArtwork> relief;       ///< of parts that have one
    std::vector<DirectionalLight> lights;
    glm::dvec3 eye_in_world_mm{0.0};  ///< the audience's eye: shading is for this point
    double exposure_ev = 0.0;         ///< radiance is scaled by 2^EV
};

/// A part's relief, or null.
const PartArtwork* relief_of(const Scene& scene, std::size_t part);
bool same_relief(const std::vector<PartArtwork>& a, const std::vector<PartArtwork>& b);

/// Whether any paint on the product, artwork's included, is such.
bool any_paint(const Scene& scene, const std::function<bool(const Material&)>& is_such);

/// The paint that a name in a look means.
using FindPaint = std::function<Material(const std::string& name)>;

/// A look on a product. A part that the look does not name keeps the file's own paint, or its
/// colour as a plain diffuse. Throws FileError (unknown part, with the names there are) and what
/// `find_paint` throws, which is called for paints that are worn. `loaded` is shared when it is the
/// environment that the look names: a map takes a while to read, and renderers keep what they have
/// made of it. A picture that a part's own paint cannot wear (artwork_coats.h) is refused, or left
/// out while the part wears it.
enum class Unwearable { refused, left_out };
Scene make_scene(std::shared_ptr<const Product> product,
                 const Look& look,
                 const FindPaint& find_paint,
                 glm::dvec3 eye_mm,
                 const std::shared_ptr<const Environment>& loaded = nullptr,
                 Unwearable unwearable = Unwearable::refused);
/// For a program that runs once: in files beside the look, else in what the library has now, all
/// read. Throws FileError with the nearest names.
Scene make_scene(std::shared_ptr<const Product> product,
                 const Look& look,
                 glm::dvec3 eye_mm,
                 const std::shared_ptr<const Environment>& loaded = nullptr);

/// Of its paints that are not read yet (is_read()): nothing is to be drawn before.
std::set<std::filesystem::path> unread_files(const Scene& scene);

/// A plain diffuse studio: the default eye and key light when nothing else was given.
glm::dvec3 default_eye_mm(const Product& product);

}  // namespace livery
