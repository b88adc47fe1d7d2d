// Photographs taken on the simulated bench and stands, as folders for anybody: patterns, a painted
// sphere, a mirror ball, a spot of light.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <glm/mat3x3.hpp>

#include "appearance/material.h"
#include "core/image.h"
#include "core/json.h"
#include "core/progress.h"
#include "twin/description.h"
#include "twin/sphere_stand.h"
#include "twin/spot_stand.h"

namespace livery {

/// Exposures, each at most 8 times the one before: the shortest such that the brightest pixel is at
/// 80% of full scale, the longest such that half of what is lit passes the middle of it.
/// `units_per_s`: light, file units a second.
std::vector<double> bracket_s(const CameraDescription& camera, const ImageF& units_per_s);

class Photographer {
  public:
    Photographer(std::filesystem::path out, std::uint64_t seed);

    /// Takes and writes one photograph, 000.png and so on; what a manifest says of it: file and
    /// exposure_s. Throws FileError.
    Json take(const CameraDescription& camera, const ImageF& units_per_s, double exposure_s);
    std::size_t taken() const { return taken_; }

  private:
    template <typename Picture>
    void write(const std::string& name, Picture picture, const ImageF& file) const;

    std::filesystem::path out_;
    std::uint64_t seed_;
    std::uint32_t taken_ = 0;
};

/// What a manifest says of all photographs of such a camera: transfer, black_level, saturates_at.
void describe_encoding(const CameraDescription& camera, Json& manifest);

/// Writes camera-to-xyz.json: the matrix of a camera that tells colours as an observer does.
void write_camera_matrix(const std::filesystem::path& out, const glm::dmat3& camera_from_working);

struct SimulatedCapturesRequest {
    BenchDescription bench;
    std::filesystem::path patterns;  ///< folder written by `livery patterns`
    std::filesystem::path out;
    double exposure_s = 0.0;  ///< 0: as the bench meters
};

struct SimulatedCaptures {
    std::size_t photographs = 0;
    double exposure_s = 0.0;
};

/// Writes 000.exr, ... with manifest.json, the colorimeter's readings as camera-to-xyz.json
/// and the projector's view as projector.json.
SimulatedCaptures photograph_patterns(const SimulatedCapturesRequest& request,
                                      const Progress& progress = {});

struct SimulatedSphereRequest {
    SphereStand stand;
    Material paint;
    std::filesystem::path out;
    std::uint64_t seed = 1;
};

struct SimulatedSphere {
    std::size_t photographs = 0, lamps = 0;
};

/// Writes 000.png, ... with manifest.json: under each lamp from two exposures on, the shortest such
/// that nothing clips, the longest such that half of what is lit passes the middle of the scale;
/// then one of a white sphere in the same place.
SimulatedSphere photograph_sphere(const SimulatedSphereRequest& request,
                                  const Progress& progress = {});

struct SimulatedBallRequest {
    MirrorBallStand stand;
    LightFrom light_from;
    std::filesystem::path out;
    std::uint64_t seed = 1;
    int samples_a_side = 6;           ///< rays a pixel, squared
    std::vector<double> exposures_s;  ///< of every camera; empty: as its light asks for
};

struct SimulatedBall {
    std::size_t photographs = 0, cameras = 0;
};

/// Writes 000.png, ... with manifest.json and a camera file for each camera.
SimulatedBall photograph_ball(const SimulatedBallRequest& request, const Progress& progress = {});

struct SimulatedSpotRequest {
    SpotStand stand;
    std::filesystem::path out;
    std::uint64_t seed = 1;  ///< of the photographs' noise
};

struct SimulatedSpot {
    std::size_t photographs = 0;
};

/// Writes 000.png, ... with manifest.json and camera.json: sample and white, each with the spot and
/// without, in two exposures or more.
SimulatedSpot photograph_spot(const SimulatedSpotRequest& request, const Progress& progress = {});

}  // namespace livery
