#include "radiance/light/mirror_look_up.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "radiance/light/mirror_quadrature.h"

namespace livery {

namespace {

/// mirror_correction() of each lobe, by the root of the cosine.
using Corrections =
    std::array<std::array<float, MirrorLookUpJob::kCorrections>, kMirrorAlphas.size()>;

const Corrections& corrections() {
    static const Corrections table = [] {
        Corrections of;
        parallel_for(of.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                for (std::size_t i = 0; i < of[k].size(); ++i) {
                    const double root =
                        static_cast<double>(i) / static_cast<double>(of[k].size() - 1);
                    of[k][i] = static_cast<float>(
                        mirror_correction(root * root, static_cast<double>(kMirrorAlphas[k])));
                }
            }
        });
        return of;
    }();
    return table;
}

/// How far from the normal to the mirrored eye a lobe's middle lies: masking takes more away from
/// the half that lies flat. Lagarde and de Rousiers, Moving Frostbite to PBR (2014).
constexpr float kLeans = 0.95f;
const std::array<float, kMirrorAlphas.size()> kTowardMirrored = [] {
    std::array<float, kMirrorAlphas.size()> share{};
    for (std::size_t k = 0; k < share.size(); ++k) {
        const float alpha = kMirrorAlphas[k];
        share[k] = (1.0f - alpha) * (std::sqrt(1.0f - alpha) + alpha);
    }
    return share;
}();

}  // namespace

static_assert(kMirrorAlphas.size() <= kMostLookUps);

MirrorLookUp::MirrorLookUp(const FilteredEnvironment& filtered) {
    const std::vector<ImageF>& all = filtered.mirrored;
    const auto wide = std::find_if(all.begin(), all.end(), [&](const ImageF& picture) {
        return picture.width != all.front().width;
    });
    const auto sharp_count = static_cast<std::size_t>(wide - all.begin());
    sharp_ = SphereStack(std::span(all).first(sharp_count));
    wide_ = SphereStack(std::span(all).subspan(sharp_count));
    largest_ = *std::max_element(all.front().values.begin(), all.front().values.end());
}

MirrorLookUp::In::In(const MirrorLookUp& layers,
                     const Environment& environment,
                     glm::dvec3 eye_mm,
                     const MirrorLobes& lobes,
                     const MirrorSums& with)
    : look_up_(with.look_up), scale_(static_cast<float>(environment.scale)), eye_mm_(eye_mm) {
    job_.sharp = layers.sharp_.texels();
    job_.wide = layers.wide_.texels();
    job_.turns = SpherePlaces(environment).turns();
    job_.alpha2_of_first = kLayerAlphas[1] * kLayerAlphas[1];
    for (std::size_t k = 0; k < kMirrorAlphas.size(); ++k) {
        if (!lobes.layers()[k]) continue;
        const auto at = static_cast<std::size_t>(job_.lobe_count++);
        layers_[at] = k;
        lobes_[at] = {kMirrorAlphas[k] * kMirrorAlphas[k],
                      kTowardMirrored[k],
                      kTowardMirrored[k] < kLeans,
                      corrections()[k].data()};
    }
}

void MirrorLookUp::In::at_fragments(std::span<const Fragment* const> fragments,
                                    std::array<MirroredLight, kNodeBlock>& light) const {
    alignas(32) std::array<std::array<float, kNodeBlock>, kLookUpLists> lists;
    for (std::size_t i = 0; i < kNodeBlock; ++i) {
        // What is left of a block repeats its last
        const Fragment& f = *fragments[std::min(i, fragments.size() - 1)];
        const glm::vec3 to_eye = eye_mm_ - f.position_mm;
        for (glm::length_t c = 0; c < 3; ++c) {
            lists[static_cast<std::size_t>(c)][i] = to_eye[c];
            lists[static_cast<std::size_t>(3 + c)][i] = f.normal[c];
        }
        lists[6][i] = f.normal_variance;
    }
    alignas(32) std::array<float, 4 * kNodeBlock * kMirrorAlphas.size()> found;
    MirrorLookUpJob job = job_;
    job.lobes = lobes_.data();
    job.fragments = lists.front().data();
    job.light = found.data();
    look_up_(job);
    for (std::size_t i = 0; i < fragments.size(); ++i) {
        light[i].fill(glm::vec3(1.0f));
        for (std::size_t lobe = 0; lobe < static_cast<std::size_t>(job.lobe_count); ++lobe) {
            const float* rgb = &found[4 * (kNodeBlock * lobe + i)];
            light[i][layers_[lobe]] = scale_ * glm::vec3(rgb[0], rgb[1], rgb[2]);
        }
    }
}

}  // namespace livery
