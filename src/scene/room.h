// Where projector, camera and mock-up were found to stand, with what that is worth, and its file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/view.h"

namespace livery {

struct RoomGeometry {
    View projector, camera;  ///< world: the product's frame
    /// Of the pair by itself: distance of what is seen from its epipolar line, camera pixels, and
    /// the share of pixels that keep to it.
    double pair_median_px = 0.0, pair_inlier_share = 0.0;
    /// Of the mock-up's pixels against its mesh, in projector pixels and on the mock-up.
    double median_px = 0.0, rms_px = 0.0, rms_mm = 0.0;
    std::size_t inliers = 0, correspondences = 0;
    double agreement = 0.0;  ///< share of the mesh's pixels where the scan has a point
    /// How many turns the product leaves open (0, 1 about an axis, 3 about a point), and through
    /// where.
    int free_turns = 0;
    glm::dvec3 turns_through_mm{0.0};
    std::vector<std::string> warnings;
    std::string made_of;  ///< hash of all that it follows from

    bool operator==(const RoomGeometry&) const = default;
};

/// `room.json`. Throws FileError.
RoomGeometry read_room_file(const std::filesystem::path& file);
/// The same of its text.
RoomGeometry parse_room(const std::string& text, const std::filesystem::path& file);
void write_room_file(const std::filesystem::path& file, const RoomGeometry& room);

}  // namespace livery
