#include "live/vote_frames.h"

#include <cstddef>

#include "core/colour.h"
#include "core/error.h"
#include "jobs/comparison.h"

namespace livery {

namespace {

void check_channels(const ImageF& wanted) {
    check_argument(wanted.channels == 4,
                   "a look's picture: found " + std::to_string(wanted.channels) +
                       " channels, expected R, G, B and coverage");
}

bool is_covered(const ImageF& wanted, std::size_t pixel) {
    return wanted.values[4 * pixel + 3] >= 0.5f;
}

}  // namespace

double mean_luminance(const ImageF& wanted) {
    check_channels(wanted);
    const glm::dmat3& xyz = xyz_from_working();
    double sum = 0.0;
    std::size_t covered = 0;
    for (std::size_t i = 0; i < wanted.pixel_count(); ++i) {
        if (!is_covered(wanted, i)) continue;
        const float* rgb = &wanted.values[4 * i];
        for (int c = 0; c < 3; ++c) sum += xyz[c][1] * static_cast<double>(rgb[c]);
        ++covered;
    }
    return covered == 0 ? 0.0 : sum / static_cast<double>(covered);
}

Image8 neutral_drive(const ImageF& wanted, double luminance, const ProjectorSetup& setup) {
    check_channels(wanted);
    // White is 1, 1, 1 in the working space, so grey is its luminance in each channel.
    const auto level = static_cast<float>(luminance);
    ImageF grey(wanted.width, wanted.height, 4);
    for (std::size_t i = 0; i < wanted.pixel_count(); ++i) {
        if (!is_covered(wanted, i)) continue;
        float* to = &grey.values[4 * i];
        to[0] = to[1] = to[2] = level;
        to[3] = wanted.values[4 * i + 3];
    }
    return setup.table ? compensate(*setup.table, grey) : srgb_from_working(grey);
}

std::optional<PictureReach> reach_of(const ImageF& wanted,
                                     const Image8& drive,
                                     const ProjectorSetup& setup) {
    if (!setup.table) return std::nullopt;
    const PictureReach reach = reach_of(*setup.table, wanted, drive);
    return reach.pixels > 0 ? std::optional(reach) : std::nullopt;
}

}  // namespace livery
