#include "scene/scene.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "appearance/material_library.h"
#include "appearance/measured/measured_paint.h"
#include "core/error.h"
#include "core/paths.h"

namespace livery {

namespace {

/// A part as the mesh file has it, in the look's variant where that has another.
const Part& own_part(const Mesh& mesh, const Look& look, std::size_t part) {
    for (const MeshVariant& variant : mesh.variants) {
        if (variant.name != look.variant) continue;
        const auto other = variant.parts.find(part);
        if (other != variant.parts.end()) return other->second;
    }
    return mesh.parts[part];
}

void check_variant(const Product& product, const Look& look) {
    std::vector<std::string> names;
    for (const MeshVariant& variant : product.mesh.variants) names.push_back(variant.name);
    const bool known = std::find(names.begin(), names.end(), look.variant) != names.end();
    if (look.variant.empty() || known) return;
    throw FileError(look.file,
                    "variant",
                    fmt::format("no variant \"{}\" of {}", look.variant, product.name),
                    names.empty() ? "none: it has no variants" : "one of " + list_of(names));
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

void check_part_name(const Product& product,
                     const Look& look,
                     const std::string& field,
                     const std::string& name) {
    const auto& parts = product.mesh.parts;
    const bool known =
        name == "*" || std::any_of(parts.begin(), parts.end(), [&](const Part& part) {
            return part.name == name;
        });
    if (known) return;
    std::string names;
    for (const auto& part : parts) names += ", " + part.name;
    throw FileError(look.file, field, "no such part in " + product.name, "one of *" + names);
}

void add_artwork(const Look& look,
                 const FindPaint& find_paint,
                 Unwearable unwearable,
                 Scene& scene) {
    const std::vector<Part>& parts = scene.product->mesh.parts;
    for (std::size_t k = 0; k < look.artwork.size(); ++k) {
        const Artwork& artwork = look.artwork[k];
        const std::string field = fmt::format("artwork[{}]", k);
        check_part_name(*scene.product, look, field + ".part", artwork.part);
        std::shared_ptr<const ArtworkPicture> picture;
        if (artwork.shape == ArtworkShape::picture) {
            picture = load_artwork_picture(
                find_artwork_picture(artwork.picture, look.file.parent_path()));
        }
        for (std::size_t p = 0; p < parts.size(); ++p) {
            if (artwork.part != "*" && artwork.part != parts[p].name) continue;
            const Material material =
                artwork.paint.empty() ? scene.part_materials[p] : find_paint(artwork.paint);
            if (is_relief(artwork)) {
                if (relief_of(scene, p)) {
                    throw FileError(look.file,
                                    field,
                                    "a second relief of part " + parts[p].name,
                                    "one at most");
                }
                scene.relief.push_back(make_part_artwork(p, artwork, material, picture));
                continue;
            }
            try {
                scene.artwork.push_back(make_part_artwork(p, artwork, material, picture));
            } catch (const std::invalid_argument& error) {
                const bool own = artwork.paint.empty();
                if (own && unwearable == Unwearable::left_out) continue;
                throw FileError(look.file, field, error.what(), "another paint or use");
            }
        }
    }
}

/// What the mesh file's pictures say: colours and roughness over the parts that wear the file's
/// paint; or reliefs, which are of the parts' shape, under any paint, but where the look has
/// another.
void add_own_pictures(const Look& look, bool reliefs, Scene& scene) {
    const std::vector<Part>& parts = scene.product->mesh.parts;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const bool own_paint = !look.parts.contains(parts[p].name) && !look.parts.contains("*");
        for (const PartPicture& picture : own_part(scene.product->mesh, look, p).pictures) {
            Artwork artwork;
            artwork.name = picture.name;
            artwork.part = parts[p].name;
            artwork.shape = ArtworkShape::picture;
            artwork.picture = picture.name;
            artwork.repeat = true;
            artwork.depth = picture.depth;
            artwork.place.by_uv = true;
            switch (picture.use) {
                case PartPicture::Use::tint:
                    artwork.use = PictureUse::tint;
                    break;
                case PartPicture::Use::roughness:
                    artwork.use = PictureUse::roughness;
                    break;
                case PartPicture::Use::relief:
                    artwork.use = PictureUse::relief;
                    break;
            }
            if (is_relief(artwork) != reliefs) continue;
            if (reliefs ? relief_of(scene, p) != nullptr : !own_paint) continue;
            auto& list = reliefs ? scene.relief : scene.artwork;
            list.push_back(make_part_artwork(p, artwork, picture.paint, picture.picture));
        }
    }
}

}  // namespace

Scene make_scene(std::shared_ptr<const Product> product,
                 const Look& look,
                 const FindPaint& find_paint,
                 glm::dvec3 eye_mm,
                 const std::shared_ptr<const Environment>& loaded,
                 Unwearable unwearable) {
    check_argument(product != nullptr, "make_scene: a product is needed");
    for (const auto& [name, paint] : look.parts) {
        check_part_name(*product, look, "parts." + name, name);
    }
    check_variant(*product, look);
    Scene scene;
    for (std::size_t p = 0; p < product->mesh.parts.size(); ++p) {
        const Part& part = own_part(product->mesh, look, p);
        auto paint = look.parts.find(part.name);
        if (paint == look.parts.end()) paint = look.parts.find("*");
        scene.part_materials.push_back(paint == look.parts.end() ? own_material(part)
                                                                 : find_paint(paint->second));
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
    add_own_pictures(look, false, scene);
    add_artwork(look, find_paint, unwearable, scene);
    add_own_pictures(look, true, scene);
    scene.lights = look.lights;
    scene.eye_in_world_mm = eye_mm;
    scene.exposure_ev = look.exposure_ev;
    return scene;
}

Scene make_scene(std::shared_ptr<const Product> product,
                 const Look& look,
                 glm::dvec3 eye_mm,
                 const std::shared_ptr<const Environment>& loaded) {
    const auto library = read_paint_library();
    std::map<std::string, Material> read;
    const auto find_paint = [&](const std::string& name) {
        if (const auto known = read.find(name); known != read.end()) return known->second;
        std::error_code error;
        const auto beside = look.file.parent_path() / name;
        const bool is_beside =
            !look.file.empty() && std::filesystem::is_regular_file(beside, error);
        return read[name] = find_material(is_beside ? beside.string() : name, *library);
    };
    return make_scene(std::move(product), look, find_paint, eye_mm, loaded);
}

std::set<std::filesystem::path> unread_files(const Scene& scene) {
    std::set<std::filesystem::path> files;
    any_paint(scene, [&](const Material& paint) {
        if (!is_read(paint)) files.insert(paint.measured->file);
        return false;
    });
    return files;
}

const PartArtwork* relief_of(const Scene& scene, std::size_t part) {
    const auto found = std::find_if(scene.relief.begin(),
                                    scene.relief.end(),
                                    [&](const PartArtwork& one) { return one.part == part; });
    return found == scene.relief.end() ? nullptr : &*found;
}

bool same_relief(const std::vector<PartArtwork>& a, const std::vector<PartArtwork>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), covers_alike);
}

bool any_paint(const Scene& scene, const std::function<bool(const Material&)>& is_such) {
    return std::any_of(scene.part_materials.begin(), scene.part_materials.end(), is_such) ||
           std::any_of(scene.artwork.begin(), scene.artwork.end(), [&](const PartArtwork& artwork) {
               return is_such(artwork.material);
           });
}

glm::dvec3 default_eye_mm(const Product& product) {
    // Three quarters from the front, a little from above, the whole product within 30 degrees.
    const Bounds bounds = bounds_of(product.mesh);
    const glm::dvec3 centre = 0.5 * (bounds.low + bounds.high);
    const double size = glm::distance(bounds.low, bounds.high);
    return centre + 2.0 * size * glm::normalize(glm::dvec3(1.0, 0.6, 1.4));
}

}  // namespace livery
