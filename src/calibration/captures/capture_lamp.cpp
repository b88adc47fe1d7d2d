// Whether the projector's light stayed what it was, by what each pair of stripes adds up to.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "calibration/captures/capture_evidence.h"
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

}  // namespace livery
