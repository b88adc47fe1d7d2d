#include "car.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "car_cage.h"
#include "car_panels.h"
#include "refine.h"
#include "sheet.h"
#include "solids.h"
#include "wheel.h"

namespace livery::assets {

namespace {

constexpr double kLength_mm = 180.0, kWidth_mm = 75.0, kHeight_mm = 60.0;
constexpr double kWheelFace_mm = 36.1;  ///< z of the tyres' outermost ring
constexpr int kLevels = 3, kFitSteps = 2;

/// Scales the skin so that the finished car has its size exactly.
void fit_to_size(std::vector<LimitVertex>& vertices) {
    glm::dvec3 low(1e9), high(-1e9);
    for (const auto& v : vertices) {
        low = glm::min(low, v.position);
        high = glm::max(high, v.position);
    }
    const glm::dvec3 scale(
        kLength_mm / (high.x - low.x), kHeight_mm / high.y, 0.5 * kWidth_mm / high.z);
    const double middle = 0.5 * (low.x + high.x);
    for (auto& v : vertices) {
        v.position = (v.position - glm::dvec3(middle, 0.0, 0.0)) * scale;
        v.normal = glm::normalize(v.normal / scale);
    }
}

/// The arches' flares, on a finer sheet, since they are narrow.
void add_flares(Sheet& half) {
    constexpr double kSide_mm = 25.0;
    refine(half, [&](const SheetTriangle& t) {
        const auto& a = half.vertices[t.corners.x].position;
        return a.z > kSide_mm && arch_flare({a.x, a.y}).height_mm > 0.06;
    });
    for (auto& v : half.vertices) {
        // Only where the skin faces sideways.
        if (v.position.z < kSide_mm) continue;
        const auto flare = arch_flare({v.position.x, v.position.y});
        v.position.z += flare.height_mm;
        v.normal = glm::normalize(v.normal - glm::dvec3(flare.gradient, 0.0) * v.normal.z);
    }
}

/// Distance along a line of the lattice, from its first point, at a fractional index.
double arc_mm(const std::vector<double>& steps_mm, double index) {
    const double at = std::clamp(index, 0.0, static_cast<double>(steps_mm.size()) - 1e-9);
    double sum = 0.0;
    for (std::size_t k = 0; k < steps_mm.size() && at > static_cast<double>(k); ++k) {
        sum += steps_mm[k] * std::min(1.0, at - static_cast<double>(k));
    }
    return sum;
}

/// Distance along the section from the centre line to each row, averaged over the car: the v
/// coordinate of the skin's chart.
double girth_mm(double row) {
    static const auto steps = [] {
        constexpr int kFrom = 2, kTo = kStations - 2;
        std::vector<double> table(kSillRow, 0.0);
        for (int r = 0; r < kSillRow; ++r) {
            for (int s = kFrom; s <= kTo; ++s) {
                table[static_cast<std::size_t>(r)] +=
                    glm::distance(feature_point(s, r), feature_point(s, r + 1)) / (kTo - kFrom + 1);
            }
        }
        return table;
    }();
    return arc_mm(steps, row);
}

/// Distance along the shoulder from the middle of the car: its u coordinate.
double length_mm(double station) {
    static const auto steps = [] {
        std::vector<double> table;
        for (int s = 0; s < kStations; ++s) {
            table.push_back(
                glm::distance(feature_point(s, kShoulderRow), feature_point(s + 1, kShoulderRow)));
        }
        return table;
    }();
    return arc_mm(steps, station) - arc_mm(steps, kStations / 2);
}

glm::dvec2 chart(const LimitVertex& v, int region) {
    switch (region) {
        case kNose:
            return {-v.position.y + kUvUnit_mm, v.position.z};
        case kTail:
            return {v.position.y - kUvUnit_mm, v.position.z};
        case kFloor:
            return {v.position.x, v.position.z + kUvUnit_mm};
        default:
            return {length_mm(v.parameters.x), girth_mm(v.parameters.y)};
    }
}

/// Wheel wells: a liner around each wheel behind the arch's edge, open below, with its inner wall.
void add_wells(PartMesh& trim) {
    constexpr double kThickness_mm = 0.2, kRadius_mm = kArchRadius_mm - 0.4, kEdge_mm = 34.0;
    const std::vector<glm::dvec2> section{{0.0, kWellDepth_mm - kThickness_mm},
                                          {kRadius_mm, kWellDepth_mm - kThickness_mm},
                                          {kRadius_mm, kEdge_mm},
                                          {kRadius_mm - kThickness_mm, kEdge_mm},
                                          {kRadius_mm - kThickness_mm, kWellDepth_mm},
                                          {0.0, kWellDepth_mm}};
    for (const double axle : {kFrontAxle_mm, kRearAxle_mm}) {
        append(trim,
               revolve(section, true, 48, -0.3, std::numbers::pi + 0.3),
               {axle, kAxleHeight_mm, 0.0});
    }
}

/// A door mirror: a housing with a flat back, on a foot at the window's front corner.
void add_mirror(std::vector<PartMesh>& parts) {
    const glm::dvec3 centre(22.0, 43.6, 36.9), half(2.7, 1.8, 2.9);
    auto housing = sphere(1.0, 18);
    for (auto& p : housing.positions_mm) {
        const auto round = [](double v, double power) {
            return std::copysign(std::pow(std::abs(v), power), v);
        };
        // A superellipsoid, flat behind, a wedge in front, swept back and slimmer outward.
        glm::dvec3 q(round(p.x, p.x > 0.0 ? 0.95 : 0.4), round(p.y, 0.55), round(p.z, 0.5));
        const double front = std::max(q.x, 0.0);
        q.x *= p.x > 0.0 ? 1.0 - 0.2 * q.z : 0.3;
        q.y *= (1.0 - 0.14 * q.z) * (1.0 - 0.3 * front * front);
        p = centre + q * half + glm::dvec3(-0.5 * (q.z + 1.0), 0.2 * (q.z + 1.0), 0.0);
    }
    compute_smooth_normals(housing);
    for (auto& uv : housing.uvs) uv *= 1.3 * half.x;  // a blunt shape is longer around
    append(parts[kBody], housing, glm::dvec3(0.0));

    std::vector<std::vector<glm::dvec3>> foot;
    for (int k = 0; k < 3; ++k) {
        const double f = k / 2.0;
        const glm::dvec3 middle =
            glm::mix(glm::dvec3(23.6, 40.2, 33.8), centre - glm::dvec3(-0.4, 1.2, 1.5), f);
        std::vector<glm::dvec3> loop;
        for (int a = 0; a < 12; ++a) {
            const double turn = 2.0 * std::numbers::pi * a / 12;
            loop.push_back(middle + glm::dvec3(1.2 * std::sin(turn), 0.0, 0.35 * std::cos(turn)));
        }
        foot.push_back(loop);
    }
    append(parts[kTrim], loft(foot), glm::dvec3(0.0));
}

}  // namespace

std::vector<PartMesh> make_car() {
    auto skin = limit_surface(make_car_cage(), kLevels, kFitSteps);
    fit_to_size(skin.vertices);
    auto sheet = half_sheet(skin);
    add_flares(sheet);
    fit_to_size(sheet.vertices);
    const auto styles = cut_car_panels(sheet);

    std::vector<PartMesh> half(kCarParts);
    build_panels(sheet, styles, chart, kTrim, half);
    add_wells(half[kTrim]);
    add_mirror(half);
    for (const double axle : {kFrontAxle_mm, kRearAxle_mm}) {
        const glm::dvec3 place(axle, kAxleHeight_mm, kWheelFace_mm - kTyreHalfWidth_mm);
        append(half[kTyres], make_tyre(), place);
        append(half[kRims], make_rim(), place);
        append(half[kTrim], make_brake(), place);
    }
    const std::array<PartStyle, kCarParts> looks{{{"body", glm::dvec3(0.46), 0.5},
                                                  {"glass", glm::dvec3(0.03), 0.15},
                                                  {"rims", glm::dvec3(0.55), 0.35},
                                                  {"tyres", glm::dvec3(0.035), 0.8},
                                                  {"lights", glm::dvec3(0.62), 0.2},
                                                  {"trim", glm::dvec3(0.06), 0.6}}};
    return mirrored_parts(looks, half);
}

}  // namespace livery::assets
