#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/hash.h"
#include "core/paths.h"
#include "core/pictures/colour_differences.h"
#include "ledger/accuracy/chain_artwork.h"
#include "ledger/accuracy/chain_steps.h"
#include "scene/library.h"

namespace livery {

namespace {

constexpr double kStripes_px[] = {0.3, 1.0, 3.0, 10.0};
constexpr double kPicture_px = 30.0;
constexpr const char* kPicture = "assets/patterns/roundel.png";
constexpr int kRays = 256, kQuickRays = 64;

/// White over the red car's body: stripes along it, and a picture again and again.
Scene with_artwork(const Scene& plain, const FrameGeometry& geometry) {
    const auto part = static_cast<std::size_t>(part_index(*plain.product, "body"));
    Look look = find_look("solid-red");
    Artwork artwork;
    artwork.part = "body";
    artwork.paint = "solid white";
    artwork.place.direction = {0.0, -1.0, 0.0};
    artwork.place.up = {0.0, 0.0, 1.0};
    const double pixel_mm = pixel_across_mm(geometry, part, artwork.place);
    for (const double stripe_px : kStripes_px) {
        artwork.size_mm = 2.0 * stripe_px * pixel_mm;
        look.artwork.push_back(artwork);
    }
    artwork.shape = ArtworkShape::picture;
    artwork.picture = kPicture;
    artwork.repeat = true;
    artwork.size_mm = kPicture_px * pixel_mm;
    look.artwork.push_back(artwork);
    return make_scene(plain.product, look, plain.eye_in_world_mm, plain.environment);
}

void measure(std::vector<ChainRow>& rows, int rays, const Progress& progress) {
    const AccuracyScene car = accuracy_scenes(true, progress).front();
    const FrameGeometry geometry(car.scene.product, car.view, progress);
    const auto pictures =
        artwork_pictures(with_artwork(car.scene, geometry), geometry, rays, progress);
    for (std::size_t k = 0; k < pictures.size(); ++k) {
        const ArtworkPictures& one = pictures[k];
        ChainRow &by_sample = rows.at(2 * k), &by_footprint = rows.at(2 * k + 1);
        set_errors(by_sample, colour_differences(one.by_sample, one.by_many));
        by_sample.ms = one.sample_ms;
        set_errors(by_footprint, colour_differences(one.by_footprint, one.by_many));
        by_footprint.ms = one.footprint_ms;
    }
}

}  // namespace

std::vector<ChainPart> artwork_parts(const AccuracyOptions& options) {
    const int rays = options.quick ? kQuickRays : kRays;
    ChainPart part;
    std::vector<std::string> names;
    for (const double stripe_px : kStripes_px) {
        names.push_back(fmt::format("artwork, stripes of {} px", stripe_px));
    }
    names.push_back(fmt::format("artwork, a picture of {} px", kPicture_px));
    for (const std::string& name : names) {
        for (const char* level : {"one sample a pixel", "footprint"}) {
            part.rows.push_back({name, level, fmt::format("mean of {} rays a pixel", rays)});
        }
    }
    part.inputs = [] {
        Hasher hasher;
        hasher.add(hash_of(accuracy_scenes(true).front()));
        hasher.add(read_text_file(shipped_path(kPicture)));
        return hasher.hex();
    };
    part.measure = [rays](std::vector<ChainRow>& rows, const Progress& progress) {
        measure(rows, rays, progress);
    };
    return {part};
}

}  // namespace livery
