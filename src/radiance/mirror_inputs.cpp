#include "radiance/mirror_inputs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/parallel.h"
#include "radiance/light/mirrored_environment.h"
#include "radiance/packed_fragments.h"

namespace livery {
namespace {

/// Numbers that are kept of a part: a quarter of a gigabyte.
constexpr std::size_t kMostKept = std::size_t{1} << 26u;
/// Less than anybody sees between two pixels, or while they are dragged.
constexpr float kEven = 0.04f, kDragged = 0.2f;

/// Parts of which some layer is named.
std::vector<bool> parts_of(const MirrorInputs::LayersOfParts& layers) {
    std::vector<bool> parts;
    for (const MirrorLayers& of_part : layers) parts.push_back(of_part.any());
    return parts;
}

/// Half floats hold the radiance in units in which the brightest texel fits.
float unit_of(const MirrorInputs::Light& light, float largest) {
    return std::max(1.0f, largest * static_cast<float>(light.environment->scale) / kLargestHalf);
}

Texel load(const std::vector<float>& texels, std::size_t k) {
    Texel texel;
    std::memcpy(&texel, &texels[4 * k], sizeof texel);
    return texel;
}
void store(const Texel& texel, std::vector<float>& texels, std::size_t k) {
    std::memcpy(&texels[4 * k], &texel, sizeof texel);
}

/// Of two fragments, at a place between them; all by their places among the texels.
void mix(std::vector<float>& texels, std::size_t k, const SmoothRuns::Between& at) {
    const Texel first = load(texels, at.first), share{at.share, at.share, at.share, at.share};
    store(first + share * (load(texels, at.second) - first), texels, k);
}

/// Those of one part, which lie side by side.
template <typename Texels>
std::span<Texels> texels_of(std::vector<Texels>& all, std::size_t part) {
    const auto first =
        std::find_if(all.begin(), all.end(), [&](const Texels& one) { return one.part == part; });
    const auto last =
        std::find_if(first, all.end(), [&](const Texels& one) { return one.part != part; });
    return {first, last};
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
    spare_texels_.clear();
    even_.clear();
    kept_.clear();
}

void MirrorInputs::hide_behind(std::shared_ptr<const NodeExchange> nodes,
                               const NodeLight& sent,
                               int version) {
    product_nodes_ = std::move(nodes);
    product_sent_ = &sent;
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
    if (light.nodes <= 0) return false;
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
                         const SmoothRuns& runs,
                         const Progress& progress) {
    if (other_rays(light)) {
        visibility_.emplace(*map_, layers.size(), light.nodes);
        visibility_eye_mm_ = light.eye_mm;
    }
    hits_.reset();
    add_mirror_visibility(
        mesh_, tracer_, *map_, runs, light.eye_mm, parts_of(layers), progress, *visibility_);
    if (!product_nodes_) return;
    hits_ = find_mirror_hits(
        mesh_, tracer_, *map_, light.eye_mm, *visibility_, *product_nodes_, progress);
}

std::vector<MirrorInputs::Texels> MirrorInputs::texels_for(const LayersOfParts& layers) {
    std::vector<Texels> all;
    for (std::size_t part = 0; part < layers.size(); ++part) {
        // A part out of the picture has no texels
        if (layout_.fragments(part) == 0) continue;
        const auto size =
            static_cast<std::size_t>(layout_.rectangle(part).height) * kPackedWidth * 4;
        for (std::size_t k = 0; k < kMirrorLayers; ++k) {
            if (!layers[part][k] || even_[part][k]) continue;
            const auto spare = std::find_if(spare_texels_.begin(),
                                            spare_texels_.end(),
                                            [&](const Texels& one) { return one.part == part; });
            if (spare == spare_texels_.end()) {
                all.push_back({part, k, std::vector<float>(size, 0.0f), false});
            } else {
                all.push_back({part, k, std::move(spare->values), false});
                spare_texels_.erase(spare);
            }
        }
    }
    return all;
}

template <typename MirroredBy>
void MirrorInputs::solve_part(const PartSolve& how,
                              std::span<Texels> texels,
                              const MirroredBy& mirrored_by,
                              const Progress& progress) const {
    const std::size_t first = layout_.part_begin[how.part], count = layout_.fragments(how.part);
    const auto put = [&](std::size_t i, const MirroredLight& mirrored) {
        // Who does not ask which lobes are hidden dims those of a joint like its diffuse light
        const bool joint = how.joints && map_->fragments[i].coverage < 1.0f;
        const float scale = (joint ? how.joints->openness(i) : 1.0f) * how.unit;
        for (Texels& to : texels) {
            const float share = to.layer < kMirrorAlphas.size() ? scale : 1.0f;
            const glm::vec3 value = share * mirrored[to.layer];
            store(Texel{value.x, value.y, value.z, 0.0f}, to.values, i - first);
        }
    };
    /// `each(ask)` of a stretch's fragments, of which none waits for another's light.
    const auto solve = [&](const auto& each) {
        progress.check_stop();
        std::vector<std::size_t> asked;
        each([&](std::size_t i) { asked.push_back(i); });
        auto mirrored_at = mirrored_by();
        std::array<MirroredLight, kNodeBlock> light;
        for (std::size_t k = 0; k < asked.size(); k += kNodeBlock) {
            const std::span<const std::size_t> some =
                std::span(asked).subspan(k, std::min(kNodeBlock, asked.size() - k));
            mirrored_at(some, light);
            for (std::size_t n = 0; n < some.size(); ++n) put(some[n], light[n]);
        }
    };
    const auto differ = [&](std::size_t one, std::size_t other) {
        return std::any_of(texels.begin(), texels.end(), [&](const Texels& to) {
            const float* a = &to.values[4 * (one - first)];
            const float* b = &to.values[4 * (other - first)];
            for (int c = 0; c < 3; ++c) {
                if (std::abs(a[c] - b[c]) > how.tolerance * std::max(a[c], b[c])) return true;
            }
            return false;
        });
    };
    parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
        solve([&](const auto& ask) { how.runs.ends(first + begin, first + end, ask); });
    });
    for (const SmoothRuns::Line line : SmoothRuns::kLines) {
        parallel_for(count, 4096, [&](std::size_t begin, std::size_t end) {
            solve([&](const auto& ask) {
                how.runs.between(line, first + begin, first + end, [&](std::size_t i, auto at) {
                    if (differ(at.first, at.second)) return ask(i);
                    const SmoothRuns::Between in_part{
                        at.first - first, at.second - first, at.share};
                    for (Texels& to : texels) mix(to.values, i - first, in_part);
                });
            });
        });
    }
}

void MirrorInputs::solve(const Light& light,
                         const LayersOfParts& layers,
                         const FilteredEnvironment& filtered,
                         const SmoothRuns& runs,
                         const SkyVisibility* joints,
                         const Progress& progress) {
    const bool hides = light.nodes > 0;
    const ImageF& sharpest = filtered.gaussians.front();
    const float unit =
        unit_of(light, *std::max_element(sharpest.values.begin(), sharpest.values.end()));
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
    even_.resize(layers.size());
    for (std::size_t part = 0; part < layers.size(); ++part) even_[part] &= ~layers[part];
    std::vector<Texels> all = texels_for(layers);
    for (std::size_t part = 0; part < layers.size(); ++part) {
        const std::span<Texels> texels = texels_of(all, part);
        if (texels.empty()) continue;
        const MirrorLobes lobes(layers[part]);
        KeptSums& kept = kept_[part];
        const std::size_t sums_each = MirroredEnvironment::kSumsALobe * lobes.count();
        const std::size_t sums = layout_.fragments(part) * sums_each;
        const bool known = kept.layers == layers[part] && kept.values.size() == sums;
        if (!known) {
            kept = {};
            if (product_nodes_ && hides && sums <= kMostKept) {
                kept.values.resize(sums);
                kept.known.resize(layout_.fragments(part));
            }
        }
        const std::span<float> values(kept.values);
        const auto mirrored_by = [&] {
            return [&, scratch = MirroredEnvironment::Scratch()](
                       std::span<const std::size_t> some,
                       std::array<MirroredLight, kNodeBlock>& found) mutable {
                for (std::size_t n = 0; n < some.size(); ++n) {
                    const std::size_t k = some[n] - layout_.part_begin[part];
                    std::span<float> own;
                    bool sums_known = false;
                    if (!values.empty()) {
                        own = values.subspan(k * sums_each, sums_each);
                        sums_known = std::exchange(kept.known[k], 1) != 0;
                    }
                    found[n] = environment.at_fragment(some[n], lobes, scratch, own, sums_known);
                }
            };
        };
        solve_part({part, runs, hides ? kEven : kDragged, hides ? nullptr : joints, 1.0f / unit},
                   texels,
                   mirrored_by,
                   progress);
        // Not before: a stop leaves them half done
        if (!kept.values.empty()) kept.layers = layers[part];
    }
    take(light, layers, unit, std::move(all));
}

void MirrorInputs::look_up(const Light& light,
                           const LayersOfParts& layers,
                           const MirrorLookUp& environment,
                           const SmoothRuns& runs,
                           const SkyVisibility* joints,
                           const Progress& progress) {
    const float unit = unit_of(light, environment.largest());
    kept_.clear();
    even_.resize(layers.size());
    std::vector<Texels> all = texels_for(layers);
    for (Texels& to : all) to.even = to.layer >= kMirrorAlphas.size();
    for (std::size_t part = 0; part < layers.size(); ++part) {
        const std::span<Texels> texels = texels_of(all, part);
        if (texels.empty()) continue;
        const MirrorLookUp::In in(
            environment, *light.environment, light.eye_mm, MirrorLobes(layers[part]));
        const auto mirrored_by = [&] {
            return [&](std::span<const std::size_t> some,
                       std::array<MirroredLight, kNodeBlock>& found) {
                std::array<const Fragment*, kNodeBlock> fragments;
                for (std::size_t n = 0; n < some.size(); ++n) {
                    fragments[n] = &map_->fragments[some[n]];
                }
                in.at_fragments(std::span(fragments).first(some.size()), found);
            };
        };
        solve_part({part, runs, kDragged, joints, 1.0f / unit}, texels, mirrored_by, progress);
    }
    take(light, layers, unit, std::move(all));
}

void MirrorInputs::take(const Light& light,
                        const LayersOfParts& layers,
                        float unit,
                        std::vector<Texels> solved) {
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
    std::move(solved.begin(), solved.end(), std::back_inserter(solved_texels_));
}

MirrorInputs::Uploaded MirrorInputs::upload(ShadingDevice device,
                                            InputLayers::Precision precision,
                                            ShadingInputs& shading) {
    Uploaded done;
    done.other_light = std::exchange(other_light_, false);
    if (!light_.environment) {
        shading.mirror = InputLayers();
        even_.clear();
        return done;
    }
    std::vector<bool> layers(kMirrorLayers, false);
    for (const Texels& texels : solved_texels_) layers[texels.layer] = true;
    done.more_room = shading.mirror.make_room(device, layout_.rows, layers, precision);
    for (const Texels& texels : solved_texels_) {
        shading.mirror.upload(
            texels.values, static_cast<int>(texels.layer), layout_.row_begin[texels.part]);
        even_[texels.part].set(texels.layer, texels.even);
    }
    // Memory that is new costs as much to touch as a draft to solve; what is not dragged gives it
    // back
    spare_texels_.clear();
    if (light_.nodes == kNoNodes) spare_texels_ = std::move(solved_texels_);
    solved_texels_.clear();
    shading.mirror_unit = unit_;
    shading.mirror_mixing = light_.mixing();
    return done;
}

}  // namespace livery
