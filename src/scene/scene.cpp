#include "scene/scene.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "core/error.h"

namespace livery {

namespace {

/// A material file may stand beside the look that names it.
Material find_paint(const Look& look,
                    const std::string& name_or_file,
                    const std::vector<Material>& own_paints) {
    for (const Material& own : own_paints) {
        if (own.name == name_or_file) return own;
    }
    std::error_code error;
    const auto beside = look.file.parent_path() / name_or_file;
    if (!look.file.empty() && std::filesystem::is_regular_file(beside, error)) {
        return find_material(beside.string());
    }
    return find_material(name_or_file);
}

/// What the mesh file says of a part.
Material own_material(const Part& part) {
    if (part.paint) return *part.paint;
    Material material;
    material.name = part.material_name.empty() ? part.name : part.material_name;
    material.diffuse = part.base_colour_rec709;
    material.provenance = "the mesh file's own colour";
    return material;
}

void check_part_names(const Product& product, const Look& look) {
    const auto& parts = product.mesh.parts;
    for (const auto& [name, paint] : look.parts) {
        if (name == "*") continue;
        const bool known = std::any_of(
            parts.begin(), parts.end(), [&](const Part& part) { return part.name == name; });
        if (known) continue;
        std::string names;
        for (const auto& part : parts) names += ", " + part.name;
        throw FileError(
            look.file, "parts." + name, "no such part in " + product.name, "one of *" + names);
    }
}

}  // namespace

Scene make_scene(std::shared_ptr<const Product> product,
                 const Look& look,
                 glm::dvec3 eye_mm,
                 const std::shared_ptr<const Environment>& loaded,
                 const std::vector<Material>& own_paints) {
    check_argument(product != nullptr, "make_scene: a product is needed");
    check_part_names(*product, look);
    Scene scene;
    for (const auto& part : product->mesh.parts) {
        auto paint = look.parts.find(part.name);
        if (paint == look.parts.end()) paint = look.parts.find("*");
        scene.part_materials.push_back(paint == look.parts.end()
                                           ? own_material(part)
                                           : find_paint(look, paint->second, own_paints));
    }
    if (!look.environment.file.empty()) {
        const auto beside = look.file.parent_path();
        const bool same = loaded && loaded->rotation_rad == look.environment.rotation_rad &&
                          loaded->scale == look.environment.scale &&
                          loaded->file == find_environment_map(look.environment.file, beside);
        scene.environment =
            same ? loaded
                 : std::make_shared<const Environment>(load_environment(look.environment, beside));
    }
    scene.product = std::move(product);
    scene.lights = look.lights;
    scene.eye_in_world_mm = eye_mm;
    scene.exposure_ev = look.exposure_ev;
    return scene;
}

glm::dvec3 default_eye_mm(const Product& product) {
    // Three quarters from the front, a little from above, the whole product within 30 degrees.
    const Bounds bounds = bounds_of(product.mesh);
    const glm::dvec3 centre = 0.5 * (bounds.low + bounds.high);
    const double size = glm::distance(bounds.low, bounds.high);
    return centre + 2.0 * size * glm::normalize(glm::dvec3(1.0, 0.6, 1.4));
}

}  // namespace livery
