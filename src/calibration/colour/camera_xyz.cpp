#include "calibration/colour/camera_xyz.h"

#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "core/mutation.h"
#include "core/statistics.h"

namespace livery {
namespace {

constexpr double kLeastBlack = 0.002;  // of white

/// M with M x ~ y, from sums of y x' and x x'.
glm::dmat3 regress(const std::vector<glm::dvec3>& x,
                   const std::vector<glm::dvec3>& y,
                   const std::vector<double>& weight) {
    glm::dmat3 yx(0.0), xx(0.0);
    for (std::size_t i = 0; i < x.size(); ++i) {
        yx += weight[i] * glm::outerProduct(y[i], x[i]);
        xx += weight[i] * glm::outerProduct(x[i], x[i]);
    }
    return LIVERY_MUTATED(camera_matrix_fit, yx * glm::inverse(xx));
}

}  // namespace

CameraPrimaries primaries_at(const ColourSamples& samples,
                             const PixelMixing& mixing,
                             const std::vector<PixelStatus>& status,
                             const glm::dvec3& share_of_channel,
                             const std::optional<glm::dvec2>& place) {
    std::vector<std::size_t> used;
    if (place) {
        for (const double reach : {2.5, 6.5}) {
            for (std::size_t i = 0; i < samples.pixels.size(); ++i) {
                const double dx = static_cast<double>(samples.pixels[i] %
                                                      static_cast<std::uint32_t>(samples.width)) +
                                  0.5 - place->x;
                const double dy = static_cast<double>(samples.pixels[i] /
                                                      static_cast<std::uint32_t>(samples.width)) +
                                  0.5 - place->y;
                if (status[i] == PixelStatus::measured && std::abs(dx) <= reach &&
                    std::abs(dy) <= reach)
                    used.push_back(i);
            }
            if (used.size() >= 4) break;
            used.clear();
        }
        if (used.empty())
            throw Refused(
                "no valid pixel lies where the primaries were measured, projector pixel " +
                    std::to_string(place->x) + ", " + std::to_string(place->y),
                "measure XYZ on a well-lit part of the mock-up that the camera sees");
    } else {
        // Relative scale: pixels of middling brightness
        std::vector<float> spans;
        for (std::size_t i = 0; i < status.size(); ++i)
            if (status[i] == PixelStatus::measured) spans.push_back(mixing.span[i].y);
        const float low = quantile(spans, 0.45), high = quantile(spans, 0.55);
        for (std::size_t i = 0; i < status.size(); ++i)
            if (status[i] == PixelStatus::measured && mixing.span[i].y >= low &&
                mixing.span[i].y <= high)
                used.push_back(i);
    }
    CameraPrimaries primaries;
    for (const std::size_t i : used) {
        const glm::dmat3 vn = glm::inverse(glm::dmat3(mixing.unmixing[i]));
        for (int k = 0; k < 3; ++k)
            primaries.columns[k] +=
                vn[k] * (static_cast<double>(mixing.span[i][k]) * share_of_channel[k]);
        primaries.white += vn * glm::dvec3(mixing.span[i]);
        primaries.black += vn * glm::dvec3(mixing.dark[i]);
    }
    primaries.columns /= static_cast<double>(used.size());
    primaries.white /= static_cast<double>(used.size());
    primaries.black /= static_cast<double>(used.size());
    return primaries;
}

void match_black(const CameraToXyz& measured,
                 const CameraPrimaries& camera,
                 const glm::dmat3& xyz_from_camera,
                 PixelMixing& mixing) {
    const auto brightness = [](glm::dvec3 c) { return c.x + c.y + c.z; };
    // With hardly any light in the dark picture its ratios are noise, and there is nothing to
    // match.
    if (!(brightness(camera.black) > kLeastBlack * brightness(camera.white))) return;
    const glm::dvec3 excess = glm::inverse(xyz_from_camera) * measured.black_xyz - camera.black;
    for (std::size_t i = 0; i < mixing.dark.size(); ++i) {
        const glm::dvec3 black =
            glm::inverse(glm::dmat3(mixing.unmixing[i])) * glm::dvec3(mixing.dark[i]);
        const double share = std::max(0.0, brightness(black) / brightness(camera.black));
        if (!std::isfinite(share)) continue;
        mixing.dark[i] +=
            LIVERY_MUTATED(match_black, mixing.unmixing[i] * glm::vec3(excess * share));
    }
}

glm::dmat3 xyz_from_primaries(const CameraToXyz& measured, const CameraPrimaries& camera) {
    std::vector<glm::dvec3> rgb, xyz;
    std::vector<double> weight;
    for (int k = 0; k < 3; ++k) {
        rgb.push_back(camera.columns[k]);
        xyz.push_back(measured.primaries_xyz[k] - measured.black_xyz);
        weight.push_back(1.0 / glm::dot(rgb.back(), rgb.back()));
    }
    if (!(condition_number(glm::dmat3(xyz[0], xyz[1], xyz[2])) < 1e4))
        throw Refused(
            "the measured XYZ of red, green and blue are not three different colours",
            "check primaries_xyz: each is XYZ of the channel at full drive, black included");
    if (!(condition_number(camera.columns) < 1e4))
        throw Refused("the camera does not tell the projector's three primaries apart",
                      "check that red, green and blue photographs show red, green and blue");
    if (measured.white_xyz) {
        rgb.push_back(camera.white);
        xyz.push_back(*measured.white_xyz - measured.black_xyz);
        // Most of what is shown is nearer to white than to a primary.
        weight.push_back(10.0 / glm::dot(rgb.back(), rgb.back()));
    }
    return regress(rgb, xyz, weight);
}

glm::dmat3 fit_camera_matrix(const std::vector<glm::dvec3>& camera_rgb,
                             const std::vector<glm::dvec3>& xyz) {
    check_argument(camera_rgb.size() == xyz.size() && xyz.size() >= 3,
                   std::to_string(camera_rgb.size()) + " camera colours and " +
                       std::to_string(xyz.size()) +
                       " XYZ given, expected the same count, 3 or more");
    glm::dmat3 spread(0.0);
    std::vector<double> weight;
    for (std::size_t i = 0; i < xyz.size(); ++i) {
        for (int c = 0; c < 3; ++c)
            check_argument(std::isfinite(camera_rgb[i][c]) && std::isfinite(xyz[i][c]),
                           "colour " + std::to_string(i) + " of the chart is not finite");
        // Relative errors count: dark patches are seen as well as bright ones.
        const double size = glm::dot(xyz[i], xyz[i]);
        weight.push_back(1.0 / (size + 1e-4));
        spread += weight.back() * glm::outerProduct(camera_rgb[i], camera_rgb[i]);
    }
    check_argument(condition_number(spread) < 1e8,
                   "the chart's colours do not span three dimensions");
    return regress(camera_rgb, xyz, weight);
}

}  // namespace livery
