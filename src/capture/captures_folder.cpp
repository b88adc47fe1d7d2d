#include "capture/captures_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "capture/exposures.h"
#include "capture/manifest_io.h"
#include "capture/transfer.h"
#include "core/channels.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/image_io.h"

namespace livery {

namespace {

/// Names of the pictures in a folder, in name order.
std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        if (has_picture_suffix(entry.path())) files.push_back(entry.path());
    }
    if (error) throw FileError(folder, "", error.message(), "a readable folder");
    std::sort(files.begin(), files.end());
    return files;
}

/// The order of the common Gray code tools for projectors of up to 1024x1024: ten column bits and
/// ten row bits, each followed by its inverse, then white and black.
std::vector<PatternEntry> usual_42_patterns() {
    std::vector<PatternEntry> patterns;
    for (const std::string axis : {"gray-column-", "gray-row-"}) {
        for (int bit = 0; bit < 10; ++bit) {
            const std::string role = axis + std::to_string(bit);
            patterns.push_back({"", role, {}});
            patterns.push_back({"", role + "-inverse", {}});
        }
    }
    patterns.push_back({"", "white", {255, 255, 255}});
    patterns.push_back({"", "black", {0, 0, 0}});
    return patterns;
}

CapturesFolder match_by_name(const std::filesystem::path& folder,
                             const std::filesystem::path& patterns_manifest) {
    CapturesFolder result;
    result.folder = folder;
    PatternsManifest known;
    if (patterns_manifest.empty()) {
        known.patterns = usual_42_patterns();
    } else {
        known = read_patterns_manifest(patterns_manifest);
    }
    const auto files = pictures_in(folder);
    if (files.size() != known.patterns.size()) {
        throw FileError(
            folder,
            "",
            std::to_string(files.size()) + " pictures and no manifest.json",
            std::to_string(known.patterns.size()) + " pictures in the order of " +
                (patterns_manifest.empty() ? "10 column bits, 10 row bits, white, black; or "
                                             "--patterns, the folder of those shown"
                                           : patterns_manifest.string()));
    }
    result.projector_width = known.projector_width;
    result.projector_height = known.projector_height;
    for (std::size_t k = 0; k < files.size(); ++k) {
        Capture capture;
        capture.file = files[k];
        capture.role = known.patterns[k].role;
        capture.drive = known.patterns[k].drive;
        if (!known.patterns[k].file.empty()) {
            capture.pattern = patterns_manifest.parent_path() / known.patterns[k].file;
        }
        capture.transfer = usual_transfer(capture.file);
        capture.raw_half = true;  // As livery capture reads RAW: nothing made up, and soon read.
        result.captures.push_back(std::move(capture));
    }
    return result;
}

/// Red, green and blue alone, one after the other.
ImageF rgb_of(const std::filesystem::path& file, ImageFile picture) {
    const std::array<int, 3> from = colour_channels(file, picture);
    const int channels = picture.image.channels;
    if (channels == 3 && from == std::array{0, 1, 2}) return std::move(picture.image);
    ImageF rgb(picture.image.width, picture.image.height, 3);
    for (std::size_t k = 0; k < rgb.pixel_count(); ++k) {
        for (std::size_t c = 0; c < 3; ++c) {
            rgb.values[3 * k + c] = picture.image.values[static_cast<std::size_t>(channels) * k +
                                                         static_cast<std::size_t>(from[c])];
        }
    }
    return rgb;
}

void check_finite(const std::filesystem::path& file, const ImageF& image) {
    const auto bad = std::find_if(image.values.begin(), image.values.end(), [](float value) {
        return !std::isfinite(value);
    });
    if (bad == image.values.end()) return;
    const auto pixel = static_cast<std::size_t>(bad - image.values.begin()) / 3;
    const auto width = static_cast<std::size_t>(image.width);
    throw FileError(file,
                    "pixel " + std::to_string(pixel % width) + "," + std::to_string(pixel / width),
                    std::isnan(*bad) ? "NaN" : "infinity",
                    "finite values");
}

}  // namespace

CapturesFolder read_captures_folder(const std::filesystem::path& folder,
                                    PhotographUse use,
                                    const std::filesystem::path& patterns_manifest) {
    std::error_code error;
    const auto status = std::filesystem::status(folder, error);
    if (!std::filesystem::exists(status)) {
        throw FileError(folder, "", "no such folder", "a folder of photographs");
    }
    if (!std::filesystem::is_directory(status)) {
        throw FileError(folder, "", "a file", "a folder of photographs");
    }
    const auto manifest = folder / "manifest.json";
    const bool has_manifest = std::filesystem::exists(manifest, error);
    const auto patterns = std::filesystem::is_directory(patterns_manifest, error)
                              ? patterns_manifest / "manifest.json"
                              : patterns_manifest;
    CapturesFolder result =
        has_manifest ? read_captures_manifest(manifest) : match_by_name(folder, patterns);
    complete_exposures(result.captures, has_manifest ? manifest : folder, use);
    return result;
}

BenchPorts ports_of(const CapturesFolder& folder) {
    struct Reading {
        CapturesFolder folder;
        std::vector<std::size_t> waiting;  ///< places of the role's photographs, the last one first
    };
    // Shared by two ports, and by every copy of them.
    const auto reading = std::make_shared<Reading>(Reading{folder, {}});
    BenchPorts ports;
    ports.show = [](const Image8&) {};
    ports.turn_to = [reading](const std::string& role) {
        const std::vector<Capture>& captures = reading->folder.captures;
        reading->waiting.clear();
        for (std::size_t k = captures.size(); k-- > 0;) {
            if (captures[k].role == role) reading->waiting.push_back(k);
        }
        if (reading->waiting.empty()) {
            throw FileError(reading->folder.folder,
                            "captures",
                            "no photograph of " + role,
                            "one photograph or more of each picture that was shown");
        }
        return static_cast<int>(reading->waiting.size());
    };
    ports.photograph = [reading](double) {
        check_argument(!reading->waiting.empty(), "ports_of: no photograph is left of this role");
        const std::size_t place = reading->waiting.back();
        reading->waiting.pop_back();
        Photograph photograph = load_photograph(reading->folder.captures[place]);
        photograph.taken_at = static_cast<double>(place);
        return photograph;
    };
    return ports;
}

Photograph load_photograph(const Capture& capture) {
    auto picture = read_image(capture.file, kMostPicturePixels, capture.raw_half);
    const double full_scale = picture.full_scale;
    const bool floating_point = picture.floating_point;
    Photograph photograph;
    photograph.settings = picture.settings;
    photograph.name = capture.file.filename().string();
    photograph.exposure_s = capture.exposure_s;
    photograph.black_level = capture.black_level;
    photograph.saturates_at = capture.saturates_at > 0.0 ? capture.saturates_at
                              : floating_point           ? std::numeric_limits<double>::infinity()
                                                         : full_scale;
    photograph.image = rgb_of(capture.file, std::move(picture));
    check_finite(capture.file, photograph.image);

    const auto linear = linearisation(capture.transfer, full_scale);
    if (!linear) return photograph;
    if (floating_point) {
        for (float& value : photograph.image.values) {
            value = static_cast<float>(linear(static_cast<double>(value)));
        }
    } else {
        std::vector<float> table(static_cast<std::size_t>(full_scale) + 1);
        for (std::size_t k = 0; k < table.size(); ++k) {
            table[k] = static_cast<float>(linear(static_cast<double>(k)));
        }
        for (float& value : photograph.image.values) {
            value = table[static_cast<std::size_t>(value)];
        }
    }
    photograph.black_level = linear(photograph.black_level);
    if (std::isfinite(photograph.saturates_at)) {
        photograph.saturates_at = linear(photograph.saturates_at);
    }
    return photograph;
}

}  // namespace livery
