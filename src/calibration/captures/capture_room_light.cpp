// Whether the room's light stayed what it was, by places that the projector hardly lights.
#include <algorithm>
#include <cmath>
#include <optional>

#include "calibration/captures/capture_evidence.h"
#include "calibration/colour/colour_report.h"
#include "core/error.h"
#include "core/statistics.h"

namespace livery {
namespace {

constexpr double kAdded = 0.003;             // of white on the mock-up
constexpr double kOtherRoomExposure = 0.06;  // of the light there
constexpr double kHardlyLit = 0.2;           // of the peak

/// light(i) of some dim blocks over the peak of white: the mean of the middle half. Room light
/// reaches nearly all of them, what a moved camera sees at edges few; a median of 8-bit files would
/// jump by whole levels.
template <typename Light>
double dim_mean(const Evidence& e, const std::vector<std::size_t>& band, const Light& light_of) {
    std::vector<float> light;
    light.reserve(band.size());
    for (const std::size_t i : band) light.push_back(light_of(i));
    std::sort(light.begin(), light.end());
    const std::size_t quarter = light.size() / 4, middle = light.size() - 2 * quarter;
    double sum = 0.0;
    for (std::size_t k = quarter; k < quarter + middle; ++k) sum += static_cast<double>(light[k]);
    return sum / static_cast<double>(middle) / e.peak;
}

double dim_light(const Evidence& e,
                 const std::vector<std::size_t>& band,
                 const CaptureSummary& capture) {
    return dim_mean(e, band, [&](std::size_t i) { return capture.light.values[i]; });
}

[[noreturn]] void refuse_room_light(const CaptureSummary& capture, double added) {
    throw Refused("the room's light changed before " + capture.name +
                      ": places that the projector hardly lights are " + percent(std::abs(added)) +
                      " of white " + (added > 0.0 ? "brighter" : "darker") + " than before",
                  "leave the room's light as it is (best: off) from the first photograph to the "
                  "last, and repeat");
}

/// What a photograph has in the dim places beyond what its picture sends there.
struct Residue {
    const CaptureSummary* capture = nullptr;
    double light = 0.0;
};

/// Photographs whose share of white is known: stripes by their pair, white, black, and the greys
/// where they show the same.
std::vector<Residue> residues(const Evidence& e,
                              const std::vector<std::size_t>& band,
                              const ShownDrives& drives,
                              double by_white) {
    std::vector<Residue> found;
    for (const CaptureSummary& c : *e.all) {
        const auto add = [&](double share, double light) {
            found.push_back({&c, light - share * by_white});
        };
        if (const StripePair* pair = e.pair_that_begins_with(c))
            // Together: of a band, one of them lights some blocks and the other the rest.
            add(0.5, 0.5 * dim_mean(e, band, [&](std::size_t i) {
                         return pair->first->light.values[i] + pair->second->light.values[i];
                     }));
        else if (c.role == "black" || (c.role == "dark-gray" && drives.dark == 0))
            add(0.0, dim_light(e, band, c));
        else if (c.role == "white" || (c.role == "bright-gray" && drives.bright == 255))
            add(1.0, dim_light(e, band, c));
    }
    return found;
}

double median_of(const std::vector<Residue>& residues, std::size_t begin, std::size_t end) {
    std::vector<float> values;
    for (std::size_t k = begin; k < end; ++k)
        values.push_back(static_cast<float>(residues[k].light));
    return static_cast<double>(median(std::move(values)));
}

/// Where the residues step from one level to another: the first photograph of the second.
struct Step {
    std::size_t at = 0;
    double size = 0.0;
};
std::optional<Step> step_of(const std::vector<Residue>& residues) {
    std::optional<Step> best;
    double least = 0.0;
    for (std::size_t at = 2; at + 2 <= residues.size(); ++at) {
        const double before = median_of(residues, 0, at),
                     after = median_of(residues, at, residues.size());
        double misfit = 0.0;
        for (std::size_t k = 0; k < residues.size(); ++k)
            misfit += std::abs(residues[k].light - (k < at ? before : after));
        if (best && misfit >= least) continue;
        least = misfit;
        best = Step{at, after - before};
    }
    return best;
}

}  // namespace

void check_room_light(const Evidence& e, const ShownDrives& drives) {
    if (!e.white || !e.black || e.dim.front().empty() || !(e.peak > 0.0)) return;
    for (const std::vector<std::size_t>& band : e.dim) {
        const double in_black = dim_light(e, band, *e.black);
        const double by_white = std::max(0.0, dim_light(e, band, *e.white) - in_black);
        const double usual = kAdded + kOtherRoomExposure * (by_white + in_black);
        const auto judge_dark = [&] {
            if (!e.dark || drives.dark != 0) return;
            const double added = dim_light(e, band, *e.dark) - in_black;
            if (std::abs(added) > usual) refuse_room_light(*e.dark, added);
        };
        // Elsewhere the lamp's own changes say more than the room's.
        if (by_white > kHardlyLit) {
            judge_dark();
            continue;
        }
        const auto changed = [&](const CaptureSummary& c) {
            const double added = dim_light(e, band, c) - in_black;
            return added > usual + by_white || added < -usual ? added : 0.0;
        };
        const std::vector<Residue> known = residues(e, band, drives, by_white);
        const auto step = step_of(known);
        if (step && std::abs(step->size) > usual) {
            // A picture between two of these whose own light is known only within bounds
            const CaptureSummary* first = known[step->at].capture;
            for (std::size_t k = e.order_of(*known[step->at - 1].capture) + 1;
                 k < e.order_of(*first);
                 ++k) {
                const CaptureSummary& c = (*e.all)[k];
                const bool whole = c.role == "red" || c.role == "green" || c.role == "blue" ||
                                   c.role == "gray-levels";
                if (whole && changed(c) != 0.0) first = &c;
            }
            refuse_room_light(*first, step->size);
        }
        // One photograph alone
        judge_dark();
        if (e.bright && drives.bright == 255)
            if (const double added = dim_light(e, band, *e.bright) - dim_light(e, band, *e.white);
                std::abs(added) > usual)
                refuse_room_light(*e.bright, added);
        for (const CaptureSummary* c : {e.red, e.green, e.blue, e.levels})
            if (c && changed(*c) != 0.0) refuse_room_light(*c, changed(*c));
    }
}

}  // namespace livery
