// glTF's metallic-roughness materials as paints of ours.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "appearance/parameter_table.h"
#include "core/paths.h"
#include "mesh/gltf/gltf_words.h"

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

/// A material's extension; an empty object where it has none of that name.
const tinygltf::Value& extension(const tinygltf::Material& material, const char* name) {
    static const tinygltf::Value none{tinygltf::Value::Object{}};
    const auto found = material.extensions.find(name);
    return found == material.extensions.end() ? none : found->second;
}

bool has_extension(const tinygltf::Material& material, std::string_view name) {
    return material.extensions.contains(std::string(name));
}

/// What a material has that no paint of ours takes, by name.
std::vector<std::string> dropped(const tinygltf::Material& material) {
    std::vector<std::string> names;
    if (material.occlusionTexture.index >= 0) names.emplace_back("occlusionTexture");
    if (material.emissiveTexture.index >= 0) names.emplace_back("emissiveTexture");
    const auto& emitted = material.emissiveFactor;
    if (std::any_of(emitted.begin(), emitted.end(), [](double value) { return value > 0.0; })) {
        names.emplace_back("emissiveFactor");
    }
    if (material.alphaMode != "OPAQUE") names.push_back("alphaMode " + material.alphaMode);
    for (const auto& [name, members] : material.extensions) {
        if (std::find(std::begin(kRead), std::end(kRead), name) == std::end(kRead)) {
            names.push_back(name);
            continue;
        }
        // Their pictures alone, but for those that are worn: the factors are read.
        for (const std::string& member : members.Keys()) {
            const bool worn = member == "clearcoatTexture" || member == "clearcoatRoughnessTexture";
            if (member.ends_with("Texture") && !worn) names.push_back(name + "." + member);
        }
        // Which matters to that picture alone.
        const char* const thinnest = "iridescenceThicknessMinimum";
        if (members.Has("iridescenceThicknessTexture") && members.Has(thinnest)) {
            names.push_back(name + "." + thinnest);
        }
    }
    return names;
}

/// Fresnel reflectance of what is no metal.
glm::dvec3 dielectric_f0(const GltfFile& gltf, std::size_t index) {
    const tinygltf::Material& material = gltf.model.materials[index];
    const double ior = number_or(extension(material, "KHR_materials_ior"), "ior", 1.5);
    if (ior > 0.0 && ior < 1.0) {
        gltf.fail(fmt::format("materials[{}].extensions.KHR_materials_ior.ior", index),
                  fmt::format("{:g}", ior),
                  "0, or 1 and more");
    }
    // 0 stands for an index without end.
    const double root = ior > 0.0 ? (ior - 1.0) / (ior + 1.0) : 1.0;
    glm::dvec3 f0(root * root);
    const tinygltf::Value& specular = extension(material, "KHR_materials_specular");
    if (specular.Has("specularColorFactor")) {
        const auto& colour = specular.Get("specularColorFactor").Get<tinygltf::Value::Array>();
        for (int c = 0; c < 3; ++c)
            f0[c] *= colour.at(static_cast<std::size_t>(c)).GetNumberAsDouble();
    }
    return glm::min(f0, glm::dvec3(1.0)) * number_or(specular, "specularFactor", 1.0);
}

double alpha_of(double roughness) { return std::max(roughness * roughness, kSmoothestAlpha); }

/// Along and across the tangent.
glm::dvec2 base_alpha(const tinygltf::Material& material,
                      double roughness,
                      const std::string& name,
                      Notes& notes) {
    const double alpha = alpha_of(roughness);
    const tinygltf::Value& anisotropy = extension(material, "KHR_materials_anisotropy");
    const double strength = number_or(anisotropy, "anisotropyStrength", 0.0);
    const double along = glm::mix(alpha, 1.0, strength * strength);
    const double right_angle = 0.5 * std::numbers::pi;
    const double turns = number_or(anisotropy, "anisotropyRotation", 0.0) / right_angle;
    const double whole = std::round(turns);
    if (strength > 0.0 && std::abs(turns - whole) > 0.01) {
        notes.push_back(fmt::format(
            "material \"{}\": its grain is turned by {:.0f} degrees; the nearest right angle is "
            "taken",
            name,
            90.0 * turns));
    }
    return std::fmod(std::abs(whole), 2.0) == 1.0 ? glm::dvec2(alpha, along)
                                                  : glm::dvec2(along, alpha);
}

/// Whether the file says more of a material than a plain colour.
bool says_more(const tinygltf::Material& material) {
    return material.values.contains("metallicFactor") ||
           material.values.contains("roughnessFactor") ||
           std::any_of(std::begin(kRead), std::end(kRead), [&](std::string_view name) {
               return has_extension(material, name);
           });
}

double within_range(
    const char* parameter, double value, const char* what, const std::string& name, Notes& notes) {
    const ParameterInfo& info = parameter_info(parameter);
    const double possible = std::clamp(value, info.low, info.high);
    if (possible != value) {
        notes.push_back(fmt::format(
            "material \"{}\": {} of {:.4g} is taken for {:.4g}", name, what, value, possible));
    }
    return possible;
}

/// Turns the paint's base into flakes with a thin film. glTF's film has air above it, ours the
/// coat's varnish: it gets the same step of index and the same path, hence the same colours.
void add_film(const tinygltf::Value& iridescence, Material& paint, Notes& notes) {
    const double factor = number_or(iridescence, "iridescenceFactor", 0.0);
    const double index = number_or(iridescence, "iridescenceIor", 1.3);
    const double thickness_nm = number_or(iridescence, "iridescenceThicknessMaximum", 400.0);
    if (factor == 0.0 || thickness_nm == 0.0) return;
    if (factor < 1.0) {
        notes.push_back(fmt::format(
            "material \"{}\": iridescenceFactor {:.4g} is taken for 1", paint.name, factor));
    }
    if (paint.alpha.x != paint.alpha.y) {
        notes.push_back(
            fmt::format("material \"{}\": under a thin film it is as rough along the "
                        "grain as across",
                        paint.name));
    }
    const double coat_f0 = paint.model == ReflectanceModel::clearcoat ? paint.coat_f0 : 0.0;
    const double varnish = (1.0 + std::sqrt(coat_f0)) / (1.0 - std::sqrt(coat_f0));
    paint.model = ReflectanceModel::car_paint;
    paint.coat_f0 = coat_f0;
    paint.flake_f0 = paint.f0;
    paint.f0 = glm::dvec3(0.0);
    paint.flake_alpha = std::sqrt(paint.alpha.x * paint.alpha.y);
    paint.alpha = glm::dvec2(paint.flake_alpha);
    paint.film_eta = within_range("film_eta", index * varnish, "a film's index", paint.name, notes);
    paint.film_nm = within_range("film_nm",
                                 thickness_nm * index / paint.film_eta,
                                 "a film's thickness in nanometres",
                                 paint.name,
                                 notes);
}

/// The whole paint that Livery wrote beside the words of glTF that come nearest to it.
std::optional<Material> paint_in_extras(const GltfFile& gltf,
                                        std::size_t index,
                                        const std::string& name,
                                        Notes& notes) {
    const Json& material = gltf.json["materials"][index];
    const Json* extras = material.contains("extras") ? &material["extras"] : nullptr;
    if (!extras || !extras->is_object() || !extras->contains(kPaintInExtras)) return std::nullopt;
    const Json& text = (*extras)[kPaintInExtras];
    if (!text.is_string()) {
        gltf.fail(fmt::format("materials[{}].extras.{}", index, kPaintInExtras),
                  text.dump(),
                  "the text of a paint");
    }
    Material paint = parse_material(text.get<std::string>(), gltf.path);
    paint.name = name;
    paint.file.clear();
    // Another program may have changed the words and kept the extras.
    const GltfSurface said = surface_of(gltf.model.materials[index]);
    const GltfSurface written = words_of(paint).surface;
    constexpr double kSame = 1e-3;
    const bool same = glm::all(glm::lessThan(glm::abs(said.base_rec709 - written.base_rec709),
                                             glm::dvec3(kSame))) &&
                      std::abs(said.metallic - written.metallic) < kSame &&
                      std::abs(said.roughness - written.roughness) < kSame &&
                      std::abs(said.coat - written.coat) < kSame &&
                      std::abs(said.coat_roughness - written.coat_roughness) < kSame;
    if (same) return paint;
    notes.push_back(fmt::format(
        "material \"{}\": changed since Livery wrote it; its paint is made of what glTF says",
        name));
    return std::nullopt;
}

}  // namespace

double number_or(const tinygltf::Value& object, const char* key, double otherwise) {
    return object.Has(key) ? object.Get(key).GetNumberAsDouble() : otherwise;
}

GltfSurface surface_of(const tinygltf::Material& material) {
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    const tinygltf::Value& coat = extension(material, "KHR_materials_clearcoat");
    return {{pbr.baseColorFactor[0], pbr.baseColorFactor[1], pbr.baseColorFactor[2]},
            pbr.metallicFactor,
            pbr.roughnessFactor,
            number_or(coat, "clearcoatFactor", 0.0),
            number_or(coat, "clearcoatRoughnessFactor", 0.0)};
}

Material gltf_paint(const GltfFile& gltf,
                    std::size_t index,
                    const GltfSurface& surface,
                    const std::string& name,
                    Notes& notes) {
    const tinygltf::Material& material = gltf.model.materials[index];
    Material paint;
    paint.name = name;
    paint.model = ReflectanceModel::ggx;
    const double metallic = surface.metallic;
    paint.diffuse = (1.0 - metallic) * surface.base_rec709;
    paint.f0 = glm::mix(dielectric_f0(gltf, index), surface.base_rec709, metallic);
    paint.alpha = base_alpha(material, surface.roughness, name, notes);
    if (surface.coat > 0.0) {
        paint.model = ReflectanceModel::clearcoat;
        paint.coat_f0 = kCoatF0 * surface.coat;
        paint.coat_alpha = alpha_of(surface.coat_roughness);
    }
    paint.family = paint.model == ReflectanceModel::clearcoat
                       ? metallic > 0.5 ? "metallic" : "solid"
                   : metallic > 0.5 ? "metal"
                                    : "plain";
    if (has_extension(material, "KHR_materials_iridescence")) {
        add_film(extension(material, "KHR_materials_iridescence"), paint, notes);
        if (paint.model == ReflectanceModel::car_paint) paint.family = "pearl";
    }
    paint.provenance = "the mesh file's own material";
    return paint;
}

GltfMaterial read_gltf_material(const GltfFile& gltf,
                                GltfPictures& pictures,
                                std::size_t index,
                                Notes& notes) {
    GltfMaterial result;
    Part& part = result.part;
    const tinygltf::Material& material = gltf.model.materials[index];
    part.material_name = material.name.empty() ? fmt::format("material {}", index) : material.name;
    const auto left_out = dropped(material);
    if (!left_out.empty()) {
        notes.push_back(
            fmt::format("material \"{}\": {} not read", part.material_name, list_of(left_out)));
    }
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    if (pbr.baseColorTexture.index < 0 || material.values.contains("baseColorFactor")) {
        part.base_colour_rec709 = surface_of(material).base_rec709;
    }
    const bool textured = pbr.metallicRoughnessTexture.index >= 0;
    const GltfPicture unread;
    const GltfPicture& of_gloss =
        textured ? pictures.of_texture(pbr.metallicRoughnessTexture.index, false) : unread;
    const bool readable = of_gloss.picture != nullptr;
    if (textured && !readable) {
        notes.push_back(
            fmt::format("material \"{}\": what is metal and what is rough is not known ({}); it is "
                        "shown without gloss",
                        part.material_name,
                        of_gloss.note));
    }
    const bool plain = textured ? !readable : !says_more(material);
    if (!plain) {
        GltfSurface surface = surface_of(material);
        surface.base_rec709 = part.base_colour_rec709;
        part.paint = gltf_paint(gltf, index, surface, part.material_name, notes);
    }
    wear_pictures(gltf, pictures, index, plain, result, notes);
    if (auto whole = paint_in_extras(gltf, index, part.material_name, notes)) {
        part.paint = std::move(whole);
    }
    return result;
}

}  // namespace livery
