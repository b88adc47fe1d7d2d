#include "capture/patterns_folder.h"

#include <algorithm>
#include <cstdio>

#include "capture/manifest_io.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/paths.h"

namespace livery {

bool is_known_role(std::string_view role) {
    static constexpr std::string_view plain[] = {"white",
                                                 "black",
                                                 "dark-gray",
                                                 "bright-gray",
                                                 "red",
                                                 "green",
                                                 "blue",
                                                 "gray-levels",
                                                 "repose",
                                                 "repose-inverse"};
    if (std::find(std::begin(plain), std::end(plain), role) != std::end(plain)) return true;

    static constexpr std::string_view inverse = "-inverse";
    static constexpr std::string_view numbered[] = {
        "gray-column-", "gray-row-", "phase-column-", "phase-row-", "colors-", "verify-"};
    for (const auto start : numbered) {
        if (!role.starts_with(start)) continue;
        role.remove_prefix(start.size());
        if (start.starts_with("gray-") && role.ends_with(inverse)) {
            role.remove_suffix(inverse.size());
        }
        return !role.empty() && role.size() <= 4 &&
               std::all_of(role.begin(), role.end(), [](char c) { return c >= '0' && c <= '9'; });
    }
    return false;
}

void write_patterns_folder(const std::filesystem::path& folder,
                           int width,
                           int height,
                           const std::vector<PatternFile>& patterns,
                           const Progress& progress) {
    check_argument(!patterns.empty(), "write_patterns_folder: no patterns");
    PatternsManifest manifest{width, height, {}};
    for (std::size_t k = 0; k < patterns.size(); ++k) {
        const auto& pattern = patterns[k];
        check_argument(is_known_role(pattern.role),
                       "write_patterns_folder: unknown role \"" + pattern.role + "\"");
        check_argument(pattern.drive.width == width && pattern.drive.height == height &&
                           pattern.drive.channels == 3,
                       "write_patterns_folder: " + pattern.role + " is " +
                           std::to_string(pattern.drive.width) + "x" +
                           std::to_string(pattern.drive.height) + "x" +
                           std::to_string(pattern.drive.channels) + ", not " +
                           std::to_string(width) + "x" + std::to_string(height) + "x3");
        char name[32];
        std::snprintf(name, sizeof name, "%03zu.png", k);
        manifest.patterns.push_back({name, pattern.role, pattern.drive_values});
    }
    make_output_folder(folder);
    for (std::size_t k = 0; k < patterns.size(); ++k) {
        progress.update(static_cast<double>(k) / static_cast<double>(patterns.size()),
                        "writing " + manifest.patterns[k].file);
        write_png(folder / manifest.patterns[k].file, patterns[k].drive);
    }
    // Last, so that a folder with a manifest is a whole one.
    write_patterns_manifest(folder / "manifest.json", manifest);
}

Image8 read_pattern(const std::filesystem::path& file, int width, int height) {
    const ImageFile picture = read_image(file);
    const ImageF& image = picture.image;
    if (image.width != width || image.height != height || image.channels < 3) {
        const auto size = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
        throw FileError(file,
                        "size",
                        size(image.width, image.height) + " with " +
                            std::to_string(image.channels) + " channels",
                        "the projector's " + size(width, height) + " with 3");
    }
    Image8 drive(width, height, 3);
    for (std::size_t i = 0; i < drive.values.size(); ++i) {
        const float value = image.values[i / 3 * static_cast<std::size_t>(image.channels) + i % 3];
        drive.values[i] = static_cast<std::uint8_t>(
            static_cast<double>(value) * 255.0 / picture.full_scale + 0.5);
    }
    return drive;
}

}  // namespace livery
