#include "calibration/correspondence/gray_code.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "calibration/support/messages.h"
#include "calibration/support/synthetic_bench.h"
#include "core/error.h"
#include "core/worst_error.h"

namespace livery {
namespace {

using testing::SyntheticBench;

SyntheticBench small_bench() {
    SyntheticBench bench;
    bench.projector_width = 160;
    bench.projector_height = 100;
    bench.camera_width = 210;
    bench.camera_height = 140;
    return bench;
}

CameraToProjector decode(SyntheticBench& bench) {
    return decode_gray_code(
        bench.photograph_all(geometry_patterns(bench.projector_width, bench.projector_height)),
        bench.projector_width,
        bench.projector_height);
}

TEST(DecodeGrayCode, GivesTheProjectorPixelOfEveryLitCameraPixelExactly) {
    SyntheticBench bench = small_bench();
    const CameraToProjector result = decode(bench);
    int lit = 0;
    for (int y = 0; y < bench.camera_height; ++y)
        for (int x = 0; x < bench.camera_width; ++x) {
            const auto p = *bench.projector_from_camera({x + 0.5, y + 0.5});
            const bool inside = p.x >= 0 && p.y >= 0 && p.x < 160 && p.y < 100;
            ASSERT_EQ(result.decoded.at(x, y) == 255, inside) << x << ", " << y;
            if (!inside) {
                EXPECT_TRUE(std::isnan(result.projector_px.at(x, y, 0)));
                continue;
            }
            ++lit;
            ASSERT_EQ(result.projector_px.at(x, y, 0), std::floor(p.x) + 0.5);
            ASSERT_EQ(result.projector_px.at(x, y, 1), std::floor(p.y) + 0.5);
        }
    EXPECT_DOUBLE_EQ(result.decoded_fraction, 1.0);
    EXPECT_NEAR(result.lit_fraction, lit / (210.0 * 140.0), 1e-12);
}

TEST(DecodeGrayCode, TakesEightSixteenBitAndFloatPicturesAlike) {
    // 37 x 31 pixels: not a multiple of the block, so that the tail is tested too
    SyntheticBench bench = small_bench();
    bench.camera_width = 37;
    bench.camera_height = 31;
    bench.projector_from_camera = [](glm::dvec2 c) -> std::optional<glm::dvec2> {
        return glm::dvec2(4.0 * c.x, 3.0 * c.y);
    };
    std::vector<Image8> in8;
    std::vector<Image16> in16;
    std::vector<ImageF> in_float;
    for (const Pattern& pattern : geometry_patterns(160, 100)) {
        Image8 a(37, 31, 1);
        Image16 b(37, 31, 1);
        ImageF c(37, 31, 1);
        const ImageF photo = bench.photograph(pattern.drive).image;
        for (std::size_t i = 0; i < a.values.size(); ++i) {
            a.values[i] = static_cast<std::uint8_t>(photo.values[3 * i] / 80.0f);
            b.values[i] = static_cast<std::uint16_t>(photo.values[3 * i]);
            c.values[i] = photo.values[3 * i];
        }
        in8.push_back(a);
        in16.push_back(b);
        in_float.push_back(c);
    }
    const auto from8 = decode_gray_code(std::span<const Image8>(in8), 160, 100);
    const auto from16 = decode_gray_code(std::span<const Image16>(in16), 160, 100);
    const auto from_float = decode_gray_code(std::span<const ImageF>(in_float), 160, 100);
    EXPECT_EQ(from8.decoded.values, from16.decoded.values);
    EXPECT_EQ(from8.decoded.values, from_float.decoded.values);
    EXPECT_GT(from8.decoded_fraction, 0.99);
    for (std::size_t i = 0; i < from8.decoded.values.size(); ++i) {
        if (!from8.decoded.values[i]) continue;
        ASSERT_EQ(from8.projector_px.values[2 * i], from16.projector_px.values[2 * i]);
        ASSERT_EQ(from8.projector_px.values[2 * i + 1], from_float.projector_px.values[2 * i + 1]);
    }
}

TEST(DecodeGrayCode, LeavesOutWhatNoiseHides) {
    // Left half lit at full, right half 3000 times dimmer: under the noise of 6 units.
    SyntheticBench bench = small_bench();
    bench.read_noise = 6.0;
    bench.scale = [](glm::dvec2 p) { return p.x < 80 ? 1.0 : 1.0 / 3000.0; };
    const CameraToProjector result = decode(bench);
    int wrong = 0, dark_decoded = 0, bright = 0;
    for (int y = 2; y < 120; ++y)
        for (int x = 8; x < 200; ++x) {
            const auto p = *bench.projector_from_camera({x + 0.5, y + 0.5});
            if (p.x < 0 || p.y < 0 || p.x >= 160 || p.y >= 100) continue;
            if (p.x >= 81) {
                dark_decoded += result.decoded.at(x, y) == 255;
            } else if (p.x < 79) {
                ++bright;
                wrong += result.decoded.at(x, y) != 255 ||
                         std::abs(result.projector_px.at(x, y, 0) - p.x) > 1.0;
            }
        }
    EXPECT_GT(bright, 5000);
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(dark_decoded, 0);
}

TEST(DecodeGrayCode, LeavesOutPixelsLitOnlyByOtherParts) {
    // Light from everywhere: every stripe picture gives half of the white one.
    SyntheticBench bench = small_bench();
    auto captures = bench.photograph_all(geometry_patterns(160, 100));
    for (RoledPhotograph& capture : captures) {
        const double share = capture.role == "white" ? 1.0 : capture.role == "black" ? 0.0 : 0.5;
        for (int y = 60; y < 80; ++y)
            for (int x = 100; x < 130; ++x)
                for (int c = 0; c < 3; ++c)
                    capture.photograph.image.at(x, y, c) =
                        static_cast<float>(256.0 + 2000.0 * share + 3.0 * bench.random.normal());
    }
    const CameraToProjector result = decode_gray_code(captures, 160, 100);
    int decoded = 0;
    for (int y = 60; y < 80; ++y)
        for (int x = 100; x < 130; ++x) decoded += result.decoded.at(x, y) == 255;
    EXPECT_EQ(decoded, 0);
}

TEST(DecodeGrayCode, PutsOtherExposuresOnOneScale) {
    SyntheticBench bench = small_bench();
    auto captures = bench.photograph_all(geometry_patterns(160, 100));
    for (std::size_t i = 0; i < captures.size(); i += 3)
        for (float& value : captures[i].photograph.image.values)
            value = 256.0f + (value - 256.0f) * 0.5f;
    for (std::size_t i = 0; i < captures.size(); i += 3) captures[i].photograph.exposure_s *= 0.5;
    EXPECT_DOUBLE_EQ(decode_gray_code(captures, 160, 100).decoded_fraction, 1.0);
}

TEST(DecodeGrayCode, NaNIsNotDecoded) {
    SyntheticBench bench = small_bench();
    auto captures = bench.photograph_all(geometry_patterns(160, 100));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    captures[4].photograph.image.at(100, 70, 1) = nan;                    // a stripe
    captures[captures.size() - 2].photograph.image.at(101, 70, 0) = nan;  // white
    captures[captures.size() - 1].photograph.image.at(102, 70, 2) = nan;  // black
    const CameraToProjector result = decode_gray_code(captures, 160, 100);
    for (int x = 100; x < 103; ++x) {
        EXPECT_EQ(result.decoded.at(x, 70), 0) << x;
        EXPECT_TRUE(std::isnan(result.projector_px.at(x, 70, 0)));
    }
    EXPECT_EQ(result.decoded.at(99, 70), 255);
}

TEST(DecodeGrayCode, BadCapturesAreNamed) {
    SyntheticBench bench = small_bench();
    const auto good = bench.photograph_all(geometry_patterns(160, 100));
    const auto decode_changed = [&](auto change, int width = 160, int height = 100) {
        auto captures = good;
        change(captures);
        decode_gray_code(captures, width, height);
    };
    using Captures = std::vector<RoledPhotograph>;

    const auto missing =
        message_of<FileError>([&] { decode_changed([](Captures& c) { c.erase(c.begin() + 5); }); });
    EXPECT_HAS(missing, "no photograph of gray-column-2-inverse");
    EXPECT_HAS(missing, "32 Gray code photographs for a 160x100 projector");

    const auto unequal = message_of<FileError>(
        [&] { decode_changed([](Captures& c) { c[7].photograph.image = ImageF(10, 11, 3); }); });
    EXPECT_HAS(unequal, "gray-column-3-inverse: size: found 10x11, expected 210x140");

    const auto empty = message_of<FileError>(
        [&] { decode_changed([](Captures& c) { c[30].photograph.image = ImageF(); }); });
    EXPECT_HAS(empty, "white: size: found 0x0");

    const auto too_small =
        message_of<FileError>([&] { decode_changed([](Captures&) {}, 128, 100); });
    EXPECT_HAS(too_small, "found gray-column-7, expected no such bit for a 128x100 projector");
    const auto too_large =
        message_of<FileError>([&] { decode_changed([](Captures&) {}, 160, 800); });
    EXPECT_HAS(too_large, "no photograph of gray-row-7");
    EXPECT_HAS(message_of<FileError>([&] { decode_gray_code(Captures{}, 160, 100); }),
               "no photograph of gray-column-0");
    EXPECT_HAS(message_of<std::invalid_argument>([&] { decode_gray_code(Captures{}, 0, 100); }),
               "0x100");

    const auto fill = [](float value) {
        return [value](Captures& c) {
            for (auto& capture : c)
                std::fill(capture.photograph.image.values.begin(),
                          capture.photograph.image.values.end(),
                          value);
        };
    };
    for (const float value : {0.0f, 16256.0f, std::numeric_limits<float>::quiet_NaN()})
        EXPECT_HAS(message_of<Refused>([&] { decode_changed(fill(value)); }),
                   "brighter under white than under black");

    // White and black swapped, and every stripe picture the same: nothing answers.
    EXPECT_HAS(
        message_of<Refused>([&] {
            decode_changed([](Captures& c) { std::swap(c[30].photograph, c[31].photograph); });
        }),
        "brighter under white");
    EXPECT_HAS(message_of<Refused>([&] {
                   decode_changed([](Captures& c) {
                       for (std::size_t i = 1; i < 30; ++i) c[i].photograph = c[0].photograph;
                   });
               }),
               "of the lit pixels answer to the stripes");

    // Roles of other kinds do no harm.
    decode_changed([](Captures& c) { c.push_back({"holiday", c[0].photograph}); });

    std::vector<ImageF> few(5, ImageF(4, 4, 1));
    EXPECT_HAS(message_of<std::invalid_argument>(
                   [&] { decode_gray_code(std::span<const ImageF>(few), 160, 100); }),
               "5 pictures given, 32 expected");
}

// ---- projector -> camera

struct MapError {
    double rms = 0.0, largest = 0.0;
    int count = 0;
};

MapError error_of(const ProjectorToCamera& map, const ProjectorToCamera& truth, int margin) {
    MapError error;
    for (int y = margin; y < map.edge.height - margin; ++y)
        for (int x = margin; x < map.edge.width - margin; ++x) {
            if (map.edge.at(x, y) || std::isnan(map.camera_px.at(x, y)) ||
                std::isnan(truth.camera_px.at(x, y)))
                continue;
            const double dx = map.camera_px.at(x, y, 0) - truth.camera_px.at(x, y, 0);
            const double dy = map.camera_px.at(x, y, 1) - truth.camera_px.at(x, y, 1);
            error.rms += dx * dx + dy * dy;
            error.largest = worse_of({error.largest, std::abs(dx), std::abs(dy)});
            ++error.count;
        }
    error.rms = std::sqrt(error.rms / std::max(error.count, 1));
    return error;
}

TEST(InvertMap, FindsSubPixelPlacesForFineAndCoarseCameras) {
    // Camera pixels per projector pixel along an axis. The rounding error of one sample is
    // 0.29 * scale camera pixels an axis; 25 * scale^2 of them give 0.06, and coarse cameras
    // are fitted over wider windows. 0.2 leaves room for uneven windows; at scale 1 both grids run
    // in step over whole windows and the rounding of one sample stays.
    for (const double scale : {0.6, 0.8, 1.0, 1.35, 2.0, 3.1}) {
        SyntheticBench bench = small_bench();
        bench.camera_width = static_cast<int>(160 * scale) + 12;
        bench.camera_height = static_cast<int>(100 * scale) + 12;
        bench.projector_from_camera = [scale](glm::dvec2 c) -> std::optional<glm::dvec2> {
            return glm::dvec2((c.x + 0.07 * c.y - 7.3) / scale, (c.y - 0.05 * c.x - 0.2) / scale);
        };
        const ProjectorToCamera map = invert_map(decode(bench), 160, 100);
        const MapError error = error_of(map, bench.exact_map(), 12);
        EXPECT_GT(error.count, 136 * 76 * 0.9) << scale;
        EXPECT_LT(error.rms, scale == 1.0 ? 0.35 : 0.2) << scale;
        EXPECT_LT(error.largest, 0.75) << scale;
        std::printf("scale %.2f: rms %.3f px, largest %.3f px, %d pixels\n",
                    scale,
                    error.rms,
                    error.largest,
                    error.count);
    }
}

TEST(InvertMap, DoesNotReachAcrossADepthEdge) {
    // A part in front of a wall, seen 23 camera pixels aside: a shadow in between.
    SyntheticBench bench = small_bench();
    bench.camera_width = 260;
    const auto in_front = [](glm::dvec2 p) { return p.x > 50 && p.x < 90 && p.y > 30 && p.y < 70; };
    bench.projector_from_camera = [in_front](glm::dvec2 c) -> std::optional<glm::dvec2> {
        const glm::dvec2 front((c.x - 33.0) / 1.3, (c.y - 4.0) / 1.3);
        if (in_front(front)) return front;
        const glm::dvec2 wall((c.x - 10.0) / 1.3, (c.y - 4.0) / 1.3);
        if (in_front(wall)) return std::nullopt;
        return wall;
    };
    const ProjectorToCamera map = invert_map(decode(bench), 160, 100);
    int edges = 0, valid = 0;
    for (int y = 3; y < 97; ++y)
        for (int x = 3; x < 157; ++x) {
            const glm::dvec2 p(x + 0.5, y + 0.5);
            const bool front = in_front(p);
            if (map.edge.at(x, y)) {
                ++edges;
                // Edges stay within 2 px of the border of the front part, or of what it hides
                // (its right side covers 23 camera pixels of wall).
                continue;
            }
            if (std::isnan(map.camera_px.at(x, y))) continue;
            ++valid;
            ASSERT_NEAR(map.camera_px.at(x, y, 0), p.x * 1.3 + (front ? 33.0 : 10.0), 0.75)
                << x << " " << y;
            ASSERT_NEAR(map.camera_px.at(x, y, 1), p.y * 1.3 + 4.0, 0.75) << x << " " << y;
        }
    EXPECT_GT(valid, 94 * 154 * 0.80);
    EXPECT_GT(edges, 40);
    EXPECT_LT(edges, 94 * 154 * 0.06);
    // Hidden from the camera: no place, not an invented one
    int invented = 0;
    for (int y = 35; y < 65; ++y)
        for (int x = 95; x < 104; ++x)
            invented += !std::isnan(map.camera_px.at(x, y)) && !map.edge.at(x, y);
    EXPECT_EQ(invented, 0);
}

TEST(InvertMap, GrossDecodingErrorsDoNotPull) {
    SyntheticBench bench = small_bench();
    CameraToProjector decoded = decode(bench);
    Random random(7);
    for (std::size_t i = 0; i < decoded.decoded.values.size(); ++i)
        if (decoded.decoded.values[i] && random.uniform() < 0.03) {
            decoded.projector_px.values[2 * i] = static_cast<float>(random.below(160)) + 0.5f;
            decoded.projector_px.values[2 * i + 1] = static_cast<float>(random.below(100)) + 0.5f;
        }
    const MapError error = error_of(invert_map(decoded, 160, 100), bench.exact_map(), 10);
    EXPECT_LT(error.rms, 0.2);
    EXPECT_LT(error.largest, 1.5);
    EXPECT_GT(error.count, 9000);
}

TEST(InvertMap, RefusesAMapOfAnotherProjector) {
    SyntheticBench bench = small_bench();
    const CameraToProjector decoded = decode(bench);
    EXPECT_HAS(message_of<std::invalid_argument>([&] { invert_map(decoded, 80, 100); }),
               "outside 80x100");
}

}  // namespace
}  // namespace livery
