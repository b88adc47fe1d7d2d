#include "scene/triangulate.h"

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
    explicit Ring(std::vector<glm::dvec2> flat)
        : flat_(std::move(flat)), next_(flat_.size()), last_(flat_.size()), ear_(flat_.size()) {
        const auto count = static_cast<std::uint32_t>(flat_.size());
        for (std::uint32_t k = 0; k < count; ++k) {
            next_[k] = (k + 1) % count;
            last_[k] = (k + count - 1) % count;
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
        ear_[before] = find_ear(before);
        ear_[after] = find_ear(after);
    }

  private:
    /// Whether the corner juts out and nothing else lies in the triangle that it makes.
    bool find_ear(std::uint32_t k) const {
        const glm::dvec2 &a = flat_[last_[k]], &b = flat_[k], &c = flat_[next_[k]];
        if (turn(a, b, c) <= 0.0) return false;
        for (std::uint32_t other = next_[next_[k]]; other != last_[k]; other = next_[other]) {
            const glm::dvec2& p = flat_[other];
            // A bridge to a hole passes the same place twice.
            if (p == a || p == b || p == c) continue;
            if (turn(flat_[last_[other]], p, flat_[next_[other]]) > 0.0) continue;
            if (holds(a, b, c, p)) return false;
        }
        return true;
    }

    std::vector<glm::dvec2> flat_;
    std::vector<std::uint32_t> next_, last_;
    std::vector<bool> ear_;
};

}  // namespace

std::vector<glm::uvec3> triangulate(const std::vector<glm::dvec3>& polygon) {
    std::vector<glm::uvec3> triangles;
    if (polygon.size() < 3) return triangles;
    triangles.reserve(polygon.size() - 2);
    Ring ring(flattened(polygon));
    std::uint32_t at = 0;
    for (std::size_t left = polygon.size(); left > 3; --left) {
        std::size_t tried = 0;
        while (tried < left && !ring.is_ear(at)) {
            at = ring.next(at);
            ++tried;
        }
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
