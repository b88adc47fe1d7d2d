// The car's shape: its size, its wheels in their arches, its joints, and the flow of its surface,
// measured on the shipped mesh as one would with a probe.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "car_panels.h"
#include "core/paths.h"
#include "scene/product.h"
#include "wheel.h"

namespace livery {
namespace {

constexpr double kDegree = 0.017453292519943295;

const Mesh& mesh() {
    static const Product car = load_product(shipped_path("assets/car.json"));
    return car.mesh;
}

int part_of(const std::string& name) {
    const auto& parts = mesh().parts;
    const auto found = std::find_if(
        parts.begin(), parts.end(), [&](const auto& part) { return part.name == name; });
    return static_cast<int>(found - parts.begin());
}

/// Calls `use` for every corner of a part's triangles.
template <typename Use>
void for_each_corner(const std::string& part, Use&& use) {
    const int index = part_of(part);
    for (std::size_t k = 0; k < mesh().triangles.size(); ++k) {
        if (mesh().triangle_part[k] != index) continue;
        for (int c = 0; c < 3; ++c) use(glm::dvec3(mesh().positions_mm[mesh().triangles[k][c]]));
    }
}

struct Touch {
    double travel_mm = 0.0;
    glm::dvec3 normal{0.0};
    int part = 0;
};

/// A probe that moves along an axis of the car toward the surface, at places near a middle.
class Probe {
  public:
    Probe(const glm::dvec3& middle, double reach_mm, const glm::dvec3& direction)
        : direction_(direction) {
        // Everything whose shadow along the direction lies within reach.
        const auto across = [&](const glm::dvec3& p) {
            return p - direction * glm::dot(p, direction);
        };
        for (std::size_t k = 0; k < mesh().triangles.size(); ++k) {
            for (int c = 0; c < 3; ++c) {
                const glm::dvec3 p = mesh().positions_mm[mesh().triangles[k][c]];
                if (glm::distance(across(p), across(middle)) > reach_mm) continue;
                near_.push_back(k);
                break;
            }
        }
    }

    /// The first surface on the way from `from`.
    std::optional<Touch> touch(const glm::dvec3& from) const {
        std::optional<Touch> first;
        for (const auto k : near_) {
            const auto& t = mesh().triangles[k];
            const glm::dvec3 a = mesh().positions_mm[t.x];
            const auto e1 = glm::dvec3(mesh().positions_mm[t.y]) - a;
            const auto e2 = glm::dvec3(mesh().positions_mm[t.z]) - a;
            const auto p = glm::cross(direction_, e2);
            const double determinant = glm::dot(e1, p);
            if (std::abs(determinant) < 1e-14) continue;
            const auto s = from - a;
            const double u = glm::dot(s, p) / determinant;
            const auto q = glm::cross(s, e1);
            const double v = glm::dot(direction_, q) / determinant;
            const double travel = glm::dot(e2, q) / determinant;
            if (u < 0.0 || v < 0.0 || u + v > 1.0 || travel < 0.0) continue;
            if (first && first->travel_mm <= travel) continue;
            const auto normal = glm::dvec3(mesh().normals[t.x]) * (1.0 - u - v) +
                                glm::dvec3(mesh().normals[t.y]) * u +
                                glm::dvec3(mesh().normals[t.z]) * v;
            first = {travel, glm::normalize(normal), mesh().triangle_part[k]};
        }
        return first;
    }

  private:
    glm::dvec3 direction_;
    std::vector<std::size_t> near_;
};

struct Joint {
    const char* name;
    glm::dvec3 from, to;  ///< the probe's way across the joint
    glm::dvec3 direction;
};

const std::array<Joint, 8> kJoints{{
    {"between the doors", {-13.0, 24.0, 60.0}, {-4.0, 24.0, 60.0}, {0, 0, -1}},
    {"front door, in front", {31.5, 24.0, 60.0}, {37.0, 24.0, 60.0}, {0, 0, -1}},
    {"rear door, behind", {-40.0, 24.0, 60.0}, {-33.0, 24.0, 60.0}, {0, 0, -1}},
    {"rear door, over the arch", {-43.0, 38.0, 60.0}, {-38.0, 38.0, 60.0}, {0, 0, -1}},
    {"bonnet, at the side", {50.0, 90.0, 25.0}, {50.0, 90.0, 33.0}, {0, -1, 0}},
    {"bonnet, in front", {77.0, 90.0, 5.0}, {86.0, 90.0, 5.0}, {0, -1, 0}},
    {"hatch, at the side", {-60.0, 90.0, 20.8}, {-60.0, 90.0, 27.0}, {0, -1, 0}},
    {"hatch, in the tail", {-120.0, 28.0, 19.0}, {-120.0, 28.0, 28.0}, {1, 0, 0}},
}};

struct Gap {
    double width_mm = 0.0;
    double turn_deg = 0.0;  ///< between the normals on its two sides
};

/// Every place on the way where the probe falls in and comes out again.
std::vector<Gap> gaps_across(const Joint& joint) {
    constexpr double kStep_mm = 0.004, kDeep_mm = 0.08, kBeside_mm = 0.06;
    constexpr int kLag = 10;  // samples: the edges' walls lean a little
    const double length = glm::distance(joint.from, joint.to);
    const auto along = (joint.to - joint.from) / length;
    const Probe probe(0.5 * (joint.from + joint.to), 0.5 * length + 1.0, joint.direction);
    std::vector<double> travel;
    for (int k = 0; k * kStep_mm < length; ++k) {
        const auto touch = probe.touch(joint.from + along * (k * kStep_mm));
        travel.push_back(touch ? touch->travel_mm : 1e3);
    }
    const auto normal_at = [&](std::size_t k, double beside_mm) {
        const double at = static_cast<double>(k) * kStep_mm + beside_mm;
        return probe.touch(joint.from + along * at)->normal;
    };
    std::vector<Gap> gaps;
    for (std::size_t k = 2 * kLag; k < travel.size(); ++k) {
        // How the skin would go on.
        const double slope = (travel[k - kLag] - travel[k - 2 * kLag]) / kLag;
        const auto depth = [&](std::size_t at) {
            const double ahead = static_cast<double>(at) - static_cast<double>(k - kLag);
            return travel[at] - travel[k - kLag] - slope * ahead;
        };
        if (depth(k) < kDeep_mm) continue;
        const auto in = [&](std::size_t at) { return depth(at) > 0.5 * kDeep_mm; };
        std::size_t from = k, to = k;
        while (in(from - 1)) --from;
        while (to + 1 < travel.size() && in(to)) ++to;
        const double cosine = glm::dot(normal_at(from, -kBeside_mm), normal_at(to, kBeside_mm));
        gaps.push_back({static_cast<double>(to - from) * kStep_mm,
                        std::acos(std::min(1.0, cosine)) / kDegree});
        k = to + 2 * kLag;
    }
    return gaps;
}

TEST(CarShape, HasExactlyItsSize) {
    constexpr double kTolerance_mm = 0.02;
    glm::dvec3 low(1e9), high(-1e9);
    for (const char* part : {"body", "trim", "glass", "tyres", "lights", "rims"}) {
        for_each_corner(part, [&](const glm::dvec3& p) {
            const bool mirror = p.y > 39.0 && p.x > 15.0 && p.x < 30.0 && std::abs(p.z) > 33.0;
            if (mirror) return;
            low = glm::min(low, p);
            high = glm::max(high, p);
        });
    }
    EXPECT_NEAR(high.x - low.x, 180.0, kTolerance_mm);
    EXPECT_NEAR(high.y - low.y, 60.0, kTolerance_mm);
    EXPECT_NEAR(high.z - low.z, 75.0, kTolerance_mm);
    EXPECT_NEAR(low.y, 0.0, 1e-4);
}

TEST(CarShape, MirrorsStandOutALittle) {
    double widest = 0.0;
    for_each_corner("body", [&](const glm::dvec3& p) { widest = std::max(widest, p.z); });
    EXPECT_GT(widest, 37.5);
    EXPECT_LT(widest, 41.5);
}

TEST(CarShape, WheelsTouchTheGroundAndStayInTheirCircle) {
    for (const double axle : {assets::kFrontAxle_mm, assets::kRearAxle_mm}) {
        for (const double side : {-1.0, 1.0}) {
            double lowest = 1e9, largest = 0.0;
            for (const char* part : {"tyres", "rims"}) {
                for_each_corner(part, [&](const glm::dvec3& p) {
                    if ((p.x > 0.0) != (axle > 0.0) || p.z * side < 0.0) return;
                    lowest = std::min(lowest, p.y);
                    largest =
                        std::max(largest, std::hypot(p.x - axle, p.y - assets::kAxleHeight_mm));
                });
            }
            EXPECT_NEAR(lowest, 0.0, 1e-4) << axle << ", " << side;
            EXPECT_NEAR(largest, assets::kTyreRadius_mm, 1e-4) << axle << ", " << side;
        }
    }
}

TEST(CarShape, WheelsAreInsideTheirArches) {
    // Every corner of a tyre and a rim: around the axle it keeps this far from all that is not
    // wheel, and above the axle it stands no farther out than the arch's edge at that angle.
    constexpr double kClearance_mm = 0.5;
    constexpr int kSectors = 24;
    for (const double axle : {assets::kFrontAxle_mm, assets::kRearAxle_mm}) {
        const auto polar = [&](const glm::dvec3& p) {
            return glm::dvec2(std::hypot(p.x - axle, p.y - assets::kAxleHeight_mm),
                              std::atan2(p.y - assets::kAxleHeight_mm, p.x - axle));
        };
        double outermost = 0.0, innermost = 1e9;
        for_each_corner("tyres", [&](const glm::dvec3& p) {
            if (p.z < 0.0 || (p.x > 0.0) != (axle > 0.0)) return;
            outermost = std::max(outermost, p.z);
            innermost = std::min(innermost, p.z);
        });
        std::array<double, kSectors> edge_mm{};
        double nearest = 1e9, stands_out = -1e9;
        const auto sector = [](double angle) {
            return static_cast<std::size_t>(
                std::clamp(angle / (180.0 * kDegree) * kSectors, 0.0, kSectors - 1e-9));
        };
        for (const char* part : {"body", "trim", "lights", "glass"}) {
            for_each_corner(part, [&](const glm::dvec3& p) {
                if (p.z < innermost || (p.x > 0.0) != (axle > 0.0)) return;
                const auto at = polar(p);
                // The brake is part of the wheel.
                if (p.z < outermost && at.x > 11.2) nearest = std::min(nearest, at.x);
                if (std::abs(at.x - assets::kArchRadius_mm) < 0.3 && at.y > 0.0) {
                    auto& edge = edge_mm[sector(at.y)];
                    edge = std::max(edge, p.z);
                }
            });
        }
        for (const char* part : {"tyres", "rims"}) {
            for_each_corner(part, [&](const glm::dvec3& p) {
                const auto at = polar(p);
                if (p.z < 0.0 || (p.x > 0.0) != (axle > 0.0) || at.y < 0.0) return;
                ASSERT_GT(edge_mm[sector(at.y)], 0.0) << "no arch at " << at.y / kDegree;
                stands_out = std::max(stands_out, p.z - edge_mm[sector(at.y)]);
            });
        }
        EXPECT_GT(nearest, assets::kTyreRadius_mm + kClearance_mm) << "axle at " << axle;
        EXPECT_LE(stands_out, 0.0) << "axle at " << axle;
    }
}

TEST(CarShape, JointsAreATenthToThreeTenthsWide) {
    for (const auto& joint : kJoints) {
        const auto gaps = gaps_across(joint);
        ASSERT_EQ(gaps.size(), 1u) << joint.name;
        EXPECT_GE(gaps.front().width_mm, 0.1) << joint.name;
        EXPECT_LE(gaps.front().width_mm, 0.3) << joint.name;
    }
}

TEST(CarShape, NormalsRunOnAcrossJoints) {
    // Over a joint and 0.06 mm on both sides the skin turns by its curvature alone.
    for (const auto& joint : kJoints) {
        const auto gaps = gaps_across(joint);
        ASSERT_EQ(gaps.size(), 1u) << joint.name;
        EXPECT_LT(gaps.front().turn_deg, 2.5) << joint.name;
    }
}

TEST(CarShape, NormalsAgreeWherePatchesMeet) {
    // Vertices of the body at one place are either of one smooth surface, or on two sides of an
    // edge. Walls of lamp recesses, where the tail curves under, are edges of 15 degrees and more:
    // five places in a thousand are edges of under 35. A turn of under 10 is no wall.
    constexpr double kSame_deg = 0.5, kShallow_deg = 10.0, kEdge_deg = 35.0;
    std::map<std::array<float, 3>, std::vector<glm::dvec3>> at_place;
    const int body = part_of("body");
    for (std::size_t k = 0; k < mesh().triangles.size(); ++k) {
        if (mesh().triangle_part[k] != body) continue;
        for (int c = 0; c < 3; ++c) {
            const auto v = mesh().triangles[k][c];
            const auto& p = mesh().positions_mm[v];
            at_place[{p.x, p.y, p.z}].push_back(mesh().normals[v]);
        }
    }
    std::size_t shared = 0, kinks = 0, shallow = 0;
    for (const auto& [place, normals] : at_place) {
        for (const auto& other : normals) {
            const double turn =
                std::acos(std::clamp(glm::dot(normals.front(), other), -1.0, 1.0)) / kDegree;
            shared += turn < kSame_deg ? 1 : 0;
            kinks += turn > kSame_deg && turn < kEdge_deg ? 1 : 0;
            shallow += turn > kSame_deg && turn < kShallow_deg ? 1 : 0;
        }
    }
    EXPECT_GT(shared, 100'000u);
    EXPECT_LT(static_cast<double>(kinks), 0.008 * static_cast<double>(shared));
    EXPECT_LT(static_cast<double>(shallow), 0.001 * static_cast<double>(shared));
}

/// How often a curve's turning changes its sense by more than `tolerance_deg`: reversals of the
/// normal's angle along a way over the skin. A highlight wriggles where it reverses.
int reversals(const std::vector<double>& angle_deg, double tolerance_deg) {
    int count = 0, sense = 0;
    double extreme = angle_deg.front();
    for (const double angle : angle_deg) {
        if (sense >= 0 && angle > extreme) extreme = angle;
        if (sense <= 0 && angle < extreme) extreme = angle;
        if (sense == 0 && std::abs(angle - angle_deg.front()) > tolerance_deg) {
            sense = angle > angle_deg.front() ? 1 : -1;
            extreme = angle;
        } else if (sense != 0 && (extreme - angle) * sense > tolerance_deg) {
            sense = -sense;
            extreme = angle;
            ++count;
        }
    }
    return count;
}

struct Way {
    const char* name;
    glm::dvec3 from, to, direction;
    int body_reversals;  ///< designed, of the two angles of the normal
    int tilt_reversals;
};

TEST(CarShape, HighlightsFlowWithoutWobble) {
    // Toward +x the normal's angle in the way's own plane (turn), and out of it (tilt). The side
    // has one hollow between the wheels; bonnet and roof only bow.
    constexpr double kStep_mm = 0.4, kTolerance_deg = 0.12;
    const std::array<Way, 9> ways{{
        {"side at the undercut", {-30, 33, 60}, {31, 33, 60}, {0, 0, -1}, 0, 1},
        {"side at the middle", {-30, 26, 60}, {31, 26, 60}, {0, 0, -1}, 0, 1},
        {"side over the catcher", {-30, 21, 60}, {31, 21, 60}, {0, 0, -1}, 0, 1},
        {"bonnet, middle", {36, 90, 2}, {78, 90, 2}, {0, -1, 0}, 0, 1},
        {"bonnet, beside", {36, 90, 14}, {76, 90, 14}, {0, -1, 0}, 0, 1},
        {"roof, middle", {-42, 90, 2}, {-6, 90, 2}, {0, -1, 0}, 0, 1},
        {"roof, beside", {-42, 90, 14}, {-6, 90, 14}, {0, -1, 0}, 0, 1},
        {"roof, across", {-25, 90, 0}, {-25, 90, 19}, {0, -1, 0}, 0, 1},
        {"bonnet, across", {55, 90, 0}, {55, 90, 20}, {0, -1, 0}, 0, 1},
    }};
    for (const auto& way : ways) {
        const double length = glm::distance(way.from, way.to);
        const auto along = (way.to - way.from) / length;
        const auto sideways = glm::cross(way.direction, along);
        const Probe probe(0.5 * (way.from + way.to), 0.5 * length + 1.0, way.direction);
        std::vector<double> turn, tilt;
        std::optional<double> before;
        for (double at = 0.0; at < length; at += kStep_mm) {
            const auto touch = probe.touch(way.from + along * at);
            ASSERT_TRUE(touch) << way.name << " at " << at;
            if (touch->part != part_of("body")) continue;
            // Not into a joint, nor at its edge.
            if (before && std::abs(touch->travel_mm - *before) > 0.8) continue;
            before = touch->travel_mm;
            const auto& n = touch->normal;
            turn.push_back(std::atan2(glm::dot(n, along), -glm::dot(n, way.direction)) / kDegree);
            tilt.push_back(std::asin(glm::dot(n, sideways)) / kDegree);
        }
        ASSERT_GT(turn.size(), 30u) << way.name;
        EXPECT_LE(reversals(turn, kTolerance_deg), way.body_reversals) << way.name << ", turn";
        EXPECT_LE(reversals(tilt, kTolerance_deg), way.tilt_reversals) << way.name << ", tilt";
    }
}

TEST(CarShape, ReversalsAreCounted) {
    // The measure itself: a bow has none, a dent of a tenth of a degree too much has two.
    std::vector<double> bow, dented;
    for (int k = 0; k < 100; ++k) {
        bow.push_back(0.1 * k);
        dented.push_back(0.1 * k + 1.2 * std::exp(-0.02 * (k - 50) * (k - 50)));
    }
    EXPECT_EQ(reversals(bow, 0.1), 0);
    EXPECT_EQ(reversals(dented, 0.1), 2);
}

}  // namespace
}  // namespace livery
