// The six colour photographs against one another.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "calibration/captures/capture_check.h"
#include "calibration/colour/colour.h"
#include "calibration/colour/colour_report.h"
#include "calibration/colour/mixing.h"
#include "core/error.h"
#include "core/statistics.h"

namespace livery {
namespace {

constexpr const char* kSameExposure =
    "photograph all pictures at one exposure set by hand (or state each exposure_s), and repeat";

struct Colours {
    std::array<const CaptureSummary*, 3> channel;
    glm::dvec3 bright{0.0};  ///< mean differences to dark-gray over what is lit
    glm::dmat3 of_channel{0.0};
    std::vector<std::uint8_t> used;
};

Colours means_of(const Evidence& e) {
    Colours c{{e.red, e.green, e.blue}, {}, {}, {}};
    c.used.assign(e.lit.size(), 0);
    for (std::size_t i = 0; i < e.lit.size(); ++i) {
        bool over = e.bright->saturated[i] != 0;
        for (const CaptureSummary* k : c.channel) over = over || k->saturated[i];
        if (!e.lit[i] || over) continue;
        c.used[i] = 1;
        const auto at = [&](const CaptureSummary& s) {
            const float* const v = s.colour.values.data() + 3 * i;
            return glm::dvec3(v[0], v[1], v[2]);
        };
        const glm::dvec3 dark = at(*e.dark);
        c.bright += at(*e.bright) - dark;
        for (int k = 0; k < 3; ++k) {
            c.of_channel[k] += at(*c.channel[static_cast<std::size_t>(k)]) - dark;
        }
    }
    return c;
}

double sum(glm::dvec3 v) { return v.x + v.y + v.z; }

/// A photograph that shows what another shows.
void refuse_same(const Evidence& e, const Colours& c) {
    const double bright = sum(c.bright);
    for (int k = 0; k < 3; ++k) {
        const CaptureSummary& one = *c.channel[static_cast<std::size_t>(k)];
        const auto refuse = [&](const CaptureSummary& other) {
            throw Refused(one.name + " shows what " + other.name + " shows",
                          "photograph each picture only after it has arrived, check which file has "
                          "which role in manifest.json, and repeat");
        };
        if (glm::length(c.of_channel[k] - c.bright) < 0.03 * glm::length(c.bright))
            refuse(*e.bright);
        if (sum(c.of_channel[k]) < 0.005 * bright) refuse(*e.dark);
        for (int j = 0; j < k; ++j)
            if (glm::length(c.of_channel[k] - c.of_channel[j]) < 0.02 * glm::length(c.bright))
                refuse(*c.channel[static_cast<std::size_t>(j)]);
    }
}

/// Each photograph to the projector channel that it most plausibly shows: the order of the three in
/// which the camera's own channels answer best. Neither a camera channel's gain nor a picture's
/// brightness has a say: each order has one factor of every row and every column.
void refuse_swapped(const Colours& c) {
    std::array<int, 3> order{0, 1, 2}, best = order;
    const auto score = [&](const std::array<int, 3>& of) {
        double product = 1.0;
        for (int camera = 0; camera < 3; ++camera)
            product *= std::max(c.of_channel[of[static_cast<std::size_t>(camera)]][camera], 1e-30);
        return product;
    };
    const double own = score(order);
    double highest = own;
    while (std::next_permutation(order.begin(), order.end()))
        if (score(order) > 1.5 * highest) {
            highest = score(order);
            best = order;
        }
    std::string names;
    for (std::size_t k = 0; k < 3; ++k)
        if (best[k] != static_cast<int>(k)) {
            names += (names.empty() ? "" : " and ") + c.channel[k]->name;
        }
    if (names.empty()) return;
    throw Refused(names + " are swapped: the camera's own channels answer best the other way round",
                  "check which file has which role in manifest.json, and that the files hold red, "
                  "green and blue in this order");
}

/// Parts of the picture where white is not the sum of the channels.
void refuse_shadowed(const Evidence& e, const Colours& c) {
    const auto light = [&](const CaptureSummary& s, std::size_t i) {
        return s.light.values[i] - e.dark->light.values[i];
    };
    // bright-gray against the stripes first: what they disagree about is a shadow in one or other
    ImageF bright = e.bright->light;
    for (std::size_t i = 0; i < bright.values.size(); ++i) bright.values[i] = light(*e.bright, i);
    const Region sum_off =
        region_of(ratio_to(bright,
                           c.used,
                           [&](std::size_t i) {
                               return light(*e.red, i) + light(*e.green, i) + light(*e.blue, i);
                           }),
                  0.06);
    const Region bright_off =
        region_of(ratio_to(e.reference, c.used, [&](std::size_t i) { return bright.values[i]; }));
    if (!sum_off.found()) {
        if (!bright_off.found()) return;
        throw Refused(e.bright->name + ", red, green and blue: " + percent(bright_off.share) +
                          " of what is lit is " + times_of(bright_off.ratio) +
                          " than the stripes and white say: a shadow, a reflection or somebody in "
                          "the light",
                      "keep out of the light of the projector and of the camera's view, and "
                      "repeat these photographs");
    }
    if (bright_off.found()) refuse_region(e.bright->name, bright_off);
    // The one whose own camera channel departs from bright-gray's there
    const CaptureSummary* worst = nullptr;
    Region of_worst;
    for (std::size_t k = 0; k < 3; ++k) {
        ImageF own(bright.width, bright.height, 1);
        for (std::size_t i = 0; i < own.values.size(); ++i)
            own.values[i] = e.bright->colour.values[3 * i + k] - e.dark->colour.values[3 * i + k];
        const Region region = region_of(ratio_to(own, c.used, [&](std::size_t i) {
            return c.channel[k]->colour.values[3 * i + k] - e.dark->colour.values[3 * i + k];
        }));
        double there = 0.0, both = 0.0;
        for (std::size_t i = 0; i < region.holds.size(); ++i) {
            there += sum_off.holds[i];
            both += sum_off.holds[i] && region.holds[i];
        }
        if (both < 0.3 * there || !region.found()) continue;
        if (!worst || std::abs(region.ratio - 1.0) > std::abs(of_worst.ratio - 1.0)) {
            worst = c.channel[k];
            of_worst = region;
        }
    }
    if (worst) refuse_region(worst->name, of_worst);
}

/// The brightest blocks of gray-levels, nearly white, over bright-gray: 1 whatever the projector
/// does to white, as long as the light and the exposure stay. Nothing without gray-levels.
std::optional<double> levels_over_bright(const Evidence& e, const Colours& c) {
    if (!e.levels) return std::nullopt;
    std::vector<float> ratios;
    for (std::size_t i = 0; i < c.used.size(); ++i)
        if (c.used[i])
            ratios.push_back((e.levels->light.values[i] - e.dark->light.values[i]) /
                             (e.bright->light.values[i] - e.dark->light.values[i]));
    if (ratios.empty()) return std::nullopt;
    return static_cast<double>(quantile(std::move(ratios), 0.99));
}

/// The light or the exposure changed between two colour photographs and stayed so. White then is
/// not the sum of the channels, as with a projector that is not additive; gray-levels tells.
void refuse_change_on_the_way(const Evidence& e, const Colours& c, glm::dvec3 held) {
    constexpr double kBlurred = 0.08;  // what blur takes from the brightest blocks
    const auto levels = levels_over_bright(e, c);
    if (!levels || std::abs(*levels - 1.0) < kBlurred) return;
    for (std::size_t k = 0; k < 3; ++k) {
        const double ratio = 1.0 / held[static_cast<int>(k)];
        if (std::abs(ratio - 1.0) < kAdditivityLimit) continue;
        if (std::abs(*levels / ratio - 1.0) > 1.5 * kBlurred) return;
        throw Refused("from " + c.channel[k]->name + " on the photographs are " + times_of(ratio) +
                          " than those before: they had another exposure, or the lamp another "
                          "brightness",
                      kSameExposure);
    }
}

/// How much of each channel's photograph bright-gray holds: 1 each where all were exposed alike.
void check_exposures(const Evidence& e,
                     const Colours& c,
                     const ShownDrives& drives,
                     CaptureVerdict& verdict) {
    constexpr double kAlike = 0.012;
    if (!(condition_number(c.of_channel) < 100.0)) return;
    const glm::dvec3 held = glm::inverse(c.of_channel) * c.bright;
    const auto off = [](double value) { return std::abs(value - 1.0); };
    const auto say = [&](const std::string& what, double error, const char* fix) {
        if (error > kAdditivityLimit) throw Refused(what, fix);
        verdict.warnings.push_back(what + "; " + fix);
    };
    // A small slip of one photograph is undone, since the others say by how much.
    const auto slipped = [&](const CaptureSummary& one, const std::string& than, double ratio) {
        if (off(ratio) <= kAdditivityLimit) verdict.gains[one.role] = 1.0 / ratio;
        say(one.name + " is " + times_of(ratio) + " than " + than +
                ": it had another exposure, or the lamp another brightness" +
                (off(ratio) <= kAdditivityLimit ? ", and is brought to theirs" : ""),
            off(ratio),
            kSameExposure);
    };

    // One of the three alone
    for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        if (off(held[k]) < kAdditivityWarning || off(held[a]) > 0.4 * off(held[k]) ||
            off(held[b]) > 0.4 * off(held[k]))
            continue;
        slipped(*c.channel[static_cast<std::size_t>(k)],
                "bright-gray and the other two say",
                1.0 / held[k]);
        return;
    }
    refuse_change_on_the_way(e, c, held);
    // bright-gray alone: white, which shows the same, tells it from a projector that is not
    // additive
    if (!e.white || !e.black || drives.dark != 0 || drives.bright != 255) return;
    const Region against_white = region_of(ratio_to(e.reference, c.used, [&](std::size_t i) {
        return e.bright->light.values[i] - e.dark->light.values[i];
    }));
    const double mean = (held.x + held.y + held.z) / 3.0;
    const double spread =
        std::max({std::abs(held.x - mean), std::abs(held.y - mean), std::abs(held.z - mean)});
    const double ratio = against_white.typical;
    // Black and dark-gray show the same too
    const double dark_ratio = e.dark->mean / std::max(e.black->mean, 1e-30);
    if (off(ratio) > kAdditivityLimit && std::abs(dark_ratio - ratio) > 0.5 * off(ratio) &&
        off(mean) < off(ratio) * 0.5)
        throw Refused("from " + e.bright->name + " on the photographs are " + times_of(ratio) +
                          " than " + e.white->name +
                          " and those before: they had another "
                          "exposure, or the lamp another brightness",
                      kSameExposure);
    if (off(ratio) > kAlike && off(mean) > kAlike && spread < 0.5 * off(mean) &&
        std::abs(ratio - mean) < 0.5 * off(ratio)) {
        slipped(*e.bright, "white and than red, green and blue together", mean);
        return;
    }
    if (off(ratio) > 0.03 && off(mean) < kAlike)
        verdict.warnings.push_back("the colour photographs are " + times_of(ratio) +
                                   " than the stripes: another exposure, or a lamp that drifts");
    // White less than its parts. The stripes have told already whether the files are linear; what
    // is left then is the projector's own, and the solver's to judge.
    if (e.pairs.empty() && mean < 1.0 - kAdditivityWarning && off(ratio) < 0.05) {
        const bool eight_bit = e.bright->saturates_at <= 255.0;
        say("white is " + percent(1.0 - mean) +
                " less than red, green and blue together: the files are encoded for viewing (JPEG, "
                "a picture style) but called linear" +
                std::string(eight_bit ? ", as 8-bit files are" : "") +
                "; or white is over-exposed; or the projector boosts pure colours",
            1.0 - mean,
            "use RAW or linear TIFF, or give \"transfer\": \"srgb\" or a response file in "
            "manifest.json; check the exposure; photograph the stripes too, which tell these "
            "apart");
    }
}

}  // namespace

void check_colours(const Evidence& e, const ShownDrives& drives, CaptureVerdict& verdict) {
    if (!e.dark || !e.bright || !e.red || !e.green || !e.blue) return;
    const Colours colours = means_of(e);
    // Dark where it should be bright: the solver names that.
    if (!(sum(colours.bright) > 0.0)) return;
    refuse_same(e, colours);
    refuse_swapped(colours);
    refuse_shadowed(e, colours);
    check_exposures(e, colours, drives, verdict);
}

}  // namespace livery
