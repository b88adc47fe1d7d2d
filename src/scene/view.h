// Where a camera or a projector stands and how its lens maps the world to pixels. A projector is a
// camera run backwards: the same type serves both.
#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace livery {

/// x_target = rotation * x_source + translation; name variables target_from_source.
struct Rigid3 {
    glm::dmat3 rotation{1.0};
    glm::dvec3 translation{0.0};

    bool operator==(const Rigid3&) const = default;
    glm::dvec3 operator*(const glm::dvec3& x_in_source) const {
        return rotation * x_in_source + translation;
    }
};
/// c_from_b * b_from_a = c_from_a.
Rigid3 operator*(const Rigid3& c_from_b, const Rigid3& b_from_a);
Rigid3 inverse(const Rigid3& target_from_source);

/// Pinhole with Brown-Conrady distortion (k1, k2, p1, p2, k3 as in OpenCV). The view's frame is
/// OpenCV's: x right, y down, z forward, millimetres. Pixel centres are at half integers, rows go
/// down: principal points are half a pixel larger than in OpenCV's files. Lens shift is a
/// principal point far from the middle, even outside the picture.
struct View {
    int width = 0;
    int height = 0;
    glm::dvec2 focal_px{1.0};
    glm::dvec2 principal_px{0.0};
    std::array<double, 5> distortion{};
    Rigid3 view_from_world;

    bool operator==(const View&) const = default;
};

struct Ray {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 0.0, 1.0};  ///< unit length
};

/// Pixel of a world point; nothing behind the view or beyond the radius where the distortion
/// polynomial stops being monotone. May lie outside the picture.
std::optional<glm::dvec2> project(const View& view, const glm::dvec3& x_in_world);

/// The ray through a pixel, lens distortion undone (Newton, to 1e-10 px or throws).
Ray ray_through(const View& view, const glm::dvec2& pixel);
/// The same; nothing where a lens that somebody guessed sends no ray to the pixel.
std::optional<Ray> find_ray(const View& view, const glm::dvec2& pixel);

/// Where the view stands, in the world.
glm::dvec3 centre_in_world(const View& view);

/// A view at `from` that looks at `at`, world y up, with a vertical field of view.
View look_at(glm::dvec3 from, glm::dvec3 at, double vertical_fov_rad, int width, int height);

/// The same lens and pose with other pixels.
View resized(const View& view, int width, int height);

/// A rectangle of the same picture, with the same lens, pose and scale.
View cropped(const View& view, int left, int top, int width, int height);

/// Camera file (docs/files.md). Converts OpenCV's pixel centres at integers. Throws FileError.
View read_camera_file(const std::filesystem::path& file);
/// The same of its text.
View parse_camera(const std::string& text, const std::filesystem::path& file);
void write_camera_file(const std::filesystem::path& file, const View& view);

}  // namespace livery
