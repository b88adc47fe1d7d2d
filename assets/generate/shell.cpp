#include "shell.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>

#include "coarsen.h"

namespace livery::assets {

namespace {

/// Normals of faces with crease angles.
class FaceNormals {
  public:
    FaceNormals(const std::vector<glm::dvec3>& points, const std::vector<CoarseTriangle>& triangles)
        : around_(points.size()) {
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            const auto& c = triangles[t].corners;
            of_triangle_.push_back(
                glm::cross(points[c.y] - points[c.x], points[c.z] - points[c.x]));
            for (int k = 0; k < 3; ++k) around_[c[k]].push_back(t);
        }
    }

    /// Area-weighted over the triangles around the vertex; where one of them turns away from that
    /// by more than `bent_cos`, over those that turn away from this one by 40 degrees at most.
    glm::dvec3 at(std::uint32_t vertex, std::uint32_t triangle, double bent_cos) const {
        constexpr double kSmooth_cos = 0.766;
        const auto sum_within = [&](const glm::dvec3& about, double least_cos) {
            glm::dvec3 sum(0.0);
            for (const auto other : around_[vertex]) {
                const auto& n = of_triangle_[other];
                if (glm::dot(n, about) >= least_cos * glm::length(n) * glm::length(about)) sum += n;
            }
            return sum;
        };
        const auto smooth = sum_within(of_triangle_[triangle], -2.0);
        const bool is_bent =
            std::any_of(around_[vertex].begin(), around_[vertex].end(), [&](auto other) {
                const auto& n = of_triangle_[other];
                return glm::dot(n, smooth) < bent_cos * glm::length(n) * glm::length(smooth);
            });
        return is_bent ? sum_within(of_triangle_[triangle], kSmooth_cos) : smooth;
    }

  private:
    std::vector<glm::dvec3> of_triangle_;
    std::vector<std::vector<std::uint32_t>> around_;
};

class ShellBuilder {
  public:
    ShellBuilder(const Sheet& sheet,
                 const Posts& posts,
                 const std::vector<PostPlaces>& places,
                 const ChartFunction& chart,
                 const std::function<PartMesh&(int piece)>& part_of)
        : sheet_(sheet), posts_(posts), places_(places), chart_(chart), part_of_(part_of) {
        for (std::size_t k = 0; k < sheet.triangles.size(); ++k) {
            if (is_of_piece(posts.of_triangle[k])) regions_.push_back(sheet.triangles[k].region);
        }
    }

    void add_faces(bool outer) {
        constexpr double kEdge_cos = 0.94, kHiddenEdge_cos = 0.6;
        std::vector<glm::dvec3> points;
        std::vector<double> tolerance_mm;
        for (std::uint32_t p = 0; p < places_.size(); ++p) {
            const auto& place = places_[p];
            points.push_back(outer ? place.outer_mm : place.inner_mm);
            tolerance_mm.push_back(outer ? place.outer_tolerance_mm : place.inner_tolerance_mm);
            if (posts_.on_centre[p]) tolerance_mm[p] = 0.0;
        }
        for (const auto& border : posts_.borders) {
            tolerance_mm[border.from] = tolerance_mm[border.to] = 0.0;
        }
        const auto triangles = coarsened(points, triangles_of_posts(), tolerance_mm);
        const FaceNormals faces(points, triangles);
        std::map<Corner, std::uint32_t> emitted;
        for (std::uint32_t k = 0; k < triangles.size(); ++k) {
            const auto& t = triangles[k].corners;
            const int region = regions_[triangles[k].origin];
            auto& part = part_of_(posts_.piece[t.x]);
            glm::uvec3 corner(0);
            for (int c = 0; c < 3; ++c) {
                auto normal = vertex_of(t[c]).normal;
                // An inner face may be bent more tightly than the skin.
                if (!outer || places_[t[c]].is_shaped) {
                    normal = unit(faces.at(t[c], k, outer ? kEdge_cos : kHiddenEdge_cos), t[c]);
                }
                if (!outer) normal = -normal;
                corner[c] = emit(emitted, part, points[t[c]], normal, t[c], region);
            }
            if (!outer) std::swap(corner.y, corner.z);
            part.add_triangle(corner.x, corner.y, corner.z);
        }
    }

    void add_wall(const PieceBorder& border) {
        auto& part = part_of_(posts_.piece[border.from]);
        const auto along =
            glm::normalize(vertex_of(border.to).position - vertex_of(border.from).position);
        const auto upright = [&](std::uint32_t post) {
            // Smooth along the edge, but not around its corners.
            const auto own = -glm::cross(vertex_of(post).normal, along);
            const auto smooth = -places_[post].inward;
            const bool is_corner = !(glm::dot(own, smooth) > 0.9 * glm::length(smooth));
            const auto out = glm::normalize(is_corner ? own : smooth);
            const auto chart = uv(post, border.region);
            return std::array<std::uint32_t, 2>{
                part.add_vertex(places_[post].outer_mm, out, chart),
                part.add_vertex(places_[post].inner_mm, out, chart)};
        };
        const auto a = upright(border.from), b = upright(border.to);
        part.add_quad(a[0], a[1], b[1], b[0]);
    }

  private:
    /// Vertices of a part that are one: post, region of the chart, normal.
    using Corner = std::tuple<std::uint32_t, int, std::array<double, 3>>;

    bool is_of_piece(const glm::uvec3& post) const { return post.x < posts_.vertex.size(); }
    std::vector<glm::uvec3> triangles_of_posts() const {
        std::vector<glm::uvec3> triangles;
        for (const auto& post : posts_.of_triangle) {
            if (is_of_piece(post)) triangles.push_back(post);
        }
        return triangles;
    }
    const LimitVertex& vertex_of(std::uint32_t post) const {
        return sheet_.vertices[posts_.vertex[post]];
    }
    /// The mirror image has the same normal on the centre line.
    glm::dvec3 unit(glm::dvec3 normal, std::uint32_t post) const {
        if (posts_.on_centre[post]) normal.z = 0.0;
        return glm::normalize(normal);
    }
    glm::dvec2 uv(std::uint32_t post, int region) const {
        return chart_(vertex_of(post), region) / kUvUnit_mm + glm::dvec2(0.5);
    }
    std::uint32_t emit(std::map<Corner, std::uint32_t>& emitted,
                       PartMesh& part,
                       const glm::dvec3& place,
                       const glm::dvec3& normal,
                       std::uint32_t post,
                       int region) const {
        const auto [entry, is_new] =
            emitted.try_emplace({post, region, {normal.x, normal.y, normal.z}}, 0u);
        if (is_new) entry->second = part.add_vertex(place, normal, uv(post, region));
        return entry->second;
    }

    const Sheet& sheet_;
    const Posts& posts_;
    const std::vector<PostPlaces>& places_;
    const ChartFunction& chart_;
    const std::function<PartMesh&(int piece)>& part_of_;
    std::vector<int> regions_;  ///< of each triangle of a piece
};

}  // namespace

void add_shells(const Sheet& sheet,
                const Posts& posts,
                const std::vector<PostPlaces>& places,
                const ChartFunction& chart,
                const std::function<PartMesh&(int piece)>& part_of) {
    ShellBuilder builder(sheet, posts, places, chart, part_of);
    builder.add_faces(true);
    builder.add_faces(false);
    for (const auto& border : posts.borders) builder.add_wall(border);
}

}  // namespace livery::assets
