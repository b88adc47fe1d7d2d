#include "car_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace livery::assets {

namespace {

struct Key {
    double station;
    glm::dvec3 point;
};
using Line = std::vector<Key>;

// clang-format off
// Feature lines, key points in millimetres (x toward the front, y up, z to one side). Between keys
// a cubic runs; the nose (20) and the tail (0) of the upper rows follow from the end profiles
// below.
const Line kCentre{{1, {-83.0, 44.4, 0}}, {2, {-76.0, 46.4, 0}}, {3, {-66.0, 50.0, 0}},
                   {4, {-56.0, 53.4, 0}}, {5, {-45.5, 56.3, 0}}, {6, {-35.0, 58.4, 0}},
                   {7, {-24.0, 59.6, 0}}, {8, {-13.0, 60.0, 0}}, {9, {-3.0, 59.4, 0}},
                   {10, {5.5, 57.6, 0}}, {11, {14.5, 53.7, 0}}, {12, {24.0, 48.8, 0}},
                   {13, {33.0, 43.9, 0}}, {14, {38.5, 41.3, 0}}, {15, {46.0, 39.8, 0}},
                   {16, {55.0, 38.6, 0}}, {17, {65.0, 37.0, 0}}, {18, {75.0, 34.8, 0}},
                   {19, {83.0, 31.9, 0}}};
const Line kCantInner{{1, {-80.5, 43.6, 18.6}}, {2, {-75.0, 45.2, 19.0}},
                      {4, {-55.0, 51.2, 18.4}}, {5, {-45.0, 53.9, 18.8}},
                      {6, {-35.0, 55.9, 20.0}}, {8, {-14.0, 57.5, 21.6}},
                      {9, {-5.0, 56.9, 22.0}}, {10, {2.5, 55.0, 22.7}}, {11, {11.0, 51.2, 24.2}},
                      {12, {20.0, 46.6, 26.0}}, {13, {28.5, 42.3, 27.4}},
                      {14, {34.5, 40.2, 27.4}}, {16, {54.5, 37.8, 25.0}},
                      {18, {72.8, 34.4, 22.2}}, {19, {79.8, 31.9, 20.4}}};
const Line kCantOuter{{1, {-79.8, 43.1, 22.3}}, {2, {-74.3, 44.6, 23.0}},
                      {4, {-54.5, 49.2, 22.0}}, {5, {-44.5, 51.7, 22.3}},
                      {6, {-34.5, 53.6, 23.2}}, {8, {-13.5, 55.1, 24.6}},
                      {9, {-5.0, 54.5, 25.0}}, {10, {2.0, 52.6, 25.7}}, {11, {10.0, 49.0, 27.1}},
                      {12, {18.8, 44.8, 28.9}}, {13, {27.3, 41.0, 30.5}},
                      {14, {33.8, 39.3, 30.6}}, {16, {54.0, 37.3, 28.5}},
                      {18, {71.8, 34.2, 25.6}}, {19, {78.8, 32.1, 23.4}}};
const Line kWindow{{1, {-78.8, 42.4, 27.0}}, {2, {-73.2, 43.4, 28.0}}, {4, {-54.0, 45.4, 27.4}},
                   {5, {-44.0, 46.6, 27.9}}, {8, {-13.5, 48.0, 29.4}}, {10, {2.0, 46.9, 30.0}},
                   {11, {10.0, 45.0, 30.7}}, {12, {18.3, 42.4, 31.8}}, {13, {26.8, 39.9, 32.7}},
                   {14, {33.6, 38.7, 32.7}}, {16, {53.8, 37.2, 31.0}}, {18, {71.0, 34.2, 28.4}},
                   {19, {78.0, 32.2, 26.1}}};
const Line kBelt{{1, {-78.2, 41.9, 30.4}}, {2, {-72.2, 42.4, 31.8}}, {4, {-53.6, 42.0, 32.6}},
                 {5, {-44.0, 41.4, 33.0}}, {8, {-13.5, 40.3, 33.4}}, {10, {2.5, 39.8, 33.4}},
                 {12, {18.3, 39.2, 33.7}}, {13, {26.8, 38.7, 34.0}}, {14, {33.8, 38.0, 34.0}},
                 {16, {53.8, 36.9, 33.2}}, {18, {70.3, 34.1, 30.9}}, {19, {77.2, 32.1, 28.6}}};
const Line kShoulderTop{{1, {-77.0, 41.6, 32.9}}, {2, {-70.8, 41.4, 34.4}},
                        {4, {-53.3, 40.6, 35.2}}, {5, {-44.0, 39.9, 35.4}},
                        {8, {-13.5, 38.8, 35.6}}, {12, {18.5, 37.9, 35.6}},
                        {14, {34.0, 37.2, 35.5}}, {16, {53.9, 36.2, 34.9}},
                        {18, {69.0, 33.6, 33.3}}, {19, {76.1, 31.8, 31.0}}};
const Line kShoulder{{0, {-80.6, 41.6, 30.8}}, {1, {-76.3, 41.0, 34.3}},
                     {2, {-70.0, 40.1, 35.9}}, {4, {-53.0, 38.9, 36.8}},
                     {7, {-24.0, 37.7, 36.45}}, {10, {5.0, 37.0, 36.35}},
                     {13, {30.0, 36.4, 36.3}}, {16, {54.0, 35.0, 36.3}},
                     {18, {68.3, 32.8, 35.0}}, {19, {75.2, 31.2, 32.7}},
                     {20, {80.2, 29.4, 28.4}}};
const Line kWidest{{0, {-82.8, 37.0, 31.4}}, {1, {-78.2, 36.3, 34.9}}, {2, {-71.0, 34.8, 36.6}},
                   {4, {-53.0, 32.4, 37.3}}, {7, {-24.0, 29.5, 37.5}}, {10, {5.0, 28.8, 37.5}},
                   {13, {30.0, 29.3, 37.3}}, {16, {54.0, 28.6, 37.0}}, {18, {69.0, 27.2, 35.6}},
                   {19, {76.2, 26.0, 33.3}}, {20, {81.3, 24.6, 29.1}}};
const Line kDoor{{0, {-84.2, 28.2, 31.6}}, {1, {-79.2, 27.6, 35.0}}, {2, {-71.5, 26.2, 36.7}},
                 {4, {-53.0, 24.0, 37.3}}, {7, {-24.0, 22.4, 36.7}}, {10, {5.0, 22.0, 36.6}},
                 {13, {30.0, 21.8, 36.8}}, {16, {54.0, 21.6, 36.9}}, {18, {69.4, 20.6, 35.7}},
                 {19, {76.8, 20.0, 33.5}}, {20, {81.9, 19.0, 29.4}}};
const Line kLowerDoor{{0, {-83.8, 20.3, 31.4}}, {1, {-79.0, 19.5, 34.7}},
                      {2, {-71.5, 18.0, 36.4}}, {4, {-53.0, 16.0, 36.9}},
                      {7, {-24.0, 15.4, 35.5}}, {10, {5.0, 15.0, 35.4}},
                      {13, {30.0, 14.6, 35.9}}, {16, {54.0, 14.4, 36.6}},
                      {18, {69.2, 14.0, 35.5}}, {19, {76.4, 13.7, 33.3}},
                      {20, {81.5, 13.4, 29.2}}};
const Line kSill{{0, {-82.4, 12.6, 30.8}}, {1, {-77.8, 11.8, 34.0}}, {2, {-70.5, 10.8, 35.7}},
                 {4, {-53.0, 10.0, 36.3}}, {7, {-24.0, 9.6, 36.3}}, {10, {5.0, 9.6, 36.2}},
                 {13, {30.0, 9.6, 36.2}}, {16, {54.0, 9.4, 36.0}}, {18, {68.9, 9.4, 34.8}},
                 {19, {75.6, 9.4, 32.6}}, {20, {80.4, 9.4, 28.6}}};
const Line kSillEdge{{0, {-79.2, 7.8, 28.5}}, {1, {-75.0, 7.3, 31.5}}, {2, {-68.5, 6.8, 32.9}},
                     {4, {-53.0, 6.4, 33.4}}, {7, {-24.0, 6.2, 33.6}}, {10, {5.0, 6.2, 33.6}},
                     {13, {30.0, 6.2, 33.6}}, {16, {54.0, 6.2, 33.4}}, {18, {68.3, 6.3, 32.2}},
                     {19, {74.2, 6.4, 30.1}}, {20, {78.3, 6.6, 26.6}}};

// The ends on the centre line, rows 8 to 13, and how far out each column of them stands.
const std::array<glm::dvec2, 6> kNoseProfile{
    {{87.6, 28.8}, {89.4, 24.4}, {90.0, 19.0}, {89.4, 13.4}, {88.0, 9.4}, {85.0, 6.6}}};
const std::array<glm::dvec2, 6> kTailProfile{
    {{-88.2, 43.8}, {-86.6, 38.4}, {-88.6, 28.4}, {-90.0, 20.8}, {-88.2, 12.8}, {-83.5, 7.8}}};
const std::array<double, 9> kEndColumns{0.0, 0.17, 0.34, 0.50, 0.63, 0.74, 0.84, 0.925, 1.0};

// clang-format on

glm::dvec3 on_line(const Line& line, double station) {
    // Clamped ends; within, a cubic Hermite with the slopes of the parabola through three keys.
    const auto last = line.size() - 1;
    std::size_t k = 0;
    while (k + 2 <= last && station > line[k + 1].station) ++k;
    const auto chord = [&](std::size_t a) {
        return (line[a + 1].point - line[a].point) / (line[a + 1].station - line[a].station);
    };
    const auto slope = [&](std::size_t a) {
        if (a == 0) return chord(0);
        if (a == last) return chord(last - 1);
        const double before = line[a].station - line[a - 1].station;
        const double after = line[a + 1].station - line[a].station;
        return (chord(a - 1) * after + chord(a) * before) / (before + after);
    };
    const double h = line[k + 1].station - line[k].station;
    const double t = (station - line[k].station) / h;
    const double t2 = t * t, t3 = t2 * t;
    return line[k].point * (2 * t3 - 3 * t2 + 1) + line[k + 1].point * (3 * t2 - 2 * t3) +
           slope(k) * (h * (t3 - 2 * t2 + t)) + slope(k + 1) * (h * (t3 - t2));
}

glm::dvec3 grid_point(int station, int row) {
    if (station == 0 || station == kStations) {
        if (row <= kShoulderRow) return end_point(station != 0, row, 0);
    }
    const auto between = [&](double z_fraction, double crown) {
        const auto a = on_line(kCentre, station), b = on_line(kCantInner, station);
        const double f = z_fraction;
        return glm::dvec3(
            a.x + (b.x - a.x) * f * f, a.y + (b.y - a.y) * std::pow(f, crown), b.z * f);
    };
    switch (row) {
        case 0:
            return on_line(kCentre, station);
        case 1:
            return between(0.37, 2.3);
        case 2:
            return between(0.72, 2.3);
        case 3:
            return on_line(kCantInner, station);
        case 4:
            return on_line(kCantOuter, station);
        case 5:
            return on_line(kWindow, station);
        case 6:
            return on_line(kBelt, station);
        case 7:
            return on_line(kShoulderTop, station);
        case 8:
            return on_line(kShoulder, station);
        case 9:
            return on_line(kWidest, station);
        case 10:
            return on_line(kDoor, station);
        case 11:
            return on_line(kLowerDoor, station);
        case 12:
            return on_line(kSill, station);
        default:
            return on_line(kSillEdge, station);
    }
}

/// The feature lines with their unevenness along the car taken out: a few steps of
/// fourth-difference smoothing, which moves a cubic's samples not at all.
const std::vector<std::vector<glm::dvec3>>& fair_grid() {
    static const auto grid = [] {
        constexpr int kSteps = 12;
        constexpr double kWeight = 1.0 / 32.0;  // stable below 1/8
        std::vector<std::vector<glm::dvec3>> rows;
        for (int row = 0; row <= kSillRow; ++row) {
            std::vector<glm::dvec3> line;
            for (int station = 0; station <= kStations; ++station) {
                line.push_back(grid_point(station, row));
            }
            for (int step = 0; step < kSteps; ++step) {
                const auto before = line;
                for (std::size_t i = 2; i + 2 < line.size(); ++i) {
                    line[i] -= kWeight * (before[i - 2] - 4.0 * before[i - 1] + 6.0 * before[i] -
                                          4.0 * before[i + 1] + before[i + 2]);
                }
            }
            rows.push_back(line);
        }
        return rows;
    }();
    return grid;
}

glm::dvec3 row_point(int station, int row) {
    return fair_grid()[static_cast<std::size_t>(row)][static_cast<std::size_t>(station)];
}

}  // namespace

double end_column(int column) { return kEndColumns[static_cast<std::size_t>(column)]; }

glm::dvec3 end_point(bool nose, int column, int level) {
    const auto& profile = nose ? kNoseProfile : kTailProfile;
    static const std::array<const Line*, 6> rows{
        &kShoulder, &kWidest, &kDoor, &kLowerDoor, &kSill, &kSillEdge};
    const auto l = static_cast<std::size_t>(level);
    const auto corner = on_line(*rows[l], nose ? kStations : 0);
    const double f = end_column(column);
    return {profile[l].x + (corner.x - profile[l].x) * std::pow(f, 3.0),
            profile[l].y + (corner.y - profile[l].y) * f * f,
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
