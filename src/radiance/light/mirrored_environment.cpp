#include "radiance/light/mirrored_environment.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "radiance/light/mirror_quadrature.h"
#include "radiance/light/mirror_visibility.h"
#include "radiance/light/sky_visibility.h"

namespace livery {

namespace {

/// The variance that is left to the Gaussian of a node beside hidden ones: a lamp behind an edge of
/// the product must not shine past it.
constexpr float kBesideHidden = 0.4f;

/// 1 where the bit is not set: nothing is in the way.
float share_seen(std::uint64_t blocked, std::uint8_t bit) {
    return ((blocked >> bit) & 1u) == 0 ? 1.0f : 0.0f;
}

const GrazingLobes& grazing_lobes(std::size_t layer) {
    return layer < kHalfAngleLobes.size() ? kHalfAngleLobes[layer] : kEntryLobes;
}

MirrorFacet facet_for_sums(const Facet& facet, std::size_t index) {
    MirrorFacet to;
    for (int c = 0; c < 3; ++c) {
        to.x[c] = facet.x[c];
        to.y[c] = facet.y[c];
        to.normal[c] = facet.normal[c];
        to.to_eye[c] = facet.wo[c];
    }
    to.variance = facet.variance;
    to.below = facet.row.below(index);
    to.above = facet.row.above(index);
    to.share = facet.row.share();
    return to;
}

}  // namespace

MirrorLobes::MirrorLobes(const MirrorLayers& layers) : layers_(layers) {
    std::array<bool, kMirrorAlphas.size()> grazes{};
    std::bitset<kMirrorAlphas.size()> needed;
    for (std::size_t k = 0; k < needed.size(); ++k) needed[k] = layers[k];
    for (std::size_t layer = 0; layer < kGrazingLayers; ++layer) {
        if (!layers[kMirrorAlphas.size() + layer]) continue;
        for (const std::size_t lobe : grazing_lobes(layer)) {
            needed.set(lobe);
            grazes[lobe] = true;
        }
    }
    for (std::size_t k = 0; k < needed.size(); ++k) {
        if (!needed[k]) continue;
        place_[k] = count_;
        grazes_[count_] = grazes[k];
        lobes_[count_++] = static_cast<int>(k);
    }
}

MirroredEnvironment::MirroredEnvironment(const Environment& environment,
                                         const FilteredEnvironment& filtered,
                                         const Mesh& mesh,
                                         const SurfaceMap& map,
                                         glm::dvec3 eye_mm,
                                         const MirrorVisibility* visibility,
                                         const MirroredProduct& product)
    : scale_(static_cast<float>(environment.scale)),
      layers_(filtered),
      mesh_(mesh),
      map_(map),
      eye_mm_(eye_mm),
      visibility_(visibility),
      product_(product),
      unoccluded_(visibility ? std::optional<MirrorQuadrature>()
                             : MirrorQuadrature(mirror_rings(0))),
      quadrature_(visibility ? visibility->quadrature : *unoccluded_) {
    if (visibility) neighbours_.emplace(map);
    job_.sharp = layers_.sharp();
    job_.wide = layers_.wide();
    job_.turns = SpherePlaces(environment).turns();
    job_.variance_of_first = kFirstGaussian_rad * kFirstGaussian_rad;
    job_.nodes = quadrature_.places();
    job_.facet_count = MirrorQuadrature::kFacets;
}

bool MirroredEnvironment::find_seen(std::size_t fragment,
                                    bool light_alone,
                                    Scratch& scratch) const {
    neighbours_->around(fragment, scratch.neighbours);
    if (const MirrorVisibility::Alone* own = find_alone(fragment)) {
        ask_itself(*own, scratch);
    } else {
        if (std::all_of(scratch.neighbours.begin(), scratch.neighbours.end(), [&](const auto& one) {
                return visibility_->blocked[one.fragment] == 0;
            })) {
            return false;
        }
        ask_neighbours(fragment, scratch);
    }
    const std::vector<float>& seen = scratch.seen_nodes;
    const std::size_t places = MirrorQuadrature::kFacets * quadrature_.places();
    const bool product_lit = product_.hits && scale_ > 0.0f;
    scratch.in_the_way.assign(product_lit ? 3 * places : 0, 0.0f);
    for (std::size_t k = 0; k < (product_lit ? seen.size() : 0); ++k) {
        const glm::vec3& light = scratch.hidden_light[k];
        if (light == glm::vec3(0.0f)) continue;
        float* to = &scratch.in_the_way[quadrature_.place_of(k)];
        for (std::size_t c = 0; c < 3; ++c) to[c * places] = light[static_cast<int>(c)] / scale_;
    }
    if (light_alone) return true;
    scratch.seen.assign(places, 0.0f);
    scratch.width.assign(places, 1.0f);
    for (std::size_t k = 0; k < seen.size(); ++k) {
        float least = 1.0f;
        for (const std::uint16_t beside : quadrature_.beside(k)) {
            least = std::min(least, seen[beside]);
        }
        const std::size_t place = quadrature_.place_of(k);
        scratch.seen[place] = seen[k];
        scratch.width[place] = 1.0f - (1.0f - kBesideHidden) * (1.0f - least);
    }
    return true;
}

void MirroredEnvironment::ask_neighbours(std::size_t fragment, Scratch& scratch) const {
    // By turn and bit; few neighbours hide anything
    std::array<std::array<float, 64>, MirrorQuadrature::kTurns> hidden{};
    std::array<std::array<glm::vec3, 64>, MirrorQuadrature::kTurns> sent{};
    std::array<float, MirrorQuadrature::kTurns> whole{};
    const std::vector<std::uint64_t>& blocked = visibility_->blocked;
    for (const FragmentNeighbours::Neighbour& one : scratch.neighbours) {
        whole[one.turn] += one.weight;
        std::uint32_t hit = product_.hits ? product_.hits->first[one.fragment] : 0;
        for (std::uint64_t left = blocked[one.fragment]; left != 0; left &= left - 1) {
            const auto bit = static_cast<std::size_t>(std::countr_zero(left));
            hidden[one.turn][bit] += one.weight;
            if (product_.hits) sent[one.turn][bit] += one.weight * product_.light(hit++);
        }
    }
    scratch.seen_nodes.resize(quadrature_.count());
    scratch.hidden_light.resize(quadrature_.count());
    for (std::size_t k = 0; k < scratch.seen_nodes.size(); ++k) {
        const MirrorQuadrature::Ray& ray = quadrature_.ray(k);
        if (ray.turn == MirrorQuadrature::kStraight) {
            scratch.seen_nodes[k] = share_seen(blocked[fragment], ray.bit);
            scratch.hidden_light[k] = sent_at(blocked[fragment], ray.bit, first_hit(fragment));
        } else {
            const float share = 1.0f / whole[ray.turn];
            scratch.seen_nodes[k] = share * (whole[ray.turn] - hidden[ray.turn][ray.bit]);
            scratch.hidden_light[k] = share * sent[ray.turn][ray.bit];
        }
    }
}

glm::vec3 MirroredEnvironment::sent_at(std::uint64_t word,
                                       std::uint8_t bit,
                                       std::uint32_t first) const {
    const std::uint64_t own = std::uint64_t{1} << bit;
    if (!product_.hits || (word & own) == 0) return glm::vec3(0.0f);
    return product_.light(first + static_cast<std::uint32_t>(std::popcount(word & (own - 1))));
}

const MirrorVisibility::Alone* MirroredEnvironment::find_alone(std::size_t fragment) const {
    const std::vector<MirrorVisibility::Alone>& alone = visibility_->alone;
    const auto found = std::lower_bound(
        alone.begin(), alone.end(), fragment, [](const auto& one, std::size_t index) {
            return one.fragment < index;
        });
    return found != alone.end() && found->fragment == fragment ? &*found : nullptr;
}

MirroredEnvironment::AloneWords MirroredEnvironment::words_of(
    const MirrorVisibility::Alone& alone) const {
    AloneWords words{&alone, neighbour_turn(map_, alone.fragment), {first_hit(alone.fragment)}};
    if (product_.hits) {
        const auto index = static_cast<std::size_t>(&alone - visibility_->alone.data());
        std::uint32_t next = product_.hits->first_alone[index];
        for (std::size_t word = 1; word < words.first.size(); ++word) {
            words.first[word] = next;
            next += static_cast<std::uint32_t>(std::popcount(alone.blocked[word]));
        }
    }
    return words;
}

void MirroredEnvironment::ask_itself(const MirrorVisibility::Alone& alone, Scratch& scratch) const {
    const AloneWords own = words_of(alone);
    // Those to the left and the right have looked into the other turns, and tell what is there;
    // where parts send no light, all that hides the environment is dark alike.
    constexpr float kBesideWeight = 6.0f;
    std::array<AloneWords, 2> others;
    std::size_t count = 0;
    for (const FragmentNeighbours::Neighbour& one : scratch.neighbours) {
        if (!product_.hits || one.weight < kBesideWeight || (one.turn + own.turn) % 2 == 0)
            continue;
        const MirrorVisibility::Alone* other = find_alone(one.fragment);
        if (other && count < others.size()) others[count++] = words_of(*other);
    }
    // How many turns from a fragment's own on
    const auto turns_from = [](const AloneWords& words, std::size_t turn) {
        return (turn + kNeighbourTurns - words.turn) % kNeighbourTurns;
    };
    scratch.seen_nodes.assign(quadrature_.count(), 0.0f);
    scratch.hidden_light.assign(quadrature_.count(), glm::vec3(0.0f));
    for (std::size_t k = 0; k < scratch.seen_nodes.size(); ++k) {
        const MirrorQuadrature::Ray& ray = quadrature_.ray(k);
        const auto look =
            [&](const AloneWords& words, std::size_t turns, std::uint8_t bit, float share) {
                const std::size_t word = turns % kNeighbourTurns / 2;
                const std::uint64_t blocked = words.of->blocked[word];
                scratch.seen_nodes[k] += share * share_seen(blocked, bit);
                scratch.hidden_light[k] += share * sent_at(blocked, bit, words.first[word]);
            };
        if (ray.turn == MirrorQuadrature::kStraight) {
            look(own, 0, ray.bit, 1.0f);
            continue;
        }
        const std::size_t turns = turns_from(own, ray.turn);
        if (turns % 2 == 0) {
            look(own, turns, ray.bit, 1.0f);
        } else if (count > 0) {
            for (std::size_t n = 0; n < count; ++n) {
                look(others[n],
                     turns_from(others[n], ray.turn),
                     ray.bit,
                     1.0f / static_cast<float>(count));
            }
        } else {
            for (const std::size_t beside : {turns - 1, turns + 1}) {
                const std::size_t turn = (own.turn + beside) % kNeighbourTurns;
                look(own, beside, quadrature_.nearest(k, turn), 0.5f);
            }
        }
    }
}

MirroredLight MirroredEnvironment::at_fragment(std::size_t fragment,
                                               const MirrorLobes& lobes,
                                               Scratch& scratch,
                                               std::span<float> sums,
                                               bool known) const {
    const bool hidden = visibility_ && find_seen(fragment, known, scratch);
    const bool product_lit = hidden && !scratch.in_the_way.empty();
    const std::size_t sum_count = kNodeLists * lobes.count();
    if (known) std::copy_n(sums.begin(), sum_count, scratch.sums.begin());
    if (!known || product_lit) {
        const Facets facets = visibility_
                                  ? facets_of(mesh_, map_, fragment, eye_mm_, quadrature_)
                                  : even_facets(map_.fragments[fragment], eye_mm_, quadrature_);
        std::array<MirrorFacet, MirrorQuadrature::kFacets> for_sums;
        for (std::size_t f = 0; f < facets.size(); ++f) for_sums[f] = facet_for_sums(facets[f], f);
        scratch.light.resize(kNodeLists * facets.size() * quadrature_.places());
        scratch.lit.resize(facets.size() * quadrature_.places() / kNodeBlock);
        MirrorSumJob job = job_;
        job.facets = for_sums.data();
        job.seen = hidden ? scratch.seen.data() : nullptr;
        job.width = scratch.width.data();
        job.lobes = lobes.lobes();
        job.grazes = lobes.grazes();
        job.lobe_count = lobes.count();
        job.light = scratch.light.data();
        job.lit = scratch.lit.data();
        if (!known) {
            job.sums = scratch.sums.data();
            best_lanes().sum_mirrored(job);
            if (!sums.empty()) std::copy_n(scratch.sums.begin(), sum_count, sums.begin());
        }
        if (product_lit) {
            job.given = scratch.in_the_way.data();
            job.sums = scratch.of_product.data();
            best_lanes().sum_mirrored(job);
            for (std::size_t k = 0; k < sum_count; ++k) scratch.sums[k] += scratch.of_product[k];
        }
    }

    const Fragment& mean = map_.fragments[fragment];
    const float cosine = std::clamp(glm::dot(toward_eye(mean, eye_mm_), mean.normal), 0.0f, 1.0f);
    const MirrorQuadrature::Even even =
        quadrature_.seen_under(std::sqrt(1.0f - cosine * cosine)).even();
    MirroredLight result;
    result.fill(glm::vec3(0.0f));
    const auto sums_of = [&](std::size_t lobe) {
        return &scratch.sums[kNodeLists * lobes.place_of(lobe)];
    };
    for (std::size_t k = 0; k < kMirrorAlphas.size(); ++k) {
        if (!lobes.layers()[k]) continue;
        const float* of = sums_of(k);
        result[k] = scale_ * glm::vec3(of[0], of[1], of[2]);
    }
    for (std::size_t layer = 0; layer < kGrazingLayers; ++layer) {
        const std::size_t to = kMirrorAlphas.size() + layer;
        if (!lobes.layers()[to]) continue;
        const std::size_t weight = layer < kHalfAngleLobes.size() ? 3 : 4;
        for (int k = 0; k < 3; ++k) {
            constexpr float kLargest = 8.0f;  // where the term is so small that no one sees it
            const float* of = sums_of(grazing_lobes(layer)[static_cast<std::size_t>(k)]);
            const float usual = (of[0] + of[1] + of[2]) * even.of[layer][k];
            // Without light as of even light
            result[to][k] = usual > 0.0f ? std::clamp(of[weight] / usual, 0.0f, kLargest) : 1.0f;
        }
    }
    return result;
}

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
                     const LaneFunctions& with)
    : look_up_(with.look_up_mirrored),
      scale_(static_cast<float>(environment.scale)),
      eye_mm_(eye_mm) {
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
