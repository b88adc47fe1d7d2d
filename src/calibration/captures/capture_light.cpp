// Whether the projector's light stayed what it was, by what each pair of stripes adds up to.
// Whether the room's light stayed what it was, by places that the projector hardly lights.
#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "calibration/captures/capture_check.h"
#include "calibration/colour/colour_report.h"
#include "core/error.h"
#include "core/statistics.h"
#include "core/worst_error.h"

namespace livery {

namespace {

/// How bright white is by one photograph, or by one pair of stripes.
struct LampReading {
    const CaptureSummary* capture = nullptr;
    const StripePair* pair = nullptr;
    double taken_at = 0.0;
    double light = 0.0;  ///< the median of what is lit
    double mean = 0.0;   ///< its mean, which small places have a say in
};

struct Line {
    double slope = 0.0, centre = 0.0, level = 1.0;
    double scatter = 0.0;  ///< relative, of one reading
    double at(double taken_at) const { return level * (1.0 + slope * (taken_at - centre)); }
};

/// `without` (by number) leaves one out.
Line line_through(const std::vector<LampReading>& readings, std::size_t without) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t k = 0; k < readings.size(); ++k) {
        if (k == without) continue;
        const LampReading& r = readings[k];
        n += 1.0;
        sx += r.taken_at;
        sy += r.light;
        sxx += r.taken_at * r.taken_at;
        sxy += r.taken_at * r.light;
    }
    Line line;
    if (n < 3.0) return line;
    line.centre = sx / n;
    line.level = sy / n;
    line.slope = (n * sxy - sx * sy) / std::max(n * sxx - sx * sx, 1e-12) / line.level;
    double scatter = 0.0;
    for (std::size_t k = 0; k < readings.size(); ++k) {
        if (k == without) continue;
        const double off = readings[k].light - line.at(readings[k].taken_at);
        scatter += off * off;
    }
    line.scatter = std::sqrt(scatter / (n - 2.0)) / line.level;
    return line;
}

/// How much more the finest stripes and their inverses add up to than coarse ones, and the standard
/// error of that: a fit of level, drift and the share of camera pixels at a stripe's border, which
/// doubles from bit to bit.
struct Excess {
    double size = 0.0, error = 0.0;
};
Excess excess_of_fine(const std::vector<LampReading>& readings) {
    std::vector<glm::dvec3> rows;
    std::vector<double> light;
    for (const std::string axis : {"gray-column-", "gray-row-"}) {
        const auto bit_of = [&](const LampReading& r) {
            return std::stoi(r.capture->role.substr(axis.size()));
        };
        int finest = -1;
        for (const LampReading& r : readings)
            if (r.capture->role.starts_with(axis)) finest = std::max(finest, bit_of(r));
        for (const LampReading& r : readings) {
            if (!r.capture->role.starts_with(axis)) continue;
            rows.emplace_back(1.0, 0.01 * r.taken_at, std::exp2(bit_of(r) - finest));
            light.push_back(r.mean);
        }
    }
    glm::dmat3 normal(0.0);
    glm::dvec3 right(0.0);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        normal += glm::outerProduct(rows[k], rows[k]);
        right += rows[k] * light[k];
    }
    if (rows.size() < 8 || !(std::abs(glm::determinant(normal)) > 1e-9)) return {};
    const glm::dmat3 covariance = glm::inverse(normal);
    const glm::dvec3 fit = covariance * right;
    double misfit = 0.0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const double off = light[k] - glm::dot(fit, rows[k]);
        misfit += off * off;
    }
    const double variance = misfit / static_cast<double>(rows.size() - 3);
    return {fit.z / fit.x, std::sqrt(variance * covariance[2][2]) / fit.x};
}

/// A camera pixel at a stripe's border sees a part of white in the one picture and the rest of it
/// in the other: in linear files the two add up to white there as everywhere, in files encoded for
/// viewing to more. What the projector does with its colours has no say in this.
void refuse_encoded(const Evidence& e, const std::vector<LampReading>& readings) {
    constexpr double kLeast = 0.01, kSigmas = 5.0;
    const Excess excess = excess_of_fine(readings);
    if (excess.size <= std::max(kLeast, kSigmas * excess.error)) return;
    const bool eight_bit = e.white && e.white->saturates_at <= 255.0;
    throw Refused("the files are encoded for viewing (JPEG, a picture style) but called linear" +
                      std::string(eight_bit ? ", as 8-bit files are" : "") +
                      ": fine stripes and their inverses add up to " + percent(excess.size) +
                      " more than coarse ones do",
                  "use RAW or linear TIFF, or give \"transfer\": \"srgb\" or a response file in "
                  "manifest.json");
}

/// Which photograph of a pair departs: the one that lights the places that do.
struct Culprit {
    const CaptureSummary* capture = nullptr;
    double share = 0.0;  ///< of what it lights that departs
};
template <typename Departs>
Culprit culprit_of(const StripePair& pair, const ImageF& ratio, const Departs& departs) {
    double lit_by[2] = {}, off[2] = {};
    for (std::size_t i = 0; i < ratio.values.size(); ++i) {
        if (!std::isfinite(ratio.values[i])) continue;
        const int which = pair.first->light.values[i] > pair.second->light.values[i] ? 0 : 1;
        lit_by[which] += 1.0;
        off[which] += departs(i) ? 1.0 : 0.0;
    }
    const int which = off[0] >= off[1] ? 0 : 1;
    return {which == 0 ? pair.first : pair.second, off[which] / std::max(1.0, lit_by[which])};
}

ImageF light_of(const Evidence& e, const StripePair& pair) {
    return ratio_to(e.reference, e.lit, [&](std::size_t i) {
        return pair.first->light.values[i] + pair.second->light.values[i] -
               2.0f * e.black->light.values[i];
    });
}

double mean_of(const ImageF& ratio) {
    double sum = 0.0, count = 0.0;
    for (const float value : ratio.values) {
        if (!std::isfinite(value)) continue;
        sum += static_cast<double>(value);
        count += 1.0;
    }
    return sum / std::max(1.0, count);
}

/// A shadow over a pair of stripes, or one of the two at an exposure of its own.
void refuse_odd_pair(const StripePair& pair, const ImageF& ratio, const Region& region) {
    // A shadow only darkens, a reflection only brightens.
    double held = 0.0, dark = 0.0, bright = 0.0;
    for (std::size_t i = 0; i < ratio.values.size(); ++i) {
        if (!region.holds[i]) continue;
        held += 1.0;
        dark += static_cast<double>(ratio.values[i]) < 0.5 * region.typical;
        bright += static_cast<double>(ratio.values[i]) > 1.5 * region.typical;
    }
    if (dark > 0.2 * held && bright > 0.2 * held)
        throw Refused(pair.first->name + " and " + pair.second->name +
                          " do not add up to white: one of them shows another picture",
                      "photograph each picture only after it has arrived and stands still (no "
                      "motion interpolation, no dynamic contrast), check which file has which role "
                      "in manifest.json, and repeat");
    const Culprit culprit =
        culprit_of(pair, ratio, [&](std::size_t i) { return region.holds[i] != 0; });
    if (culprit.share > 0.7)
        throw Refused(culprit.capture->name + " is " + times_of(region.ratio) +
                          " than the other stripes say: another exposure, or a picture that had "
                          "not arrived",
                      kManualExposure);
    refuse_region(culprit.capture->name, region);
}

/// Takes out of `readings` what stands alone off their line, and says so: a picture of stripes is
/// read by its signs and white only tells what is lit, so that it does no harm.
Line line_without_slips(const Evidence& e,
                        std::vector<LampReading>& readings,
                        std::vector<std::string>& warnings) {
    constexpr double kSlip = 0.02, kSigmas = 5.0;
    constexpr int kMostSlips = 3;
    for (int slips = 0; slips < kMostSlips && readings.size() > 8; ++slips) {
        std::size_t oddest = 0;
        Line rest;
        double largest = 0.0;
        for (std::size_t k = 0; k < readings.size(); ++k) {
            const Line without = line_through(readings, k);
            const double off = std::abs(readings[k].light / without.at(readings[k].taken_at) - 1.0);
            if (off <= largest) continue;
            largest = off;
            oddest = k;
            rest = without;
        }
        if (largest < kSlip || largest < kSigmas * rest.scatter) break;
        const LampReading& odd = readings[oddest];
        std::string name = odd.capture->name;
        double ratio = odd.light / rest.at(odd.taken_at);
        if (odd.pair) {
            const ImageF of_pair = light_of(e, *odd.pair);
            const auto middle = static_cast<float>(0.5 * (ratio + 1.0) * rest.at(odd.taken_at));
            name = culprit_of(*odd.pair, of_pair, [&](std::size_t i) {
                       return ratio < 1.0 ? of_pair.values[i] < middle : of_pair.values[i] > middle;
                   }).capture->name;
        }
        warnings.push_back(name + " is " + times_of(ratio) +
                           " than the other stripes and white say: it had another exposure, or the "
                           "lamp another brightness; it tells only where things are, so that no "
                           "colour suffers");
        readings.erase(readings.begin() + static_cast<std::ptrdiff_t>(oddest));
    }
    return line_through(readings, readings.size());
}

Region region_against_stripes(const Evidence& e, const CaptureSummary& white) {
    return region_of(ratio_to(e.reference, e.lit, [&](std::size_t i) {
        return white.light.values[i] - e.black->light.values[i];
    }));
}

/// Of one photograph: a pair holds half the light of each of two.
constexpr double kFlickerWarning = 0.003, kLargestFlicker = 0.01;
constexpr double kDriftWarning = 0.02;  // from the first photograph to the last
/// What is off a line counts as steady up to a quarter of the whole change.
constexpr double kOffLine = 0.25;
/// A quarter of this is less than a flicker that is not worth a word.
constexpr double kLargestChangeInColours = 0.01;

/// From bright-gray to the last of the other colours.
void refuse_fast_drift(const Evidence& e, const LampDrift& drift) {
    if (!e.bright) return;
    double change = 0.0;
    for (const CaptureSummary* c : {e.red, e.green, e.blue, e.levels})
        if (c)
            change = worse_of(
                change,
                std::abs(drift.light_at(c->taken_at) / drift.light_at(e.bright->taken_at) - 1.0));
    if (change > kLargestChangeInColours)
        throw Refused(
            "the lamp changes by " + percent(change) + " while the colours are photographed",
            "let the lamp warm up for 20 minutes and repeat");
}

}  // namespace

void refuse_other_white(const Evidence& e, WhiteTaken taken) {
    if (e.pairs.size() < 5 || !e.black) return;
    for (const CaptureSummary& c : *e.all) {
        if (c.role != "white") continue;
        const bool after = e.bright && c.taken_at > e.bright->taken_at;
        if (after != (taken == WhiteTaken::after_them)) continue;
        // By the stripes next to it in time: the lamp may drift.
        std::vector<const StripePair*> nearest;
        for (const StripePair& pair : e.pairs) nearest.push_back(&pair);
        const auto away = [&](const StripePair* pair) {
            return std::abs(pair->first->taken_at - c.taken_at);
        };
        std::partial_sort(nearest.begin(), nearest.begin() + 3, nearest.end(), [&](auto a, auto b) {
            return away(a) < away(b);
        });
        std::vector<float> there;
        for (std::size_t k = 0; k < 3; ++k)
            there.push_back(static_cast<float>(region_of(light_of(e, *nearest[k])).typical));
        const Region region = region_against_stripes(e, c);
        const double ratio = region.typical / static_cast<double>(median(std::move(there)));
        if (!region.found() && std::abs(ratio - 1.0) > 0.1)
            throw Refused(c.name + " is " + times_of(ratio) +
                              " than the stripes say: it had another exposure, or the lamp another "
                              "brightness",
                          kManualExposure);
    }
}

LampDrift check_stripes(const Evidence& e, std::vector<std::string>& warnings) {
    if (e.pairs.size() < 5 || !e.black) return {};
    std::vector<LampReading> readings;
    std::vector<std::pair<ImageF, Region>> of_pair;
    for (const StripePair& pair : e.pairs) {
        ImageF ratio = light_of(e, pair);
        Region region = region_of(ratio);
        readings.push_back({pair.first,
                            &pair,
                            0.5 * (pair.first->taken_at + pair.second->taken_at),
                            region.typical,
                            mean_of(ratio)});
        of_pair.emplace_back(std::move(ratio), std::move(region));
    }
    refuse_encoded(e, readings);
    for (std::size_t k = 0; k < of_pair.size(); ++k)
        if (of_pair[k].second.found())
            refuse_odd_pair(e.pairs[k], of_pair[k].first, of_pair[k].second);
    for (const CaptureSummary& c : *e.all) {
        if (c.role != "white") continue;
        const Region region = region_against_stripes(e, c);
        if (region.found()) refuse_region(c.name, region);
        readings.push_back({&c, nullptr, c.taken_at, region.typical, 0.0});
    }

    const Line line = line_without_slips(e, readings, warnings);
    const auto [first, last] = std::minmax_element(
        readings.begin(), readings.end(), [](const LampReading& a, const LampReading& b) {
            return a.taken_at < b.taken_at;
        });
    const double change = line.slope * (last->taken_at - first->taken_at);
    const double flicker = std::sqrt(2.0) * line.scatter;
    const bool steady =
        std::abs(change) > kDriftWarning && line.scatter < kOffLine * std::abs(change);
    if (!steady && flicker > kLargestFlicker)
        throw Refused("the light flickers: photographs differ by " + percent(flicker) +
                          " in brightness from one to the next",
                      kSteady);
    if (!steady && flicker > kFlickerWarning)
        warnings.push_back("the light flickers: photographs differ by " + percent(flicker) +
                           " in brightness from one to the next; " + kSteady);
    // The error of a line's rise over its own length, of n readings: scatter * sqrt(12 / n)
    const double uncertainty =
        line.scatter * std::sqrt(12.0 / static_cast<double>(readings.size()));
    if (std::abs(change) < 3.0 * uncertainty) return {};
    const LampDrift drift{line.slope, line.centre};
    refuse_fast_drift(e, drift);
    if (std::abs(change) > kDriftWarning)
        warnings.push_back("the light drifts: it is " + times_of(1.0 + change) + " in " +
                           e.all->back().name + " than in " + e.all->front().name +
                           ", and is divided out as a steady change; " + kSteady);
    return drift;
}

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
