#include "live/capture_findings.h"

#include <algorithm>
#include <array>

#include "core/pictures/white_balance.h"
#include "live/capture_pictures.h"
#include "scene/mockup_mask.h"

namespace livery {

namespace {

constexpr std::array<std::uint8_t, 3> kOutline{255, 150, 40}, kMeasured{70, 150, 90},
    kPredicted{80, 120, 190}, kMissing{200, 60, 50};

void paint(Image8& picture, int x, int y, const std::array<std::uint8_t, 3>& colour) {
    for (int c = 0; c < 3; ++c) picture.at(x, y, c) = colour[static_cast<std::size_t>(c)];
}

}  // namespace

Image8 outline_on_photograph(const Photograph& photograph,
                             const View& camera,
                             const Mesh& mesh,
                             int width) {
    Image8 picture = small_photograph(photograph, width, white_balance(photograph));
    const Image8 inside = mockup_mask(mesh, resized(camera, picture.width, picture.height));
    for (int y = 1; y < picture.height; ++y)
        for (int x = 1; x < picture.width; ++x) {
            const bool here = inside.at(x, y) != 0;
            if (here != (inside.at(x - 1, y) != 0) || here != (inside.at(x, y - 1) != 0))
                paint(picture, x, y, kOutline);
        }
    return picture;
}

Image8 status_picture(const ColourCalibration& calibration, const Image8& mockup, int width) {
    Image8 picture(calibration.width, calibration.height, 3, 24);
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const auto status = static_cast<PixelStatus>(calibration.status.at(x, y));
            if (status == PixelStatus::predicted) {
                paint(picture, x, y, kPredicted);
            } else if (is_valid(status)) {
                paint(picture, x, y, kMeasured);
            } else if (!mockup.empty() && mockup.at(x, y)) {
                paint(picture, x, y, kMissing);
            }
        }
    return small_picture(picture, width);
}

}  // namespace livery
