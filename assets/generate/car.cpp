#include "car.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "car_cage.h"
#include "car_panels.h"
#include "sheet.h"
#include "solids.h"
#include "wheel.h"

namespace livery::assets {

namespace {

constexpr double kLength_mm = 180.0, kWidth_mm = 75.0, kHeight_mm = 60.0;
constexpr double kWellDepth_mm = 25.5;  ///< z of the wheel wells' inner wall
constexpr double kFloor_mm = 6.6;
constexpr int kLevels = 3, kFitSteps = 4;

/// Scales the skin so that the finished car has its size exactly.
void fit_to_size(LimitMesh& skin) {
    glm::dvec3 low(1e9), high(-1e9);
    for (const auto& v : skin.vertices) {
        low = glm::min(low, v.position);
        high = glm::max(high, v.position);
    }
    const glm::dvec3 scale(
        kLength_mm / (high.x - low.x), kHeight_mm / high.y, kWidth_mm / (high.z - low.z));
    const double middle = 0.5 * (low.x + high.x);
    for (auto& v : skin.vertices) {
        v.position = (v.position - glm::dvec3(middle, 0.0, 0.0)) * scale;
        v.normal = glm::normalize(v.normal / scale);
    }
}

void add_flares(LimitMesh& skin) {
    for (auto& v : skin.vertices) {
        // Only where the skin faces sideways, fading smoothly toward the top.
        const double side = v.position.z > 0.0 ? 1.0 : -1.0;
        if (std::abs(v.position.z) < 25.0) continue;
        const auto flare = arch_flare({v.position.x, v.position.y});
        v.position.z += side * flare.height_mm;
        v.normal = glm::normalize(v.normal - glm::dvec3(flare.gradient, 0.0) * (side * v.normal.z));
    }
}

/// Distance along the section from the centre line to each row, averaged over the cabin: the v
/// coordinate of the skin's chart.
double girth_mm(double row) {
    static const auto table = [] {
        std::array<double, kSillRow + 1> sum{};
        for (int r = 1; r <= kSillRow; ++r) {
            double step = 0.0;
            for (int s = 4; s <= 16; ++s) {
                step += glm::distance(feature_point(s, r), feature_point(s, r - 1)) / 13.0;
            }
            sum[static_cast<std::size_t>(r)] = sum[static_cast<std::size_t>(r - 1)] + step;
        }
        return sum;
    }();
    const double r = std::clamp(row, 0.0, static_cast<double>(kSillRow) - 1e-9);
    const auto k = static_cast<std::size_t>(r);
    return table[k] + (table[k + 1] - table[k]) * (r - static_cast<double>(k));
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
            return {v.position.x, girth_mm(v.parameters.y)};
    }
}

/// Wheel wells: from the arches' edges inward, and a wall behind the wheel.
void add_wells(const std::vector<OpenEdge>& open, PartMesh& body, PartMesh& trim) {
    constexpr double kLip_mm = 1.2;
    const auto wall = [](PartMesh& part, const OpenEdge& edge, double from_z, double to_z) {
        const auto at = [](const glm::dvec3& p, double z) { return glm::dvec3(p.x, p.y, z); };
        const double axle =
            std::abs(edge.from.x - kFrontAxle_mm) < std::abs(edge.from.x - kRearAxle_mm)
                ? kFrontAxle_mm
                : kRearAxle_mm;
        std::array<std::uint32_t, 4> corner{};
        const std::array<glm::dvec3, 4> places{
            at(edge.from, from_z > 0 ? from_z : edge.from.z),
            at(edge.from, to_z > 0 ? to_z : edge.from.z - kLip_mm),
            at(edge.to, to_z > 0 ? to_z : edge.to.z - kLip_mm),
            at(edge.to, from_z > 0 ? from_z : edge.to.z)};
        for (std::size_t k = 0; k < 4; ++k) {
            const glm::dvec3 out(axle - places[k].x, kAxleHeight_mm - places[k].y, 0.0);
            corner[k] = part.add_vertex(places[k],
                                        glm::normalize(out),
                                        glm::dvec2(places[k].x, places[k].z) / kUvUnit_mm + 0.5);
        }
        part.add_quad(corner[0], corner[1], corner[2], corner[3]);
    };
    for (const auto& edge : open) {
        const auto near_arch = [&](const glm::dvec3& p) {
            for (const double axle : {kFrontAxle_mm, kRearAxle_mm}) {
                const double r = std::hypot(p.x - axle, p.y - kAxleHeight_mm);
                if (std::abs(r - kArchRadius_mm) < 0.4 && p.z > 20.0) return true;
            }
            return false;
        };
        if (!near_arch(edge.from) || !near_arch(edge.to)) continue;
        if (std::abs(edge.from.z - edge.to.z) > 1.5) continue;
        wall(body, edge, 0.0, 0.0);
    }
    for (const double axle : {kFrontAxle_mm, kRearAxle_mm}) {
        // A liner a little wider than the opening, open below, with its inner wall.
        const std::vector<glm::dvec2> liner{{kArchRadius_mm + 0.3, 35.6},
                                            {kArchRadius_mm + 0.3, kWellDepth_mm},
                                            {0.0, kWellDepth_mm}};
        append(trim,
               revolve(liner, false, 48, -0.55, std::numbers::pi + 0.55),
               {axle, kAxleHeight_mm, 0.0});
    }
}

/// The floor between the wells: a plain plate inside the sills.
void add_floor(PartMesh& trim) {
    struct Span {
        double from_mm, to_mm, half_from_mm, half_to_mm;
    };
    const double r = kArchRadius_mm + 0.2;
    const std::array<Span, 7> spans{{
        {-84.0, -78.0, 24.0, 29.0},
        {-78.0, kRearAxle_mm - r, 29.0, 32.0},
        {kRearAxle_mm - r, kRearAxle_mm + r, kWellDepth_mm, kWellDepth_mm},
        {kRearAxle_mm + r, kFrontAxle_mm - r, 33.0, 33.0},
        {kFrontAxle_mm - r, kFrontAxle_mm + r, kWellDepth_mm, kWellDepth_mm},
        {kFrontAxle_mm + r, 78.0, 31.5, 27.5},
        {78.0, 85.0, 27.5, 14.0},
    }};
    const glm::dvec3 down(0, -1, 0);
    for (const auto& span : spans) {
        const auto vertex = [&](double x, double z) {
            return trim.add_vertex(
                {x, kFloor_mm, z}, down, glm::dvec2(x, z) / kUvUnit_mm + glm::dvec2(0.5, 1.5));
        };
        const auto a = vertex(span.from_mm, 0.0), b = vertex(span.to_mm, 0.0);
        const auto c = vertex(span.to_mm, span.half_to_mm);
        const auto d = vertex(span.from_mm, span.half_from_mm);
        trim.add_quad(a, b, c, d);
    }
}

}  // namespace

std::vector<PartMesh> make_car() {
    auto skin = limit_surface(make_car_cage(), kLevels, kFitSteps);
    fit_to_size(skin);
    add_flares(skin);
    fit_to_size(skin);
    auto sheet = half_sheet(skin, [](int region, const glm::dvec3& centre) {
        return region != kFloor || centre.z > 27.0;
    });
    const auto styles = cut_car_panels(sheet);

    std::vector<PartMesh> half(kCarParts), parts(kCarParts);
    const std::array<const char*, kCarParts> names{
        "body", "glass", "rims", "tyres", "lights", "trim"};
    const std::array<glm::dvec3, kCarParts> colours{glm::dvec3(0.46),
                                                    glm::dvec3(0.03),
                                                    glm::dvec3(0.55),
                                                    glm::dvec3(0.035),
                                                    glm::dvec3(0.62),
                                                    glm::dvec3(0.06)};
    const std::array<double, kCarParts> roughness{0.5, 0.15, 0.35, 0.8, 0.2, 0.6};

    const auto open = build_panels(sheet, styles, chart, kTrim, half);
    add_wells(open, half[kBody], half[kTrim]);
    add_floor(half[kTrim]);
    for (const double axle : {kFrontAxle_mm, kRearAxle_mm}) {
        const glm::dvec3 place(axle, kAxleHeight_mm, 36.6 - kTyreHalfWidth_mm);
        append(half[kTyres], make_tyre(), place);
        append(half[kRims], make_rim(), place);
        append(half[kTrim], make_brake(), place);
    }
    for (std::size_t k = 0; k < parts.size(); ++k) {
        constexpr double kSliver_mm2 = 1e-5;
        parts[k].name = names[k];
        parts[k].base_colour_rec709 = colours[k];
        parts[k].roughness = roughness[k];
        remove_slivers(half[k], kSliver_mm2);
        append(parts[k], half[k], glm::dvec3(0.0));
        append_mirrored(parts[k], half[k]);
        compute_tangents(parts[k]);
    }
    return parts;
}

}  // namespace livery::assets
