#include "radiance/subsurface/subsurface_inputs.h"

#include <algorithm>

#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"
#include "radiance/subsurface/slab_thickness.h"
#include "radiance/subsurface/subsurface_near.h"
#include "tracing/closed_part.h"

namespace livery {

namespace {

/// Light enters by what each node stands for, is carried from disc to disc, and is interpolated, a
/// variance of 1/18, 1/(4 pi) and .225 of the cells' side squared: all over the last.
constexpr float kNodeBlur = 1.6f;

using Media = std::vector<std::optional<TranslucentMaterial>>;

bool same_or_none(const std::optional<TranslucentMaterial>& a,
                  const std::optional<TranslucentMaterial>& b) {
    return a.has_value() == b.has_value() && (!a || same_medium(*a, *b));
}

bool same_media(const Media& a, const Media& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_or_none);
}

bool same_light(const SubsurfaceInputs::Wanted& a, const SubsurfaceInputs::Wanted& b) {
    return a.lights == b.lights && a.environment == b.environment;
}

SubsurfaceInputs::Part where_it_enters(const TranslucentMaterial& medium) {
    SubsurfaceInputs::Part part;
    part.medium = medium;
    part.total = glm::vec3(working_from_rec709() * entering_albedo(medium));
    return part;
}

/// Of each channel; 0 where nothing is met.
glm::vec3 mean_free_paths_mm(const TranslucentMaterial& medium) {
    glm::vec3 paths(0.0f);
    for (int c = 0; c < 3; ++c) {
        const ScatteringMedium channel = medium_of(medium, c);
        if (channel.sigma_t_prime() > 0.0) {
            paths[c] = static_cast<float>(channel.mean_free_path_mm());
        }
    }
    return paths;
}

/// Of a part that is open, and so as thick as its medium is told to be; none where no light goes so
/// deep.
std::optional<float> told_thickness_mm(const Mesh& mesh,
                                       std::size_t part,
                                       const TranslucentMaterial& medium,
                                       float deep_mm) {
    if (!medium.thickness_mm || !(*medium.thickness_mm < static_cast<double>(deep_mm)) ||
        is_closed(mesh, part)) {
        return std::nullopt;
    }
    return static_cast<float>(*medium.thickness_mm);
}

/// Light between parts takes what enters a part for leaving where it does. What in truth leaves
/// elsewhere, as on the other side of a wall, may come back to the part: a `share` of it enters,
/// and the boundary mirrors the rest. From wall to wall it is followed as if it left where it
/// enters, for it is even by then. Adds to `leaving` what leaves of it in the end; returned is all
/// that enters, nothing where no light comes back.
std::vector<glm::vec3> returned_to_itself(const Mesh& mesh,
                                          const NodeExchange& exchange,
                                          const SubsurfaceTransport& transport,
                                          const SubsurfaceKernel& kernel,
                                          const std::vector<glm::vec3>& entering,
                                          LeavingLight& leaving,
                                          float share,
                                          const Progress& progress) {
    constexpr int kMostTimes = 32;
    constexpr float kNothing = 3e-3f;  // of the brightest place: less than anybody sees
    const auto brightest = [](const glm::vec3& v) { return std::max({v.x, v.y, v.z}); };
    std::vector<glm::vec3> sent(entering.size()), all;
    float most = 0.0f;
    for (std::size_t i = 0; i < sent.size(); ++i) {
        const glm::vec3 leaves = leaving.from_afar[i] + leaving.near_share[i] * entering[i];
        most = std::max(most, brightest(leaves));
        sent[i] = leaves - kernel.total * entering[i];
    }
    for (int time = 0; time < kMostTimes; ++time) {
        progress.check_stop();
        const auto back = at_part_nodes(
            mesh,
            exchange.nodes,
            gathered_at_nodes(exchange, from_part_nodes(transport, sent, mesh, exchange.nodes)),
            transport);
        float largest = 0.0f;
        for (const glm::vec3& one : back) largest = std::max(largest, brightest(glm::abs(one)));
        if (!(largest > kNothing * most)) break;
        all.resize(back.size(), glm::vec3(0.0f));
        for (std::size_t i = 0; i < back.size(); ++i) {
            all[i] += share * back[i];
            sent[i] = (share * leaving.even_share[i] + 1.0f - share) * back[i];
        }
    }
    if (all.empty()) return all;
    const LeavingLight added = leaving_at_nodes(transport, kernel, all, progress);
    for (std::size_t i = 0; i < all.size(); ++i) leaving.from_afar[i] += added.from_afar[i];
    return all;
}

}  // namespace

bool SubsurfaceInputs::stands(const Wanted& wanted) const {
    return solved_ && same_media(solved_->media, wanted.media) && same_light(*solved_, wanted) &&
           solved_->exchange_version == wanted.exchange_version &&
           solved_->arriving_version == wanted.arriving_version && solved_->detail == wanted.detail;
}

void SubsurfaceInputs::solve(const Wanted& wanted,
                             const SurfaceMap& map,
                             const PixelSize& pixels,
                             const EnteringAt& entering_at,
                             const FilteredEnvironment& filtered,
                             const std::shared_ptr<const NodeExchange>& exchange,
                             const std::vector<glm::vec3>& between,
                             const Progress& progress) {
    kernels_.resize(wanted.media.size());
    std::vector<std::optional<Part>> parts(wanted.media.size());
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (!wanted.media[p]) continue;
        const TranslucentMaterial& medium = *wanted.media[p];
        if (!kernels_[p] || !same_medium(kernels_[p]->medium, medium)) {
            const float deep_mm = kernel_reach_mm(medium);
            const auto told_mm = told_thickness_mm(mesh_, p, medium, deep_mm);
            const auto sheet_mm =
                told_mm ? told_mm : sheet_thickness_mm(tracer_, mesh_, p, deep_mm);
            const float reach_mm =
                sheet_mm ? std::min(deep_mm, kernel_reach_mm(medium, sheet_mm)) : deep_mm;
            kernels_[p] = {medium, shared_reach_mm(reach_mm), told_mm.value_or(0.0f), {}};
        }
        KernelOf& of = *kernels_[p];
        progress.check_stop();
        const auto transport =
            transports_->of(mesh_, tracer_, p, of.reach_mm, wanted.detail, progress, of.sheet_mm);
        if (of.kernel.near_mm != std::min(transport->near_mm, of.reach_mm)) {
            float most_bent_per_mm = 0.0f;
            for (const float one : transport->curvature_per_mm) {
                most_bent_per_mm = std::max(most_bent_per_mm, one);
            }
            of.kernel = subsurface_kernel(
                medium, of.reach_mm, transport->near_mm, transport->slabs_mm, most_bent_per_mm);
        }
        const EnteredMedium entered{
            medium.eta, mean_free_paths_mm(medium), transport->curvature_per_mm};
        std::vector<glm::vec3> entering = direct_at_nodes(transport->mesh,
                                                          tracer_,
                                                          transport->exchange,
                                                          wanted.lights,
                                                          wanted.environment.get(),
                                                          filtered,
                                                          progress,
                                                          &entered);
        const float share = entering_share(medium.eta);
        if (exchange) {
            const auto more = at_part_nodes(mesh_, exchange->nodes, between, *transport);
            for (std::size_t i = 0; i < more.size(); ++i) entering[i] += share * more[i];
        }
        LeavingLight leaving = leaving_at_nodes(*transport, of.kernel, entering, progress);
        std::vector<glm::vec3> returned;
        if (exchange) {
            returned = returned_to_itself(
                mesh_, *exchange, *transport, of.kernel, entering, leaving, share, progress);
        }
        const auto at_fragment = [&](const std::vector<glm::vec3>& at_nodes) {
            return at_fragments(transport->mesh,
                                map,
                                transport->exchange.nodes,
                                at_nodes,
                                transport->place_of,
                                transport->behind_of);
        };
        Part& part = parts[p].emplace(where_it_enters(medium));
        part.spread = true;
        part.at_fragments =
            at_fragment(transport->exchange.nodes.sharpened(leaving.from_afar, kNodeBlur));
        const std::vector<glm::vec3> near_share = at_fragment(leaving.near_share);
        std::vector<glm::vec3> bent;
        for (const float curvature : transport->curvature_per_mm) bent.emplace_back(curvature);
        const std::vector<glm::vec3> curvature = at_fragment(bent);
        std::vector<glm::vec3> at_own;
        for (std::size_t i = map.part_begin[p]; i < map.part_begin[p + 1]; ++i) {
            at_own.push_back(entering_at(i, entered, share, curvature[i].x));
        }
        if (!returned.empty()) {
            const std::vector<glm::vec3> more = at_fragment(returned);
            for (std::size_t k = 0; k < at_own.size(); ++k)
                at_own[k] += more[map.part_begin[p] + k];
        }
        progress.check_stop();
        const std::vector<glm::vec3> nearby = entering_nearby(map, pixels, p, of.kernel, at_own);
        for (std::size_t i = map.part_begin[p]; i < map.part_begin[p + 1]; ++i) {
            part.at_fragments[i] += near_share[i] * nearby[i];
        }
    }
    parts_ = std::move(parts);
    solved_ = wanted;
    ++version_;
}

void SubsurfaceInputs::use_what_stands(const Wanted& wanted) {
    bool changed = parts_.size() != wanted.media.size();
    parts_.resize(wanted.media.size());
    const bool same_lit = solved_ && same_light(*solved_, wanted);
    for (std::size_t p = 0; p < parts_.size(); ++p) {
        std::optional<Part>& part = parts_[p];
        const auto& medium = wanted.media[p];
        const bool stands =
            part.has_value() == medium.has_value() &&
            (!part || (same_medium(part->medium, *medium) && (!part->spread || same_lit)));
        if (stands) continue;
        changed = true;
        part.reset();
        if (medium) part = where_it_enters(*medium);
        // A later solve() has it to do
        if (solved_ && p < solved_->media.size()) solved_->media[p].reset();
    }
    if (changed) ++version_;
}

void SubsurfaceInputs::clear() {
    if (!parts_.empty()) ++version_;
    solved_.reset();
    parts_.clear();
}

}  // namespace livery
