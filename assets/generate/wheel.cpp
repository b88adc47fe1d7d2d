#include "wheel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "solids.h"

namespace livery::assets {

namespace {

constexpr int kSpokes = 5, kNuts = 5;

/// Height of the spokes' face over the wheel's middle: concave, steepening toward the rim.
double face_mm(double radius_mm) {
    const double f = std::clamp((radius_mm - 1.8) / 8.9, 0.0, 1.0);
    return 1.5 + 2.8 * f * f * (1.3 - 0.3 * f);
}

/// A loop around a spoke's section: a flat face with bevelled edges, narrower behind.
std::vector<glm::dvec3> spoke_section(
    double radius_mm, double across_mm, double half_width_mm, double depth_mm, double angle_rad) {
    constexpr double kBevel = 0.16;
    const double bevel = kBevel * half_width_mm * 1.6;
    const double top = face_mm(radius_mm), bottom = top - depth_mm;
    const std::array<glm::dvec2, 10> section{{{half_width_mm - 2.0 * bevel, top + 0.02},
                                              {half_width_mm - bevel, top},
                                              {half_width_mm, top - bevel},
                                              {half_width_mm * 0.95, 0.5 * (top + bottom)},
                                              {half_width_mm * 0.75, bottom},
                                              {-half_width_mm * 0.75, bottom},
                                              {-half_width_mm * 0.95, 0.5 * (top + bottom)},
                                              {-half_width_mm, top - bevel},
                                              {-half_width_mm + bevel, top},
                                              {-half_width_mm + 2.0 * bevel, top + 0.02}}};
    std::vector<glm::dvec3> loop;
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    for (auto p = section.rbegin(); p != section.rend(); ++p) {
        const double y = across_mm + p->x;
        loop.emplace_back(radius_mm * c - y * s, radius_mm * s + y * c, p->y);
    }
    return loop;
}

/// One arm of a spoke that forks on its way to the rim; `side` is -1 or 1.
PartMesh make_arm(double angle_rad, double side) {
    constexpr int kSections = 10;
    std::vector<std::vector<glm::dvec3>> loops;
    for (int k = 0; k < kSections; ++k) {
        const double f = static_cast<double>(k) / (kSections - 1);
        const double r = 1.6 + f * 9.1;
        const double across = side * (0.66 + 1.9 * f * f);
        const double half_width = 0.78 - 0.20 * f + 0.25 * std::pow(f, 6.0);
        const double depth = 1.7 - 0.5 * f;
        loops.push_back(spoke_section(r, across, half_width, depth, angle_rad));
    }
    return loft(loops);
}

}  // namespace

PartMesh make_tyre() {
    // Half of the section, from the outer bead over the sidewall to the middle of the tread.
    const std::vector<glm::dvec2> half{{11.05, 4.3},
                                       {11.2, 4.62},
                                       {11.55, 4.86},
                                       {11.75, 4.86},
                                       {12.2, 5.02},
                                       {12.9, 5.08},
                                       {13.5, 4.98},
                                       {13.95, 4.74},
                                       {14.25, 4.36},
                                       {14.41, 3.8},
                                       {14.48, 2.2},
                                       {14.15, 2.15},
                                       {14.15, 1.65},
                                       {14.5, 1.6}};
    std::vector<glm::dvec2> profile;
    for (const auto& p : half) profile.emplace_back(p.x, -p.y);
    for (auto p = half.rbegin(); p != half.rend(); ++p) profile.push_back(*p);
    return revolve(profile, true, 48);
}

PartMesh make_rim() {
    const std::vector<glm::dvec2> barrel{{11.0, -4.4},
                                         {11.0, 4.2},
                                         {11.12, 4.55},
                                         {11.1, 4.68},
                                         {10.98, 4.74},
                                         {10.82, 4.7},
                                         {10.74, 4.55},
                                         {10.66, 4.1},
                                         {10.45, 3.3},
                                         {10.3, 2.0},
                                         {10.2, 0.0},
                                         {10.3, -4.4}};
    const std::vector<glm::dvec2> hub{{0.0, -1.6},
                                      {2.6, -1.6},
                                      {2.75, 0.8},
                                      {2.6, 1.4},
                                      {2.2, 1.6},
                                      {1.3, 1.62},
                                      {1.22, 2.0},
                                      {1.05, 2.12},
                                      {0.0, 2.18}};
    PartMesh rim = revolve(barrel, true, 48);
    append(rim, revolve(hub, false, 36), {0, 0, 0});
    for (int k = 0; k < kSpokes; ++k) {
        const double angle = std::numbers::pi / 2 + 2.0 * std::numbers::pi * k / kSpokes;
        for (double side : {-1.0, 1.0}) append(rim, make_arm(angle, side), {0, 0, 0});
    }
    const std::vector<glm::dvec2> disc{{3.0, -2.6}, {8.1, -2.6}, {8.1, -1.9}, {3.0, -1.9}};
    append(rim, revolve(disc, true, 48), {0, 0, 0});
    return rim;
}

PartMesh make_brake() {
    const std::vector<glm::dvec2> hat{
        {0.0, -3.0}, {3.3, -3.0}, {3.3, -1.8}, {2.9, -1.7}, {0.0, -1.7}};
    PartMesh brake = revolve(hat, false, 36);
    const std::vector<glm::dvec2> nut{
        {0.0, 0.6}, {0.26, 0.6}, {0.26, 1.14}, {0.2, 1.2}, {0.0, 1.2}};
    for (int k = 0; k < kNuts; ++k) {
        const double angle = std::numbers::pi / 2 + 2.0 * std::numbers::pi * (k + 0.5) / kNuts;
        append(brake, revolve(nut, false, 8), {1.8 * std::cos(angle), 1.8 * std::sin(angle), 0});
    }
    // The caliper, a sector around the disc at its rear.
    const std::vector<glm::dvec2> caliper{
        {5.6, -3.1}, {9.0, -3.1}, {9.0, -1.3}, {8.6, -1.0}, {6.0, -1.0}, {5.6, -1.3}};
    append(brake, revolve(caliper, true, 14, 2.65, 3.65), {0, 0, 0});
    return brake;
}

}  // namespace livery::assets
