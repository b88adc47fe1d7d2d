#include "wheel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "solids.h"

namespace livery::assets {

namespace {

constexpr double kPi = std::numbers::pi;

/// One of a pair of spokes that spread from the hub out to the barrel; `side` is -1 or 1.
PartMesh make_spoke(double angle_rad, double side) {
    constexpr int kSections = 7, kAround = 12;
    std::vector<std::vector<glm::dvec3>> loops;
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    for (int k = 0; k < kSections; ++k) {
        const double f = static_cast<double>(k) / (kSections - 1);
        const double r = 1.5 + f * 7.5;
        const double across = side * (0.55 + 1.35 * f * f * (1.5 - 0.5 * f));
        const double half_width = 0.78 - 0.26 * std::sin(kPi * std::min(1.0, f * 1.1)) + 0.08 * f;
        const double face_z = 2.2 + 1.35 * f * f;
        const double depth = 2.0 - 0.5 * f;
        std::vector<glm::dvec3> loop;
        for (int a = 0; a < kAround; ++a) {
            const double turn = 2.0 * kPi * a / kAround;
            // A superellipse: flat face, rounded edges.
            const auto round = [](double v) {
                return std::copysign(std::pow(std::abs(v), 0.55), v);
            };
            const double y = across + half_width * round(std::cos(turn));
            const double z = face_z + 0.5 * depth * (round(std::sin(turn)) - 1.0);
            loop.emplace_back(r * c - y * s, r * s + y * c, z);
        }
        loops.push_back(loop);
    }
    return loft(loops);
}

}  // namespace

PartMesh make_tyre() {
    // Half of the section, from the outer bead over the sidewall to the middle of the tread.
    const std::vector<glm::dvec2> half{{9.55, 4.05},
                                       {9.8, 4.3},
                                       {10.4, 4.58},
                                       {11.2, 4.7},
                                       {12.0, 4.62},
                                       {12.7, 4.35},
                                       {13.2, 3.85},
                                       {13.42, 2.9},
                                       {13.46, 2.0},
                                       {13.1, 1.95},
                                       {13.1, 1.45},
                                       {13.5, 1.4}};
    std::vector<glm::dvec2> profile;
    for (const auto& p : half) profile.emplace_back(p.x, -p.y);
    for (auto p = half.rbegin(); p != half.rend(); ++p) profile.push_back(*p);
    return revolve(profile, true, 60);
}

PartMesh make_rim() {
    const std::vector<glm::dvec2> barrel{{9.75, -4.2},
                                         {9.75, 4.05},
                                         {9.85, 4.25},
                                         {9.75, 4.42},
                                         {9.5, 4.45},
                                         {9.25, 4.2},
                                         {9.05, 3.7},
                                         {8.9, 3.0},
                                         {8.7, 0.0},
                                         {8.9, -4.2}};
    const std::vector<glm::dvec2> hub{{0.0, -1.0},
                                      {2.4, -1.0},
                                      {2.5, 1.9},
                                      {2.3, 2.25},
                                      {1.5, 2.4},
                                      {1.35, 2.6},
                                      {0.9, 2.72},
                                      {0.0, 2.75}};
    PartMesh rim = revolve(barrel, true, 60);
    append(rim, revolve(hub, false, 30), {0, 0, 0});
    for (int k = 0; k < 5; ++k) {
        const double angle = kPi / 2 + 2.0 * kPi * k / 5;
        for (double side : {-1.0, 1.0}) append(rim, make_spoke(angle, side), {0, 0, 0});
    }
    return rim;
}

PartMesh make_brake() {
    const std::vector<glm::dvec2> disc{{2.4, -0.9}, {7.3, -0.9}, {7.3, -0.3}, {2.4, -0.3}};
    PartMesh brake = revolve(disc, true, 48);
    // The caliper, a sector around the disc at its rear.
    const std::vector<glm::dvec2> caliper{{5.0, -1.4}, {7.9, -1.4}, {7.9, 0.4}, {5.0, 0.4}};
    append(brake, revolve(caliper, true, 10, 2.7, 3.6), {0, 0, 0});
    return brake;
}

}  // namespace livery::assets
