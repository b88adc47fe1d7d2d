// orient: one winding for each connected surface, and its outside out.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "mesh/surface.h"

namespace livery {

namespace {

/// Fractions of a surface's area from where on votes decide.
constexpr double kClearVote = 0.5;
/// How much a surface bulges, from 0 (flat, saddle) to 1 (sphere): enough to tell its outside, and
/// enough to do so against a winding that is at least consistent.
constexpr double kBulges = 0.1, kBulgesClearly = 0.5;

/// Sums over one connected surface, wound as its first triangle is.
struct Patch {
    std::size_t turned = 0;  ///< triangles wound against the first
    bool closed = true, one_sided = false;
    glm::dvec3 origin{0.0};  ///< a point of it; sums count from there
    glm::dvec3 weighted_centre{0.0};
    double area = 0.0, volume = 0.0;
    double wound = 0.0;    ///< area wound as the patch less area wound against it
    double normals = 0.0;  ///< area whose normals agree less area whose normals do not
    double flux = 0.0, reach = 0.0;
    bool consistent() const { return turned == 0; }
};

class Orienter {
  public:
    Orienter(Surface& surface, const std::vector<glm::vec3>& normals)
        : surface_(surface),
          normals_(normals),
          patch_of_(surface.triangles.size(), Surface::none),
          against_(surface.triangles.size(), false) {}
    Orientation run();

  private:
    void spread(std::uint32_t first);
    void sum_up();
    bool faces_inward(const Patch& patch) const;
    bool file_says_inward(const Patch& patch) const;
    /// Area times normal, as the patch winds it.
    glm::dvec3 vector_of(std::size_t triangle) const {
        return (against_[triangle] ? -0.5 : 0.5) * area_vector(surface_, triangle);
    }
    glm::dvec3 centre_of(std::size_t triangle) const {
        const glm::uvec3& t = surface_.triangles[triangle];
        return (glm::dvec3(surface_.points[t.x]) + glm::dvec3(surface_.points[t.y]) +
                glm::dvec3(surface_.points[t.z])) /
               3.0;
    }

    Surface& surface_;
    const std::vector<glm::vec3>& normals_;
    std::vector<std::uint32_t> patch_of_;
    std::vector<bool> against_;  ///< wound against the first triangle of its patch
    std::vector<Patch> patches_;
    std::vector<std::uint32_t> pending_;
};

/// Whether two triangles that share an edge run along it in the same direction, as only those of
/// different winding do.
bool run_alike(const glm::uvec3& t, int corner, const glm::uvec3& other) {
    const std::uint32_t from = t[corner], to = t[(corner + 1) % 3];
    for (int k = 0; k < 3; ++k) {
        if (other[k] == from && other[(k + 1) % 3] == to) return true;
    }
    return false;
}

void Orienter::spread(std::uint32_t first) {
    const auto number = static_cast<std::uint32_t>(patches_.size());
    Patch patch;
    patch.origin = centre_of(first);
    patch_of_[first] = number;
    pending_.assign(1, first);
    while (!pending_.empty()) {
        const std::uint32_t t = pending_.back();
        pending_.pop_back();
        if (surface_.lone[t]) patch.closed = false;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t other = surface_.neighbours[t][static_cast<std::size_t>(k)];
            if (other == Surface::none) continue;
            const bool alike = run_alike(surface_.triangles[t], k, surface_.triangles[other]);
            const bool against = against_[t] != alike;
            if (patch_of_[other] == Surface::none) {
                patch_of_[other] = number;
                against_[other] = against;
                pending_.push_back(other);
            } else if (against_[other] != against) {
                patch.one_sided = true;
            }
        }
    }
    patches_.push_back(patch);
}

void Orienter::sum_up() {
    for (std::size_t t = 0; t < patch_of_.size(); ++t) {
        Patch& patch = patches_[patch_of_[t]];
        const glm::dvec3 vector = vector_of(t), centre = centre_of(t) - patch.origin;
        const double area = glm::length(vector);
        if (against_[t]) ++patch.turned;
        patch.area += area;
        patch.weighted_centre += area * centre;
        patch.volume += glm::dot(centre, vector) / 3.0;
        patch.wound += against_[t] ? -area : area;
        const double agrees = glm::dot(vector, glm::dvec3(normals_[t]));
        if (agrees != 0.0) patch.normals += agrees > 0.0 ? area : -area;
    }
    for (std::size_t t = 0; t < patch_of_.size(); ++t) {
        Patch& patch = patches_[patch_of_[t]];
        if (patch.closed || !(patch.area > 0.0)) continue;
        const glm::dvec3 vector = vector_of(t);
        const glm::dvec3 arm = centre_of(t) - patch.origin - patch.weighted_centre / patch.area;
        patch.flux += glm::dot(arm, vector);
        patch.reach += glm::length(arm) * glm::length(vector);
    }
}

bool Orienter::faces_inward(const Patch& patch) const {
    if (patch.closed && !patch.one_sided) return patch.volume < 0.0;
    const double wound = patch.wound / patch.area, normals = patch.normals / patch.area;
    const double bulge = patch.reach > 0.0 ? patch.flux / patch.reach : 0.0;
    if (std::abs(normals) >= kClearVote) return normals < 0.0;
    if (std::abs(bulge) >= (patch.consistent() ? kBulgesClearly : kBulges)) return bulge < 0.0;
    return wound < 0.0;
}

/// Whether the file has a closed surface face inward: by its winding, where that is one, else by
/// its normals.
bool Orienter::file_says_inward(const Patch& patch) const {
    if (patch.consistent()) return patch.volume < 0.0;
    const double normals = patch.normals / patch.area;
    return std::abs(normals) >= kClearVote && (normals < 0.0) != (patch.volume < 0.0);
}

Orientation Orienter::run() {
    const auto count = static_cast<std::uint32_t>(surface_.triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) {
        if (patch_of_[t] == Surface::none) spread(t);
    }
    sum_up();

    std::vector<bool> closed, inward;
    for (const Patch& patch : patches_) {
        closed.push_back(patch.closed && !patch.one_sided);
        inward.push_back(faces_inward(patch));
    }
    Orientation result;
    // A closed surface that faces inward may be the inner side of a hollow thing.
    std::optional<Insideness> insideness;
    for (std::uint32_t number = 0; number < patches_.size(); ++number) {
        const Patch& patch = patches_[number];
        if (patch.one_sided) ++result.one_sided;
        if (!closed[number] || !file_says_inward(patch)) continue;
        if (!insideness) insideness.emplace(surface_, patch_of_, closed);
        if (!insideness->inside_others(patch.origin, number)) continue;
        inward[number] = !inward[number];
        ++result.cavities;
    }

    result.turned.assign(count, false);
    result.open.assign(count, false);
    std::vector<std::size_t> turned_in(patches_.size(), 0);
    for (std::uint32_t t = 0; t < count; ++t) {
        result.open[t] = !closed[patch_of_[t]];
        // What no winding fits at least follows its normals.
        const double agrees = patches_[patch_of_[t]].one_sided
                                  ? glm::dot(area_vector(surface_, t), glm::dvec3(normals_[t]))
                                  : 0.0;
        result.turned[t] = agrees != 0.0 ? agrees < 0.0 : against_[t] != inward[patch_of_[t]];
        if (!result.turned[t]) continue;
        ++turned_in[patch_of_[t]];
        std::swap(surface_.triangles[t].y, surface_.triangles[t].z);
        std::swap(surface_.neighbours[t][0], surface_.neighbours[t][2]);
    }
    for (std::size_t number = 0; number < patches_.size(); ++number) {
        if (!patches_[number].consistent()) {
            result.against += turned_in[number];
        } else if (turned_in[number] > 0) {
            ++result.inward;
            result.inward_triangles += turned_in[number];
        }
    }
    return result;
}

}  // namespace

Orientation orient(Surface& surface, const std::vector<glm::vec3>& normals) {
    return Orienter(surface, normals).run();
}

std::string counted(std::size_t count, const char* one, const char* many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

void note_orientation(const Orientation& orientation, std::vector<std::string>& notes) {
    if (orientation.against > 0) {
        notes.push_back(fmt::format("{} wound against their neighbours turned over",
                                    counted(orientation.against, "triangle", "triangles")));
    }
    if (orientation.inward > 0) {
        notes.push_back(
            fmt::format("{} facing inward turned outside out ({})",
                        counted(orientation.inward, "surface", "surfaces"),
                        counted(orientation.inward_triangles, "triangle", "triangles")));
    }
    if (orientation.cavities > 0) {
        notes.push_back(
            fmt::format("{} inside others left facing inward: hollow spaces",
                        counted(orientation.cavities, "closed surface", "closed surfaces")));
    }
    if (orientation.one_sided > 0) {
        notes.push_back(
            fmt::format("{} of one side only (a Moebius strip) wound as well as it goes",
                        counted(orientation.one_sided, "surface", "surfaces")));
    }
}

namespace {

/// Cells a triangle may stand in, on average; large ones stand in many.
constexpr std::size_t kMostCells = 8;
constexpr std::size_t kLargestSide = 1024;

}  // namespace

std::size_t Insideness::cell_of(double value, int axis) const {
    const double extent = high_[axis] - low_[axis];
    if (!(extent > 0.0)) return 0;
    const double cell = (value - low_[axis]) / extent * static_cast<double>(side_);
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(side_ - 1)));
}

Insideness::Insideness(const Surface& surface,
                       const std::vector<std::uint32_t>& owner,
                       const std::vector<bool>& closed_owner)
    : surface_(surface), owner_(owner) {
    std::vector<std::uint32_t> closed;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
        if (closed_owner[owner[t]]) closed.push_back(t);
    }
    if (closed.empty()) return;
    low_ = high_ = glm::dvec3(surface.points[surface.triangles[closed[0]].x]);
    for (const std::uint32_t t : closed) {
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 point(surface.points[surface.triangles[t][k]]);
            low_ = glm::min(low_, point);
            high_ = glm::max(high_, point);
        }
    }
    /// The cells under the triangle's box: columns, then rows.
    const auto cells_of = [&](std::uint32_t t, auto&& visit) {
        const glm::uvec3& corners = surface_.triangles[t];
        const glm::dvec3 a(surface_.points[corners.x]), b(surface_.points[corners.y]),
            c(surface_.points[corners.z]);
        const glm::dvec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
        visit(cell_of(low.x, 0), cell_of(high.x, 0), cell_of(low.z, 2), cell_of(high.z, 2));
    };
    side_ = std::clamp(static_cast<std::size_t>(std::sqrt(static_cast<double>(closed.size()))),
                       std::size_t{1},
                       kLargestSide);
    for (;; side_ /= 2) {
        std::size_t places = 0;
        for (const std::uint32_t t : closed) {
            cells_of(t, [&](std::size_t x0, std::size_t x1, std::size_t z0, std::size_t z1) {
                places += (x1 - x0 + 1) * (z1 - z0 + 1);
            });
        }
        if (side_ == 1 || places <= kMostCells * closed.size()) break;
    }
    first_.assign(side_ * side_ + 1, 0);
    const auto each_cell = [&](std::uint32_t t, auto&& visit) {
        cells_of(t, [&](std::size_t x0, std::size_t x1, std::size_t z0, std::size_t z1) {
            for (std::size_t z = z0; z <= z1; ++z) {
                for (std::size_t x = x0; x <= x1; ++x) visit(z * side_ + x);
            }
        });
    };
    for (const std::uint32_t t : closed)
        each_cell(t, [&](std::size_t cell) { ++first_[cell + 1]; });
    for (std::size_t cell = 0; cell + 1 < first_.size(); ++cell) first_[cell + 1] += first_[cell];
    triangles_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (const std::uint32_t t : closed) {
        each_cell(t, [&](std::size_t cell) { triangles_[next[cell]++] = t; });
    }
}

bool Insideness::inside_others(const glm::dvec3& point, std::uint32_t own) const {
    if (first_.empty()) return false;
    const std::size_t cell = cell_of(point.z, 2) * side_ + cell_of(point.x, 0);
    bool inside = false;
    for (std::uint32_t at = first_[cell]; at < first_[cell + 1]; ++at) {
        const std::uint32_t t = triangles_[at];
        if (owner_[t] == own) continue;
        const glm::uvec3& corners = surface_.triangles[t];
        // Seen from above, whether the point is within, edges belonging to one side only, so that
        // a ray through an edge meets one of its two triangles.
        bool within = false;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 a(surface_.points[corners[k]]),
                b(surface_.points[corners[(k + 1) % 3]]);
            if ((a.z > point.z) == (b.z > point.z)) continue;
            const glm::dvec3 &from = a.z < b.z ? a : b, &to = a.z < b.z ? b : a;
            const double x = from.x + (to.x - from.x) * ((point.z - from.z) / (to.z - from.z));
            if (point.x < x) within = !within;
        }
        if (!within) continue;
        const glm::dvec3 a(surface_.points[corners.x]);
        const glm::dvec3 normal = area_vector(surface_, t);
        if (normal.y == 0.0) continue;
        const double height =
            a.y - (normal.x * (point.x - a.x) + normal.z * (point.z - a.z)) / normal.y;
        if (height > point.y) inside = !inside;
    }
    return inside;
}

}  // namespace livery
