// A paint in glTF's words. Internal to mesh/.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "mesh/gltf/gltf_parts.h"

namespace livery {

/// Of a material's extras: the text of a material file.
inline constexpr const char* kPaintInExtras = "livery_paint";

/// The extension that says which paints a primitive may wear.
inline constexpr const char* kVariantsExtension = "KHR_materials_variants";

/// A material's metallic-roughness values with those extensions that paints are read from.
struct GltfWords {
    GltfSurface surface;
    glm::dvec3 dielectric_f0{0.04};  ///< of KHR_materials_specular, index 1.5
    double anisotropy = 0.0;         ///< strength
    bool grain_across = false;       ///< turned by a right angle
    bool whole = false;              ///< they say all of the paint
};

/// A member's number, or `otherwise` where there is none.
double number_or(const tinygltf::Value& object, const char* key, double otherwise);

/// What comes nearest to a paint.
GltfWords words_of(const Material& paint);

/// Sets what the words say on a material.
void put_words(const GltfWords& words, tinygltf::Material& material);

}  // namespace livery
