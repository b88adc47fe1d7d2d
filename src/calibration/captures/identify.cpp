#include "calibration/captures/identify.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr std::size_t kPixels = 6000;

// Costs of the alignment. A picture that is missing or odd costs one; what is seen of a match costs
// up to three, so that a match that is plainly wrong is none.
constexpr double kMissing = 1.0, kOdd = 1.0, kUnverified = 0.15, kNumberGap = 0.1, kWrong = 3.0,
                 kLooksFlat = 0.2;
constexpr std::size_t kLongestGap = 12;  // of roles or photographs in a row

bool is_inverse(const std::string& role) { return role.ends_with("-inverse"); }

bool is_stripes(const std::string& role) {
    return role.starts_with("gray-column-") || role.starts_with("gray-row-");
}

/// The last number in a name: what a camera counts.
std::optional<long> number_in(const std::string& name) {
    std::size_t end = name.rfind('.');
    if (end == std::string::npos) end = name.size();
    while (end > 0 && !std::isdigit(static_cast<unsigned char>(name[end - 1]))) --end;
    std::size_t begin = end;
    while (begin > 0 && std::isdigit(static_cast<unsigned char>(name[begin - 1]))) --begin;
    if (begin == end || end - begin > 9) return std::nullopt;
    return std::stol(name.substr(begin, end - begin));
}

/// Photographs as shares of white, at the pixels that the projector lights.
struct Shares {
    /// Of each photograph: of each pixel, the channels' mean and red, green, blue.
    std::vector<std::vector<float>> mean;
    std::vector<std::array<double, 3>> channel;  ///< medians over the pixels
    std::vector<double> spread;                  ///< median distance from the median
};

/// Of each value, those at two fractions of the photographs' sorted ones.
std::array<std::vector<float>, 2> quantiles(const std::vector<Glimpse>& photographs,
                                            std::array<double, 2> fractions) {
    const std::size_t count = photographs.front().values.size();
    std::array<std::vector<float>, 2> results{std::vector<float>(count), std::vector<float>(count)};
    parallel_for(count, 4096, [&](std::size_t begin, std::size_t end) {
        std::vector<float> values(photographs.size());
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t k = 0; k < values.size(); ++k) values[k] = photographs[k].values[i];
            for (std::size_t f = 0; f < 2; ++f)
                results[f][i] = quantile_in_place(std::span<float>(values), fractions[f]);
        }
    });
    return results;
}

Shares shares_of(const std::vector<Glimpse>& photographs) {
    // Every pixel is lit in about half of the stripes, whatever else somebody photographed.
    const auto [black, white] = quantiles(photographs, {0.15, 0.75});
    std::vector<float> light(white.size() / 3);
    for (std::size_t i = 0; i < light.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) light[i] += white[3 * i + c] - black[3 * i + c];
    const float limit = 0.15f * quantile(light, 0.999);
    std::vector<std::size_t> lit;
    for (std::size_t i = 0; i < light.size(); ++i)
        if (light[i] > limit) lit.push_back(i);

    Shares shares;
    for (const Glimpse& photograph : photographs) {
        std::vector<float> mean;
        std::array<std::vector<float>, 3> of;
        for (const std::size_t i : lit) {
            float sum = 0.0f;
            for (std::size_t c = 0; c < 3; ++c) {
                const float above = photograph.values[3 * i + c] - black[3 * i + c];
                sum += above;
                const float whole = white[3 * i + c] - black[3 * i + c];
                of[c].push_back(whole > 0.0f ? above / whole : 0.0f);
            }
            mean.push_back(sum / light[i]);
        }
        const float middle = median(mean);
        std::vector<float> distance;
        for (const float share : mean) distance.push_back(std::abs(share - middle));
        shares.spread.push_back(static_cast<double>(median(std::move(distance))));
        shares.channel.push_back({static_cast<double>(median(std::move(of[0]))),
                                  static_cast<double>(median(std::move(of[1]))),
                                  static_cast<double>(median(std::move(of[2])))});
        shares.mean.push_back(std::move(mean));
    }
    return shares;
}

double mean_distance(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
    return sum / static_cast<double>(std::max<std::size_t>(a.size(), 1));
}

double mean_distance(const std::vector<float>& a, double value) {
    double sum = 0.0;
    for (const float share : a) sum += std::abs(static_cast<double>(share) - value);
    return sum / static_cast<double>(std::max<std::size_t>(a.size(), 1));
}

/// How far two photographs are from adding up to white.
double from_white(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += std::abs(static_cast<double>(a[i]) + static_cast<double>(b[i]) - 1.0);
    return sum / static_cast<double>(std::max<std::size_t>(a.size(), 1));
}

/// What a photograph by itself says against being of a role.
double own_cost(const Shares& shares, std::size_t photograph, const std::string& role) {
    const auto scaled = [](double distance) { return std::min(kWrong, 8.0 * distance); };
    const std::vector<float>& mean = shares.mean[photograph];
    const auto& channel = shares.channel[photograph];
    if (role == "white" || role == "bright-gray") return scaled(mean_distance(mean, 1.0));
    if (role == "black" || role == "dark-gray") return scaled(mean_distance(mean, 0.0));
    const char* const channels[] = {"red", "green", "blue"};
    for (std::size_t c = 0; c < 3; ++c) {
        if (role != channels[c]) continue;
        const bool most = channel[c] >= *std::max_element(channel.begin(), channel.end());
        const bool part =
            channel[c] > 0.3 && *std::min_element(channel.begin(), channel.end()) < 0.8;
        return most && part && shares.spread[photograph] < 0.15 ? 0.0 : kWrong;
    }
    std::size_t between = 0;
    for (const float share : mean) between += share > 0.08f && share < 0.92f;
    const double part = static_cast<double>(between) / static_cast<double>(mean.size());
    if (is_stripes(role)) {
        // Fine ones are blurred. On a small mock-up coarse ones may look like white and black, and
        // white and black add up to white as a pair does: others are taken first.
        const bool flat = std::min(mean_distance(mean, 0.0), mean_distance(mean, 1.0)) < 0.2;
        return kUnverified + 0.3 * part + (flat ? kLooksFlat : 0.0);
    }
    // Levels and mosaics: neither black, nor white, nor both alone
    return part > 0.12 && shares.spread[photograph] > 0.01 ? 0.0 : kWrong;
}

/// What is missing among what is left over, each by what it shows: stripes beside their inverse,
/// flat pictures by their light. Others, as levels and mosaics, only where one alone is missing.
class Leftovers {
  public:
    Leftovers(const Shares& shares,
              const std::vector<std::string>& roles,
              IdentifiedPhotographs& result)
        : shares_(shares), roles_(roles), result_(result), free_(shares.mean.size(), true) {
        for (const auto& place : result.photograph_of_role)
            if (place) free_[*place] = false;
    }

    void match() {
        replace_half_a_pair();
        for (std::size_t r = 0; r < roles_.size(); ++r)
            if (!result_.photograph_of_role[r]) match_one(r);
        match_a_pair();
    }

  private:
    static constexpr double kSame = 0.1;  // of white, on average over the pixels

    std::optional<std::size_t> partner_of(std::size_t r) const {
        if (!is_stripes(roles_[r])) return std::nullopt;
        const std::string name = is_inverse(roles_[r]) ? roles_[r].substr(0, roles_[r].size() - 8)
                                                       : roles_[r] + "-inverse";
        const auto found = std::find(roles_.begin(), roles_.end(), name);
        if (found == roles_.end()) return std::nullopt;
        return static_cast<std::size_t>(found - roles_.begin());
    }

    /// Infinite where the photograph cannot be of the role.
    double distance(std::size_t p, std::size_t r) const {
        const std::string& role = roles_[r];
        if (is_stripes(role)) {
            const auto partner = partner_of(r);
            const auto beside = partner ? result_.photograph_of_role[*partner] : std::nullopt;
            return beside ? from_white(shares_.mean[*beside], shares_.mean[p]) : kNever;
        }
        const bool flat = role == "white" || role == "bright-gray" || role == "black" ||
                          role == "dark-gray" || role == "red" || role == "green" || role == "blue";
        if (!flat && !is_last_of_its_kind(r)) return kNever;
        return own_cost(shares_, p, role) / 8.0;
    }

    bool is_last_of_its_kind(std::size_t r) const {
        std::size_t others = 0;
        for (std::size_t k = 0; k < roles_.size(); ++k)
            others += !result_.photograph_of_role[k] && !is_stripes(roles_[k]);
        const auto left = std::count(free_.begin(), free_.end(), true);
        return others == 1 && left == 1 && !roles_[r].starts_with("phase-");
    }

    void match_one(std::size_t r) {
        std::optional<std::size_t> best;
        double least = kSame;
        for (std::size_t p = 0; p < free_.size(); ++p) {
            if (!free_[p]) continue;
            const double one = distance(p, r);
            if (one >= least) continue;
            least = one;
            best = p;
        }
        if (best) take(*best, r);
    }

    /// Of a pair of which one is missing nobody can tell which one is there. Both photographed
    /// again, one after the other, can.
    void replace_half_a_pair() {
        for (std::size_t r = 0; r < roles_.size(); ++r) {
            const auto partner = partner_of(r);
            if (result_.photograph_of_role[r] || !partner) continue;
            const auto half = result_.photograph_of_role[*partner];
            if (!half) continue;
            for (std::size_t p = 0; p + 1 < free_.size(); ++p) {
                const std::size_t q = p + 1;
                if (!free_[p] || !free_[q]) continue;
                if (from_white(shares_.mean[p], shares_.mean[q]) >= kSame) continue;
                if (std::min(mean_distance(shares_.mean[*half], shares_.mean[p]),
                             mean_distance(shares_.mean[*half], shares_.mean[q])) >= kSame)
                    continue;
                free_[*half] = true;
                take(p, std::min(r, *partner));
                take(q, std::max(r, *partner));
                break;
            }
        }
    }

    /// A whole pair, where no other is missing: in the order in which they were taken.
    void match_a_pair() {
        std::vector<std::size_t> missing;
        for (std::size_t r = 0; r < roles_.size(); ++r)
            if (!result_.photograph_of_role[r] && is_stripes(roles_[r])) missing.push_back(r);
        if (missing.size() != 2 || partner_of(missing[0]) != missing[1]) return;
        for (std::size_t p = 0; p < free_.size(); ++p)
            for (std::size_t q = p + 1; q < free_.size(); ++q) {
                if (!free_[p] || !free_[q] || is_flat(p)) continue;
                if (from_white(shares_.mean[p], shares_.mean[q]) >= kSame) continue;
                take(p, missing[0]);
                take(q, missing[1]);
                return;
            }
    }

    bool is_flat(std::size_t p) const {
        const std::vector<float>& mean = shares_.mean[p];
        return std::min(mean_distance(mean, 0.0), mean_distance(mean, 1.0)) < 2.0 * kSame;
    }

    void take(std::size_t p, std::size_t r) {
        free_[p] = false;
        result_.photograph_of_role[r] = p;
        result_.out_of_order.push_back({p, r});
    }

    static constexpr double kNever = std::numeric_limits<double>::infinity();
    const Shares& shares_;
    const std::vector<std::string>& roles_;
    IdentifiedPhotographs& result_;
    std::vector<bool> free_;
};

struct Match {
    double cost = std::numeric_limits<double>::infinity();
    std::size_t photograph = 0, role = 0;  ///< the match before; counted from 1, 0: none
};

}  // namespace

Glimpse glimpse_of(const Photograph& photograph) {
    Glimpse glimpse{photograph.name, photograph.image.width, photograph.image.height, {}};
    const std::size_t pixels = photograph.image.pixel_count();
    // An odd step, so that it does not fall in with stripes.
    const std::size_t step = std::max<std::size_t>(1, pixels / kPixels) | 1u;
    for (std::size_t i = 0; i < pixels; i += step)
        for (std::size_t c = 0; c < 3; ++c)
            glimpse.values.push_back(photograph.image.values[3 * i + c] -
                                     static_cast<float>(photograph.black_level));
    return glimpse;
}

bool IdentifiedPhotographs::complete() const {
    return std::all_of(photograph_of_role.begin(), photograph_of_role.end(), [](const auto& found) {
        return found.has_value();
    });
}

IdentifiedPhotographs identify(const std::vector<Glimpse>& photographs,
                               const std::vector<std::string>& roles) {
    IdentifiedPhotographs result;
    result.photograph_of_role.resize(roles.size());
    if (photographs.empty() || roles.empty()) return result;
    for (const Glimpse& one : photographs)
        check_argument(one.values.size() == photographs.front().values.size(),
                       "photographs of different sizes: " + one.name);
    const Shares shares = shares_of(photographs);
    std::vector<std::optional<long>> numbers;
    for (const Glimpse& one : photographs) numbers.push_back(number_in(one.name));

    // Each photograph with those before it, as a picture and its inverse
    std::vector<std::array<double, kLongestGap>> pair_cost(photographs.size());
    for (std::size_t p = 0; p < photographs.size(); ++p)
        for (std::size_t back = 1; back <= std::min(p, kLongestGap); ++back)
            pair_cost[p][back - 1] =
                std::min(kWrong, 8.0 * from_white(shares.mean[p - back], shares.mean[p]));

    // best[p][r]: the cheapest alignment whose last match is photograph p with role r, from 1
    const std::size_t last_p = photographs.size(), last_r = roles.size();
    std::vector<std::vector<Match>> best(last_p + 1, std::vector<Match>(last_r + 1));
    best[0][0].cost = 0.0;
    const auto gap = [&](std::size_t p, std::size_t r, std::size_t from_p, std::size_t from_r) {
        double cost = kOdd * static_cast<double>(p - from_p - 1) +
                      kMissing * static_cast<double>(r - from_r - 1);
        if (from_p == 0 || !numbers[p - 1] || !numbers[from_p - 1]) return cost;
        const long passed = *numbers[p - 1] - *numbers[from_p - 1];
        if (passed != static_cast<long>(r - from_r)) cost += kNumberGap;
        return cost;
    };
    for (std::size_t p = 1; p <= last_p; ++p)
        for (std::size_t r = 1; r <= last_r; ++r) {
            const std::string& role = roles[r - 1];
            const double own = own_cost(shares, p - 1, role);
            Match& step = best[p][r];
            for (std::size_t from_p = p > kLongestGap ? p - kLongestGap : 0; from_p < p; ++from_p)
                for (std::size_t from_r = r > kLongestGap ? r - kLongestGap : 0; from_r < r;
                     ++from_r) {
                    const double before = best[from_p][from_r].cost;
                    if (!(before < step.cost)) continue;
                    double match = own;
                    const bool pair =
                        from_p > 0 && is_stripes(role) && is_inverse(role) && from_r + 1 == r;
                    // Verified, and so is the one before
                    if (pair) match = pair_cost[p - 1][p - from_p - 1] - kUnverified;
                    const double cost = before + gap(p, r, from_p, from_r) + match;
                    if (cost < step.cost) step = {cost, from_p, from_r};
                }
        }

    // What is left over at the end is odd or missing too
    double least = std::numeric_limits<double>::infinity();
    std::size_t p = 0, r = 0;
    for (std::size_t end_p = 0; end_p <= last_p; ++end_p)
        for (std::size_t end_r = 0; end_r <= last_r; ++end_r) {
            const double cost = best[end_p][end_r].cost +
                                kOdd * static_cast<double>(last_p - end_p) +
                                kMissing * static_cast<double>(last_r - end_r);
            if (!(cost < least)) continue;
            least = cost;
            p = end_p;
            r = end_r;
        }
    while (p > 0 && r > 0) {
        result.photograph_of_role[r - 1] = p - 1;
        const Match step = best[p][r];
        p = step.photograph;
        r = step.role;
    }

    Leftovers(shares, roles, result).match();

    std::vector<bool> matched(last_p, false);
    for (const auto& place : result.photograph_of_role)
        if (place) matched[*place] = true;
    for (std::size_t odd = 0; odd < last_p; ++odd) {
        if (matched[odd]) continue;
        std::string why = "shows none of the pictures that are wanted";
        double nearest = 0.04;
        for (std::size_t other = 0; other < last_p; ++other) {
            if (!matched[other]) continue;
            const double distance = mean_distance(shares.mean[odd], shares.mean[other]);
            if (distance >= nearest) continue;
            nearest = distance;
            why = "shows the same as " + photographs[other].name;
        }
        result.odd.push_back({odd, std::move(why)});
    }
    return result;
}

bool comes_before(const std::string& a, const std::string& b) {
    std::size_t i = 0, k = 0;
    const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
    while (i < a.size() && k < b.size()) {
        if (!digit(a[i]) || !digit(b[k])) {
            if (a[i] != b[k]) return a[i] < b[k];
            ++i;
            ++k;
            continue;
        }
        const auto number = [&](const std::string& text, std::size_t& at) {
            while (at < text.size() && text[at] == '0') ++at;
            std::size_t end = at;
            while (end < text.size() && digit(text[end])) ++end;
            const std::string found = text.substr(at, end - at);
            at = end;
            return found;
        };
        const std::string left = number(a, i), right = number(b, k);
        if (left.size() != right.size()) return left.size() < right.size();
        if (left != right) return left < right;
    }
    return a.size() - i < b.size() - k;
}

std::vector<std::size_t> order_of_names(const std::vector<std::string>& names) {
    std::vector<std::size_t> order(names.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return comes_before(names[a], names[b]);
    });
    if (order.size() < 2) return order;
    const auto first = number_in(names[order.front()]), last = number_in(names[order.back()]);
    if (!first || !last || *first > 1 || (*last != 9999 && *last != 99999)) return order;
    // The longest run of numbers that no file has is where the counting began
    std::size_t begin = 0;
    long longest = 1;
    for (std::size_t k = 1; k < order.size(); ++k) {
        const auto a = number_in(names[order[k - 1]]), b = number_in(names[order[k]]);
        if (!a || !b || *b - *a <= longest) continue;
        longest = *b - *a;
        begin = k;
    }
    std::rotate(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(begin), order.end());
    return order;
}

}  // namespace livery
