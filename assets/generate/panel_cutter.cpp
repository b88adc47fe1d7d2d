#include "panel_cutter.h"

#include <algorithm>
#include <cmath>

#include "car_lines.h"

namespace livery::assets {

namespace {

constexpr double kDevelopedAbout_mm = 48.0;  ///< |x| of the upright axes
constexpr double kDevelopedAt_mm = 40.0;     ///< radius whose arcs are true
constexpr double kStation_mm = 7.5, kRow_mm = 4.0;

}  // namespace

glm::dvec2 side_view(const LimitVertex& v) { return {v.position.x, v.position.y}; }
glm::dvec2 top_view(const LimitVertex& v) { return {v.position.x, v.position.z}; }

glm::dvec2 end_view(const LimitVertex& v) { return {v.position.z, v.position.y}; }

glm::dvec2 nose_view(const LimitVertex& v) {
    return {std::atan2(v.position.z, v.position.x - kDevelopedAbout_mm) * kDevelopedAt_mm,
            v.position.y};
}
glm::dvec2 tail_view(const LimitVertex& v) {
    return {std::atan2(v.position.z, -kDevelopedAbout_mm - v.position.x) * kDevelopedAt_mm,
            v.position.y};
}
glm::dvec2 line_view(const LimitVertex& v) { return along_lines(v.parameters.x, v.parameters.y); }

glm::dvec2 along_lines(double station, double row) {
    return {station * kStation_mm, row * kRow_mm};
}

glm::dvec2 side_of(double station, double row) {
    const auto p = feature_point(station, row);
    return {p.x, p.y};
}
double behind_pillar_mm(const LimitVertex& v) {
    const double above = v.position.y - 39.5;
    return -(v.position.x + 9.0 + (above > 0.0 ? 0.10 : 0.09) * above);
}

Points mirrored(const Points& half) {
    Points all = half;
    for (auto p = half.rbegin(); p != half.rend(); ++p) {
        if (p->y > 0.0) all.emplace_back(p->x, -p->y);
    }
    return all;
}

void Cutter::operator()(const Outline& outline,
                        View view,
                        double offset,
                        const std::vector<int>& from,
                        int to,
                        const TriangleMask& where) const {
    along([&](const LimitVertex& v) { return outline.signed_distance(view(v)) - offset; },
          from,
          to,
          where);
}

void Cutter::along(const CutFunction& f,
                   const std::vector<int>& from,
                   int to,
                   const TriangleMask& where) const {
    const auto is_from = [&](int panel) {
        return std::find(from.begin(), from.end(), panel) != from.end();
    };
    cut(
        sheet,
        f,
        [&](const SheetTriangle& t) { return is_from(t.panel) && where(t); },
        [&](int) { return to; });
}

glm::dvec3 Cutter::centre(const SheetTriangle& t) const {
    return (sheet.vertices[t.corners.x].position + sheet.vertices[t.corners.y].position +
            sheet.vertices[t.corners.z].position) /
           3.0;
}

double Cutter::row(const SheetTriangle& t) const {
    return (sheet.vertices[t.corners.x].parameters.y + sheet.vertices[t.corners.y].parameters.y +
            sheet.vertices[t.corners.z].parameters.y) /
           3.0;
}

}  // namespace livery::assets
