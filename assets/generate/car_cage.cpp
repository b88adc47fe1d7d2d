#include "car_cage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace livery::assets {

namespace {

/// Row by row of the lattice box: i along the car, j across (negative: right), k down.
struct Lattice {
    Cage cage;
    std::map<std::array<int, 3>, int> index;

    int vertex(int i, int j, int k) {
        const auto [place, is_new] = index.try_emplace({i, j, k}, 0);
        if (!is_new) return place->second;
        place->second = static_cast<int>(cage.surface_points.size());
        const int column = std::abs(j);
        glm::dvec3 point;
        glm::dvec2 parameters(i, column + k);
        if (column == kShoulderRow || k == 0) {
            point = feature_point(i, column + k);
        } else if (i == 0 || i == kStations) {
            point = end_point(i != 0, column, k);
        } else {
            const auto edge = feature_point(i, kSillRow);
            point = {edge.x, edge.y, edge.z * end_column(column)};
            parameters.y = kSillRow + kShoulderRow - column;
        }
        if (j < 0) {
            point.z = -point.z;
            parameters.y = -parameters.y;
        }
        cage.surface_points.push_back(point);
        cage.parameters.push_back(parameters);
        return place->second;
    }
    void face(glm::ivec4 corners, CageRegion region) { cage.faces.push_back({corners, region}); }
    void crease(std::array<int, 3> a, std::array<int, 3> b, double sharpness) {
        cage.creases.push_back({{vertex(a[0], a[1], a[2]), vertex(b[0], b[1], b[2])}, sharpness});
    }
};

}  // namespace

Cage make_car_cage() {
    Lattice box;
    constexpr int n = kStations, m = kShoulderRow, depth = kSillRow - kShoulderRow;
    for (int i = 0; i < n; ++i) {
        for (int j = -m; j < m; ++j) {
            box.face({box.vertex(i, j, 0),
                      box.vertex(i, j + 1, 0),
                      box.vertex(i + 1, j + 1, 0),
                      box.vertex(i + 1, j, 0)},
                     kTop);
            box.face({box.vertex(i, j, depth),
                      box.vertex(i + 1, j, depth),
                      box.vertex(i + 1, j + 1, depth),
                      box.vertex(i, j + 1, depth)},
                     kFloor);
        }
        for (int k = 0; k < depth; ++k) {
            box.face({box.vertex(i, m, k),
                      box.vertex(i, m, k + 1),
                      box.vertex(i + 1, m, k + 1),
                      box.vertex(i + 1, m, k)},
                     kSide);
            box.face({box.vertex(i, -m, k),
                      box.vertex(i + 1, -m, k),
                      box.vertex(i + 1, -m, k + 1),
                      box.vertex(i, -m, k + 1)},
                     kSide);
        }
    }
    for (int j = -m; j < m; ++j) {
        for (int k = 0; k < depth; ++k) {
            box.face({box.vertex(n, j, k),
                      box.vertex(n, j + 1, k),
                      box.vertex(n, j + 1, k + 1),
                      box.vertex(n, j, k + 1)},
                     kNose);
            box.face({box.vertex(0, j, k),
                      box.vertex(0, j, k + 1),
                      box.vertex(0, j + 1, k + 1),
                      box.vertex(0, j + 1, k)},
                     kTail);
        }
    }

    // The shoulder, softening toward the ends; the belt's valley; the tail's spoiler edge.
    for (int side : {-1, 1}) {
        for (int i = 0; i < n; ++i) {
            const double fade = std::clamp((19.0 - i) / 5.0, 0.0, 1.0);
            if (fade > 0.0) {
                box.crease({i, side * m, 0}, {i + 1, side * m, 0}, 1.2 * fade);
            }
            if (i >= 4 && i < 14) box.crease({i, side * 6, 0}, {i + 1, side * 6, 0}, 1.3);
            if (i >= 14 && i < 19) {
                box.crease({i, side * 3, 0}, {i + 1, side * 3, 0}, i == 14 || i == 18 ? 0.5 : 1.0);
            }
            box.crease({i, side * m, depth}, {i + 1, side * m, depth}, 1.0);
        }
        for (int j = 0; j < m; ++j) {
            box.crease({0, side * j, 0}, {0, side * (j + 1), 0}, j + 1 < m ? 2.0 : 1.0);
        }
    }
    return box.cage;
}

}  // namespace livery::assets
