#include "calibration/sphere/sphere_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/angles.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {

TangentCone cone_of(const View& view, const Sphere& sphere) {
    const glm::dvec3 to_centre = sphere.centre_mm - centre_in_world(view);
    TangentCone cone;
    cone.distance_mm = glm::length(to_centre);
    check_argument(
        2.0 * cone.distance_mm > sphere.diameter_mm && sphere.diameter_mm > 0.0,
        fmt::format(
            "a sphere of {} mm at {} mm from the camera", sphere.diameter_mm, cone.distance_mm));
    cone.axis = to_centre / cone.distance_mm;
    const glm::dvec3 rows_down = glm::transpose(view.view_from_world.rotation)[1];
    cone.right = glm::normalize(glm::cross(rows_down, cone.axis));
    cone.down = glm::cross(cone.axis, cone.right);
    cone.angle_rad = std::asin(0.5 * sphere.diameter_mm / cone.distance_mm);
    return cone;
}

Sphere sphere_of(const View& view, const TangentCone& cone) {
    return {centre_in_world(view) + cone.distance_mm * cone.axis,
            2.0 * cone.distance_mm * std::sin(cone.angle_rad)};
}

glm::dvec3 around(const TangentCone& cone, double turn_rad) {
    return std::cos(turn_rad) * cone.right + std::sin(turn_rad) * cone.down;
}

ConeEdge edge_of(const TangentCone& cone, const glm::dvec3& direction) {
    const double x = glm::dot(direction, cone.right), y = glm::dot(direction, cone.down);
    const double turn = std::atan2(y, x);
    return {turn < 0.0 ? turn + 2.0 * std::numbers::pi : turn,
            std::atan2(std::hypot(x, y), glm::dot(direction, cone.axis))};
}

double move_cone(std::span<const ConeEdge> edges, double outlier_rad, TangentCone& cone) {
    glm::dvec3 change(0.0);
    double rms = 0.0;
    for (int round = 0; round < 20; ++round) {
        glm::dmat3 normal(0.0);
        glm::dvec3 right(0.0);
        double squares = 0.0, weights = 0.0;
        for (const ConeEdge& edge : edges) {
            const glm::dvec3 row(std::cos(edge.turn_rad), std::sin(edge.turn_rad), 1.0);
            const double off = edge.angle_rad - cone.angle_rad - glm::dot(row, change);
            const double weight = std::min(1.0, outlier_rad / std::max(std::abs(off), 1e-12));
            normal += weight * glm::outerProduct(row, row);
            right += weight * off * row;
            squares += weight * off * off;
            weights += weight;
        }
        if (!(std::abs(glm::determinant(normal)) > 1e-6)) break;
        change += glm::inverse(normal) * right;
        rms = std::sqrt(squares / weights);
    }
    const double distance = cone.distance_mm;
    const double angle = cone.angle_rad + change.z;
    const glm::dvec3 axis =
        glm::normalize(cone.axis + change.x * cone.right + change.y * cone.down);
    const glm::dvec3 rows_right = glm::normalize(cone.right - glm::dot(cone.right, axis) * axis);
    cone = {axis, rows_right, glm::cross(axis, rows_right), distance, angle};
    return rms;
}

namespace {

constexpr int kSectors = 72;
constexpr double kDimmestEdge = 0.15;  ///< cosine of the light to the outline's normal
constexpr double kCoarseReach = 0.35;  ///< of the angular radius: how far off the start may be
constexpr std::array<double, 4> kFineReaches_px{12.0, 6.0, 6.0, 6.0};
constexpr double kLargestRms_px = 1.0;
constexpr double kFewestSeen = 0.6;

/// A pixel as the cone sees it.
struct PixelPlace {
    std::size_t pixel = 0;
    double angle_rad = 0.0;  ///< from the axis
};
using Sectors = std::array<std::vector<PixelPlace>, kSectors>;

Sectors pixels_near(const std::vector<glm::dvec3>& rays,
                    const TangentCone& cone,
                    double reach_rad) {
    Sectors sectors;
    for (std::size_t k = 0; k < rays.size(); ++k) {
        const ConeEdge at = edge_of(cone, rays[k]);
        if (std::abs(at.angle_rad - cone.angle_rad) > reach_rad) continue;
        const int sector =
            std::min(static_cast<int>(at.turn_rad / kFullTurn * kSectors), kSectors - 1);
        sectors[static_cast<std::size_t>(sector)].push_back({k, at.angle_rad});
    }
    return sectors;
}

/// Sum of the channels a second; nothing where one of them is saturated.
std::vector<std::optional<float>> brightness(const MergedPhotographs& picture) {
    std::vector<std::optional<float>> result(picture.counts.pixel_count());
    for (std::size_t k = 0; k < result.size(); ++k) {
        const float* counts = picture.counts.values.data() + 3 * k;
        const float* seconds = picture.seconds.values.data() + 3 * k;
        if (seconds[0] > 0.0f && seconds[1] > 0.0f && seconds[2] > 0.0f) {
            result[k] = counts[0] / seconds[0] + counts[1] / seconds[1] + counts[2] / seconds[2];
        }
    }
    return result;
}

using Brightness = std::vector<std::optional<float>>;

/// The outermost place where brightness passes the middle between outside and inside: good to some
/// pixels, from far away.
std::optional<double> coarse_edge(const std::vector<PixelPlace>& places,
                                  const Brightness& light,
                                  const TangentCone& cone,
                                  double reach_rad,
                                  double pixel_rad) {
    const double step = 2.0 * pixel_rad;
    const auto bins = static_cast<std::size_t>(std::max(8.0, std::ceil(2.0 * reach_rad / step)));
    std::vector<double> sum(bins, 0.0), count(bins, 0.0);
    std::vector<double> inside, outside;
    for (const PixelPlace& place : places) {
        const double at = (place.angle_rad - cone.angle_rad) / reach_rad;
        // Of light no value is known beyond saturation: bright enough.
        const double value = light[place.pixel] ? static_cast<double>(*light[place.pixel]) : 1e30;
        if (at < -0.5) inside.push_back(value);
        if (at > 0.5) outside.push_back(value);
        const auto bin = std::min(
            static_cast<std::size_t>(0.5 * (at + 1.0) * static_cast<double>(bins)), bins - 1);
        sum[bin] += std::min(value, 1e30);
        count[bin] += 1.0;
    }
    if (inside.size() < 4 || outside.size() < 4) return std::nullopt;
    const double bright = median(inside), dark = median(outside);
    if (!(bright > 2.0 * std::abs(dark)) || bright >= 1e30) return std::nullopt;
    const double middle = dark + 0.3 * (bright - dark);
    for (std::size_t bin = bins; bin-- > 0;) {
        if (count[bin] > 0.0 && sum[bin] / count[bin] > middle) {
            return cone.angle_rad +
                   reach_rad *
                       (2.0 * static_cast<double>(bin + 1) / static_cast<double>(bins) - 1.0);
        }
    }
    return std::nullopt;
}

/// Least squares of four unknowns by elimination; nothing when singular.
std::optional<std::array<double, 4>> solve4(std::array<std::array<double, 5>, 4> rows) {
    for (std::size_t column = 0; column < 4; ++column) {
        std::size_t pivot = column;
        for (std::size_t row = column + 1; row < 4; ++row) {
            if (std::abs(rows[row][column]) > std::abs(rows[pivot][column])) pivot = row;
        }
        if (std::abs(rows[pivot][column]) < 1e-9) return std::nullopt;
        std::swap(rows[pivot], rows[column]);
        for (std::size_t row = 0; row < 4; ++row) {
            if (row == column) continue;
            const double factor = rows[row][column] / rows[column][column];
            for (std::size_t k = column; k < 5; ++k) rows[row][k] -= factor * rows[column][k];
        }
    }
    return std::array{rows[0][4] / rows[0][0],
                      rows[1][4] / rows[1][1],
                      rows[2][4] / rows[2][2],
                      rows[3][4] / rows[3][3]};
}

struct Edge {
    double angle_rad = 0.0, contrast = 0.0;
};

/// To a small part of a pixel. Inside of the outline brightness is a step, a root (the normal turns
/// away as the root of the depth) and a slope over the depth in pixels, each averaged over a pixel;
/// the place is the one that explains the pixels best.
std::optional<Edge> fine_edge(const std::vector<PixelPlace>& places,
                              const Brightness& light,
                              const TangentCone& cone,
                              double reach_px,
                              double pixel_rad) {
    std::vector<std::array<double, 2>> samples;  // depth, brightness
    double scale = 0.0;
    for (const PixelPlace& place : places) {
        if (!light[place.pixel]) continue;
        const auto value = static_cast<double>(*light[place.pixel]);
        samples.push_back({(cone.angle_rad - place.angle_rad) / pixel_rad, value});
        scale = std::max(scale, std::abs(value));
    }
    if (samples.size() < 30 || scale <= 0.0) return std::nullopt;
    constexpr double kStep = 0.05;
    const double largest = reach_px - 2.5;  // enough of both sides stays in view
    double best = 1e300, best_shift = 0.0, best_contrast = 0.0, best_step = 0.0;
    for (double shift = -largest; shift <= largest; shift += kStep) {
        std::array<std::array<double, 5>, 4> normal{};
        double squares = 0.0;
        for (const auto& [depth, value] : samples) {
            const double high = std::max(depth - shift + 0.5, 0.0);
            const double low = std::max(depth - shift - 0.5, 0.0);
            const std::array<double, 5> row = {
                1.0,
                high - low,
                (high * std::sqrt(high) - low * std::sqrt(low)) / 1.5,
                0.5 * (high * high - low * low),
                value / scale};
            for (std::size_t i = 0; i < 4; ++i) {
                for (std::size_t j = 0; j < 5; ++j) normal[i][j] += row[i] * row[j];
            }
            squares += row[4] * row[4];
        }
        const auto x = solve4(normal);
        if (!x) continue;
        double explained = 0.0;
        for (std::size_t i = 0; i < 4; ++i) explained += (*x)[i] * normal[i][4];
        if (squares - explained < best) {
            best = squares - explained;
            best_shift = shift;
            best_step = (*x)[1];
            best_contrast = (*x)[1] + (*x)[2] + (*x)[3] - std::abs((*x)[0]);
        }
    }
    if (best_step <= 0.0 || best_contrast <= 0.0 || std::abs(best_shift) > largest - 2.0 * kStep) {
        return std::nullopt;
    }
    return Edge{cone.angle_rad - best_shift * pixel_rad, best_contrast * scale};
}

/// The lights that meet the outline least aslant there, best first.
std::vector<std::size_t> best_lights(const TangentCone& cone,
                                     const View& view,
                                     double turn_rad,
                                     std::span<const LitSphere> lit) {
    const double radius = cone.distance_mm * std::sin(cone.angle_rad);
    const glm::dvec3 normal =
        std::cos(cone.angle_rad) * around(cone, turn_rad) - std::sin(cone.angle_rad) * cone.axis;
    const glm::dvec3 edge = centre_in_world(view) + cone.distance_mm * cone.axis + radius * normal;
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t k = 0; k < lit.size(); ++k) {
        const double cosine = glm::dot(normal, glm::normalize(lit[k].light_mm - edge));
        if (cosine > kDimmestEdge) order.emplace_back(-cosine, k);
    }
    std::sort(order.begin(), order.end());
    std::vector<std::size_t> best;
    for (std::size_t k = 0; k < std::min<std::size_t>(order.size(), 3); ++k) {
        best.push_back(order[k].second);
    }
    return best;
}

using Edges = std::array<std::optional<double>, kSectors>;

std::vector<ConeEdge> found_of(const Edges& edges) {
    std::vector<ConeEdge> found;
    for (std::size_t k = 0; k < edges.size(); ++k) {
        if (edges[k])
            found.push_back({kFullTurn * (static_cast<double>(k) + 0.5) / kSectors, *edges[k]});
    }
    return found;
}

double share_of(const Edges& edges) {
    return static_cast<double>(std::count_if(
               edges.begin(), edges.end(), [](const auto& edge) { return edge.has_value(); })) /
           kSectors;
}

[[noreturn]] void refuse_outline(const std::string& why) {
    throw Refused("the sphere's outline does not show: " + why,
                  "put it before a dark cloth, light it from several sides, and check camera and "
                  "sphere in manifest.json");
}

}  // namespace

std::optional<OutlineBox> outline_box(const View& view, const Sphere& sphere) {
    const glm::dvec3 in_view = view.view_from_world * sphere.centre_mm;
    if (in_view.z <= 0.5 * sphere.diameter_mm) return std::nullopt;
    const TangentCone cone = cone_of(view, sphere);
    OutlineBox box{1e30, 1e30, -1e30, -1e30};
    for (int k = 0; k < kSectors; ++k) {
        const glm::dvec3 direction =
            std::cos(cone.angle_rad) * cone.axis +
            std::sin(cone.angle_rad) * around(cone, kFullTurn * k / kSectors);
        const auto pixel = project(view, centre_in_world(view) + cone.distance_mm * direction);
        if (!pixel) return std::nullopt;
        box.left = std::min(box.left, pixel->x);
        box.right = std::max(box.right, pixel->x);
        box.top = std::min(box.top, pixel->y);
        box.bottom = std::max(box.bottom, pixel->y);
    }
    return box;
}

OutlineFit fit_outline(const View& view, const Sphere& start, std::span<const LitSphere> lit) {
    check_argument(!lit.empty(), "fit_outline: no pictures");
    std::vector<glm::dvec3> rays(static_cast<std::size_t>(view.width) *
                                 static_cast<std::size_t>(view.height));
    parallel_for(rays.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const auto width = static_cast<std::size_t>(view.width);
            rays[k] = ray_through(view, glm::dvec2(k % width, k / width) + 0.5).direction;
        }
    });
    std::vector<Brightness> light;
    for (const LitSphere& one : lit) {
        check_argument(
            one.picture.counts.width == view.width && one.picture.counts.height == view.height,
            "fit_outline: a picture of another size than the view's");
        light.push_back(brightness(one.picture));
    }
    TangentCone cone = cone_of(view, start);
    const double pixel_rad = 1.0 / std::min(view.focal_px.x, view.focal_px.y);

    const auto edges_at = [&](double reach_rad, const auto& find) {
        const Sectors sectors = pixels_near(rays, cone, reach_rad);
        Edges edges;
        parallel_for(kSectors, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                const double turn = kFullTurn * (static_cast<double>(k) + 0.5) / kSectors;
                std::vector<double> found;
                for (const std::size_t one : best_lights(cone, view, turn, lit)) {
                    if (const auto edge = find(sectors[k], light[one])) found.push_back(*edge);
                }
                if (!found.empty()) edges[k] = median(found);
            }
        });
        return edges;
    };
    for (int round = 0; round < 3; ++round) {
        const double reach = kCoarseReach * cone.angle_rad / (1 + round);
        const Edges edges = edges_at(reach, [&](const auto& places, const Brightness& one) {
            return coarse_edge(places, one, cone, reach, pixel_rad);
        });
        if (share_of(edges) < kFewestSeen) {
            refuse_outline(
                fmt::format("it is seen over {:.0f}% of the way around, expected {:.0f}%",
                            100.0 * share_of(edges),
                            100.0 * kFewestSeen));
        }
        move_cone(found_of(edges), 2.0 * pixel_rad, cone);
    }
    OutlineFit fit;
    for (const double reach_px : kFineReaches_px) {
        const Edges edges =
            edges_at(reach_px * pixel_rad,
                     [&](const auto& places, const Brightness& one) -> std::optional<double> {
                         const auto edge = fine_edge(places, one, cone, reach_px, pixel_rad);
                         return edge ? std::optional(edge->angle_rad) : std::nullopt;
                     });
        fit.seen_fraction = share_of(edges);
        if (fit.seen_fraction < kFewestSeen) {
            refuse_outline(
                fmt::format("it is sharp over {:.0f}% of the way around, expected {:.0f}%",
                            100.0 * fit.seen_fraction,
                            100.0 * kFewestSeen));
        }
        fit.rms_px = move_cone(found_of(edges), 0.3 * pixel_rad, cone) / pixel_rad;
    }
    if (fit.rms_px > kLargestRms_px) {
        refuse_outline(fmt::format("the edges lie {:.1f} px from a sphere's", fit.rms_px));
    }
    fit.sphere = sphere_of(view, cone);
    return fit;
}

}  // namespace livery
