#include "radiance/mirror_inputs.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "radiance/light/mirrored_environment.h"

namespace livery {
namespace {

constexpr float kHalfLargest = 65000.0f;
/// Numbers that are kept of a part: a quarter of a gigabyte.
constexpr std::size_t kMostKept = std::size_t{1} << 26u;

/// Whether a draft mirrors at a fragment the mean of what it does on both sides in the same row:
/// all three whole pixels of one surface that turns by less than a degree, so that no reflection
/// moves by more than another one.
bool lies_between(const SurfaceMap& map, std::size_t i) {
    constexpr float kOneDegree = 0.99985f;
    if (i == 0 || i + 1 >= map.fragments.size()) return false;
    const Fragment &left = map.fragments[i - 1], &own = map.fragments[i],
                   &right = map.fragments[i + 1];
    const auto width = static_cast<std::uint32_t>(map.width);
    const std::uint32_t x = own.pixel % width;
    return x % 2 == 1 && x + 1 < width && left.pixel + 1 == own.pixel &&
           own.pixel + 1 == right.pixel && left.part == own.part && right.part == own.part &&
           left.coverage == 1.0f && own.coverage == 1.0f && right.coverage == 1.0f &&
           glm::dot(left.normal, right.normal) > kOneDegree &&
           glm::dot(left.normal, own.normal) > kOneDegree;
}

/// Parts of which some layer is named.
std::vector<bool> parts_of(const MirrorInputs::LayersOfParts& layers) {
    std::vector<bool> parts;
    for (const MirrorLayers& of_part : layers) parts.push_back(of_part.any());
    return parts;
}

}  // namespace

MirrorInputs::MirrorInputs(const Mesh& mesh,
                           const Tracer& tracer,
                           const SurfaceMap& map,
                           const PackedLayout& layout)
    : mesh_(mesh), tracer_(tracer), map_(&map), layout_(layout) {}

void MirrorInputs::use(const SurfaceMap& map) {
    map_ = &map;
    clear();
}

void MirrorInputs::clear() {
    if (light_.environment) other_light_ = true;
    light_ = {};
    visibility_.reset();
    hits_.reset();
    solved_texels_.clear();
    kept_.clear();
}

void MirrorInputs::hide_behind(std::shared_ptr<const NodeExchange> nodes,
                               std::span<const glm::vec3> sent,
                               int version) {
    product_nodes_ = std::move(nodes);
    product_sent_ = sent;
    if (product_version_ == version) return;
    product_version_ = version;
    // A draft knows nothing of what hides the environment
    if (light_.nodes > 0) newest_.assign(solved_.size(), MirrorLayers());
}

MirrorInputs::LayersOfParts MirrorInputs::missing(const Light& light,
                                                  const LayersOfParts& wanted,
                                                  bool and_old) const {
    if (!light.environment) return LayersOfParts(wanted.size());
    if (light != light_) return wanted;
    LayersOfParts left = wanted;
    const LayersOfParts& there = and_old ? newest_ : solved_;
    for (std::size_t p = 0; p < left.size(); ++p) left[p] &= ~there[p];
    return left;
}

bool MirrorInputs::lacks_visibility(const Light& light, const LayersOfParts& layers) const {
    if (light.nodes == 0) return false;
    const bool lacks_hits = product_nodes_ && !hits_;
    for (std::size_t p = 0; p < layers.size(); ++p) {
        if (layers[p].any() && (other_rays(light) || lacks_hits || !visibility_->parts[p])) {
            return true;
        }
    }
    return false;
}

void MirrorInputs::trace(const Light& light,
                         const LayersOfParts& layers,
                         const Progress& progress) {
    if (other_rays(light)) {
        visibility_.emplace(*map_, layers.size(), light.nodes);
        visibility_eye_mm_ = light.eye_mm;
    }
    hits_.reset();
    add_mirror_visibility(
        mesh_, tracer_, *map_, light.eye_mm, parts_of(layers), progress, *visibility_);
    if (!product_nodes_) return;
    hits_ = find_mirror_hits(
        mesh_, tracer_, *map_, light.eye_mm, *visibility_, product_nodes_->nodes, progress);
}

void MirrorInputs::solve_part(const MirroredEnvironment& environment,
                              std::size_t part,
                              const MirrorLobes& lobes,
                              std::span<Texels> texels,
                              const SkyVisibility* joints,
                              float unit,
                              std::span<float> sums,
                              bool known,
                              const Progress& progress) const {
    const std::size_t first = layout_.part_begin[part], count = layout_.fragments(part);
    const std::size_t sums_each = MirroredEnvironment::kSumsALobe * lobes.count();
    const bool draft = !environment.knows_what_hides();
    const auto is_mean = [&](std::size_t i) { return draft && lies_between(*map_, i); };
    parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        MirroredEnvironment::Scratch scratch;
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t i = first + k;
            if (is_mean(i)) continue;
            const MirroredLight mirrored = environment.at_fragment(
                i,
                lobes,
                scratch,
                sums.empty() ? sums : sums.subspan(k * sums_each, sums_each),
                known);
            // Who does not ask which lobes are hidden dims those of a joint like its diffuse light
            const bool joint = draft && joints && map_->fragments[i].coverage < 1.0f;
            const float scale = (joint ? joints->openness(i) : 1.0f) * unit;
            for (Texels& to : texels) {
                const float share = to.layer < kMirrorAlphas.size() ? scale : 1.0f;
                for (int c = 0; c < 3; ++c) {
                    to.values[4 * k + static_cast<std::size_t>(c)] = share * mirrored[to.layer][c];
                }
            }
        }
    });
    if (!draft) return;
    parallel_for(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            if (!is_mean(first + k)) continue;
            for (Texels& to : texels) {
                float* at = &to.values[4 * k];
                for (std::size_t c = 0; c < 3; ++c) at[c] = 0.5f * (at[c - 4] + at[c + 4]);
            }
        }
    });
}

void MirrorInputs::solve(const Light& light,
                         const LayersOfParts& layers,
                         const FilteredEnvironment& filtered,
                         const SkyVisibility* joints,
                         const Progress& progress) {
    const bool hides = light.nodes > 0;
    // Half floats hold the radiance in units in which the brightest texel fits.
    const ImageF& sharpest = filtered.gaussians.front();
    const float largest = *std::max_element(sharpest.values.begin(), sharpest.values.end()) *
                          static_cast<float>(light.environment->scale);
    const float unit = std::max(1.0f, largest / kHalfLargest);
    const MirroredEnvironment environment(
        *light.environment,
        filtered,
        mesh_,
        *map_,
        light.eye_mm,
        hides ? &*visibility_ : nullptr,
        product_nodes_ && hits_ ? MirroredProduct{&*hits_, product_sent_} : MirroredProduct());
    if (light != light_) kept_.clear();
    kept_.resize(layers.size());
    std::vector<Texels> all;
    for (std::size_t part = 0; part < layers.size(); ++part) {
        const std::size_t fragments = layout_.fragments(part);
        // A part out of the picture has no texels
        if (layers[part].none() || fragments == 0) continue;
        const std::size_t first_texels = all.size();
        const auto size =
            static_cast<std::size_t>(layout_.rectangle(part).height) * kPackedWidth * 4;
        for (std::size_t k = 0; k < kMirrorLayers; ++k) {
            if (layers[part][k]) all.push_back({part, k, std::vector<float>(size, 0.0f)});
        }
        const MirrorLobes lobes(layers[part]);
        KeptSums& kept = kept_[part];
        const std::size_t sums = fragments * MirroredEnvironment::kSumsALobe * lobes.count();
        const bool known = kept.layers == layers[part] && kept.values.size() == sums;
        if (!known) {
            kept = {};
            if (product_nodes_ && hides && sums <= kMostKept) kept.values.resize(sums);
        }
        solve_part(environment,
                   part,
                   lobes,
                   std::span(all).subspan(first_texels),
                   joints,
                   1.0f / unit,
                   kept.values,
                   known,
                   progress);
        // Not before: a stop leaves them half done
        if (!kept.values.empty()) kept.layers = layers[part];
    }
    if (light != light_) {
        solved_texels_.clear();
        solved_.assign(layers.size(), MirrorLayers());
        newest_ = solved_;
        other_light_ = true;
        light_ = light;
        unit_ = unit;
    }
    for (std::size_t p = 0; p < layers.size(); ++p) {
        // Of those that were there, other light is mirrored now
        other_light_ = other_light_ || (solved_[p] & layers[p]).any();
        solved_[p] |= layers[p];
        newest_[p] |= layers[p];
    }
    // What waits to be uploaded and was solved again is not waited for
    std::erase_if(solved_texels_, [&](const Texels& old) { return layers[old.part][old.layer]; });
    std::move(all.begin(), all.end(), std::back_inserter(solved_texels_));
}

MirrorInputs::Uploaded MirrorInputs::upload(ShadingDevice device, ShadingInputs& shading) {
    Uploaded done;
    done.other_light = std::exchange(other_light_, false);
    if (!light_.environment) {
        shading.mirror = InputLayers();
        return done;
    }
    std::vector<bool> layers(kMirrorLayers, false);
    for (const Texels& texels : solved_texels_) layers[texels.layer] = true;
    done.more_room =
        shading.mirror.make_room(device, layout_.rows, layers, InputLayers::Precision::half);
    for (const Texels& texels : solved_texels_) {
        shading.mirror.upload(
            texels.values, static_cast<int>(texels.layer), layout_.row_begin[texels.part]);
    }
    solved_texels_.clear();
    shading.mirror_unit = unit_;
    return done;
}

}  // namespace livery
