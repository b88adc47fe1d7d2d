// While nobody changes anything the mock-up's picture gets better.
#include <algorithm>

#include "studio/drawing.h"

namespace livery {

namespace {

constexpr const char* kSetting = "refine-while-still";
/// Long enough that who tries one thing after the other is not in its way.
constexpr double kStill_s = 2.0;

EffectLevels levels_of(const Document& document) {
    return document.levels ? *document.levels : levels_of(document.quality);
}

bool may_refine(const Studio& studio) {
    for (const Panel& panel : all_panels()) {
        if (panel.holds_picture && panel.holds_picture(studio)) return false;
    }
    return !studio.refinement.on && refines_while_still(studio.settings) && !studio.tried &&
           !studio.opening && !shows_reference(studio);
}

}  // namespace

bool shows_reference(const Studio& studio) {
    return studio.frame && studio.frame->plan.quality == Quality::reference &&
           find_pass(studio.frame->plan, PassKind::path_tracer);
}

bool refines_while_still(const UserSettings& settings) {
    return setting(settings, kSetting) != "no";
}

void set_refines_while_still(UserSettings& settings, bool on) {
    keep_setting(settings, kSetting, on ? "yes" : "no");
}

std::optional<EffectLevels> refined_levels(const Document& document) {
    if (document.quality == Quality::reference && !document.levels) return std::nullopt;
    const EffectLevels own = levels_of(document), high = levels_of(Quality::high);
    EffectLevels finer = own;
    for (std::size_t e = 0; e < kEffects; ++e) finer.of[e] = std::max(own.of[e], high.of[e]);
    return finer == own ? std::nullopt : std::optional(finer);
}

void begin_anew(Studio& studio, const WantedFrame& frame) {
    Refinement& refinement = studio.refinement;
    SolveKeys light = frame.keys;
    // What paints send on is solved for each of them
    for (auto& side : light) {
        if (side) side->sends_on.clear();
    }
    const bool same = refinement.light && missing_of(*refinement.light, light).empty();
    if (!same || !refines_while_still(studio.settings)) refinement.on = false;
    refinement.light = std::move(light);
    refinement.still_since_s = studio.now_s;
}

bool stands_refined(const Studio& studio) {
    return !studio.refinement.on || refines_while_still(studio.settings);
}

bool refinement_is_due(const Studio& studio) {
    const bool all_there = studio.frame && studio.frame->number == studio.frame_number &&
                           studio.frame->unfinished.empty();
    return may_refine(studio) && all_there &&
           studio.now_s >= studio.refinement.still_since_s + kStill_s &&
           refined_levels(studio.session.document());
}

double next_refinement_s(const Studio& studio) {
    const double due_s = studio.refinement.still_since_s + kStill_s;
    return may_refine(studio) && due_s > studio.now_s ? due_s : 0.0;
}

}  // namespace livery
