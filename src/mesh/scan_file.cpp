#include "mesh/scan_file.h"

#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace livery {

namespace {

/// Twice the area vector (Newell): right for concave polygons too.
glm::dvec3 area_vector(const std::vector<glm::dvec3>& polygon) {
    glm::dvec3 sum(0.0);
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
        sum += glm::cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
    }
    return sum;
}

/// The polygon on the plane that it is least foreshortened in, counter-clockwise.
std::vector<glm::dvec2> flattened(const std::vector<glm::dvec3>& polygon) {
    const glm::dvec3 normal = area_vector(polygon);
    int drop = 0;
    for (int axis = 1; axis < 3; ++axis) {
        if (std::abs(normal[axis]) > std::abs(normal[drop])) drop = axis;
    }
    const int u = (drop + 1) % 3, v = (drop + 2) % 3;
    const double side = normal[drop] < 0.0 ? -1.0 : 1.0;
    std::vector<glm::dvec2> flat;
    flat.reserve(polygon.size());
    for (const auto& corner : polygon) flat.emplace_back(side * corner[u], corner[v]);
    return flat;
}

double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool holds(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& p) {
    return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
}

/// The corners not cut off yet, as a ring that knows its ears. Cutting one changes only whether its
/// two neighbours are ears: what blocks a triangle are corners that turn inward, and those lie in
/// no ear.
class Ring {
  public:
    Ring(std::vector<glm::dvec2> flat, std::size_t& steps)
        : flat_(std::move(flat)),
          next_(flat_.size()),
          last_(flat_.size()),
          ear_(flat_.size()),
          place_(flat_.size(), kNowhere),
          steps_(steps) {
        const auto count = static_cast<std::uint32_t>(flat_.size());
        for (std::uint32_t k = 0; k < count; ++k) {
            next_[k] = (k + 1) % count;
            last_[k] = (k + count - 1) % count;
        }
        for (std::uint32_t k = 0; k < count; ++k) {
            if (turns_inward(k)) list(k);
        }
        for (std::uint32_t k = 0; k < count; ++k) ear_[k] = find_ear(k);
    }

    std::uint32_t next(std::uint32_t k) const { return next_[k]; }
    glm::uvec3 triangle(std::uint32_t k) const { return {last_[k], k, next_[k]}; }
    bool is_ear(std::uint32_t k) const { return ear_[k]; }

    void cut(std::uint32_t k) {
        const std::uint32_t before = last_[k], after = next_[k];
        next_[before] = after;
        last_[after] = before;
        forget(k);
        look_again(before);
        look_again(after);
        ear_[before] = find_ear(before);
        ear_[after] = find_ear(after);
    }

  private:
    bool turns_inward(std::uint32_t k) const {
        return !(turn(flat_[last_[k]], flat_[k], flat_[next_[k]]) > 0.0);
    }

    /// Whether the corner juts out and nothing else lies in the triangle that it makes.
    bool find_ear(std::uint32_t k) {
        const glm::dvec2 &a = flat_[last_[k]], &b = flat_[k], &c = flat_[next_[k]];
        if (turn(a, b, c) <= 0.0) return false;
        steps_ += inward_.size();
        for (const std::uint32_t other : inward_) {
            const glm::dvec2& p = flat_[other];
            // A bridge to a hole passes the same place twice.
            if (p == a || p == b || p == c) continue;
            if (holds(a, b, c, p)) return false;
        }
        return true;
    }

    /// Cutting an ear can turn a neighbour outward, never inward but for rounding.
    void look_again(std::uint32_t k) {
        const bool listed = place_[k] != kNowhere;
        if (turns_inward(k) == listed) return;
        listed ? forget(k) : list(k);
    }
    void list(std::uint32_t k) {
        place_[k] = static_cast<std::uint32_t>(inward_.size());
        inward_.push_back(k);
    }
    void forget(std::uint32_t k) {
        if (place_[k] == kNowhere) return;
        inward_[place_[k]] = inward_.back();
        place_[inward_.back()] = place_[k];
        inward_.pop_back();
        place_[k] = kNowhere;
    }

    static constexpr std::uint32_t kNowhere = 0xffffffffu;

    std::vector<glm::dvec2> flat_;
    std::vector<std::uint32_t> next_, last_;
    std::vector<bool> ear_;
    std::vector<std::uint32_t> inward_;  ///< the corners left that turn inward
    std::vector<std::uint32_t> place_;   ///< in inward_
    std::size_t& steps_;
};

}  // namespace

std::vector<glm::uvec3> triangulate(const std::vector<glm::dvec3>& polygon, std::size_t& steps) {
    std::vector<glm::uvec3> triangles;
    if (polygon.size() < 3) return triangles;
    triangles.reserve(polygon.size() - 2);
    steps += polygon.size();
    Ring ring(flattened(polygon), steps);
    std::uint32_t at = 0;
    for (std::size_t left = polygon.size(); left > 3; --left) {
        std::size_t tried = 0;
        while (tried < left && !ring.is_ear(at)) {
            at = ring.next(at);
            ++tried;
        }
        steps += tried;
        // Without an ear the polygon crosses itself or is a line: any corner goes.
        triangles.push_back(ring.triangle(at));
        ring.cut(at);
        // The one after the next, so that a convex polygon does not become a fan of needles.
        at = ring.next(ring.next(at));
    }
    triangles.push_back(ring.triangle(at));
    return triangles;
}

}  // namespace livery
