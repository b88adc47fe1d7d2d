#include "calibration/scan/scan_planes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "calibration/registration/rotation.h"
#include "calibration/registration/surface_samples.h"
#include "core/statistics.h"

namespace livery {

namespace {

/// Deviations within which a point is on the plane, and beyond which it stands out of it.
constexpr double kOn = 4.0, kOut = 12.0;
/// Points behind a plane that hang together with it, over those on it: from here on it is a side.
constexpr double kSideShare = 0.25;
/// A table or a wall has the product before it: so many points, and so much of what is known.
constexpr std::size_t kLeastLeft = 500;
constexpr double kLeastLeftShare = 0.01;
/// Of the samples; smaller ones are no tables.
constexpr double kLeastPlaneShare = 0.02;
constexpr std::size_t kLeastPiece_px = 40;
/// Of a plane's points: larger pieces beside it are something that lies on it.
constexpr double kSmallShare = 0.005;

struct FittedPlane {
    glm::dvec3 normal;
    double offset_mm;
    double excess = 1.0;  ///< scatter of its points over what their deviations say, 1 at least
};

/// Where a point lies against a plane.
struct Height {
    double mm;        ///< over it, toward the product
    double sigma_mm;  ///< across it
};

glm::dvec3 point_of(const Scan& scan, std::size_t i) {
    const float* p = &scan.points_mm.values[3 * i];
    return {p[0], p[1], p[2]};
}

bool is_known(const Scan& scan, std::size_t i) { return std::isfinite(scan.sigma_mm.values[i]); }

Height height_over(const FittedPlane& plane,
                   const Scan& scan,
                   const glm::dvec3& lamp,
                   std::size_t i) {
    const glm::dvec3 point = point_of(scan, i);
    const double along = std::abs(glm::dot(plane.normal, glm::normalize(point - lamp)));
    return {glm::dot(plane.normal, point) - plane.offset_mm,
            plane.excess * along * static_cast<double>(scan.sigma_mm.values[i])};
}

/// Least squares of the points near a plane, weighted by their deviations, again with those that
/// are near the better one.
FittedPlane fitted(const Scan& scan,
                   const glm::dvec3& lamp,
                   const SurfacePlane& start,
                   double within) {
    FittedPlane plane{start.normal, start.offset};
    constexpr int kRounds = 5;
    for (int round = 0; round < kRounds; ++round) {
        // Heights as a + b x + c y of places on the plane before
        const glm::dmat3 upright = rotation_between(plane.normal, {0.0, 0.0, 1.0});
        const glm::dvec3 origin = plane.normal * plane.offset_mm;
        glm::dmat3 normal_matrix(0.0);
        glm::dvec3 right(0.0);
        std::vector<float> ratios;
        for (std::size_t i = 0; i < scan.sigma_mm.values.size(); ++i) {
            if (!is_known(scan, i)) continue;
            const Height height = height_over(plane, scan, lamp, i);
            const double limit =
                round == 0 ? std::max(within, kOn * height.sigma_mm) : kOn * height.sigma_mm;
            if (std::abs(height.mm) > limit) continue;
            const glm::dvec3 place = upright * (point_of(scan, i) - origin);
            const glm::dvec3 row(1.0, place.x, place.y);
            const double weight = 1.0 / (height.sigma_mm * height.sigma_mm + 1e-12);
            normal_matrix += weight * glm::outerProduct(row, row);
            right += weight * place.z * row;
            ratios.push_back(static_cast<float>(plane.excess * std::abs(height.mm) /
                                                std::max(height.sigma_mm, 1e-9)));
        }
        if (ratios.size() < kLeastPiece_px || !(glm::determinant(normal_matrix) > 0.0))
            return plane;
        const glm::dvec3 solved = glm::inverse(normal_matrix) * right;
        const glm::dvec3 normal =
            glm::transpose(upright) * glm::normalize(glm::dvec3(-solved.y, -solved.z, 1.0));
        const glm::dvec3 on = origin + glm::transpose(upright) * glm::dvec3(0.0, 0.0, solved.x);
        plane.normal = normal;
        plane.offset_mm = glm::dot(normal, on);
        // Half of a normal distribution lies within .674 deviations.
        plane.excess = std::max(1.0, static_cast<double>(median(ratios)) / 0.674);
    }
    return plane;
}

/// Pieces of the projector's picture that hang together, of pixels for which `counts` says so.
template <typename Counts>
std::vector<std::vector<std::uint32_t>> pieces_of(const Scan& scan, const Counts& counts) {
    const int width = scan.sigma_mm.width, height = scan.sigma_mm.height;
    const glm::dvec3 lamp = centre_in_world(scan.projector);
    const double pixel_angle = 2.0 / (scan.projector.focal_px.x + scan.projector.focal_px.y);
    constexpr double kSteepest_rad = 1.40;
    std::vector<std::uint8_t> seen(scan.sigma_mm.values.size(), 0);
    std::vector<std::vector<std::uint32_t>> pieces;
    std::vector<std::uint32_t> stack;
    for (std::uint32_t start = 0; start < seen.size(); ++start) {
        if (seen[start] || !is_known(scan, start) || !counts(start)) continue;
        std::vector<std::uint32_t>& piece = pieces.emplace_back();
        stack.assign(1, start);
        seen[start] = 1;
        while (!stack.empty()) {
            const std::uint32_t at = stack.back();
            stack.pop_back();
            piece.push_back(at);
            const int x = static_cast<int>(at) % width, y = static_cast<int>(at) / width;
            const double range = glm::length(point_of(scan, at) - lamp);
            for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
                if (x + dx < 0 || y + dy < 0 || x + dx >= width || y + dy >= height) continue;
                const auto next = static_cast<std::uint32_t>((y + dy) * width + x + dx);
                if (seen[next] || !is_known(scan, next) || !counts(next)) continue;
                const double sigma = static_cast<double>(
                    std::max(scan.sigma_mm.values[at], scan.sigma_mm.values[next]));
                if (!on_one_surface(range,
                                    glm::length(point_of(scan, next) - lamp),
                                    pixel_angle,
                                    sigma,
                                    kSteepest_rad))
                    continue;
                seen[next] = 1;
                stack.push_back(next);
            }
        }
    }
    return pieces;
}

enum class CutSide : std::uint8_t { unknown, behind, on, beside, before };

/// What a plane would do to the scan.
struct Cut {
    std::vector<CutSide> sides;
    std::size_t behind = 0, on = 0, left = 0;
    std::size_t behind_of_it = 0;  ///< behind, and hanging together with what is on it
    double rms_mm = 0.0;
};

Cut cut_by(const FittedPlane& plane, const Scan& scan, const glm::dvec3& lamp) {
    Cut cut;
    cut.sides.assign(scan.sigma_mm.values.size(), CutSide::unknown);
    double squares = 0.0;
    for (std::size_t i = 0; i < cut.sides.size(); ++i) {
        if (!is_known(scan, i)) continue;
        const Height height = height_over(plane, scan, lamp, i);
        cut.sides[i] = height.mm < -kOut * height.sigma_mm  ? CutSide::behind
                       : height.mm < kOn * height.sigma_mm  ? CutSide::on
                       : height.mm < kOut * height.sigma_mm ? CutSide::beside
                                                            : CutSide::before;
        if (cut.sides[i] == CutSide::behind) ++cut.behind;
        if (cut.sides[i] != CutSide::on) continue;
        ++cut.on;
        squares += height.mm * height.mm;
    }
    cut.rms_mm = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(cut.on, 1)));
    for (const auto& piece : pieces_of(scan, [](std::uint32_t) { return true; })) {
        std::size_t on = 0, behind = 0;
        for (const std::uint32_t at : piece) {
            on += cut.sides[at] == CutSide::on;
            behind += cut.sides[at] == CutSide::behind;
        }
        if (on >= kLeastPiece_px) cut.behind_of_it += behind;
    }
    // What is left of the plane itself: small pieces that stand out of it nowhere
    const auto small = static_cast<std::size_t>(kSmallShare * static_cast<double>(cut.on));
    const auto is_left = [&](std::uint32_t at) { return cut.sides[at] >= CutSide::beside; };
    for (const auto& piece : pieces_of(scan, is_left)) {
        const auto before = std::count_if(piece.begin(), piece.end(), [&](std::uint32_t at) {
            return cut.sides[at] == CutSide::before;
        });
        if (static_cast<std::size_t>(before) >= kLeastPiece_px ||
            piece.size() > std::max(small, kLeastPiece_px)) {
            cut.left += piece.size();
            continue;
        }
        for (const std::uint32_t at : piece) cut.sides[at] = CutSide::on;
        cut.on += piece.size();
    }
    return cut;
}

bool is_background(const Cut& cut) {
    const std::size_t known = cut.on + cut.behind + cut.left;
    return static_cast<double>(cut.behind_of_it) < kSideShare * static_cast<double>(cut.on) &&
           cut.left >= kLeastLeft &&
           static_cast<double>(cut.left) > kLeastLeftShare * static_cast<double>(known);
}

void take_out(const Cut& cut, Scan& scan) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 0; i < cut.sides.size(); ++i) {
        if (cut.sides[i] != CutSide::behind && cut.sides[i] != CutSide::on) continue;
        for (std::size_t c = 0; c < 3; ++c)
            scan.points_mm.values[3 * i + c] = scan.normals.values[3 * i + c] = nan;
        scan.sigma_mm.values[i] = nan;
    }
}

}  // namespace

RemovedPlanes remove_planes(Scan& scan, int count) {
    RemovedPlanes removed;
    if (count == 0) return removed;
    const glm::dvec3 lamp = centre_in_world(scan.projector);
    std::vector<FittedPlane> planes;
    bool passed_over = false;
    while (static_cast<int>(planes.size()) < count) {
        const double spacing = 8.0 * point_spacing(scan);
        SurfaceSamples samples = sample_scan(scan, spacing);
        const auto least =
            static_cast<std::size_t>(kLeastPlaneShare * static_cast<double>(samples.size()));
        bool found = false;
        while (!found && samples.size() > 0) {
            const SurfacePlane start = main_plane(samples, spacing);
            const FittedPlane plane = fitted(scan, lamp, start, 0.3 * spacing);
            const std::size_t before = samples.size();
            const Cut cut = cut_by(plane, scan, lamp);
            found = is_background(cut);
            if (found) {
                take_out(cut, scan);
                planes.push_back(plane);
                removed.planes.push_back(
                    {plane.normal, plane.offset_mm, cut.rms_mm, cut.on, cut.behind});
                break;
            }
            passed_over = true;
            samples = beside_plane(samples, start, 0.6 * spacing);
            if (before - samples.size() < std::max<std::size_t>(least, 10)) break;
        }
        if (!found) break;
    }
    for (std::size_t i = 0; i < scan.sigma_mm.values.size(); ++i) {
        if (!is_known(scan, i)) continue;
        removed.beside += std::any_of(planes.begin(), planes.end(), [&](const FittedPlane& plane) {
            const Height height = height_over(plane, scan, lamp, i);
            return height.mm < kOut * height.sigma_mm;
        });
    }
    if (static_cast<int>(planes.size()) < count)
        removed.warnings.push_back(fmt::format(
            "{} of the {} planes asked for could be left out: {}",
            planes.size(),
            count,
            passed_over
                ? "what is flat besides has other parts of the scan behind it or hardly any "
                  "before it, as a side of the product does"
                : "nothing else is flat"));
    return removed;
}

}  // namespace livery
