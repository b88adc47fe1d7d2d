#include "jobs/picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/colour.h"
#include "core/error.h"

namespace livery {

namespace {

std::uint8_t byte_of(double value) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
}

/// byte_of(srgb_encode(value)) by table: the byte of each of kSteps equal steps of [0, 1], and
/// where the bytes change. A step holds at most one change: the curve rises by 12.92 x 255 a unit
/// at most.
class SrgbBytes {
  public:
    SrgbBytes() {
        for (int k = 0; k < 256; ++k) from_[static_cast<std::size_t>(k)] = first_of(k);
        int byte = 0;
        for (int step = 0; step <= kSteps; ++step) {
            while (byte < 255 && from_[static_cast<std::size_t>(byte) + 1] * kSteps <= step) ++byte;
            bytes_[static_cast<std::size_t>(step)] = static_cast<std::uint8_t>(byte);
        }
    }
    std::uint8_t operator()(double value) const {
        const double clipped = value > 0.0 ? std::min(value, 1.0) : 0.0;
        const std::size_t byte = bytes_[static_cast<std::size_t>(clipped * kSteps)];
        const bool next = byte < 255 && clipped >= from_[byte + 1];
        return static_cast<std::uint8_t>(byte + (next ? 1 : 0));
    }

  private:
    static constexpr int kSteps = 4096;
    /// The smallest value that becomes byte k, by halving.
    static double first_of(int k) {
        if (k == 0) return 0.0;
        double below = 0.0, above = 1.0;
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (below + above);
            (byte_of(srgb_encode(middle)) >= k ? above : below) = middle;
        }
        return above;
    }
    std::array<double, 256> from_{};
    std::array<std::uint8_t, kSteps + 1> bytes_{};
};

/// Any linear picture through `rec709_from_source` into sRGB bytes.
void encode_srgb(const ImageF& source, const glm::dmat3& rec709_from_source, Image8* result) {
    static const SrgbBytes bytes;
    check_argument(source.channels >= 3, "srgb pictures need three channels");
    if (result->width != source.width || result->height != source.height || result->channels != 3) {
        *result = Image8(source.width, source.height, 3);
    }
    for (std::size_t i = 0; i < source.pixel_count(); ++i) {
        const float* v = source.values.data() + i * static_cast<std::size_t>(source.channels);
        std::uint8_t* out = result->values.data() + 3 * i;
        if (v[0] == 0.0f && v[1] == 0.0f && v[2] == 0.0f) {
            std::fill(out, out + 3, std::uint8_t{0});
            continue;
        }
        const glm::dvec3 rgb = rec709_from_source * glm::dvec3(v[0], v[1], v[2]);
        for (int c = 0; c < 3; ++c) out[c] = bytes(rgb[c]);
    }
}

/// Dark violet over red and orange to pale yellow, lightness rising evenly: its stops are Oklab
/// L = .25 .40 .55 .70 .85 .97 at hues that turn from violet to yellow.
std::array<std::uint8_t, 3> ramp(double t) {
    static const std::array<glm::dvec3, 6> stops = {glm::dvec3(0.25, 0.03, -0.10),
                                                    glm::dvec3(0.40, 0.12, -0.06),
                                                    glm::dvec3(0.55, 0.18, 0.04),
                                                    glm::dvec3(0.70, 0.12, 0.13),
                                                    glm::dvec3(0.85, 0.02, 0.15),
                                                    glm::dvec3(0.97, -0.02, 0.08)};
    const double place = std::clamp(t, 0.0, 1.0) * (stops.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    const double f = place - static_cast<double>(i);
    const glm::dvec3 rgb =
        rec709_from_xyz() * xyz_from_oklab((1.0 - f) * stops[i] + f * stops[i + 1]);
    std::array<std::uint8_t, 3> bytes{};
    for (int c = 0; c < 3; ++c) {
        bytes[static_cast<std::size_t>(c)] = byte_of(srgb_encode(std::clamp(rgb[c], 0.0, 1.0)));
    }
    return bytes;
}

}  // namespace

PixelRectangle bounds_of_mask(const Image8& mask, int margin_px) {
    PixelRectangle box{mask.width, mask.height, 0, 0};
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            if (!mask.at(x, y)) continue;
            box = {std::min(box.left, x),
                   std::min(box.top, y),
                   std::max(box.right, x + 1),
                   std::max(box.bottom, y + 1)};
        }
    }
    if (box.right <= box.left) return {0, 0, mask.width, mask.height};
    return {std::max(0, box.left - margin_px),
            std::max(0, box.top - margin_px),
            std::min(mask.width, box.right + margin_px),
            std::min(mask.height, box.bottom + margin_px)};
}

ImageF developed(const Photograph& photograph, const glm::dmat3& xyz_from_camera) {
    ImageF xyz(photograph.image.width, photograph.image.height, 3);
    for (std::size_t i = 0; i < xyz.pixel_count(); ++i) {
        glm::dvec3 camera;
        for (int c = 0; c < 3; ++c) {
            camera[c] = linear_from_file_units(
                photograph,
                static_cast<double>(photograph.image.values[3 * i + static_cast<std::size_t>(c)]));
        }
        const glm::dvec3 value = xyz_from_camera * camera;
        for (int c = 0; c < 3; ++c) {
            xyz.values[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(value[c]);
        }
    }
    return xyz;
}

Image8 srgb_from_xyz(const ImageF& xyz, double white_y) {
    Image8 result;
    encode_srgb(xyz, rec709_from_xyz() * (1.0 / white_y), &result);
    return result;
}

Image8 srgb_from_working(const ImageF& working) {
    Image8 result;
    srgb_from_working_into(working, &result);
    return result;
}

void srgb_from_working_into(const ImageF& working, Image8* srgb) {
    encode_srgb(working, rec709_from_working(), srgb);
}

Image8 difference_map(const ImageF& de00, double full_scale) {
    Image8 result(de00.width, de00.height, 3, 96);
    for (std::size_t i = 0; i < de00.pixel_count(); ++i) {
        if (!std::isfinite(de00.values[i])) continue;
        const auto colour = ramp(static_cast<double>(de00.values[i]) / full_scale);
        std::copy(colour.begin(),
                  colour.end(),
                  result.values.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return result;
}

Image8 difference_legend(int width, int height) {
    ImageF values(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            values.at(x, y) = static_cast<float>(x) / static_cast<float>(std::max(1, width - 1));
        }
    }
    return difference_map(values, 1.0);
}

}  // namespace livery
