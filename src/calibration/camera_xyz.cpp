#include "calibration/camera_xyz.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"

namespace livery {
namespace {

/// M with M x ~ y, from sums of y x' and x x'.
glm::dmat3 regress(const std::vector<glm::dvec3>& x,
                   const std::vector<glm::dvec3>& y,
                   const std::vector<double>& weight) {
    glm::dmat3 yx(0.0), xx(0.0);
    for (std::size_t i = 0; i < x.size(); ++i) {
        yx += weight[i] * glm::outerProduct(y[i], x[i]);
        xx += weight[i] * glm::outerProduct(x[i], x[i]);
    }
    return yx * glm::inverse(xx);
}

}  // namespace

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
