// Photographs of still light on a simulated stand, as files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <glm/mat3x3.hpp>

#include "core/image.h"
#include "core/json.h"
#include "twin/description.h"

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

}  // namespace livery
