#include "radiance/light/spiral.h"

#include <cmath>

#include "core/random.h"

namespace livery {

Basis basis_around(const glm::vec3& n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

double turn_of_fragment_rad(std::size_t fragment, std::uint32_t purpose, std::uint32_t salt) {
    return 2.0 * std::numbers::pi *
           (hash_3d(static_cast<std::uint32_t>(fragment), purpose, salt) * 0x1p-32);
}

void turn_around(std::span<const glm::vec3> points,
                 const glm::vec3& axis,
                 const Basis& basis,
                 double turn_rad,
                 std::span<glm::vec3> directions) {
    const auto c = static_cast<float>(std::cos(turn_rad));
    const auto s = static_cast<float>(std::sin(turn_rad));
    const glm::vec3 x = c * basis.s + s * basis.t, y = c * basis.t - s * basis.s;
    for (std::size_t k = 0; k < points.size(); ++k) {
        directions[k] = points[k].x * x + points[k].y * y + points[k].z * axis;
    }
}

}  // namespace livery
