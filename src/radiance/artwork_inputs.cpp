#include "radiance/artwork_inputs.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "core/parallel.h"

namespace livery {

ArtworkInputs::ArtworkInputs(const Mesh& mesh,
                             const View& view,
                             const SurfaceMap& map,
                             const PackedLayout& layout,
                             ShadingDevice device)
    : mesh_(mesh),
      view_(view),
      map_(map),
      layout_(layout),
      device_(device),
      footprints_(mesh.parts.size()),
      changed_parts_(mesh.parts.size(), false) {}

bool ArtworkInputs::stands(const Scene& scene) const {
    return std::equal(scene.artwork.begin(),
                      scene.artwork.end(),
                      solved_.begin(),
                      solved_.end(),
                      [](const PartArtwork& a, const auto& b) { return covers_alike(a, b->of); });
}

bool ArtworkInputs::solve(const Scene& scene) {
    if (stands(scene)) return false;
    // Every part whose list is no longer the same; what stood elsewhere in the list still stands
    std::vector<std::shared_ptr<Solved>> next;
    for (const PartArtwork& artwork : scene.artwork) {
        const auto found = std::find_if(solved_.begin(), solved_.end(), [&](const auto& solved) {
            return solved && covers_alike(artwork, solved->of);
        });
        if (found != solved_.end()) {
            next.push_back(*found);
            continue;
        }
        auto solved = std::make_shared<Solved>();
        solved->of = artwork;
        if (artwork.picture) solved->filtered = filtered_of(artwork);
        solve_one(*solved);
        next.push_back(std::move(solved));
    }
    const auto mark_against = [&](const auto& these, const auto& those) {
        for (const auto& solved : these) {
            if (std::find(those.begin(), those.end(), solved) == those.end()) {
                changed_parts_[solved->of.part] = true;
            }
        }
    };
    mark_against(next, solved_);
    mark_against(solved_, next);
    for (std::size_t k = 0; k < std::min(next.size(), solved_.size()); ++k) {
        if (next[k] != solved_[k]) changed_parts_[next[k]->of.part] = true;
    }
    solved_ = std::move(next);
    std::erase_if(pictures_, [&](const Picture& picture) {
        return std::none_of(solved_.begin(), solved_.end(), [&](const auto& solved) {
            return solved->filtered == picture.filtered;
        });
    });
    return true;
}

std::shared_ptr<const FilteredPicture> ArtworkInputs::filtered_of(const PartArtwork& artwork) {
    const PictureUse use = artwork.artwork.use;
    const bool repeat = artwork.artwork.repeat;
    for (const Picture& known : pictures_) {
        if (known.of == artwork.picture && known.use == use && known.repeat == repeat &&
            known.pigment_response == artwork.pigment_response) {
            return known.filtered;
        }
    }
    auto filtered = std::make_shared<const FilteredPicture>(
        picture_layers(*artwork.picture, use, artwork.pigment_response), repeat);
    pictures_.push_back({artwork.picture, use, repeat, artwork.pigment_response, filtered});
    return filtered;
}

void ArtworkInputs::solve_one(Solved& solved) {
    const PartArtwork& artwork = solved.of;
    std::vector<Footprint>& footprints = footprints_[artwork.part];
    if (footprints.empty()) footprints = footprints_of(view_, map_, artwork.part);
    const ArtworkPlane plane = plane_of(artwork.artwork.place);
    const std::size_t layers =
        solved.filtered ? static_cast<std::size_t>(solved.filtered->channels()) / 4 : 1;
    const std::size_t texels = static_cast<std::size_t>(layout_.rows) * kPackedWidth * 4;
    solved.texels.assign(layers, std::vector<float>(texels, 0.0f));
    const std::size_t first = map_.part_begin[artwork.part];
    const PictureFrame frame = artwork.picture ? picture_frame(artwork) : PictureFrame();
    std::atomic<std::size_t> covered = 0;
    parallel_for(layout_.fragments(artwork.part), 1024, [&](std::size_t begin, std::size_t end) {
        std::vector<float> values(4 * layers);
        for (std::size_t i = first + begin; i < first + end; ++i) {
            const Fragment& fragment = map_.fragments[i];
            const glm::dvec3 normal(fragment.normal);
            const double facing =
                facing_cover(artwork.artwork.place, glm::dot(normal, plane.toward));
            if (facing <= 0.0) continue;
            const FlatFootprint flat =
                flat_footprint(mesh_, map_, i, footprints[i - first], artwork, plane);
            if (solved.filtered) {
                solved.filtered->mean(
                    frame.uv(flat.at), frame.turned(flat.a), frame.turned(flat.b), values.data());
            } else {
                std::fill(
                    values.begin(),
                    values.end(),
                    static_cast<float>(shape_cover(artwork.artwork, flat.at, flat.a, flat.b)));
            }
            const std::size_t address = 4 * layout_.address(i, artwork.part);
            for (std::size_t k = 0; k < layers; ++k) {
                for (std::size_t c = 0; c < 4; ++c) {
                    solved.texels[k][address + c] = static_cast<float>(facing) * values[4 * k + c];
                }
            }
            if (values[3] > 0.0f) ++covered;
        }
    });
    solved.covered = covered;
}

void ArtworkInputs::upload() {
    for (const auto& solved : solved_) {
        if (solved->texels.empty()) continue;
        if (solved->covered > 0) {
            const auto layers = static_cast<int>(solved->texels.size());
            if (solved->layers.make(device_, layout_.rows, layers, InputLayers::Precision::full)) {
                ++layers_made_;
            }
            for (int k = 0; k < layers; ++k) {
                solved->layers.upload(solved->texels[static_cast<std::size_t>(k)], k);
            }
        }
        solved->texels.clear();
        solved->texels.shrink_to_fit();
    }
}

std::vector<bool> ArtworkInputs::take_changed_parts() {
    return std::exchange(changed_parts_, std::vector<bool>(changed_parts_.size(), false));
}

}  // namespace livery
