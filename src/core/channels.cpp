#include "core/channels.h"

#include <algorithm>

#include "core/error.h"

namespace livery {

int channel_named(const ImageFile& picture, const std::string& name) {
    const auto& names = picture.channel_names;
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

std::array<int, 3> colour_channels(const std::filesystem::path& file, const ImageFile& picture) {
    const std::array<int, 3> rgb = {
        channel_named(picture, "R"), channel_named(picture, "G"), channel_named(picture, "B")};
    if (std::min({rgb[0], rgb[1], rgb[2]}) >= 0) return rgb;
    const int channels = picture.image.channels;
    const bool with_alpha = channels == 2 && channel_named(picture, "A") >= 0;
    if (channels == 1 || with_alpha) {
        for (const char* name : {"Y", "L", "I", "V", "R", "G", "B", ""}) {
            if (const int grey = channel_named(picture, name); grey >= 0) return {grey, grey, grey};
        }
    }
    std::string names;
    for (const auto& name : picture.channel_names) names += (names.empty() ? "" : ", ") + name;
    throw FileError(file, "channels", names, "R, G, B, or grey (Y) alone");
}

}  // namespace livery
