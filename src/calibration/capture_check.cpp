#include "calibration/capture_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "calibration/capture_evidence.h"
#include "calibration/colour_report.h"
#include "calibration/statistics.h"
#include "core/error.h"

namespace livery {
namespace {

using Warnings = std::vector<std::string>;
constexpr const char* kManualExposure =
    "set exposure, ISO, aperture and white balance by hand, the same for all, and repeat";
constexpr const char* kSteady =
    "let the lamp warm up for 20 minutes, switch off eco and dynamic-contrast modes and automatic "
    "exposure, expose for whole projector frames, and repeat";

std::string times_of(double ratio) {
    return ratio < 1.0 ? percent(1.0 - ratio) + " darker" : percent(ratio - 1.0) + " brighter";
}

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
        worst = std::max(worst, over);
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
        const glm::vec2 d = displacement(e.white->light, light, mask);
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

void refuse_region(const std::string& name, const Region& region) {
    throw Refused(name + ": " + percent(region.share) + " of what is lit is " +
                      times_of(region.ratio) +
                      " than the other photographs say: a shadow, a reflection or somebody in the "
                      "light",
                  "keep out of the light of the projector and of the camera's view, and repeat "
                  "that photograph");
}

/// Each pair of stripes adds up to white and black, everywhere and every time.
void check_stripes(const Evidence& e, Warnings& warnings) {
    if (e.pairs.size() < 5 || !e.black) return;
    std::vector<double> brightness, order;
    for (const StripePair& pair : e.pairs) {
        ImageF ratio = ratio_to(e.reference, e.lit, [&](std::size_t i) {
            return pair.first->light.values[i] + pair.second->light.values[i] -
                   2.0f * e.black->light.values[i];
        });
        const Region region = region_of(ratio);
        if (region.found()) {
            // The one of the two that lights the place
            double first = 0.0, deviating = 0.0, lit_by[2] = {}, off[2] = {};
            for (std::size_t i = 0; i < ratio.values.size(); ++i) {
                if (!std::isfinite(ratio.values[i])) continue;
                const bool by_first = pair.first->light.values[i] > pair.second->light.values[i];
                lit_by[by_first ? 0 : 1] += 1.0;
                if (!region.holds[i]) continue;
                deviating += 1.0;
                first += by_first;
                off[by_first ? 0 : 1] += 1.0;
            }
            const int which = 2.0 * first >= deviating ? 0 : 1;
            const CaptureSummary& one = which == 0 ? *pair.first : *pair.second;
            if (off[which] > 0.7 * lit_by[which])
                throw Refused(one.name + " is " + times_of(region.ratio) +
                                  " than the other stripes say: another exposure, or a picture "
                                  "that had not arrived",
                              kManualExposure);
            refuse_region(one.name, region);
        }
        brightness.push_back(region.typical);
        order.push_back(static_cast<double>(pair.order));
    }
    if (e.white) {
        const Region region = region_of(ratio_to(e.reference, e.lit, [&](std::size_t i) {
            return e.white->light.values[i] - e.black->light.values[i];
        }));
        if (region.found()) refuse_region(e.white->name, region);
        brightness.push_back(region.typical);
        order.push_back(static_cast<double>(e.order_of(*e.white)));
    }
    const Trend trend = trend_of(order, brightness);
    const double change = trend.slope * (order.back() - order.front());
    if (std::abs(change) > 0.02 && trend.scatter < 0.25 * std::abs(change))
        warnings.push_back("the light drifts: it is " + times_of(1.0 + change) + " in " +
                           e.all->back().name + " than in " + e.all->front().name + "; " + kSteady);
    else if (trend.scatter > 0.01)
        throw Refused("the light flickers: photographs differ by " + percent(trend.scatter) +
                          " in brightness from one to the next",
                      kSteady);
}

/// dark-gray and bright-gray show what black and white show, when s and t are 0 and 255. Where the
/// projector lights little, another exposure changes little.
void check_room_light(const Evidence& e, const ShownDrives& drives) {
    constexpr double kAdded = 0.003;         // of white on the mock-up
    constexpr double kOtherExposure = 0.06;  // of the light there
    if (!e.white || !e.black || e.dim.front().empty() || !(e.peak > 0.0)) return;
    for (const std::vector<std::size_t>& band : e.dim) {
        // The mean of the middle half: room light reaches nearly all of them, what a moved camera
        // sees at edges few; a median of 8-bit files would jump by whole levels.
        const auto in_the_dim = [&](const CaptureSummary& c, const CaptureSummary* against) {
            std::vector<float> light;
            light.reserve(band.size());
            for (const std::size_t i : band)
                light.push_back(c.light.values[i] - (against ? against->light.values[i] : 0.0f));
            std::sort(light.begin(), light.end());
            const std::size_t quarter = light.size() / 4, middle = light.size() - 2 * quarter;
            double sum = 0.0;
            for (std::size_t k = quarter; k < quarter + middle; ++k)
                sum += static_cast<double>(light[k]);
            return sum / static_cast<double>(middle) / e.peak;
        };
        const auto refuse = [&](const CaptureSummary& c, double added) {
            throw Refused("the room's light changed before " + c.name +
                              ": places that the projector hardly lights are " +
                              percent(std::abs(added)) + " of white " +
                              (added > 0.0 ? "brighter" : "darker") + " than in " + e.black->name,
                          "leave the room's light as it is (best: off) from the first photograph "
                          "to the last, and repeat");
        };
        const double by_white = std::max(0.0, in_the_dim(*e.white, e.black));
        const double usual = kAdded + kOtherExposure * (by_white + in_the_dim(*e.black, nullptr));
        if (e.dark && drives.dark == 0)
            if (const double added = in_the_dim(*e.dark, e.black); std::abs(added) > usual)
                refuse(*e.dark, added);
        if (e.bright && drives.bright == 255)
            if (const double added = in_the_dim(*e.bright, e.white); std::abs(added) > usual)
                refuse(*e.bright, added);
        for (const CaptureSummary* c : {e.red, e.green, e.blue, e.levels}) {
            if (!c) continue;
            const double added = in_the_dim(*c, e.black);
            if (added > usual + by_white || added < -usual) refuse(*c, added);
        }
    }
}

/// The photographs of one role say the same.
void check_repeats(const Evidence& e) {
    for (std::size_t k = 1; k < e.all->size(); ++k) {
        const CaptureSummary& again = (*e.all)[k];
        const auto first = std::find_if(
            e.all->begin(), e.all->end(), [&](const auto& c) { return c.role == again.role; });
        if (&*first == &again || !e.black || again.role == "black" || again.role == "dark-gray")
            continue;
        const Region region = region_of(ratio_to(first->light, e.lit, [&](std::size_t i) {
            return first->saturated[i] || again.saturated[i]
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

}  // namespace

std::vector<std::string> check_captures(const std::vector<CaptureSummary>& captures,
                                        int block_px,
                                        const ShownDrives& drives) {
    Warnings warnings;
    const Evidence evidence = gather_evidence(captures, block_px);
    if (evidence.lit_count < 64.0) {
        refuse_late(evidence);
        refuse_automatic_exposure(evidence);
        return warnings;  // too little light for more; the solver says where it is missing
    }
    refuse_saturated(evidence);
    refuse_late(evidence);
    refuse_automatic_exposure(evidence);
    check_room_light(evidence, drives);
    check_moved(evidence, warnings);
    check_stripes(evidence, warnings);
    check_repeats(evidence);
    check_colours(evidence, drives, warnings);
    return warnings;
}

}  // namespace livery
