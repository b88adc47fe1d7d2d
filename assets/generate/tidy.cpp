#include "tidy.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace livery::assets {

namespace {

constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();

class NeedleRemover {
  public:
    NeedleRemover(Sheet& sheet, double height_mm) : sheet_(sheet), height_mm_(height_mm) {}

    /// Takes out needles whose neighbourhoods do not touch; returns how many.
    std::size_t pass() {
        index();
        std::vector<bool> touched(sheet_.vertices.size(), false);
        std::size_t count = 0;
        for (std::uint32_t t = 0; t < sheet_.triangles.size(); ++t) {
            if (is_gone_[t] || sheet_.triangles[t].panel == kNoPanel) continue;
            const int longest = longest_edge(sheet_.triangles[t].corners);
            const auto& c = sheet_.triangles[t].corners;
            const auto a = c[longest], b = c[(longest + 1) % 3], tip = c[(longest + 2) % 3];
            if (touched[a] || touched[b] || touched[tip] || !is_needle(c)) continue;
            const auto nearer = length(tip, a) <= length(tip, b) ? a : b;
            const bool done =
                (length(tip, nearer) < 3.0 * height_mm_ &&
                 (collapse(tip, nearer, touched) || collapse(nearer, tip, touched))) ||
                give_way(t, longest, touched);
            count += done ? 1 : 0;
        }
        std::vector<SheetTriangle> kept;
        for (std::size_t t = 0; t < sheet_.triangles.size(); ++t) {
            if (!is_gone_[t]) kept.push_back(sheet_.triangles[t]);
        }
        sheet_.triangles = std::move(kept);
        return count;
    }

  private:
    void index() {
        around_.assign(sheet_.vertices.size(), {});
        half_edges_.clear();
        is_gone_.assign(sheet_.triangles.size(), false);
        for (std::uint32_t t = 0; t < sheet_.triangles.size(); ++t) {
            for (int k = 0; k < 3; ++k) {
                const auto a = sheet_.triangles[t].corners[k];
                const auto b = sheet_.triangles[t].corners[(k + 1) % 3];
                around_[a].push_back(t);
                half_edges_[key(a, b)] = t;
            }
        }
    }
    static std::uint64_t key(std::uint32_t from, std::uint32_t to) {
        return (static_cast<std::uint64_t>(from) << 32) | to;
    }
    const glm::dvec3& at(std::uint32_t v) const { return sheet_.vertices[v].position; }
    double length(std::uint32_t a, std::uint32_t b) const { return glm::distance(at(a), at(b)); }
    glm::dvec3 normal(const glm::uvec3& c) const {
        return glm::cross(at(c.y) - at(c.x), at(c.z) - at(c.x));
    }
    int longest_edge(const glm::uvec3& c) const {
        int longest = 0;
        for (int k = 1; k < 3; ++k) {
            if (length(c[k], c[(k + 1) % 3]) > length(c[longest], c[(longest + 1) % 3]))
                longest = k;
        }
        return longest;
    }
    bool is_needle(const glm::uvec3& c) const {
        const int longest = longest_edge(c);
        return glm::length(normal(c)) < height_mm_ * length(c[longest], c[(longest + 1) % 3]);
    }
    std::set<std::uint32_t> neighbours(std::uint32_t v) const {
        std::set<std::uint32_t> ring;
        for (const auto t : around_[v]) {
            if (is_gone_[t]) continue;
            for (int k = 0; k < 3; ++k) ring.insert(sheet_.triangles[t].corners[k]);
        }
        ring.erase(v);
        return ring;
    }
    std::uint32_t across(std::uint32_t a, std::uint32_t b) const {
        const auto found = half_edges_.find(key(b, a));
        return found == half_edges_.end() ? kNone : found->second;
    }
    bool is_border(std::uint32_t a, std::uint32_t b) const {
        const auto one = across(b, a), other = across(a, b);
        return one == kNone || other == kNone ||
               sheet_.triangles[one].panel != sheet_.triangles[other].panel;
    }

    /// Moves `v` onto `u`, along a border if it is on one.
    bool collapse(std::uint32_t v, std::uint32_t u, std::vector<bool>& touched) {
        const auto ring = neighbours(v), ring_of_u = neighbours(u);
        if (std::any_of(ring.begin(), ring.end(), [&](auto w) { return touched[w]; })) return false;
        const auto borders =
            std::count_if(ring.begin(), ring.end(), [&](auto w) { return is_border(v, w); });
        if (borders > 2 || (borders > 0 && !is_border(v, u))) return false;
        if (at(v).z == 0.0 && at(u).z != 0.0) return false;
        std::vector<std::uint32_t> common;
        std::set_intersection(ring.begin(),
                              ring.end(),
                              ring_of_u.begin(),
                              ring_of_u.end(),
                              std::back_inserter(common));
        const std::size_t shared =
            (across(v, u) != kNone ? 1u : 0u) + (across(u, v) != kNone ? 1u : 0u);
        if (common.size() != shared) return false;
        const auto moved = [&](std::uint32_t t) {
            auto c = sheet_.triangles[t].corners;
            for (int k = 0; k < 3; ++k) c[k] = c[k] == v ? u : c[k];
            return c;
        };
        const auto dies = [&](std::uint32_t t) {
            const auto& c = sheet_.triangles[t].corners;
            return c.x == u || c.y == u || c.z == u;
        };
        for (const auto t : around_[v]) {
            if (dies(t)) continue;
            // A needle's normal says nothing; its turn comes.
            const auto corners = moved(t);
            if (is_needle(corners)) continue;
            const auto after = normal(corners);
            const auto& outside = sheet_.vertices[u].normal;
            if (glm::dot(outside, after) < 0.5 * glm::length(after)) return false;
        }
        for (const auto w : ring) touched[w] = true;
        touched[v] = true;
        for (const auto t : around_[v]) {
            if (dies(t)) {
                is_gone_[t] = true;
            } else {
                sheet_.triangles[t].corners = moved(t);
            }
        }
        return true;
    }

    /// A flat triangle's longest edge gives way to one from its tip through the triangle across;
    /// both halves are of that one's panel.
    bool give_way(std::uint32_t t, int longest, std::vector<bool>& touched) {
        const auto c = sheet_.triangles[t].corners;
        const auto a = c[longest], b = c[(longest + 1) % 3], tip = c[(longest + 2) % 3];
        if (at(a).z == 0.0 && at(b).z == 0.0) return false;
        const auto other = across(a, b);
        if (other == kNone) {
            is_gone_[t] = true;
            touched[a] = touched[b] = touched[tip] = true;
            return true;
        }
        const auto& d = sheet_.triangles[other].corners;
        const auto far = d.x != a && d.x != b ? d.x : (d.y != a && d.y != b ? d.y : d.z);
        if (is_gone_[other] || touched[far] || half_edges_.contains(key(tip, far)) ||
            half_edges_.contains(key(far, tip))) {
            return false;
        }
        const glm::uvec3 first(tip, a, far), second(tip, far, b);
        const auto whole = normal(d);
        const auto is_good = [&](const glm::uvec3& corners) {
            return is_needle(corners) || glm::dot(normal(corners), whole) > 0.0;
        };
        if (!is_good(first) || !is_good(second)) return false;
        touched[a] = touched[b] = touched[tip] = touched[far] = true;
        auto& one = sheet_.triangles[t];
        auto& two = sheet_.triangles[other];
        one = two;
        one.corners = first;
        two.corners = second;
        return true;
    }

    Sheet& sheet_;
    double height_mm_;
    std::vector<std::vector<std::uint32_t>> around_;
    std::unordered_map<std::uint64_t, std::uint32_t> half_edges_;
    std::vector<bool> is_gone_;
};

}  // namespace

Sheet without_needles(Sheet sheet, double height_mm) {
    constexpr int kMostPasses = 20;
    NeedleRemover remover(sheet, height_mm);
    for (int pass = 0; pass < kMostPasses && remover.pass() > 0; ++pass) {
    }
    return sheet;
}

}  // namespace livery::assets
