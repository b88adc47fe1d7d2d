#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <type_traits>
#include <utility>

#include "calibration/captures/exposure_merge.h"
#include "calibration/correspondence/gray_code.h"
#include "calibration/correspondence/patterns.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {
namespace {

/// The pictures as planes; bit k of columns is at 2k, its inverse at 2k + 1; rows follow.
template <typename T>
struct Planes {
    std::vector<const T*> stripes;
    const T* white = nullptr;
    const T* black = nullptr;
    int width = 0, height = 0;
    int column_bits = 0, row_bits = 0;
    int projector_width = 0, projector_height = 0;
};

/// Wide enough for the sum of 28 absolute differences.
template <typename T>
using ContrastOf =
    std::conditional_t<std::is_same_v<T, std::uint8_t>,
                       std::uint16_t,
                       std::conditional_t<std::is_same_v<T, std::uint16_t>, std::uint32_t, float>>;

constexpr std::size_t kBlockPixels = 1024;  // pixels; the working set stays in the first cache

/// Stripes answered with less than this part of white - black say little of where the light came
/// from. Blur weakens the two finest bits of an axis, a stripe's border one more.
constexpr int kWeakPart = 5;
constexpr std::uint8_t kMostWeakBits = 3;

/// One axis of a block of pixels. Bytes, so that a vector register holds as many pixels as it can.
struct AxisOfBlock {
    std::array<std::uint8_t, kBlockPixels> coarse,
        fine;                                        ///< Gray code, its last eight bits in `fine`
    std::array<std::uint8_t, kBlockPixels> weak;     ///< bits that were answered weakly
    std::array<std::uint16_t, kBlockPixels> number;  ///< columns or rows
};

/// The least answer to a stripe that is not weak, of each pixel.
template <typename T>
void least_answers(const T* white, const T* black, T* __restrict least) {
    for (std::size_t i = 0; i < kBlockPixels; ++i) {
        const T above = white[i] > black[i] ? white[i] : black[i];
        const T lit_by = static_cast<T>(above - black[i]);
        if constexpr (std::is_floating_point_v<T>)
            least[i] = lit_by / static_cast<T>(kWeakPart);
        else  // rounded up: whole answers below it are those below the fifth itself
            least[i] = static_cast<T>(lit_by / kWeakPart + (lit_by % kWeakPart != 0 ? 1 : 0));
    }
}

/// Gray code from the signs of an axis' bit pairs, how many of them were weak, and the sum of all
/// answers. Fixed trip counts vectorise, and so it must be known that what is written is not read.
template <typename T>
void decode_axis(const Planes<T>& planes,
                 int first_bit,
                 int bits,
                 std::size_t offset,
                 const T* __restrict least,
                 AxisOfBlock& axis,
                 ContrastOf<T>* __restrict contrast) {
    axis.coarse.fill(0);
    axis.fine.fill(0);
    axis.weak.fill(0);
    for (int bit = 0; bit < bits; ++bit) {
        const auto at = static_cast<std::size_t>(2 * (first_bit + bit));
        const T* const __restrict positive = planes.stripes[at] + offset;
        const T* const __restrict negative = planes.stripes[at + 1] + offset;
        std::uint8_t* const __restrict code =
            bit < bits - 8 ? axis.coarse.data() : axis.fine.data();
        std::uint8_t* const __restrict weak = axis.weak.data();
        for (std::size_t i = 0; i < kBlockPixels; ++i) {
            const bool above = positive[i] > negative[i];
            const T high = above ? positive[i] : negative[i];
            const T low = above ? negative[i] : positive[i];
            const T answer = static_cast<T>(high - low);
            code[i] = static_cast<std::uint8_t>(code[i] + code[i] + (above ? 1 : 0));
            weak[i] = static_cast<std::uint8_t>(weak[i] + (answer < least[i] ? 1 : 0));
            contrast[i] = static_cast<ContrastOf<T>>(contrast[i] + answer);
        }
    }
    for (std::size_t i = 0; i < kBlockPixels; ++i) {
        // Gray to binary: each bit is the exclusive or of all Gray bits before it.
        unsigned code = static_cast<unsigned>(axis.coarse[i]) << 8 | axis.fine[i];
        code ^= code >> 8;
        code ^= code >> 4;
        code ^= code >> 2;
        axis.number[i] = static_cast<std::uint16_t>(code ^ code >> 1);
    }
}

/// A block at the end of the picture is decoded from a copy, so that every block is full.
template <typename T>
struct Tail {
    std::vector<std::vector<T>> storage;
    Planes<T> planes;

    Tail(const Planes<T>& source, std::size_t offset, std::size_t count) : planes(source) {
        const auto copy = [&](const T* from) {
            storage.emplace_back(kBlockPixels, T{});
            std::copy_n(from + offset, count, storage.back().begin());
            return storage.back().data();
        };
        storage.reserve(source.stripes.size() + 2);
        for (const T*& plane : planes.stripes) plane = copy(plane);
        planes.white = copy(planes.white);
        planes.black = copy(planes.black);
    }
};

struct DecodeCounts {
    std::size_t lit = 0, decoded = 0;
};

template <typename T>
DecodeCounts decode_block(const Planes<T>& planes,
                          std::size_t offset,
                          std::size_t count,
                          float threshold,
                          float* __restrict projector_px,
                          std::uint8_t* __restrict decoded) {
    std::array<T, kBlockPixels> least;
    least_answers(planes.white + offset, planes.black + offset, least.data());
    AxisOfBlock columns_of, rows_of;
    std::array<ContrastOf<T>, kBlockPixels> contrast{};
    decode_axis(planes, 0, planes.column_bits, offset, least.data(), columns_of, contrast.data());
    decode_axis(planes,
                planes.column_bits,
                planes.row_bits,
                offset,
                least.data(),
                rows_of,
                contrast.data());

    // A third of the mean contrast: blur takes it from the two finest bits of each axis, light
    // that arrives over other parts takes it from all. In a shadow such light still follows the
    // coarse stripes, for it comes from somewhere, but none of the finer ones.
    const float share = static_cast<float>(planes.column_bits + planes.row_bits) / 3.0f;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto columns = static_cast<unsigned>(planes.projector_width);
    const auto rows = static_cast<unsigned>(planes.projector_height);
    unsigned lit_count = 0, decoded_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const float lit_by = static_cast<float>(planes.white[offset + i]) -
                             static_cast<float>(planes.black[offset + i]);
        const bool lit = lit_by > threshold;
        const bool good = lit & (static_cast<float>(contrast[i]) >= share * lit_by) &
                          (columns_of.weak[i] <= kMostWeakBits) &
                          (rows_of.weak[i] <= kMostWeakBits) & (columns_of.number[i] < columns) &
                          (rows_of.number[i] < rows);
        lit_count += lit ? 1u : 0u;
        decoded_count += good ? 1u : 0u;
        decoded[i] = good ? 255 : 0;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const bool good = decoded[i] != 0;
        projector_px[2 * i] = good ? static_cast<float>(columns_of.number[i]) + 0.5f : nan;
        projector_px[2 * i + 1] = good ? static_cast<float>(rows_of.number[i]) + 0.5f : nan;
    }
    return {lit_count, decoded_count};
}

/// Standard deviation of the noise, from second differences along rows (structure cancels).
template <typename T>
double noise_of(const T* picture, int width, int height) {
    std::vector<float> samples;
    const int step = std::max(1, width * height / 60000);
    for (int y = 0; y < height; ++y)
        for (int x = 1 + (y * 7) % step; x + 1 < width; x += step) {
            const T* const p = picture +
                               static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(x);
            const float difference = static_cast<float>(p[-1]) - 2.0f * static_cast<float>(p[0]) +
                                     static_cast<float>(p[1]);
            if (std::isfinite(difference)) samples.push_back(std::abs(difference));
        }
    if (samples.empty()) return 0.0;
    const double sigma =
        static_cast<double>(median(std::move(samples))) / (0.6745 * std::sqrt(6.0));
    // Whole numbers hide noise under half a step.
    return std::is_floating_point_v<T> ? sigma : std::max(sigma, 0.5);
}

/// Eight sigma of white - black, and at least half a percent of the brightest lit pixels.
template <typename T>
double automatic_threshold(const Planes<T>& planes) {
    const std::size_t count =
        static_cast<std::size_t>(planes.width) * static_cast<std::size_t>(planes.height);
    std::vector<float> differences;
    const std::size_t step = std::max<std::size_t>(1, count / 60000);
    for (std::size_t i = 0; i < count; i += step) {
        const float difference =
            static_cast<float>(planes.white[i]) - static_cast<float>(planes.black[i]);
        if (std::isfinite(difference)) differences.push_back(difference);
    }
    if (differences.empty()) return 0.0;
    return std::max({8.0 * std::sqrt(2.0) * noise_of(planes.black, planes.width, planes.height),
                     0.005 * static_cast<double>(quantile(std::move(differences), 0.999)),
                     0.0});
}

template <typename T>
CameraToProjector decode_planes(const Planes<T>& planes, double lit_threshold) {
    CameraToProjector result;
    result.projector_px = ImageF(planes.width, planes.height, 2);
    result.decoded = Image8(planes.width, planes.height, 1);
    result.lit_threshold = lit_threshold >= 0.0 ? lit_threshold : automatic_threshold(planes);
    const auto threshold = static_cast<float>(result.lit_threshold);

    const std::size_t pixels = result.decoded.pixel_count();
    const std::size_t full_blocks = pixels / kBlockPixels;
    std::atomic<std::size_t> lit{0}, decoded{0};
    const auto decode_one =
        [&](const Planes<T>& from, std::size_t from_offset, std::size_t offset, std::size_t count) {
            const DecodeCounts counts = decode_block(from,
                                                     from_offset,
                                                     count,
                                                     threshold,
                                                     result.projector_px.values.data() + 2 * offset,
                                                     result.decoded.values.data() + offset);
            lit += counts.lit;
            decoded += counts.decoded;
        };
    parallel_for(full_blocks, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block)
            decode_one(planes, block * kBlockPixels, block * kBlockPixels, kBlockPixels);
    });
    if (const std::size_t rest = pixels - full_blocks * kBlockPixels; rest > 0) {
        const Tail<T> tail(planes, full_blocks * kBlockPixels, rest);
        decode_one(tail.planes, 0, full_blocks * kBlockPixels, rest);
    }

    // Verdict
    const auto percent = [](double fraction) {
        std::string text = std::to_string(100.0 * fraction);
        return text.substr(0, text.find('.') + 3) + "%";
    };
    result.lit_fraction = static_cast<double>(lit) / static_cast<double>(pixels);
    result.decoded_fraction =
        lit > 0 ? static_cast<double>(decoded) / static_cast<double>(lit) : 0.0;
    if (lit < 64 || result.lit_fraction < 1e-4)
        throw Refused(
            "only " + percent(result.lit_fraction) +
                " of the photograph is brighter under white than under black",
            "check that the projector's picture falls on the mock-up, that the camera "
            "sees it and is neither saturated nor far too dark, that its exposure is set by hand, "
            "and that the room is dark");
    if (decoded < 64 || result.decoded_fraction < 0.2)
        throw Refused(
            "only " + percent(result.decoded_fraction) + " of the lit pixels answer to the stripes",
            "check that the photographs are in the order of the patterns, that camera and "
            "projector did not move, that each picture had arrived before its photograph, "
            "and the focus");
    return result;
}

/// Checks count and sizes, and lines the pictures up.
template <typename T>
CameraToProjector decode_in_order(std::span<const Image<T>> pictures,
                                  int projector_width,
                                  int projector_height,
                                  double lit_threshold) {
    check_pattern_size(projector_width, projector_height);
    Planes<T> planes;
    planes.projector_width = projector_width;
    planes.projector_height = projector_height;
    planes.column_bits = gray_code_bits(projector_width);
    planes.row_bits = gray_code_bits(projector_height);
    const auto stripes = static_cast<std::size_t>(2 * (planes.column_bits + planes.row_bits));
    check_argument(pictures.size() == stripes + 2,
                   std::to_string(pictures.size()) + " pictures given, " +
                       std::to_string(stripes + 2) + " expected for a " +
                       std::to_string(projector_width) + "x" + std::to_string(projector_height) +
                       " projector");
    planes.width = pictures[0].width;
    planes.height = pictures[0].height;
    for (const Image<T>& picture : pictures)
        check_argument(picture.channels == 1 && picture.width == planes.width &&
                           picture.height == planes.height && !picture.empty(),
                       "pictures of one channel and one size expected, found " +
                           std::to_string(picture.width) + "x" + std::to_string(picture.height) +
                           "x" + std::to_string(picture.channels));
    for (std::size_t i = 0; i < stripes; ++i) planes.stripes.push_back(pictures[i].values.data());
    planes.white = pictures[stripes].values.data();
    planes.black = pictures[stripes + 1].values.data();
    return decode_planes(planes, lit_threshold);
}

}  // namespace

CameraToProjector decode_gray_code(std::span<const Image8> in_pattern_order,
                                   int projector_width,
                                   int projector_height,
                                   double lit_threshold) {
    return decode_in_order(in_pattern_order, projector_width, projector_height, lit_threshold);
}

CameraToProjector decode_gray_code(std::span<const Image16> in_pattern_order,
                                   int projector_width,
                                   int projector_height,
                                   double lit_threshold) {
    return decode_in_order(in_pattern_order, projector_width, projector_height, lit_threshold);
}

CameraToProjector decode_gray_code(std::span<const ImageF> in_pattern_order,
                                   int projector_width,
                                   int projector_height,
                                   double lit_threshold) {
    return decode_in_order(in_pattern_order, projector_width, projector_height, lit_threshold);
}

void check_gray_code(const std::filesystem::path& source,
                     const std::vector<std::string>& roles,
                     int projector_width,
                     int projector_height) {
    check_pattern_size(projector_width, projector_height);
    const std::string projector =
        std::to_string(projector_width) + "x" + std::to_string(projector_height) + " projector";
    const auto holds = [&](const std::string& role) {
        return std::find(roles.begin(), roles.end(), role) != roles.end();
    };
    for (const auto& [axis, count] :
         {std::pair("column", projector_width), std::pair("row", projector_height)}) {
        const std::string finer =
            std::string("gray-") + axis + "-" + std::to_string(gray_code_bits(count));
        if (holds(finer)) throw FileError(source, "role", finer, "no such bit for a " + projector);
    }
    const std::vector<std::string> wanted = geometry_roles(projector_width, projector_height);
    for (const std::string& role : wanted)
        if (!holds(role))
            throw FileError(
                source,
                "role",
                "no photograph of " + role,
                std::to_string(wanted.size()) + " Gray code photographs for a " + projector);
}

CameraToProjector decode_gray_code(const std::vector<RoledPhotograph>& photographs,
                                   int projector_width,
                                   int projector_height,
                                   double lit_threshold) {
    std::vector<std::string> roles;
    for (const RoledPhotograph& photograph : photographs) roles.push_back(photograph.role);
    check_gray_code("captures", roles, projector_width, projector_height);
    std::vector<ImageF> pictures;
    const std::vector<std::string> wanted = geometry_roles(projector_width, projector_height);
    const auto first =
        std::find_if(photographs.begin(), photographs.end(), [&](const RoledPhotograph& one) {
            return one.role == wanted.front();
        });
    for (const std::string& role : wanted)
        pictures.push_back(exposed_alike(photographs, role, *first));
    return decode_in_order(
        std::span<const ImageF>(pictures), projector_width, projector_height, lit_threshold);
}

}  // namespace livery
