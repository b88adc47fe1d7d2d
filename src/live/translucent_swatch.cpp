#include "live/translucent_swatch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "appearance/subsurface/exact_totals.h"
#include "appearance/subsurface/translucent_material.h"
#include "core/colour.h"
#include "core/error.h"

namespace livery {

namespace {

/// What absorbs nothing sends T + R = 1 of them: neither end of its wedge may burn out.
constexpr double kBehind = 0.75, kInFront = 0.25;
constexpr std::size_t kThicknesses = 13;
constexpr double kSphereShare = 0.96;  ///< of the square, as the spheres of other paints

/// Linear Rec.709 at thicknesses in equal ratios.
std::array<glm::dvec3, kThicknesses> wedge_of(const TranslucentMaterial& material) {
    std::array<glm::dvec3, kThicknesses> wedge{};
    for (std::size_t k = 0; k < kThicknesses; ++k) {
        const double share = static_cast<double>(k) / (kThicknesses - 1.0);
        for (int c = 0; c < 3; ++c) {
            ScatteringMedium medium = medium_of(material, c);
            medium.thickness_mm =
                kThinnestWedge_mm * std::pow(kThickestWedge_mm / kThinnestWedge_mm, share);
            const DiffuseTotals totals = exact_totals(medium);
            const UnscatteredLight straight = unscattered_light(medium);
            wedge[k][c] = kBehind * (totals.transmittance + straight.transmitted) +
                          kInFront * (totals.reflectance + straight.reflected);
        }
    }
    return wedge;
}

}  // namespace

Image8 translucent_swatch(const Material& translucent, int size_px) {
    check_argument(translucent.model == ReflectanceModel::translucent && translucent.medium,
                   fmt::format("paint '{}' is not translucent", translucent.name));
    const auto wedge = wedge_of(*translucent.medium);
    Image8 swatch(size_px, size_px, 4);
    const double middle = 0.5 * size_px, radius = kSphereShare * middle;
    for (int y = 0; y < size_px; ++y) {
        for (int x = 0; x < size_px; ++x) {
            const double across = x + 0.5 - middle, down = y + 0.5 - middle;
            const double inside = radius - std::hypot(across, down) + 0.5;
            const double place = std::clamp(0.5 + 0.5 * across / radius, 0.0, 1.0) *
                                 static_cast<double>(kThicknesses - 1);
            const auto below = std::min(static_cast<std::size_t>(place), kThicknesses - 2);
            const glm::dvec3 colour =
                glm::mix(wedge[below], wedge[below + 1], place - static_cast<double>(below));
            std::uint8_t* pixel = swatch.pixel(x, y);
            for (int c = 0; c < 3; ++c) {
                pixel[c] = static_cast<std::uint8_t>(
                    std::lround(255.0 * srgb_encode(std::clamp(colour[c], 0.0, 1.0))));
            }
            pixel[3] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(inside, 0.0, 1.0)));
        }
    }
    return swatch;
}

}  // namespace livery
