// MERL tables made from a formula, independently of the code that reads them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <string>

#include <glm/vec3.hpp>

namespace livery {

/// The directions at half and difference angles: the half vector in the plane of x and z.
struct HalfDifferencePair {
    glm::dvec3 wi, wo;
};
inline HalfDifferencePair pair_from_angles(double theta_h, double theta_d, double phi_d) {
    const glm::dvec3 h(std::sin(theta_h), 0.0, std::cos(theta_h));
    const glm::dvec3 t(std::cos(theta_h), 0.0, -std::sin(theta_h));
    const glm::dvec3 b(0.0, 1.0, 0.0);
    const glm::dvec3 across = std::sin(theta_d) * (std::cos(phi_d) * t + std::sin(phi_d) * b);
    return {std::cos(theta_d) * h + across, std::cos(theta_d) * h - across};
}

/// A file's bytes: value(wi, wo) in linear Rec.709 at each bin's middle, -1 below the horizon.
template <typename Value>
std::string merl_bytes(const Value& value) {
    constexpr std::size_t kBins = 90 * 90 * 180;
    const std::array<double, 3> per_unit{1500.0, 1500.0 / 1.15, 1500.0 / 1.66};
    std::string bytes(12 + 24 * kBins, '\0');
    const std::array<std::int32_t, 3> header{90, 90, 180};
    std::memcpy(bytes.data(), header.data(), 12);
    for (int h = 0; h < 90; ++h) {
        for (int d = 0; d < 90; ++d) {
            for (int p = 0; p < 180; ++p) {
                const double root = (h + 0.5) / 90.0;
                const auto [wi, wo] = pair_from_angles(0.5 * std::numbers::pi * root * root,
                                                       std::numbers::pi * (d + 0.5) / 180.0,
                                                       std::numbers::pi * (p + 0.5) / 180.0);
                const bool above = wi.z > 0.0 && wo.z > 0.0;
                const glm::dvec3 rgb = above ? glm::dvec3(value(wi, wo)) : glm::dvec3(-1.0);
                const auto bin = static_cast<std::size_t>(p + 180 * (d + 90 * h));
                for (std::size_t c = 0; c < 3; ++c) {
                    const double raw =
                        above ? rgb[static_cast<glm::length_t>(c)] * per_unit[c] : -1.0;
                    std::memcpy(bytes.data() + 12 + 8 * (bin + c * kBins), &raw, 8);
                }
            }
        }
    }
    return bytes;
}

}  // namespace livery
