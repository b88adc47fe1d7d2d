#include "evaluation/report/report_pictures.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/image_io.h"

namespace livery {

Image8 read_report_picture(const std::filesystem::path& file, int widest) {
    const ImageFile read = read_image(file);
    if (read.floating_point) {
        throw FileError(file, "", "floating-point values", "a picture to look at, such as a PNG");
    }
    const ImageF& image = read.image;
    const int width = std::min(image.width, widest);
    const int height = std::max(
        1, static_cast<int>(std::lround(static_cast<double>(image.height) * width / image.width)));
    Image8 small(width, height, 3);
    // The mean over what each pixel covers, of the values as they are: for thumbnails good enough.
    const auto bounds = [](int at, int count, int of) {
        const auto from = static_cast<int>(static_cast<std::int64_t>(at) * of / count);
        const auto to = static_cast<int>(static_cast<std::int64_t>(at + 1) * of / count);
        return std::pair{from, std::max(from + 1, to)};
    };
    for (int y = 0; y < height; ++y) {
        const auto [top, bottom] = bounds(y, height, image.height);
        for (int x = 0; x < width; ++x) {
            const auto [left, right] = bounds(x, width, image.width);
            for (int c = 0; c < 3; ++c) {
                const int channel = image.channels >= 3 ? c : 0;
                double sum = 0.0;
                for (int row = top; row < bottom; ++row) {
                    for (int column = left; column < right; ++column) {
                        sum += static_cast<double>(image.at(column, row, channel));
                    }
                }
                const double mean = sum / ((bottom - top) * (right - left)) / read.full_scale;
                small.at(x, y, c) =
                    static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(mean, 0.0, 1.0)));
            }
        }
    }
    return small;
}

}  // namespace livery
