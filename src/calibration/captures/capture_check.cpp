#include "calibration/captures/capture_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "calibration/colour/colour_report.h"
#include "core/error.h"
#include "core/statistics.h"
#include "core/worst_error.h"

namespace livery {

namespace {

using Warnings = std::vector<std::string>;
/// Largest share of the lit blocks at the camera's limit that is still worth a calibration.
constexpr double kMostSaturated = 0.05;

void refuse_saturated(const Evidence& e) {
    std::string names;
    double worst = 0.0;
    for (const CaptureSummary* c : {e.white, e.bright}) {
        if (!c) continue;
        double over = 0.0;
        for (std::size_t i = 0; i < e.lit.size(); ++i) over += e.lit[i] && c->saturated[i];
        over /= std::max(1.0, e.lit_count);
        if (over <= kMostSaturated) continue;
        names += (names.empty() ? "" : " and ") + c->name;
        worst = worse_of(worst, over);
    }
    if (!names.empty())
        throw Refused(names + ": over-exposed, " + percent(worst) +
                          " of what is lit is at the camera's limit (saturated)",
                      "shorten the exposure until white on the mock-up stays under 85% of full "
                      "scale, and repeat all photographs");
    for (const CaptureSummary* c : {e.white, e.bright})
        // A renderer may light an even wall evenly: one value everywhere is no limit.
        if (c && c->plateau > 0.0 && c->plateau < 0.98 * c->saturates_at &&
            c->plateau_share < 0.9 * e.lit_count / static_cast<double>(e.lit.size()))
            throw Refused(c->name + ": over-exposed, " + percent(c->plateau_share) +
                              " of its pixels stop exactly at " +
                              std::to_string(std::lround(c->plateau)) +
                              ", where the camera seems to be saturated",
                          "shorten the exposure until white on the mock-up stays under 85% of full "
                          "scale, and give that value as saturates_at in manifest.json");
}

/// Where full scale is known: white's peak in the better of the two photographs that show it.
void check_too_dim(const Evidence& e, Warnings& warnings) {
    // At a twentieth, a paint of 2% is 8 to 16 of a RAW file's levels over black, as much as the
    // noise; the live calibration does with a fifth.
    constexpr double kRefused = 0.05, kWarned = 0.2;
    const CaptureSummary* best = nullptr;
    double peak = 0.0;
    for (const CaptureSummary* c : {e.white, e.bright}) {
        if (!c || !std::isfinite(c->full_light)) continue;
        std::vector<float> light;
        for (std::size_t i = 0; i < e.lit.size(); ++i)
            if (e.lit[i]) light.push_back(c->light.values[i]);
        const double here = static_cast<double>(quantile(std::move(light), 0.99)) / c->full_light;
        if (best && here <= peak) continue;
        best = c;
        peak = here;
    }
    if (!best || peak >= kWarned) return;
    const std::string what = best->name + ": under-exposed, white on the mock-up reaches only " +
                             percent(peak) + " of full scale: too dark to tell dark paints apart";
    const std::string fix =
        "expose longer, so that white on the mock-up reaches about 80% of full scale, and repeat "
        "all photographs";
    if (peak < kRefused) throw Refused(what, fix);
    warnings.push_back(what + "; " + fix);
}

/// RAW and linear files carry a pedestal, which looks like room light where nobody takes it off.
void check_black_level(const Evidence& e, Warnings& warnings) {
    constexpr double kPedestal = 0.003;  // of white: less is no worse than a good projector's leak
    if (!e.black || e.black->has_black_level || e.black->saturates_at <= 255.0) return;
    const double darkest = static_cast<double>(quantile(e.black->light.values, 0.01)) / e.peak;
    if (darkest > kPedestal)
        warnings.push_back("the darkest place in " + e.black->name + " still has " +
                           percent(darkest) +
                           " of white, and manifest.json states no black_level: without light most "
                           "cameras' RAW and linear files do not read 0; state black_level, else "
                           "it counts as room light");
}

void refuse_late(const Evidence& e) {
    if (!e.white || !e.black || e.black->mean <= 1.5 * e.white->mean) return;
    throw Refused(e.black->name + " is brighter than " + e.white->name +
                      ": the photographs show the picture before theirs, or the two are swapped",
                  "photograph each picture only after it has arrived, and check which file has "
                  "which role in manifest.json");
}

/// A fixed exposure cannot make white darker than black anywhere, nor red as bright as white.
void refuse_automatic_exposure(const Evidence& e) {
    if (!e.white || !e.black) return;
    double darker = 0.0, brighter = 0.0;
    for (std::size_t i = 0; i < e.white->light.values.size(); ++i) {
        const float w = e.white->light.values[i], k = e.black->light.values[i];
        darker += w < 0.9f * k && k > 0.05f * static_cast<float>(e.black->mean);
        brighter += w > 1.1f * k;
    }
    const auto count = static_cast<double>(e.white->light.values.size());
    const bool impossible = darker > 0.03 * count && brighter > 0.03 * count;
    const bool alike = e.black->mean > 0.5 * e.white->mean;
    bool colours_alike = e.bright != nullptr;
    for (const CaptureSummary* c : {e.red, e.green, e.blue})
        colours_alike = colours_alike && c && c->mean > 0.7 * e.bright->mean;
    if (impossible && alike)
        throw Refused("automatic exposure: " + e.black->name + " is as bright as " + e.white->name +
                          (colours_alike ? ", and so is every other photograph" : "") +
                          ", though what the projector does not light is darker in white",
                      kManualExposure);
}

/// Where each photograph stands against white, in camera pixels; a pair of stripes by its sum.
struct Placed {
    std::string name;
    glm::vec2 at_px;
};

void check_moved(const Evidence& e, Warnings& warnings) {
    constexpr float kWarned_px = 0.3f, kRefused_px = 1.3f;
    if (!e.white) return;
    Image8 mask(e.white->light.width, e.white->light.height, 1);
    for (std::size_t i = 0; i < mask.values.size(); ++i) mask.values[i] = e.lit[i] ? 255 : 0;
    const std::vector<TextureBlock> white = texture_blocks(e.white->light, mask);
    std::vector<Placed> placed;
    for (const CaptureSummary& c : *e.all) {
        ImageF light;
        if (const StripePair* pair = e.pair_that_begins_with(c)) {
            light = pair->first->light;
            for (std::size_t i = 0; i < light.values.size(); ++i)
                light.values[i] += pair->second->light.values[i];
        } else if (&c == e.white) {
            placed.push_back({c.name, glm::vec2(0.0f)});
            continue;
        } else if (&c == e.bright || &c == e.red || &c == e.green || &c == e.blue ||
                   (c.role == "white" && &c != e.white)) {
            light = c.light;
        } else {
            continue;
        }
        const glm::vec2 d = displacement(white, light);
        if (std::isfinite(d.x + d.y))
            placed.push_back({c.name, d * static_cast<float>(e.block_px)});
    }
    for (std::size_t k = 1; k < placed.size(); ++k) {
        const glm::vec2 moved = placed[k].at_px - placed.front().at_px;
        if (glm::length(moved) < kWarned_px) continue;
        // One photograph alone is misread more often than moved there and back.
        const bool stays = k + 1 == placed.size() ||
                           glm::length(placed[k + 1].at_px - placed.front().at_px) >= kWarned_px;
        if (!stays) continue;
        float farthest = 0.0f;
        for (const Placed& p : placed)
            farthest = std::max(farthest, glm::length(p.at_px - placed.front().at_px));
        const std::string what = "camera, projector or mock-up moved: from " + placed[k].name +
                                 " on, what is seen lies " + std::to_string(farthest).substr(0, 4) +
                                 " camera pixels beside where " + placed.front().name + " has it";
        const std::string fix =
            "fix all three firmly, release the camera by cable or timer, and "
            "repeat";
        if (farthest >= kRefused_px) throw Refused(what, fix);
        warnings.push_back(what + "; " + fix);
        return;
    }
}

/// Of white's light.
constexpr float kDark = 0.1f;

/// The photographs of one role say the same.
void check_repeats(const Evidence& e) {
    for (std::size_t k = 1; k < e.all->size(); ++k) {
        const CaptureSummary& again = (*e.all)[k];
        const auto first = std::find_if(
            e.all->begin(), e.all->end(), [&](const auto& c) { return c.role == again.role; });
        if (&*first == &again || !e.black || again.role == "black" || again.role == "dark-gray")
            continue;
        const Region region = region_of(ratio_to(first->light, e.lit, [&](std::size_t i) {
            // Where the picture is dark there is only noise to compare.
            const bool dark = first->light.values[i] < kDark * e.reference.values[i];
            return dark || first->saturated[i] || again.saturated[i]
                       ? std::numeric_limits<float>::quiet_NaN()
                       : again.light.values[i];
        }));
        if (region.found()) refuse_region(again.name, region);
        if (std::abs(region.typical - 1.0) > 0.02 && !again.role.starts_with("white"))
            throw Refused(again.name + " is " + times_of(region.typical) + " than " + first->name +
                              ", which shows the same picture",
                          kSteady);
    }
}

/// Each block's light over black as it was in the middle of the session.
std::vector<CaptureSummary> without_drift(const Evidence& e, const LampDrift& drift) {
    std::vector<CaptureSummary> steady = *e.all;
    if (drift.slope == 0.0 || !e.black) return steady;
    for (CaptureSummary& summary : steady) {
        const auto gain = static_cast<float>(1.0 / drift.light_at(summary.taken_at));
        for (std::size_t i = 0; i < summary.colour.values.size(); ++i) {
            const float black = e.black->colour.values[i];
            summary.colour.values[i] = black + (summary.colour.values[i] - black) * gain;
        }
        for (std::size_t i = 0; i < summary.light.values.size(); ++i) {
            const float black = e.black->light.values[i];
            summary.light.values[i] = black + (summary.light.values[i] - black) * gain;
        }
    }
    return steady;
}

}  // namespace

CaptureVerdict check_captures(const std::vector<CaptureSummary>& captures,
                              int block_px,
                              const ShownDrives& drives) {
    CaptureVerdict verdict;
    const Evidence evidence = gather_evidence(captures, block_px);
    if (evidence.lit_count < 64.0) {
        refuse_late(evidence);
        refuse_automatic_exposure(evidence);
        return verdict;  // too little light for more; the solver says where it is missing
    }
    refuse_saturated(evidence);
    refuse_late(evidence);
    check_too_dim(evidence, verdict.warnings);
    refuse_automatic_exposure(evidence);
    check_black_level(evidence, verdict.warnings);
    refuse_other_white(evidence, WhiteTaken::before_colours);
    check_room_light(evidence, drives);
    check_moved(evidence, verdict.warnings);
    verdict.drift = check_stripes(evidence, verdict.warnings);
    // The colours are judged as if the lamp had stood still.
    const std::vector<CaptureSummary> steady = without_drift(evidence, verdict.drift);
    const Evidence of_steady = gather_evidence(steady, block_px);
    check_repeats(of_steady);
    check_colours(of_steady, drives, verdict);
    refuse_other_white(evidence, WhiteTaken::after_them);
    return verdict;
}

namespace {

constexpr float kLitShare = 0.1f;  // of the brightest

const CaptureSummary* first_of(const std::vector<CaptureSummary>& captures, const char* role) {
    for (const CaptureSummary& capture : captures)
        if (capture.role == role) return &capture;
    return nullptr;
}

ImageF difference(const ImageF& a, const ImageF& b) {
    ImageF out = a;
    for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] -= b.values[i];
    return out;
}

ImageF reference_of(const Evidence& e) {
    if (e.pairs.size() >= 5 && e.black) {
        ImageF reference = e.black->light;
        std::vector<float> sums(e.pairs.size());
        for (std::size_t i = 0; i < reference.values.size(); ++i) {
            for (std::size_t k = 0; k < sums.size(); ++k)
                sums[k] = e.pairs[k].first->light.values[i] + e.pairs[k].second->light.values[i];
            reference.values[i] =
                quantile_in_place(std::span<float>(sums), 0.5) - 2.0f * e.black->light.values[i];
        }
        return reference;
    }
    if (e.white && e.black) return difference(e.white->light, e.black->light);
    if (e.bright && e.dark) return difference(e.bright->light, e.dark->light);
    return {};
}

}  // namespace

const StripePair* Evidence::pair_that_begins_with(const CaptureSummary& capture) const {
    for (const StripePair& pair : pairs)
        if (pair.first == &capture) return &pair;
    return nullptr;
}

std::size_t Evidence::order_of(const CaptureSummary& capture) const {
    return static_cast<std::size_t>(&capture - all->data());
}

Evidence gather_evidence(const std::vector<CaptureSummary>& captures, int block_px) {
    Evidence e;
    e.all = &captures;
    e.block_px = block_px;
    e.white = first_of(captures, "white");
    e.black = first_of(captures, "black");
    e.dark = first_of(captures, "dark-gray");
    e.bright = first_of(captures, "bright-gray");
    e.red = first_of(captures, "red");
    e.green = first_of(captures, "green");
    e.blue = first_of(captures, "blue");
    e.levels = first_of(captures, "gray-levels");
    for (std::size_t k = 0; k < captures.size(); ++k) {
        const std::string& role = captures[k].role;
        if (!role.starts_with("gray-column-") && !role.starts_with("gray-row-")) continue;
        if (role.ends_with("-inverse") || first_of(captures, role.c_str()) != &captures[k])
            continue;
        if (const CaptureSummary* inverse = first_of(captures, (role + "-inverse").c_str()))
            e.pairs.push_back({&captures[k], inverse, k});
    }
    e.reference = reference_of(e);
    const std::vector<float>& light = e.reference.values;
    e.lit.assign(light.size(), 0);
    if (light.empty()) return e;
    // What is not a number in any photograph counts in none.
    std::vector<std::uint8_t> known(light.size(), 1);
    for (const CaptureSummary& capture : captures)
        for (std::size_t i = 0; i < known.size(); ++i) known[i] = known[i] && !capture.unknown[i];
    const float peak = quantile(light, 0.995);
    e.peak = static_cast<double>(peak);
    for (std::size_t i = 0; i < light.size(); ++i) {
        e.lit[i] = known[i] && peak > 0.0f && light[i] > kLitShare * peak;
        e.lit_count += e.lit[i];
    }
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < light.size(); ++i)
        if (known[i]) order.push_back(i);
    // Not by `reference`: it holds black's noise, which would choose the blocks.
    const std::vector<float>& chosen_by = !e.pairs.empty()
                                              ? e.pairs.front().first->light.values
                                              : (e.white ? e.white : e.bright)->light.values;
    const std::vector<float>& and_by =
        !e.pairs.empty() ? e.pairs.front().second->light.values : chosen_by;
    std::sort(order.begin(), order.end(), [&](auto a, auto b) {
        return chosen_by[a] + and_by[a] < chosen_by[b] + and_by[b];
    });
    const std::size_t tenth = order.size() / 10;
    for (std::size_t band = 0; band < e.dim.size(); ++band)
        for (std::size_t k = band * tenth; k < (band + 1) * tenth; ++k)
            e.dim[band].push_back(order[k]);
    return e;
}

Region region_of(const ImageF& ratio, double tolerance) {
    Region region;
    std::vector<float> known;
    for (const float value : ratio.values)
        if (std::isfinite(value)) known.push_back(value);
    region.holds.assign(ratio.values.size(), 0);
    if (known.empty()) return region;
    region.typical = static_cast<double>(median(known));
    const auto typical = static_cast<float>(region.typical);
    const auto side = [&](int x, int y) {
        const float value = ratio.at(x, y);
        if (!std::isfinite(value)) return 0;
        const float off = value - typical, most = static_cast<float>(tolerance) * typical;
        return off > most ? 1 : off < -most ? -1 : 0;
    };
    // Silhouettes and thin borders deviate by a fraction of a pixel: only pieces of 3 x 3 count.
    std::vector<float> there;
    for (int y = 1; y + 1 < ratio.height; ++y)
        for (int x = 1; x + 1 < ratio.width; ++x) {
            const int own = side(x, y);
            bool whole = own != 0;
            for (int v = y - 1; v <= y + 1 && whole; ++v)
                for (int u = x - 1; u <= x + 1 && whole; ++u) whole = side(u, v) == own;
            if (!whole) continue;
            region.holds[ratio.index(x, y)] = 1;
            there.push_back(ratio.at(x, y));
        }
    region.share = static_cast<double>(there.size()) / static_cast<double>(known.size());
    if (!there.empty()) region.ratio = static_cast<double>(median(there)) / region.typical;
    return region;
}

std::string times_of(double ratio) {
    return ratio < 1.0 ? percent(1.0 - ratio) + " darker" : percent(ratio - 1.0) + " brighter";
}

void refuse_region(const std::string& name, const Region& region) {
    throw Refused(name + ": " + percent(region.share) + " of what is lit is " +
                      times_of(region.ratio) +
                      " than the other photographs say: a shadow, a reflection or somebody in the "
                      "light",
                  "keep out of the light of the projector and of the camera's view, and repeat "
                  "that photograph");
}

}  // namespace livery
