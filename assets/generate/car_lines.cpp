#include "car_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace livery::assets {

namespace {

/// A key of a line: place along the car (nominal: the ends bend), height, half width.
struct Key {
    double along, y, z;
};
using Keys = std::vector<Key>;

/// A line is one curve, or two that meet with a kink at the cowl.
struct Line {
    Keys rear, front;
};

constexpr double kHalf_mm = 90.0;
constexpr double kCowl_mm = -kHalf_mm + 2.0 * kHalf_mm * kCowlStation / kStations;

// clang-format off
// Few keys a line, so that a curve through them can only be smooth. The ends of the rows above the
// shoulder follow from the profiles of the nose and the tail.
const Line kCentre{{{-76, 49.2, 0}, {-54, 55.3, 0}, {-28, 59.4, 0}, {-10, 60.0, 0}, {5, 57.5, 0},
                    {18, 51.9, 0}, {kCowl_mm, 44.2, 0}},
                   {{kCowl_mm, 44.2, 0}, {45, 42.8, 0}, {60, 40.9, 0}, {76, 36.9, 0}}};
const Line kCantInner{{{-76, 48.3, 20.6}, {-54, 53.9, 20.8}, {-28, 57.4, 22.0}, {-8, 57.9, 22.8},
                       {12, 52.4, 25.0}, {kCowl_mm, 43.2, 27.6}},
                      {{kCowl_mm, 43.2, 27.6}, {58, 39.9, 24.2}, {76, 36.4, 21.6}}};
const Line kCantOuter{{{-76, 47.4, 24.8}, {-54, 52.1, 25.0}, {-28, 55.3, 25.9}, {-8, 55.6, 26.4},
                       {12, 50.1, 28.0}, {kCowl_mm, 42.6, 29.6}},
                      {{kCowl_mm, 42.6, 29.6}, {58, 39.3, 27.1}, {76, 36.0, 24.5}}};
const Line kWindow{{{-76, 46.0, 29.4}, {-54, 48.4, 30.0}, {-28, 49.3, 30.5}, {-8, 49.2, 30.6},
                    {12, 46.4, 31.0}, {kCowl_mm, 42.0, 31.4}},
                   {{kCowl_mm, 42.0, 31.4}, {58, 39.15, 29.6}, {76, 35.5, 27.3}}};
const Line kBelt{{{-76, 45.0, 32.0}, {-54, 44.3, 33.4}, {-28, 42.9, 33.4}, {5, 41.9, 33.2},
                  {kCowl_mm, 41.3, 33.0}, {58, 38.95, 32.0}, {76, 35.0, 30.0}}, {}};
const Line kShoulderTop{{{-76, 43.8, 34.2}, {-54, 42.6, 35.6}, {-28, 40.9, 34.9}, {5, 39.9, 34.5},
                         {34, 39.4, 34.6}, {58, 38.2, 34.6}, {76, 34.35, 32.8}}, {}};
const Line kShoulder{{{-90, 43.0, 30.8}, {-76, 42.3, 35.7}, {-55, 40.9, 37.2}, {-36, 39.5, 36.8},
                      {0, 38.0, 36.3}, {40, 37.0, 36.6}, {58, 36.2, 36.9}, {76, 33.3, 35.6},
                      {90, 29.2, 28.6}}, {}};
const Line kUndercut{{{-90, 38.4, 31.2}, {-76, 38.2, 36.2}, {-55, 36.9, 37.4}, {-36, 35.6, 36.4},
                      {0, 34.2, 35.3}, {40, 33.2, 36.4}, {58, 32.2, 37.2}, {76, 29.7, 36.1},
                      {90, 26.2, 28.9}}, {}};
const Line kDoor{{{-90, 31.5, 31.6}, {-76, 31.0, 36.5}, {-55, 30.3, 37.4}, {-36, 29.2, 36.3},
                  {0, 28.0, 34.9}, {40, 27.3, 36.3}, {58, 26.8, 37.2}, {76, 25.0, 36.3},
                  {90, 22.2, 29.1}}, {}};
const Line kLowerDoor{{{-90, 25.0, 31.6}, {-76, 24.2, 36.4}, {-55, 23.1, 37.3}, {-36, 22.0, 36.3},
                       {0, 20.5, 35.0}, {40, 19.8, 36.3}, {58, 20.2, 37.1}, {76, 19.8, 36.3},
                       {90, 18.0, 29.2}}, {}};
const Line kCatcher{{{-90, 18.0, 31.4}, {-76, 17.4, 36.1}, {-55, 17.2, 37.1}, {-36, 16.5, 36.8},
                     {0, 14.7, 36.6}, {40, 13.5, 36.6}, {58, 14.2, 37.0}, {76, 14.6, 36.2},
                     {90, 14.0, 29.1}}, {}};
const Line kSill{{{-90, 12.4, 31.0}, {-76, 11.0, 35.4}, {-54, 10.4, 36.6}, {-28, 9.8, 36.4},
                  {5, 9.6, 36.4}, {34, 9.4, 36.4}, {58, 9.6, 36.5}, {76, 9.8, 35.5},
                  {90, 10.0, 28.8}}, {}};
const Line kSillEdge{{{-90, 8.6, 28.4}, {-76, 7.6, 32.5}, {-54, 6.9, 33.6}, {-28, 6.5, 34.0},
                      {5, 6.4, 34.0}, {34, 6.4, 34.0}, {58, 6.5, 33.8}, {76, 6.9, 33.0},
                      {90, 7.2, 26.4}}, {}};

// The ends on the centre line, rows 8 to 14, and how far out each column of them stands.
const std::array<glm::dvec2, 7> kNoseProfile{{{87.2, 29.8}, {89.2, 26.0}, {90.0, 21.5},
                                              {90.0, 17.0}, {89.6, 13.0}, {88.4, 9.5},
                                              {85.5, 7.0}}};
const std::array<glm::dvec2, 7> kTailProfile{{{-88.2, 46.6}, {-86.7, 42.0}, {-87.1, 36.0},
                                              {-88.8, 29.6}, {-90.0, 24.0}, {-88.8, 14.0},
                                              {-84.0, 8.5}}};
constexpr double kNoseCorner_mm = 82.5, kTailCorner_mm = -82.5;
const std::array<double, 9> kEndColumns{0.0, 0.22, 0.44, 0.64, 0.74, 0.82, 0.89, 0.95, 1.0};
// How far the cowl bows forward at each row.
const std::array<double, 9> kCowlBow_mm{3.5, 3.1, 1.6, -1.2, -3.2, -2.2, -0.6, 0.0, 0.0};
// clang-format on

/// The natural cubic spline through the keys.
Key on_spline(const Keys& keys, double along) {
    const std::size_t n = keys.size();
    std::vector<glm::dvec2> bend(n, glm::dvec2(0.0));  // second derivatives of y and z
    std::vector<double> factor(n, 0.0);
    const auto value = [&](std::size_t k) { return glm::dvec2(keys[k].y, keys[k].z); };
    for (std::size_t k = 1; k + 1 < n; ++k) {
        const double before = keys[k].along - keys[k - 1].along;
        const double after = keys[k + 1].along - keys[k].along;
        const auto jump = (value(k + 1) - value(k)) / after - (value(k) - value(k - 1)) / before;
        const double pivot = 2.0 * (before + after) - before * factor[k - 1];
        factor[k] = after / pivot;
        bend[k] = (6.0 * jump - before * bend[k - 1]) / pivot;
    }
    for (std::size_t k = n - 1; k-- > 1;) bend[k] -= factor[k] * bend[k + 1];
    std::size_t k = 0;
    while (k + 2 < n && along > keys[k + 1].along) ++k;
    const double h = keys[k + 1].along - keys[k].along;
    const double b = (along - keys[k].along) / h, a = 1.0 - b;
    const auto at = a * value(k) + b * value(k + 1) +
                    (h * h / 6.0) * ((a * a * a - a) * bend[k] + (b * b * b - b) * bend[k + 1]);
    return {along, at.x, at.y};
}

double nominal_mm(int station) { return -kHalf_mm + 2.0 * kHalf_mm * station / kStations; }

const Line& line_of(int row) {
    static const std::array<const Line*, kSillRow + 1> lines{&kCentre,
                                                             &kCentre,
                                                             &kCentre,
                                                             &kCantInner,
                                                             &kCantOuter,
                                                             &kWindow,
                                                             &kBelt,
                                                             &kShoulderTop,
                                                             &kShoulder,
                                                             &kUndercut,
                                                             &kDoor,
                                                             &kLowerDoor,
                                                             &kCatcher,
                                                             &kSill,
                                                             &kSillEdge};
    return *lines[static_cast<std::size_t>(row)];
}

Key on_line(int row, double along) {
    if (row == 1 || row == 2) {
        // Between the centre line and the cant rail, bowed.
        const double f = row == 1 ? 0.36 : 0.71;
        const auto a = on_line(0, along), b = on_line(kBonnetRow, along);
        return {along, a.y + (b.y - a.y) * std::pow(f, 2.3), b.z * f};
    }
    const auto& line = line_of(row);
    Keys keys = !line.front.empty() && along > kCowl_mm ? line.front : line.rear;
    if (row < kShoulderRow) {
        if (line.front.empty() || along <= kCowl_mm) {
            const auto tail = end_point(false, row, 0);
            keys.insert(keys.begin(), {-kHalf_mm, tail.y, tail.z});
        }
        if (line.front.empty() || along > kCowl_mm) {
            const auto nose = end_point(true, row, 0);
            keys.push_back({kHalf_mm, nose.y, nose.z});
        }
    }
    return on_spline(keys, along);
}

/// Where a row really passes: drawn back toward its ends' places near the nose and the tail, and
/// bowed at the cowl.
double bent_mm(int row, double along) {
    constexpr double kFrom_mm = 48.0;
    const auto toward_end = [&](double distance) {
        const double f = std::clamp((distance - kFrom_mm) / (kHalf_mm - kFrom_mm), 0.0, 1.0);
        return f * f * f;
    };
    const int column = std::min(row, kShoulderRow), level = std::max(row - kShoulderRow, 0);
    double x = along;
    x -= (kHalf_mm - end_point(true, column, level).x) * toward_end(along);
    x += (kHalf_mm + end_point(false, column, level).x) * toward_end(-along);
    const double from_cowl = (along - kCowl_mm) / 15.0;
    return x + kCowlBow_mm[static_cast<std::size_t>(column)] * std::exp(-from_cowl * from_cowl);
}

const std::vector<std::vector<glm::dvec3>>& grid() {
    static const auto points = [] {
        std::vector<std::vector<glm::dvec3>> rows;
        for (int row = 0; row <= kSillRow; ++row) {
            std::vector<glm::dvec3> line;
            for (int station = 0; station <= kStations; ++station) {
                const double along = nominal_mm(station);
                const auto key = on_line(row, along);
                line.emplace_back(bent_mm(row, along), key.y, row == 0 ? 0.0 : key.z);
            }
            rows.push_back(line);
        }
        return rows;
    }();
    return points;
}

glm::dvec3 row_point(int station, int row) {
    return grid()[static_cast<std::size_t>(row)][static_cast<std::size_t>(station)];
}

}  // namespace

double end_column(int column) { return kEndColumns[static_cast<std::size_t>(column)]; }

glm::dvec3 end_point(bool nose, int column, int level) {
    const auto profile = (nose ? kNoseProfile : kTailProfile)[static_cast<std::size_t>(level)];
    const auto& corner_line = line_of(kShoulderRow + level).rear;
    const auto& corner = nose ? corner_line.back() : corner_line.front();
    // A corner's x follows the profile's lean.
    const double middle = nose ? kHalf_mm : -kHalf_mm;
    const double corner_x = (nose ? kNoseCorner_mm : kTailCorner_mm) + 0.7 * (profile.x - middle);
    const double f = end_column(column);
    return {profile.x + (corner_x - profile.x) * f * f * f,
            profile.y + (corner.y - profile.y) * f * f,
            corner.z * f};
}

glm::dvec3 feature_point(double station, double row) {
    const double s = std::clamp(station, 0.0, static_cast<double>(kStations));
    const double r = std::clamp(row, 0.0, static_cast<double>(kSillRow));
    const int i = std::min(static_cast<int>(s), kStations - 1);
    const int j = std::min(static_cast<int>(r), kSillRow - 1);
    return glm::mix(glm::mix(row_point(i, j), row_point(i + 1, j), s - i),
                    glm::mix(row_point(i, j + 1), row_point(i + 1, j + 1), s - i),
                    r - j);
}

}  // namespace livery::assets
