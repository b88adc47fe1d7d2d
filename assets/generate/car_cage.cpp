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
            // Farther in beside the ends, whose corners are drawn back.
            const double inset = i == 1 || i == kStations - 1 ? 2.6 : 1.0;
            point = {edge.x, edge.y, edge.z * std::pow(end_column(column), inset)};
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

    // Creases fade in and out: `from` and `to` are the stations where they have gone.
    const auto fade = [](int station, double from, double to, double run) {
        const double middle = station + 0.5;
        return std::clamp(std::min(middle - from, to - middle) / run, 0.0, 1.0);
    };
    for (int side : {-1, 1}) {
        const auto along = [&](int i, int column, int level, double sharpness) {
            if (sharpness <= 0.0) return;
            box.crease({i, side * column, level}, {i + 1, side * column, level}, sharpness);
        };
        for (int i = 0; i < n; ++i) {
            along(i, m, 0, 2.2 * fade(i, 0.0, 20.5, 5.0));
            along(i, kBeltRow, 0, 1.6 * fade(i, 4.0, kCowlStation + 4.0, 4.0));
            along(i, kBonnetRow, 0, 1.8 * fade(i, kCowlStation - 0.5, n - 1.0, 3.0));
            along(i, m, kCatcherRow - m, 1.8 * fade(i, 6.0, 18.5, 4.0));
            along(i, m, depth, 1.0);
        }
        for (int j = 0; j < m; ++j) {
            box.crease({0, side * j, 0}, {0, side * (j + 1), 0}, j + 1 < m ? 2.0 : 1.0);
            box.crease(
                {n, side * j, 0}, {n, side * (j + 1), 0}, 1.2 * fade(m - j, 0.0, 2.0 * m, 4.0));
            if (j < kBeltRow) {
                box.crease({kCowlStation, side * j, 0},
                           {kCowlStation, side * (j + 1), 0},
                           j + 1 < kBeltRow ? 2.5 : 1.2);
            }
        }
    }
    return box.cage;
}

}  // namespace livery::assets
