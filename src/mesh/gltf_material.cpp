// glTF's metallic-roughness materials as paints of ours.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "appearance/parameter_table.h"
#include "core/paths.h"
#include "mesh/gltf_parts.h"

namespace livery {

namespace {

using Notes = std::vector<std::string>;

constexpr std::string_view kRead[] = {"KHR_materials_clearcoat",
                                      "KHR_materials_specular",
                                      "KHR_materials_ior",
                                      "KHR_materials_anisotropy",
                                      "KHR_materials_iridescence"};
constexpr double kSmoothestAlpha = 0.001;  ///< a mirror; glTF's 0 is none that a lamp shows in
constexpr double kCoatF0 = 0.04;           ///< of an index of 1.5, which glTF gives every coat

/// Pictures are not read: names the one that colours a material in other programs.
std::string picture_note(const GltfFile& gltf, const JsonReader& texture_index) {
    const auto root = gltf.root();
    const auto texture = root["textures"].at(index_into(root, "textures", texture_index));
    if (!texture.has("source")) return "an embedded picture is not read";
    const auto image = root["images"].at(index_into(root, "images", texture["source"]));
    if (!image.has("uri") || image["uri"].text().starts_with("data:")) {
        return "an embedded picture is not read";
    }
    const std::string uri = image["uri"].text();
    std::error_code error;
    const bool exists = std::filesystem::exists(gltf.path.parent_path() / uri, error);
    return fmt::format("the picture \"{}\" {}", uri, exists ? "is not read" : "is missing");
}

double number_or(
    const JsonReader& object, const char* key, double low, double high, double otherwise) {
    return object.has(key) ? object[key].number_between(low, high) : otherwise;
}

glm::dvec3 colour_or(const JsonReader& object,
                     const char* key,
                     std::size_t count,
                     double high,
                     glm::dvec3 otherwise) {
    if (!object.has(key)) return otherwise;
    const auto factor = object[key].numbers(count);
    for (std::size_t k = 0; k < count; ++k) object[key].at(k).number_between(0.0, high);
    return {factor[0], factor[1], factor[2]};
}

/// What a material has that no paint of ours takes, by name.
std::vector<std::string> dropped(const JsonReader& material) {
    std::vector<std::string> names;
    for (const char* name : {"normalTexture", "occlusionTexture", "emissiveTexture"}) {
        if (material.has(name)) names.emplace_back(name);
    }
    const glm::dvec3 emitted = colour_or(material, "emissiveFactor", 3, 1e9, glm::dvec3(0.0));
    if (std::max({emitted.x, emitted.y, emitted.z}) > 0.0) names.emplace_back("emissiveFactor");
    if (material.has("alphaMode") && material["alphaMode"].text() != "OPAQUE") {
        names.push_back("alphaMode " + material["alphaMode"].text());
    }
    if (!material.has("extensions")) return names;
    const auto extensions = material["extensions"];
    for (const std::string& name : extensions.keys()) {
        if (std::find(std::begin(kRead), std::end(kRead), name) == std::end(kRead)) {
            names.push_back(name);
            continue;
        }
        // Their pictures alone: the factors are read.
        for (const std::string& member : extensions[name].keys()) {
            if (member.ends_with("Texture")) names.push_back(name + "." + member);
        }
        // Which matters to that picture alone.
        const char* const thinnest = "iridescenceThicknessMinimum";
        if (extensions[name].has("iridescenceThicknessTexture") && extensions[name].has(thinnest)) {
            names.push_back(name + "." + thinnest);
        }
    }
    return names;
}

std::optional<JsonReader> extension(const JsonReader& material, const char* name) {
    if (!material.has("extensions") || !material["extensions"].has(name)) return std::nullopt;
    const auto found = material["extensions"][name];
    if (!found.is_object()) found.fail(found.found(), "an object");
    return found;
}

/// Fresnel reflectance of what is no metal.
glm::dvec3 dielectric_f0(const JsonReader& material) {
    double index = 1.5;
    if (const auto ior = extension(material, "KHR_materials_ior")) {
        index = number_or(*ior, "ior", 0.0, 100.0, 1.5);
        if (index > 0.0 && index < 1.0) {
            (*ior)["ior"].fail((*ior)["ior"].found(), "0, or 1 and more");
        }
    }
    // 0 stands for an index without end.
    const double root = index > 0.0 ? (index - 1.0) / (index + 1.0) : 1.0;
    glm::dvec3 f0(root * root);
    if (const auto specular = extension(material, "KHR_materials_specular")) {
        f0 = glm::min(f0 * colour_or(*specular, "specularColorFactor", 3, 1e6, glm::dvec3(1.0)),
                      glm::dvec3(1.0)) *
             number_or(*specular, "specularFactor", 0.0, 1.0, 1.0);
    }
    return f0;
}

double alpha_of(double roughness) { return std::max(roughness * roughness, kSmoothestAlpha); }

/// Along and across the tangent.
glm::dvec2 base_alpha(const JsonReader& material, double roughness, Part& part, Notes& notes) {
    const double alpha = alpha_of(roughness);
    const auto anisotropy = extension(material, "KHR_materials_anisotropy");
    if (!anisotropy) return glm::dvec2(alpha);
    const double strength = number_or(*anisotropy, "anisotropyStrength", 0.0, 1.0, 0.0);
    const double along = glm::mix(alpha, 1.0, strength * strength);
    const double right_angle = 0.5 * std::numbers::pi;
    const double turns = number_or(*anisotropy, "anisotropyRotation", -1e4, 1e4, 0.0) / right_angle;
    const double whole = std::round(turns);
    if (strength > 0.0 && std::abs(turns - whole) > 0.01) {
        notes.push_back(fmt::format(
            "material \"{}\": its grain is turned by {:.0f} degrees; the nearest right angle is "
            "taken",
            part.material_name,
            90.0 * turns));
    }
    return std::fmod(std::abs(whole), 2.0) == 1.0 ? glm::dvec2(alpha, along)
                                                  : glm::dvec2(along, alpha);
}

/// Whether the file says more of a material than a plain colour.
bool says_more(const JsonReader& material) {
    for (const std::string_view name : kRead) {
        if (extension(material, std::string(name).c_str())) return true;
    }
    if (!material.has("pbrMetallicRoughness")) return false;
    const auto pbr = material["pbrMetallicRoughness"];
    return pbr.has("metallicFactor") || pbr.has("roughnessFactor");
}

double within_range(
    const char* parameter, double value, const char* what, const Part& part, Notes& notes) {
    const ParameterInfo& info = parameter_info(parameter);
    const double possible = std::clamp(value, info.low, info.high);
    if (possible != value) {
        notes.push_back(fmt::format("material \"{}\": {} of {:.4g} is taken for {:.4g}",
                                    part.material_name,
                                    what,
                                    value,
                                    possible));
    }
    return possible;
}

/// Turns the paint's base into flakes with a thin film. glTF's film has air above it, ours the
/// coat's varnish: it gets the same step of index and the same path, hence the same colours.
void add_film(const JsonReader& iridescence, Material& paint, const Part& part, Notes& notes) {
    const double factor = number_or(iridescence, "iridescenceFactor", 0.0, 1.0, 0.0);
    const double index = number_or(iridescence, "iridescenceIor", 1.0, 100.0, 1.3);
    number_or(iridescence, "iridescenceThicknessMinimum", 0.0, 1e6, 100.0);
    const double thickness_nm =
        number_or(iridescence, "iridescenceThicknessMaximum", 0.0, 1e6, 400.0);
    if (factor == 0.0 || thickness_nm == 0.0) return;
    if (factor < 1.0) {
        notes.push_back(fmt::format("material \"{}\": iridescenceFactor {:.4g} is taken for 1",
                                    part.material_name,
                                    factor));
    }
    if (paint.alpha.x != paint.alpha.y) {
        notes.push_back(
            fmt::format("material \"{}\": under a thin film it is as rough along the "
                        "grain as across",
                        part.material_name));
    }
    const double coat_f0 = paint.model == ReflectanceModel::clearcoat ? paint.coat_f0 : 0.0;
    const double varnish = (1.0 + std::sqrt(coat_f0)) / (1.0 - std::sqrt(coat_f0));
    paint.model = ReflectanceModel::car_paint;
    paint.coat_f0 = coat_f0;
    paint.flake_f0 = paint.f0;
    paint.f0 = glm::dvec3(0.0);
    paint.flake_alpha = std::sqrt(paint.alpha.x * paint.alpha.y);
    paint.alpha = glm::dvec2(paint.flake_alpha);
    paint.film_eta = within_range("film_eta", index * varnish, "a film's index", part, notes);
    paint.film_nm = within_range("film_nm",
                                 thickness_nm * index / paint.film_eta,
                                 "a film's thickness in nanometres",
                                 part,
                                 notes);
}

Material paint_of(const JsonReader& material, Part& part, Notes& notes) {
    Material paint;
    paint.name = part.material_name;
    paint.model = ReflectanceModel::ggx;
    double metallic = 1.0, roughness = 1.0;
    if (material.has("pbrMetallicRoughness")) {
        const auto pbr = material["pbrMetallicRoughness"];
        metallic = number_or(pbr, "metallicFactor", 0.0, 1.0, 1.0);
        roughness = number_or(pbr, "roughnessFactor", 0.0, 1.0, 1.0);
    }
    const glm::dvec3& base = part.base_colour_rec709;
    paint.diffuse = (1.0 - metallic) * base;
    paint.f0 = glm::mix(dielectric_f0(material), base, metallic);
    paint.alpha = base_alpha(material, roughness, part, notes);
    if (const auto coat = extension(material, "KHR_materials_clearcoat")) {
        const double factor = number_or(*coat, "clearcoatFactor", 0.0, 1.0, 0.0);
        const double coat_roughness = number_or(*coat, "clearcoatRoughnessFactor", 0.0, 1.0, 0.0);
        if (factor > 0.0) {
            paint.model = ReflectanceModel::clearcoat;
            paint.coat_f0 = kCoatF0 * factor;
            paint.coat_alpha = alpha_of(coat_roughness);
        }
    }
    paint.family = paint.model == ReflectanceModel::clearcoat
                       ? metallic > 0.5 ? "metallic" : "solid"
                   : metallic > 0.5 ? "metal"
                                    : "plain";
    if (const auto iridescence = extension(material, "KHR_materials_iridescence")) {
        add_film(*iridescence, paint, part, notes);
        if (paint.model == ReflectanceModel::car_paint) paint.family = "pearl";
    }
    paint.provenance = "the mesh file's own material";
    return paint;
}

}  // namespace

Part read_gltf_material(const GltfFile& gltf, std::size_t index, Notes& notes) {
    Part part;
    const auto material = gltf.root()["materials"].at(index);
    part.material_name = name_or(material, fmt::format("material {}", index));
    const auto left_out = dropped(material);
    if (!left_out.empty()) {
        notes.push_back(
            fmt::format("material \"{}\": {} not read", part.material_name, list_of(left_out)));
    }
    part.base_colour_rec709 = glm::dvec3(1.0);  // glTF's default
    bool textured = false;
    if (material.has("pbrMetallicRoughness")) {
        const auto pbr = material["pbrMetallicRoughness"];
        const bool has_picture = pbr.has("baseColorTexture");
        const glm::dvec3 otherwise = has_picture ? Part().base_colour_rec709 : glm::dvec3(1.0);
        part.base_colour_rec709 = colour_or(pbr, "baseColorFactor", 4, 1.0, otherwise);
        if (has_picture) {
            notes.push_back(fmt::format("material \"{}\": {}; its plain colour is shown",
                                        part.material_name,
                                        picture_note(gltf, pbr["baseColorTexture"]["index"])));
        }
        textured = pbr.has("metallicRoughnessTexture");
        if (textured) {
            notes.push_back(fmt::format(
                "material \"{}\": what is metal and what is rough stands in a picture that is not "
                "read; it is shown without gloss",
                part.material_name));
        }
    }
    if (!textured && says_more(material)) part.paint = paint_of(material, part, notes);
    return part;
}

}  // namespace livery
