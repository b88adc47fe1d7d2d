// wear_pictures: glTF's textures as paints whose weighted sum is what is seen. A paint takes the
// colours of a picture; whatever else changes from texel to texel (metallic, roughness, clear coat)
// becomes a few paints between which the texels are mixed.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "mesh/gltf/gltf_parts.h"
#include "mesh/gltf/gltf_words.h"

namespace livery {

namespace {

using Notes = std::vector<std::string>;

/// Paints side by side on one part.
constexpr std::size_t kMostPaints = 12;
/// Of all paints' pictures of a file: half a gigabyte.
constexpr std::size_t kMostWornTexels = 1u << 25u;
/// What changes by less, of 1, is even.
constexpr double kEven = 0.015;
/// Slope parameters, the squares of roughnesses, of paints that are mixed.
constexpr double kRoughnessStep = 1.5;
constexpr std::size_t kMostRoughnesses = 4;
constexpr double kSmoothest = 0.0317;  ///< whose square is the least slope parameter

/// One of a material's textures.
struct Use {
    std::string name;
    int texture = -1;
    GltfUvs uvs;
    std::shared_ptr<const ArtworkPicture> picture{};
};

glm::dvec2 pair_or(const tinygltf::Value& object, const char* key, const glm::dvec2& otherwise) {
    if (!object.Has(key)) return otherwise;
    const tinygltf::Value& pair = object.Get(key);
    return {pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble()};
}

GltfUvs uvs_of(int set, const tinygltf::Value& transform) {
    GltfUvs uvs{set, glm::dmat3(1.0)};
    if (!transform.IsObject()) return uvs;
    uvs.set = static_cast<int>(number_or(transform, "texCoord", set));
    const glm::dvec2 offset = pair_or(transform, "offset", glm::dvec2(0.0));
    const glm::dvec2 scale = pair_or(transform, "scale", glm::dvec2(1.0));
    const double angle = number_or(transform, "rotation", 0.0);
    const double c = std::cos(angle), s = std::sin(angle);
    // Counter-clockwise in the picture, whose v runs down; scaled first and moved last.
    uvs.picture_from_uv = glm::dmat3(glm::dvec3(scale.x * c, -scale.x * s, 0.0),
                                     glm::dvec3(scale.y * s, scale.y * c, 0.0),
                                     glm::dvec3(offset, 1.0));
    return uvs;
}

/// Of pbrMetallicRoughness and of normals.
template <typename Info>
Use use_of(std::string name, const Info& info) {
    const auto transform = info.extensions.find("KHR_texture_transform");
    const bool turned = transform != info.extensions.end();
    return {std::move(name),
            info.index,
            uvs_of(info.texCoord, turned ? transform->second : tinygltf::Value())};
}

/// Of an extension's member.
Use use_of(const tinygltf::Material& material, const char* extension, const char* member) {
    Use use;
    use.name = std::string(extension) + "." + member;
    const auto found = material.extensions.find(extension);
    if (found == material.extensions.end() || !found->second.Has(member)) return use;
    const tinygltf::Value& info = found->second.Get(member);
    use.texture = info.Get("index").GetNumberAsInt();
    const bool extended = info.Has("extensions");
    use.uvs =
        uvs_of(static_cast<int>(number_or(info, "texCoord", 0.0)),
               extended ? info.Get("extensions").Get("KHR_texture_transform") : tinygltf::Value());
    return use;
}

/// What of a surface changes from texel to texel, and the values of the paints between which it is
/// mixed.
struct SurfaceAxis {
    double GltfSurface::*value = nullptr;
    std::optional<ImageF> picture{};
    int channel = 0;
    double factor = 1.0;
    bool of_roughness = false;     ///< slope parameters mix by their ratio: levels are logarithms
    std::vector<double> levels{};  ///< rising

    double at(std::size_t texel) const {
        const auto c = static_cast<std::size_t>(channel);
        const double found = factor * static_cast<double>(picture->values[4 * texel + c]);
        return of_roughness ? std::log(std::max(found, kSmoothest)) : found;
    }
    double value_of(double level) const { return of_roughness ? std::exp(level) : level; }
    /// How much of what stands at x the paint of a level has.
    double share(double x, std::size_t level) const {
        const auto between = [&](std::size_t below) {
            const double low = levels[below], high = levels[below + 1];
            return glm::clamp((x - low) / (high - low), 0.0, 1.0);
        };
        double share = 1.0;
        if (level > 0) share *= between(level - 1);
        if (level + 1 < levels.size()) share *= 1.0 - between(level);
        return share;
    }
};

/// Sets the levels, and the surface's own value to the mean. An axis that is even has one.
void find_levels(SurfaceAxis& axis, std::size_t texels, bool coloured, GltfSurface& surface) {
    double low = 1e9, high = -1e9, sum = 0.0;
    for (std::size_t i = 0; i < texels; ++i) {
        const double x = axis.at(i);
        low = std::min(low, x);
        high = std::max(high, x);
        sum += x;
    }
    const double mean = sum / static_cast<double>(texels);
    surface.*axis.value = axis.value_of(mean);
    const bool even = high - low < kEven;
    if (axis.value == &GltfSurface::metallic && (coloured || !even)) {
        // A picture colours a pigment or a metal; in between, both side by side reflect the same.
        if (low < 1.0 - kEven) axis.levels.push_back(0.0);
        if (high > kEven) axis.levels.push_back(1.0);
    } else if (even) {
        axis.levels = {mean};
    } else if (axis.of_roughness) {
        const double steps = std::ceil(2.0 * (high - low) / std::log(kRoughnessStep));
        const auto count =
            std::clamp<std::size_t>(static_cast<std::size_t>(steps) + 1, 2, kMostRoughnesses);
        for (std::size_t k = 0; k < count; ++k) {
            const double t = static_cast<double>(k) / static_cast<double>(count - 1);
            axis.levels.push_back(glm::mix(low, high, t));
        }
    } else {
        axis.levels = {low, high};
    }
}

/// All that a material's pictures say, texel by texel, on one grid.
struct Texels {
    int width = 0, height = 0;
    std::optional<ImageF> base;  ///< linear, with the factor
    GltfSurface surface;         ///< in the mean
    std::vector<SurfaceAxis> axes;

    std::size_t count() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    std::size_t paints() const {
        std::size_t product = 1;
        for (const SurfaceAxis& axis : axes) product *= axis.levels.size();
        return product;
    }
    /// The level of each axis in the paint of a number.
    std::size_t level(std::size_t paint, std::size_t axis) const {
        for (std::size_t a = 0; a < axis; ++a) paint /= axes[a].levels.size();
        return paint % axes[axis].levels.size();
    }
};

void fit_grid(Texels& texels, int width, int height) {
    texels.width = width;
    texels.height = height;
    if (texels.base) texels.base = resampled(*texels.base, width, height);
    for (SurfaceAxis& axis : texels.axes) axis.picture = resampled(*axis.picture, width, height);
}

void find_all_levels(Texels& texels) {
    for (SurfaceAxis& axis : texels.axes) {
        axis.levels.clear();
        find_levels(axis, texels.count(), texels.base.has_value(), texels.surface);
    }
    for (SurfaceAxis& axis : texels.axes) {
        if (texels.paints() > kMostPaints && axis.levels.size() > 2) {
            axis.levels = {axis.levels.front(), axis.levels.back()};
        }
    }
}

/// Of a grid that every picture fits and whose paints' pictures fit the memory.
void choose_grid(Texels& texels, std::size_t most) {
    int width = 1, height = 1;
    const auto take = [&](const ImageF& picture) {
        width = std::max(width, picture.width);
        height = std::max(height, picture.height);
    };
    if (texels.base) take(*texels.base);
    for (const SurfaceAxis& axis : texels.axes) take(*axis.picture);
    fit_grid(texels, width, height);
    find_all_levels(texels);
    while (texels.count() * texels.paints() > most && std::max(width, height) > 1) {
        width = std::max(width / 2, 1);
        height = std::max(height / 2, 1);
        fit_grid(texels, width, height);
        find_all_levels(texels);
    }
}

/// The picture of every paint; paints that are nowhere are left out. Each covers those before it,
/// so that the share of paint k is alpha[k] times what those after it leave.
std::vector<std::pair<std::size_t, std::shared_ptr<const ArtworkPicture>>> paint_pictures(
    const Texels& texels) {
    const std::size_t paints = texels.paints();
    std::vector<ArtworkPicture> made(paints);
    std::vector<double> most(paints, 0.0), shares(paints);
    for (ArtworkPicture& picture : made) {
        picture.rgba = ImageF(texels.width, texels.height, 4);
        picture.linear = picture.has_alpha = true;
    }
    for (std::size_t i = 0; i < texels.count(); ++i) {
        std::fill(shares.begin(), shares.end(), 1.0);
        for (std::size_t a = 0; a < texels.axes.size(); ++a) {
            const double x = texels.axes[a].at(i);
            for (std::size_t k = 0; k < paints; ++k) {
                shares[k] *= texels.axes[a].share(x, texels.level(k, a));
            }
        }
        double beneath = 1.0;
        for (std::size_t k = paints; k-- > 0;) {
            const double alpha = beneath > 1e-9 ? std::min(shares[k] / beneath, 1.0) : 1.0;
            beneath = std::max(beneath - shares[k], 0.0);
            most[k] = std::max(most[k], shares[k]);
            float* rgba = &made[k].rgba.values[4 * i];
            for (std::size_t c = 0; c < 3; ++c) {
                rgba[c] = texels.base
                              ? texels.base->values[4 * i + c]
                              : static_cast<float>(texels.surface.base_rec709[static_cast<int>(c)]);
            }
            rgba[3] = static_cast<float>(alpha);
        }
    }
    std::vector<std::pair<std::size_t, std::shared_ptr<const ArtworkPicture>>> found;
    for (std::size_t k = 0; k < paints; ++k) {
        if (most[k] < 1.0 / 255.0) continue;
        if (found.empty()) {
            for (std::size_t i = 0; i < texels.count(); ++i) made[k].rgba.values[4 * i + 3] = 1.0f;
        }
        found.emplace_back(k, std::make_shared<const ArtworkPicture>(std::move(made[k])));
    }
    return found;
}

/// At least one.
std::size_t textured_materials(const tinygltf::Model& model) {
    const auto count = std::count_if(
        model.materials.begin(), model.materials.end(), [](const tinygltf::Material& material) {
            const auto& pbr = material.pbrMetallicRoughness;
            return pbr.baseColorTexture.index >= 0 || pbr.metallicRoughnessTexture.index >= 0;
        });
    return std::max<std::size_t>(static_cast<std::size_t>(count), 1);
}

bool is_repeated(const tinygltf::Model& model, int texture) {
    const int sampler = model.textures[static_cast<std::size_t>(texture)].sampler;
    if (sampler < 0) return true;
    const auto& wrap = model.samplers[static_cast<std::size_t>(sampler)];
    return wrap.wrapS == TINYGLTF_TEXTURE_WRAP_REPEAT && wrap.wrapT == TINYGLTF_TEXTURE_WRAP_REPEAT;
}

/// Roughness alone changes, on a paint that has one: a map of it, exact in more steps.
std::optional<PartPicture> roughness_map(const Texels& texels) {
    const SurfaceAxis* changing = nullptr;
    for (const SurfaceAxis& axis : texels.axes) {
        if (axis.levels.size() == 1) continue;
        if (changing || !axis.of_roughness) return std::nullopt;
        changing = &axis;
    }
    const bool coated = texels.surface.coat > 0.0;
    if (!changing || texels.base || coated != (changing->value == &GltfSurface::coat_roughness)) {
        return std::nullopt;
    }
    ArtworkPicture picture;
    picture.rgba = ImageF(texels.width, texels.height, 4, 1.0f);
    for (std::size_t i = 0; i < texels.count(); ++i) {
        std::fill_n(&picture.rgba.values[4 * i],
                    3,
                    static_cast<float>(std::exp(changing->at(i) - changing->levels.back())));
    }
    PartPicture map;
    map.use = PartPicture::Use::roughness;
    map.picture = std::make_shared<const ArtworkPicture>(std::move(picture));
    return map;
}

}  // namespace

void wear_pictures(const GltfFile& gltf,
                   GltfPictures& pictures,
                   std::size_t index,
                   bool plain,
                   GltfMaterial& material,
                   Notes& notes) {
    const tinygltf::Material& from = gltf.model.materials[index];
    const std::string& name = material.part.material_name;
    const auto note = [&](const std::string& text) {
        notes.push_back(fmt::format("material \"{}\": {}", name, text));
    };
    const char* const coat = "KHR_materials_clearcoat";
    std::array<Use, 5> uses{
        use_of("baseColorTexture", from.pbrMetallicRoughness.baseColorTexture),
        use_of("metallicRoughnessTexture", from.pbrMetallicRoughness.metallicRoughnessTexture),
        use_of(from, coat, "clearcoatTexture"),
        use_of(from, coat, "clearcoatRoughnessTexture"),
        use_of("normalTexture", from.normalTexture)};
    const Use* first = nullptr;
    for (Use& use : uses) {
        if (use.texture < 0) continue;
        const bool is_base = &use == &uses[0];
        const GltfPicture& found = pictures.of_texture(use.texture, is_base);
        const bool said = &use == &uses[1] && !found.picture;  // that it has no gloss, and why
        if (!found.note.empty() && !said) {
            note(is_base && !found.picture ? found.note + "; its plain colour is shown"
                                           : use.name + ": " + found.note);
        }
        if (!found.picture) continue;
        if (first && !(use.uvs == first->uvs)) {
            note(fmt::format("{} lies along other texture coordinates than {}; it is not read",
                             use.name,
                             first->name));
            continue;
        }
        use.picture = found.picture;
        if (first) continue;
        first = &use;
        if (!is_repeated(gltf.model, use.texture)) {
            note(use.name + " is repeated beyond its edge, which the file wants otherwise");
        }
    }
    const auto& [base, metal_rough, coated, coat_rough, normals] = uses;

    Texels texels;
    texels.surface = surface_of(from);
    if (!base.picture) texels.surface.base_rec709 = material.part.base_colour_rec709;
    if (base.picture) {
        texels.base = base.picture->rgba;
        for (std::size_t i = 0; i < texels.base->values.size(); ++i) {
            const auto c = static_cast<int>(i % 4);
            if (c < 3) {
                texels.base->values[i] *= static_cast<float>(texels.surface.base_rec709[c]);
            }
        }
    }
    GltfSurface& surface = texels.surface;
    const auto add = [&](const Use& use, double GltfSurface::*value, int channel, bool roughness) {
        if (!use.picture || surface.*value == 0.0) return;
        texels.axes.push_back({value, use.picture->rgba, channel, surface.*value, roughness, {}});
    };
    if (metal_rough.picture) {
        add(metal_rough, &GltfSurface::metallic, 2, false);
    } else if (texels.base && !plain) {
        texels.axes.push_back(
            {&GltfSurface::metallic, ImageF(1, 1, 4, 1.0f), 2, surface.metallic, false, {}});
    }
    add(metal_rough, &GltfSurface::roughness, 1, true);
    if (surface.coat > 0.0) {
        add(coated, &GltfSurface::coat, 0, false);
        add(coat_rough, &GltfSurface::coat_roughness, 1, true);
    }

    if (normals.picture) {
        PartPicture relief;
        relief.use = PartPicture::Use::relief;
        relief.name = fmt::format("{} of {}", normals.name, name);
        relief.picture = normals.picture;
        relief.depth = glm::clamp(from.normalTexture.scale, -10.0, 10.0);
        material.part.pictures.push_back(std::move(relief));
    }
    if (first) material.uvs = first->uvs;
    if (!texels.base && texels.axes.empty()) return;

    choose_grid(texels, kMostWornTexels / textured_materials(gltf.model));
    if (texels.base) {
        glm::dvec3 sum(0.0);
        for (std::size_t i = 0; i < texels.count(); ++i) {
            for (int c = 0; c < 3; ++c) {
                sum[c] +=
                    static_cast<double>(texels.base->values[4 * i + static_cast<std::size_t>(c)]);
            }
        }
        surface.base_rec709 = sum / static_cast<double>(texels.count());
        material.part.base_colour_rec709 = surface.base_rec709;
    }
    Notes said_before;
    const auto paint_of = [&](const GltfSurface& of) {
        if (!plain) return gltf_paint(gltf, index, of, name, said_before);
        Material paint;
        paint.name = name;
        paint.diffuse = of.base_rec709;
        return paint;
    };
    if (!plain) material.part.paint = paint_of(surface);

    if (!plain && material.part.paint->model == ReflectanceModel::car_paint) {
        note(
            "under a thin film its colours and its roughness are even, those of its pictures in "
            "the mean");
        return;
    }
    if (auto map = roughness_map(texels)) {
        GltfSurface roughest = surface;
        for (const SurfaceAxis& axis : texels.axes)
            roughest.*axis.value = axis.value_of(axis.levels.back());
        map->paint = paint_of(roughest);
        map->name = "roughness of " + name;
        material.part.pictures.push_back(std::move(*map));
        return;
    }
    if (!texels.base && texels.paints() == 1) return;
    for (auto& [k, picture] : paint_pictures(texels)) {
        GltfSurface white = surface;
        white.base_rec709 = glm::dvec3(1.0);
        for (std::size_t a = 0; a < texels.axes.size(); ++a) {
            const SurfaceAxis& axis = texels.axes[a];
            white.*axis.value = axis.value_of(axis.levels[texels.level(k, a)]);
        }
        PartPicture worn;
        worn.name = fmt::format("{} of {}", texels.base ? base.name : metal_rough.name, name);
        worn.paint = paint_of(white);
        worn.picture = std::move(picture);
        material.part.pictures.push_back(std::move(worn));
    }
}

}  // namespace livery
