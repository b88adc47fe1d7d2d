#include "studio/seats/room_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace livery {

namespace {

constexpr double kLeastShown_mm = 1000.0;
constexpr double kMargin = 0.14;  // of the longer side, at each edge

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

glm::dvec2 nearest_on(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& at) {
    const glm::dvec2 along = to - from;
    const double length2 = glm::dot(along, along);
    const double share =
        length2 > 0.0 ? std::clamp(glm::dot(at - from, along) / length2, 0.0, 1.0) : 0.0;
    return from + share * along;
}

glm::dvec2 on_steps(const glm::dvec2& at_mm) {
    return {kSeatStep_mm * std::round(at_mm.x / kSeatStep_mm),
            kSeatStep_mm * std::round(at_mm.y / kSeatStep_mm)};
}

/// By the nearest way as far from the outline as a seat stands.
glm::dvec2 beside(const std::vector<glm::dvec2>& outline, glm::dvec2 at_mm) {
    const OutlineDistance found = distance_to_outline(outline, at_mm);
    glm::dvec2 out = (found.mm < 0.0 ? -1.0 : 1.0) * (at_mm - found.nearest_mm);
    if (glm::length(out) < 1e-6) {
        // On the outline itself: away from the middle, then again by the nearest way
        glm::dvec2 middle(0.0);
        for (const glm::dvec2& point : outline)
            middle += point / static_cast<double>(outline.size());
        out = at_mm - middle;
        if (glm::length(out) < 1e-6) out = {0.0, 1.0};
        return beside(outline, at_mm + glm::normalize(out));
    }
    return found.nearest_mm + kLeastFromMockup_mm * glm::normalize(out);
}

/// The nearest other seat that stands in the way of an eye there.
const EyeSeat* in_the_way(const EyeSeat& seat,
                          const glm::dvec2& at_mm,
                          const std::vector<EyeSeat>& seats) {
    for (const EyeSeat& other : seats) {
        if (other.number == seat.number) continue;
        if (glm::distance(in_plan(other.eye_mm), at_mm) < kLeastBetweenSeats_mm) return &other;
    }
    return nullptr;
}

}  // namespace

std::vector<glm::dvec2> outline_from_above(const Mesh& mesh) {
    std::vector<glm::dvec2> points;
    points.reserve(mesh.positions_mm.size());
    for (const glm::vec3& x : mesh.positions_mm) points.push_back(in_plan(glm::dvec3(x)));
    const auto before = [](const glm::dvec2& a, const glm::dvec2& b) {
        return a.x < b.x || (a.x == b.x && a.y < b.y);
    };
    std::sort(points.begin(), points.end(), before);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return points;
    // Andrew's monotone chain
    std::vector<glm::dvec2> hull(2 * points.size());
    std::size_t count = 0;
    const auto add = [&](const glm::dvec2& point, std::size_t least) {
        while (count >= least &&
               cross(hull[count - 1] - hull[count - 2], point - hull[count - 2]) <= 0.0) {
            --count;
        }
        hull[count++] = point;
    };
    for (const glm::dvec2& point : points) add(point, 2);
    const std::size_t least = count + 1;
    for (auto point = points.rbegin() + 1; point != points.rend(); ++point) add(*point, least);
    hull.resize(count - 1);
    return hull;
}

OutlineDistance distance_to_outline(const std::vector<glm::dvec2>& outline, const glm::dvec2& at) {
    OutlineDistance found{std::numeric_limits<double>::infinity(), at};
    bool inside = outline.size() > 2;
    for (std::size_t k = 0; k < outline.size(); ++k) {
        const glm::dvec2& from = outline[k];
        const glm::dvec2& to = outline[(k + 1) % outline.size()];
        if (cross(to - from, at - from) < 0.0) inside = false;
        const glm::dvec2 nearest = nearest_on(from, to, at);
        const double mm = glm::distance(nearest, at);
        if (mm < found.mm) found = {mm, nearest};
    }
    if (inside) found.mm = -found.mm;
    return found;
}

PlanExtent plan_extent(const std::vector<glm::dvec2>& points_mm, double aspect) {
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const glm::dvec2& point : points_mm) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    if (points_mm.empty()) low = high = glm::dvec2(0.0);
    glm::dvec2 size = glm::max(high - low, glm::dvec2(kLeastShown_mm));
    size += 2.0 * kMargin * std::max(size.x, size.y);
    size.x = std::max(size.x, aspect * size.y);
    size.y = std::max(size.y, size.x / aspect);
    const glm::dvec2 middle = 0.5 * (low + high);
    return {middle - 0.5 * size, middle + 0.5 * size};
}

std::optional<PlanCone> cone_in_plan(const View& view, double reach_mm) {
    const auto toward = [&](double x_px) -> std::optional<glm::dvec2> {
        const auto ray = find_ray(view, {x_px, 0.5 * view.height});
        if (!ray) return std::nullopt;
        const glm::dvec2 along = in_plan(ray->direction);
        const double length = glm::length(along);
        if (!(length > 1e-6)) return std::nullopt;
        return along / length;
    };
    const auto left = toward(0.5), right = toward(view.width - 0.5);
    if (!left || !right) return std::nullopt;
    PlanCone cone;
    cone.from_mm = in_plan(centre_in_world(view));
    cone.left_mm = cone.from_mm + reach_mm * *left;
    cone.right_mm = cone.from_mm + reach_mm * *right;
    return cone;
}

double scale_bar_mm(double longest_mm) {
    if (!(longest_mm > 0.0)) return 0.0;
    const double decade = std::pow(10.0, std::floor(std::log10(longest_mm)));
    for (const double factor : {5.0, 2.0}) {
        if (factor * decade <= longest_mm) return factor * decade;
    }
    return decade;
}

std::string length_in_words(double mm) {
    return mm >= 1000.0 ? fmt::format("{:g} m", mm / 1000.0) : fmt::format("{:g} mm", mm);
}

PlacedSeat placed_seat(const EyeSeat& seat,
                       const glm::dvec2& wanted_mm,
                       const std::vector<EyeSeat>& seats,
                       const std::vector<glm::dvec2>& outline,
                       const PlanExtent& extent) {
    PlacedSeat placed{seat.eye_mm, ""};
    glm::dvec2 at_mm = on_steps(wanted_mm);
    const glm::dvec2 within = glm::clamp(at_mm, extent.low_mm, extent.high_mm);
    if (within != at_mm) {
        placed.why = "The plan ends here. Numbers below go farther.";
        at_mm = within;
    }
    if (distance_to_outline(outline, at_mm).mm < kLeastFromMockup_mm) {
        placed.why = "Nobody sits on the mock-up: the seat stays beside it.";
        at_mm = beside(outline, at_mm);
    }
    if (const EyeSeat* other = in_the_way(seat, at_mm, seats)) {
        const glm::dvec2 there = in_plan(other->eye_mm);
        const glm::dvec2 out = at_mm - there;
        const double length = glm::length(out);
        const glm::dvec2 way = length > 1e-9 ? out / length : glm::dvec2(1.0, 0.0);
        placed.why =
            fmt::format("Seat {} is there: the seats stay beside each other.", other->number);
        // A little more, or rounding would make it less
        at_mm = there + (kLeastBetweenSeats_mm + 0.5) * way;
        const bool free = !in_the_way(seat, at_mm, seats) &&
                          distance_to_outline(outline, at_mm).mm >= kLeastFromMockup_mm - 1.0 &&
                          glm::clamp(at_mm, extent.low_mm, extent.high_mm) == at_mm;
        if (!free) {
            placed.why =
                fmt::format("Seat {} is there: this one stays where it was.", other->number);
            return placed;
        }
    }
    placed.eye_mm = {at_mm.x, seat.eye_mm.y, at_mm.y};
    return placed;
}

}  // namespace livery
