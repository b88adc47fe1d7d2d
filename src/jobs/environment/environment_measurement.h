// A folder of photographs of a mirror ball or a panorama -> a map of the light all around.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "calibration/environment/map_figures.h"
#include "calibration/sphere/sphere_outline.h"
#include "core/progress.h"

namespace livery {

struct EnvironmentRequest {
    std::filesystem::path captures;       ///< a folder (docs/measuring.md)
    std::filesystem::path camera_to_xyz;  ///< empty: what the manifest names, if anything
    std::filesystem::path out;            ///< .exr
    std::filesystem::path mask;           ///< .exr that says what was seen; empty: not written
    int width = 1024;                     ///< of the map, twice its height
    /// Of the map for a file unit a second; nothing: such that white that faces where it is
    /// brightest has luminance 1.
    std::optional<double> scale;
    std::optional<glm::dvec3> reflectance;  ///< the ball's, instead of what the manifest says
};

/// One camera's photographs.
struct EnvironmentView {
    std::size_t photographs = 0;
    std::optional<Sphere> ball;           ///< where it was taken to stand; none: a panorama
    std::optional<OutlineFit> outline;    ///< where its outline was fitted
    std::optional<double> correction_mm;  ///< from the manifest's centre to the fitted one
    double hidden_rad = 0.0;              ///< half the angle of the cone that the ball hides
    Coverage coverage;
};

struct EnvironmentMeasurement {
    RadianceMap map;  ///< scaled, filled
    std::vector<EnvironmentView> views;
    Coverage coverage;
    double filled = 0.0;  ///< share of all directions
    double scale = 1.0;   ///< of the map for a file unit a second
    double dynamic_range_stops = 0.0;
    double mean_luminance = 0.0;
    std::size_t saturated_texels = 0;
    std::vector<ClippedLamp> clipped;
    double marks_residual_rad = 0.0;  ///< of a panorama turned by marks
    glm::dvec3 reflectance{1.0};
    std::string camera_colours;  ///< where the colours come from: "matrix", "assumed Rec.709"
    std::vector<std::string> notes;
};

/// Writes the map, linear Rec.709, and the mask. Throws FileError, Refused, std::invalid_argument
/// (a name that does not end in .exr, a width), Cancelled.
EnvironmentMeasurement measure_environment(const EnvironmentRequest& request,
                                           const Progress& progress = {});

}  // namespace livery
