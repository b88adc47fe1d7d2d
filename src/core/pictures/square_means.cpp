#include "core/pictures/square_means.h"

#include "core/error.h"

namespace livery {

ImageF square_means(const ImageF& picture, int side_px) {
    check_argument(
        picture.channels == 4 && side_px > 0,
        "square_means: a picture with coverage and squares of a pixel or more are needed");
    if (side_px == 1) return picture;
    ImageF means(picture.width / side_px, picture.height / side_px, 4);
    for (int y = 0; y < means.height * side_px; ++y) {
        for (int x = 0; x < means.width * side_px; ++x) {
            const float coverage = picture.at(x, y, 3);
            if (coverage == 0.0f) continue;
            for (int c = 0; c < 3; ++c) {
                means.at(x / side_px, y / side_px, c) += coverage * picture.at(x, y, c);
            }
            means.at(x / side_px, y / side_px, 3) += coverage;
        }
    }
    for (std::size_t i = 0; i < means.values.size(); i += 4) {
        float* mean = &means.values[i];
        for (int c = 0; c < 3 && mean[3] > 0.0f; ++c) mean[c] /= mean[3];
        mean[3] /= static_cast<float>(side_px * side_px);
    }
    return means;
}

}  // namespace livery
