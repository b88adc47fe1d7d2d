// The colour photographs as seen by each projector pixel: linear camera colour per second.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "calibration/correspondence/gray_code.h"
#include "calibration/correspondence/patterns.h"

namespace livery {

/// Variance of one camera value of one photograph: read + shot * colour, per channel.
struct NoiseModel {
    glm::dvec3 read{0.0}, shot{0.0};
    glm::dvec3 variance(glm::dvec3 colour) const {
        return read + shot * glm::max(colour, glm::dvec3(0.0));
    }
};

enum PictureOf : std::size_t { kDark, kBright, kRed, kGreen, kBlue, kLevels, kPictureCount };

struct SampledPicture {
    std::string role;
    int shots = 0;
    std::vector<glm::vec3> colour;  ///< mean of the shots; one a sampled pixel
    double shot_spread = 0.0;       ///< largest relative difference of a shot's mean brightness
};

struct ColourSamples {
    int width = 0, height = 0;
    std::vector<std::uint32_t> pixels;  ///< projector pixels with a place and no edge, rising
    std::vector<float> tap_share;       ///< noise variance of bilinear reading over a pixel's own
    std::vector<std::uint8_t> saturated, finite;  ///< 1 or 0; over all pictures
    std::array<SampledPicture, kPictureCount> pictures;
    std::vector<SampledPicture> mosaics;
    NoiseModel noise;  ///< of one photograph

    /// Noise variance of sample i of a picture.
    glm::dvec3 variance(const SampledPicture& picture, std::size_t i) const {
        return noise.variance(picture.colour[i]) *
               static_cast<double>(tap_share[i] / static_cast<float>(picture.shots));
    }
};

/// Reads all pictures through the map. Throws FileError for missing and unknown roles, unequal
/// sizes, other than three channels; std::invalid_argument when the map and patterns disagree.
ColourSamples sample_colours(const std::vector<RoledPhotograph>& captures,
                             const ProjectorToCamera& map);

/// 1 where a pattern is uniform for `reach` pixels around: the centres of blocks.
std::vector<std::uint8_t> block_centres(const Image8& drive, int reach);

}  // namespace livery
