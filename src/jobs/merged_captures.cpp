#include "jobs/merged_captures.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace livery {

bool MergedCaptures::all_saturated() const {
    const auto& seconds = picture.seconds.values;
    return std::none_of(seconds.begin(), seconds.end(), [](float one) { return one > 0.0f; });
}

MergedCaptures merge_captures(const std::vector<Capture>& captures,
                              const std::function<Photograph(const Capture&)>& load,
                              const Progress& progress) {
    MergedCaptures merged;
    double done = 0.0;
    for (const Capture& capture : captures) {
        progress.update(done / static_cast<double>(captures.size()),
                        "reading " + capture.file.filename().string());
        done += 1.0;
        const Photograph photograph = load(capture);
        add(photograph, merged.picture);
        merged.clipped_light = std::max(merged.clipped_light, clipped_light(photograph));
    }
    return merged;
}

Photograph load_photograph_of(const Capture& capture, const View& camera) {
    Photograph photograph = load_photograph(capture);
    const ImageF& image = photograph.image;
    if (image.width != camera.width || image.height != camera.height) {
        throw FileError(capture.file,
                        "size",
                        fmt::format("{}x{}", image.width, image.height),
                        fmt::format("the camera's {}x{}", camera.width, camera.height));
    }
    return photograph;
}

}  // namespace livery
