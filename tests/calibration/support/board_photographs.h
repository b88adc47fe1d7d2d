// Gray code photographs of a flat board, ray by ray: its plane through the camera's lens, and the
// projector's light on it through the projector's.
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "calibration/correspondence/gray_code.h"
#include "calibration/correspondence/patterns.h"
#include "calibration/geometry/board.h"
#include "calibration/geometry/board_sight.h"
#include "calibration/geometry/solve_pair.h"
#include "calibration/registration/rotation.h"

namespace livery::testing {

/// The camera's frame is the world.
struct BoardScene {
    View camera, projector;
    Rigid3 camera_from_board;
    /// Reflectance at a place of the board's plane, mm from its first inner corner.
    std::function<double(glm::dvec2 board_mm)> reflectance;
    /// What stands before the board, by the camera's pixel: negative for nothing, else the light
    /// that it sends to the camera whatever is projected.
    std::function<double(glm::dvec2 camera_px)> before = [](glm::dvec2) { return -1.0; };
    double ambient = 0.02;  ///< over the projector's white
    double noise = 0.002;   ///< of a photograph, the same unit
    std::uint32_t seed = 1;
};

/// Squares of a chessboard with so many inner corners, a white border of one and a half squares,
/// and a grey wall in the same plane.
inline std::function<double(glm::dvec2)> chessboard(int columns, int rows, double square_mm) {
    return [=](glm::dvec2 p) {
        const double x = p.x / square_mm + 1.0, y = p.y / square_mm + 1.0;
        const bool inside = x >= 0.0 && y >= 0.0 && x < columns + 1.0 && y < rows + 1.0;
        if (inside) return (static_cast<int>(x) + static_cast<int>(y)) % 2 == 0 ? 0.12 : 0.8;
        const bool border = x >= -1.5 && y >= -1.5 && x < columns + 2.5 && y < rows + 2.5;
        return border ? 0.8 : 0.3;
    };
}

/// The same with markers; what is dark reflects as much.
inline std::function<double(glm::dvec2)> charuco_board(const Board& board) {
    const auto squares = chessboard(board.columns, board.rows, board.square_mm);
    const auto markers = markers_of(board);
    return [=](glm::dvec2 p) {
        const glm::dvec2 square = glm::floor(p / board.square_mm + 1.0);
        const int column = static_cast<int>(square.x), row = static_cast<int>(square.y);
        const bool inside = column >= 0 && row >= 0 && column <= board.columns && row <= board.rows;
        if (!inside || (column + row) % 2 == 0) return squares(p);
        const int before = row * (board.columns + 1) + column;
        // Every second square holds one; in rows that begin with a white one, half a step earlier.
        const int number = board.columns % 2 == 1 ? before / 2 : (before - 1) / 2;
        const BoardMarker& marker = markers[static_cast<std::size_t>(number)];
        const glm::dvec2 cell = glm::floor((p - marker.middle_mm) / board.marker_mm * 7.0 + 3.5);
        if (cell.x < 0.0 || cell.y < 0.0 || cell.x > 6.0 || cell.y > 6.0) return 0.8;
        if (cell.x < 1.0 || cell.y < 1.0 || cell.x > 5.0 || cell.y > 5.0) return 0.12;
        const auto at = static_cast<std::size_t>(5.0 * (cell.y - 1.0) + cell.x - 1.0);
        return marker_cells(marker.number)[at] ? 0.8 : 0.12;
    };
}

/// A camera of 640 x 512 pixels and a projector of 256 x 192, whose axis lies below its picture,
/// 400 mm apart.
inline BoardScene board_scene(const glm::dvec3& turn,
                              const glm::dvec3& place_mm = {0.0, 0.0, 2000.0}) {
    BoardScene scene;
    scene.camera = {640, 512, {1200, 1205}, {326, 252}, {-0.12, 0.1, 0, 0, 0}, {}};
    scene.projector = {256,
                       192,
                       {470, 472},
                       {129, 210},
                       {-0.05, 0.02, 0, 0, 0},
                       {rotation_of({0.278, -0.2, 0.02}), {400, 60, 40}}};
    const glm::dmat3 r = rotation_of(turn);
    scene.camera_from_board = {r, place_mm - r * glm::dvec3(300, 225, 0)};
    scene.reflectance = chessboard(9, 7, 75.0);
    return scene;
}

/// What one ray of a pixel meets.
struct BoardRay {
    glm::dvec2 board_mm{0.0};
    float reflectance = 0.0f;  ///< mean of its part of the pixel
    float before = -1.0f;
    int column = -1, row = -1;  ///< projector pixel, -1: outside its picture
};

inline constexpr int kBoardRays = 2;  ///< a side of each pixel

inline std::vector<BoardRay> board_rays(const BoardScene& scene) {
    const int width = scene.camera.width * kBoardRays, height = scene.camera.height * kBoardRays;
    const Rigid3 board_from_camera = inverse(scene.camera_from_board);
    std::vector<BoardRay> rays;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::dvec2 pixel((x + 0.5) / kBoardRays, (y + 0.5) / kBoardRays);
            BoardRay& one = rays.emplace_back();
            one.before = static_cast<float>(scene.before(pixel));
            const Ray ray = ray_through(scene.camera, pixel);
            const glm::dvec3 from = board_from_camera * ray.origin;
            const glm::dvec3 along = board_from_camera.rotation * ray.direction;
            const glm::dvec3 place = from - along * (from.z / along.z);
            one.board_mm = {place.x, place.y};
            const auto lit = project(scene.projector, scene.camera_from_board * place);
            if (!lit || lit->x < 0.0 || lit->y < 0.0 || lit->x >= scene.projector.width ||
                lit->y >= scene.projector.height)
                continue;
            one.column = static_cast<int>(lit->x);
            one.row = static_cast<int>(lit->y);
        }
    // Edges to a sixteenth of a pixel: in each ray's part of the board's plane 4 x 4 places more.
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto at = [&](int u, int v) {
                return static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                       static_cast<std::size_t>(u);
            };
            BoardRay& one = rays[at(x, y)];
            const int left = std::min(x, width - 2), top = std::min(y, height - 2);
            const glm::dvec2 across = rays[at(left + 1, y)].board_mm - rays[at(left, y)].board_mm;
            const glm::dvec2 down = rays[at(x, top + 1)].board_mm - rays[at(x, top)].board_mm;
            for (const double v : {-0.375, -0.125, 0.125, 0.375})
                for (const double u : {-0.375, -0.125, 0.125, 0.375})
                    one.reflectance += static_cast<float>(
                        scene.reflectance(one.board_mm + u * across + v * down) / 16.0);
        }
    return rays;
}

/// Each role of geometry_roles(), of one channel.
inline std::vector<RoledPhotograph> photographs_of(const BoardScene& scene) {
    const int width = scene.camera.width, height = scene.camera.height;
    const std::vector<BoardRay> rays = board_rays(scene);
    std::mt19937 random(scene.seed);
    std::normal_distribution<float> noise(0.0f, static_cast<float>(scene.noise));
    std::vector<RoledPhotograph> photographs;
    const auto roles = geometry_roles(scene.projector.width, scene.projector.height);
    for (std::size_t k = 0; k < roles.size(); ++k) {
        const Image8 drive =
            geometry_pattern(scene.projector.width, scene.projector.height, k).drive;
        RoledPhotograph one{roles[k], {}};
        ImageF& image = one.photograph.image = ImageF(width, height, 1);
        one.photograph.name = roles[k];
        for (std::size_t r = 0; r < rays.size(); ++r) {
            const BoardRay& ray = rays[r];
            float light = ray.before;
            if (light < 0.0f) {
                const bool lit = ray.column >= 0 && drive.at(ray.column, ray.row) > 127;
                light = ray.reflectance * (static_cast<float>(scene.ambient) + (lit ? 1.0f : 0.0f));
            }
            const int place = static_cast<int>(r), side = width * kBoardRays;
            image.at(place % side / kBoardRays, place / side / kBoardRays) +=
                light / (kBoardRays * kBoardRays);
        }
        for (float& value : image.values) value += noise(random);
        photographs.push_back(std::move(one));
    }
    return photographs;
}

/// The board in photographs_of() a scene of the usual projector.
inline SightSearch search_board(const std::vector<RoledPhotograph>& photographs,
                                const Board& board) {
    return search_sight(photographs, decode_gray_code(photographs, 256, 192).projector_px, board);
}

}  // namespace livery::testing
