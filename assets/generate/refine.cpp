#include "refine.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace livery::assets {

namespace {

LimitVertex middle_of(const LimitVertex& a, const LimitVertex& b) {
    const auto chord = b.position - a.position;
    const auto bow =
        (b.normal * glm::dot(b.normal, chord) - a.normal * glm::dot(a.normal, chord)) / 8.0;
    LimitVertex middle{0.5 * (a.position + b.position) + bow,
                       glm::normalize(a.normal + b.normal),
                       0.5 * (a.parameters + b.parameters)};
    if (a.position.z == 0.0 && b.position.z == 0.0) middle.position.z = 0.0;
    return middle;
}

}  // namespace

void refine(Sheet& sheet, const TriangleMask& mask) {
    using Edge = std::pair<std::uint32_t, std::uint32_t>;
    const auto edge_of = [](const SheetTriangle& t, int k) -> Edge {
        return std::minmax<std::uint32_t>({t.corners[k], t.corners[(k + 1) % 3]});
    };
    std::map<Edge, std::uint32_t> middles;
    for (const auto& t : sheet.triangles) {
        if (!mask(t)) continue;
        for (int k = 0; k < 3; ++k) {
            const auto edge = edge_of(t, k);
            const auto [place, is_new] = middles.try_emplace(edge, 0);
            if (!is_new) continue;
            place->second = static_cast<std::uint32_t>(sheet.vertices.size());
            sheet.vertices.push_back(
                middle_of(sheet.vertices[edge.first], sheet.vertices[edge.second]));
        }
    }
    std::vector<SheetTriangle> result;
    for (const auto& t : sheet.triangles) {
        // Corners around the triangle, with the middles of its split edges between them.
        std::array<const std::uint32_t*, 3> middle{};
        int splits = 0;
        for (int k = 0; k < 3; ++k) {
            const auto found = middles.find(edge_of(t, k));
            if (found == middles.end()) continue;
            middle[static_cast<std::size_t>(k)] = &found->second;
            ++splits;
        }
        const auto emit = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            result.push_back({{a, b, c}, t.panel, t.region});
        };
        if (splits == 0) {
            result.push_back(t);
            continue;
        }
        // Turned so that the first edge is split and, of two, the last is not.
        int first = 0;
        const auto is_split = [&](int k) {
            return middle[static_cast<std::size_t>(k % 3)] != nullptr;
        };
        while (!(is_split(first) && (splits == 3 || !is_split(first + 2)))) ++first;
        const auto corner = [&](int k) { return t.corners[(first + k) % 3]; };
        const auto mid = [&](int k) { return *middle[static_cast<std::size_t>((first + k) % 3)]; };
        if (splits == 1) {
            emit(corner(0), mid(0), corner(2));
            emit(mid(0), corner(1), corner(2));
        } else if (splits == 2) {
            emit(mid(0), corner(1), mid(1));
            emit(corner(0), mid(0), mid(1));
            emit(corner(0), mid(1), corner(2));
        } else {
            emit(corner(0), mid(0), mid(2));
            emit(mid(0), corner(1), mid(1));
            emit(mid(2), mid(1), corner(2));
            emit(mid(0), mid(1), mid(2));
        }
    }
    sheet.triangles = std::move(result);
}

}  // namespace livery::assets
