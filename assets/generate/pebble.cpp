#include "pebble.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

namespace livery::assets {

namespace {

constexpr double kPlanPower = 2.5, kEdgePower = 3.0;

/// A point of the flat part's outline and the way outward from it, in plan (y, z).
struct Station {
    glm::dvec2 from{0.0};
    glm::dvec2 outward{0.0};  ///< to where e is 1, in units of the edge's width
    std::uint32_t flat = 0;   ///< vertex of the flat part
};

/// Half of the way around, from the top's middle to the bottom's.
std::vector<Station> stations(const Pebble& pebble, int columns, int rows, int corner_steps) {
    const double flat_y = pebble.half_height_mm - pebble.edge_mm;
    const double flat_z = pebble.half_width_mm - pebble.edge_mm;
    const auto vertex = [&](int row, int column) {
        return static_cast<std::uint32_t>(row * (columns + 1) + column);
    };
    std::vector<Station> all;
    const auto corner = [&](double sign_y, int row, bool from_y) {
        for (int k = 1; k < corner_steps; ++k) {
            const double f = static_cast<double>(k) / corner_steps;
            const double angle = std::numbers::pi / 2 * (from_y ? f : 1.0 - f);
            const double c = std::cos(angle), s = std::sin(angle);
            const double norm =
                std::pow(std::pow(c, kPlanPower) + std::pow(s, kPlanPower), 1.0 / kPlanPower);
            all.push_back(
                {{sign_y * flat_y, flat_z}, {sign_y * c / norm, s / norm}, vertex(row, columns)});
        }
    };
    for (int j = 0; j <= columns; ++j) {
        all.push_back({{flat_y, flat_z * j / columns}, {1.0, 0.0}, vertex(0, j)});
    }
    corner(1.0, 0, true);
    for (int i = 0; i <= rows; ++i) {
        const double y = flat_y * (1.0 - 2.0 * i / rows);
        all.push_back({{y, flat_z}, {0.0, 1.0}, vertex(i, columns)});
    }
    corner(-1.0, rows, false);
    for (int j = columns; j >= 0; --j) {
        all.push_back({{-flat_y, flat_z * j / columns}, {-1.0, 0.0}, vertex(rows, j)});
    }
    return all;
}

}  // namespace

Sheet pebble_sheet(const Pebble& pebble, double spacing_mm) {
    const double flat_y = pebble.half_height_mm - pebble.edge_mm;
    const double flat_z = pebble.half_width_mm - pebble.edge_mm;
    const int columns = static_cast<int>(std::ceil(flat_z / spacing_mm));
    const int rows = static_cast<int>(std::ceil(2.0 * flat_y / spacing_mm));
    const int corner_steps = static_cast<int>(std::ceil(1.5 * pebble.edge_mm / spacing_mm));
    const int rings = static_cast<int>(std::ceil(pebble.edge_mm / spacing_mm)) + 4;
    const auto around = stations(pebble, columns, rows, corner_steps);
    const auto count = static_cast<std::uint32_t>(around.size());

    Sheet sheet;
    const auto add = [&](const glm::dvec3& place, const glm::dvec3& normal) {
        sheet.vertices.push_back({place, glm::normalize(normal), {0.0, 0.0}});
        return static_cast<std::uint32_t>(sheet.vertices.size() - 1);
    };
    // Of the rings the last is the equator, which both sides share.
    std::uint32_t equator = 0;
    for (const double side : {1.0, -1.0}) {
        const int region = side > 0.0 ? kFront : kBehind;
        const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            if (a == b || b == c || c == a) return;
            if (side < 0.0) std::swap(b, c);
            sheet.triangles.push_back({{a, b, c}, 0, region});
        };
        const auto flat = static_cast<std::uint32_t>(sheet.vertices.size());
        for (int i = 0; i <= rows; ++i) {
            for (int j = 0; j <= columns; ++j) {
                add({side * pebble.half_thickness_mm,
                     flat_y * (1.0 - 2.0 * i / rows),
                     flat_z * j / columns},
                    {side, 0.0, 0.0});
            }
        }
        for (int i = 0; i < rows; ++i) {
            for (int j = 0; j < columns; ++j) {
                const auto a = flat + static_cast<std::uint32_t>(i * (columns + 1) + j);
                const auto below = a + static_cast<std::uint32_t>(columns) + 1;
                triangle(a, below + 1, below);
                triangle(a, a + 1, below + 1);
            }
        }
        std::vector<std::uint32_t> ring;
        for (const auto& station : around) ring.push_back(flat + station.flat);
        for (int r = 1; r <= rings; ++r) {
            std::vector<std::uint32_t> next;
            const bool is_equator = r == rings;
            const double turn = std::numbers::pi / 2 * r / rings;
            const double e = is_equator ? 1.0 : std::pow(std::sin(turn), 2.0 / kEdgePower);
            const double height = is_equator ? 0.0 : std::pow(std::cos(turn), 2.0 / kEdgePower);
            if (is_equator && side < 0.0) {
                for (std::uint32_t k = 0; k < count; ++k) next.push_back(equator + k);
            } else {
                if (is_equator) equator = static_cast<std::uint32_t>(sheet.vertices.size());
                for (const auto& station : around) {
                    const auto plan = station.from + station.outward * (e * pebble.edge_mm);
                    // The gradient of e^p + |x|^p, with e = |outward|_n in plan.
                    const auto steep = [&](double along) {
                        return std::copysign(std::pow(std::abs(along), kPlanPower - 1.0), along);
                    };
                    const double flank = std::pow(e, kEdgePower - 1.0) / pebble.edge_mm;
                    add({side * height * pebble.half_thickness_mm, plan.x, plan.y},
                        {side * std::pow(height, kEdgePower - 1.0) / pebble.half_thickness_mm,
                         flank * steep(station.outward.x),
                         flank * steep(station.outward.y)});
                    next.push_back(static_cast<std::uint32_t>(sheet.vertices.size() - 1));
                }
            }
            for (std::uint32_t k = 0; k + 1 < count; ++k) {
                triangle(ring[k], next[k], next[k + 1]);
                triangle(ring[k], next[k + 1], ring[k + 1]);
            }
            ring = std::move(next);
        }
    }
    return sheet;
}

}  // namespace livery::assets
