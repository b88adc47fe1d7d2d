#include "radiance/subsurface_inputs.h"

#include <algorithm>

#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"

namespace livery {

namespace {

using Media = std::vector<std::optional<TranslucentMaterial>>;

bool same_medium(const TranslucentMaterial& a, const TranslucentMaterial& b) {
    return a.sigma_a_per_mm == b.sigma_a_per_mm &&
           a.sigma_s_prime_per_mm == b.sigma_s_prime_per_mm && a.g == b.g && a.eta == b.eta;
}

bool same(const std::optional<TranslucentMaterial>& a,
          const std::optional<TranslucentMaterial>& b) {
    return a.has_value() == b.has_value() && (!a || same_medium(*a, *b));
}

bool same_media(const Media& a, const Media& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
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

}  // namespace

bool SubsurfaceInputs::stands(const Wanted& wanted) const {
    return solved_ && same_media(solved_->media, wanted.media) && same_light(*solved_, wanted) &&
           solved_->exchange_version == wanted.exchange_version && solved_->detail == wanted.detail;
}

void SubsurfaceInputs::solve(const Wanted& wanted,
                             const SurfaceMap& map,
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
            kernels_[p] = {medium, subsurface_kernel(medium)};
        }
        progress.check_stop();
        const SubsurfaceKernel& kernel = kernels_[p]->kernel;
        const auto transport =
            transports_->of(mesh_, tracer_, p, kernel.reach_mm, wanted.detail, progress);
        std::vector<glm::vec3> entering = direct_at_nodes(transport->mesh,
                                                          tracer_,
                                                          transport->exchange,
                                                          wanted.lights,
                                                          wanted.environment.get(),
                                                          filtered,
                                                          progress,
                                                          medium.eta);
        if (exchange) {
            const auto more = at_part_nodes(mesh_, exchange->nodes, between, *transport);
            const float share = entering_share(medium.eta);
            for (std::size_t i = 0; i < more.size(); ++i) entering[i] += share * more[i];
        }
        const auto leaving = leaving_at_nodes(*transport, kernel, entering, progress);
        Part& part = parts[p].emplace(where_it_enters(medium));
        part.spread = true;
        part.at_fragments = at_fragments(
            transport->mesh, map, transport->exchange.nodes, leaving, transport->place_of);
    }
    parts_ = std::move(parts);
    solved_ = wanted;
}

bool SubsurfaceInputs::use_what_stands(const Wanted& wanted) {
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
    return changed;
}

bool SubsurfaceInputs::clear() {
    const bool any = !parts_.empty();
    solved_.reset();
    parts_.clear();
    return any;
}

}  // namespace livery
