#include "calibration/captures/capture_evidence.h"

#include <algorithm>
#include <span>

#include "calibration/colour/colour_report.h"
#include "core/error.h"
#include "core/statistics.h"

namespace livery {
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
