#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "appearance/material_json.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/image_io.h"
#include "core/parallel.h"
#include "core/paths.h"
#include "core/pictures/picture_means.h"
#include "core/statistics.h"
#include "core/worst_error.h"
#include "ledger/accuracy/truth.h"
#include "reference/path_tracer.h"
#include "scene/look_json.h"

namespace livery {

namespace {

/// Counts up when the path tracer's pictures change.
constexpr int kTracer = 1;

void add_numbers(Hasher& hasher, std::initializer_list<double> numbers) {
    hasher.add(std::span<const double>(numbers.begin(), numbers.size()));
}

void add(Hasher& hasher, const glm::dvec3& v) { add_numbers(hasher, {v.x, v.y, v.z}); }

void add(Hasher& hasher, const PartArtwork& artwork) {
    hasher.add(json_of(std::vector<Artwork>{artwork.artwork}).dump());
    hasher.add(json_of(artwork.material)["parameters"].dump());
    add_numbers(hasher, {static_cast<double>(artwork.part)});
}

void add(Hasher& hasher, const View& view) {
    add_numbers(hasher,
                {1.0 * view.width,
                 1.0 * view.height,
                 view.focal_px.x,
                 view.focal_px.y,
                 view.principal_px.x,
                 view.principal_px.y});
    hasher.add(std::span<const double>(view.distortion));
    for (int c = 0; c < 3; ++c) add(hasher, view.view_from_world.rotation[c]);
    add(hasher, view.view_from_world.translation);
}

ImageF traced(const AccuracyScene& scene,
              const TruthOptions& options,
              std::uint64_t seed,
              const Progress& progress) {
    ReferenceOptions reference;
    reference.samples_per_pixel = options.samples_per_pixel;
    reference.seed = seed;
    return trace_reference(scene.scene, scene.view, reference, progress).radiance_working;
}

/// Both pictures of a scene, as they were kept; nothing where they were not, or not whole.
std::optional<std::array<ImageF, 2>> kept(const std::filesystem::path& file, const View& view) {
    std::error_code error;
    if (file.empty() || !std::filesystem::exists(file, error)) return std::nullopt;
    try {
        const ImageFile read = read_image(file);
        if (read.image.width != view.width || read.image.height != view.height ||
            read.image.channels != 8) {
            return std::nullopt;
        }
        std::array<ImageF, 2> pictures{ImageF(view.width, view.height, 4),
                                       ImageF(view.width, view.height, 4)};
        for (std::size_t i = 0; i < read.image.pixel_count(); ++i) {
            for (std::size_t c = 0; c < 8; ++c) {
                pictures[c / 4].values[4 * i + c % 4] = read.image.values[8 * i + c];
            }
        }
        return pictures;
    } catch (const FileError&) {
        return std::nullopt;
    }
}

void keep(const std::filesystem::path& file, const std::array<ImageF, 2>& pictures) {
    make_output_folder(file.parent_path());
    ImageF both(pictures[0].width, pictures[0].height, 8);
    for (std::size_t i = 0; i < both.pixel_count(); ++i) {
        for (std::size_t c = 0; c < 8; ++c) {
            both.values[8 * i + c] = pictures[c / 4].values[4 * i + c % 4];
        }
    }
    // Another process may read it: whole or not at all
    std::filesystem::path part = file;
    part.replace_filename("part-" + file.filename().string());
    write_exr(part, both, {"a.R", "a.G", "a.B", "a.A", "b.R", "b.G", "b.B", "b.A"});
    std::filesystem::rename(part, file);
}

}  // namespace

std::string hash_of(const AccuracyScene& scene) {
    const Scene& s = scene.scene;
    Hasher hasher;
    hasher.add(shape_hash(s.product->mesh));
    hasher.add(std::span<const glm::vec3>(s.product->mesh.normals));
    hasher.add(std::span<const std::uint16_t>(s.product->mesh.triangle_part));
    for (const Material& material : s.part_materials) {
        const Json json = json_of(material);
        hasher.add(json["model"].dump());
        hasher.add(json["parameters"].dump());
    }
    for (const PartArtwork& artwork : s.artwork) add(hasher, artwork);
    for (const PartArtwork& relief : s.relief) add(hasher, relief);
    hasher.add(json_of(s.lights).dump());
    if (s.environment) {
        hasher.add(std::span<const float>(s.environment->radiance_working.values));
        add_numbers(hasher, {s.environment->rotation_rad, s.environment->scale});
    }
    add(hasher, s.eye_in_world_mm);
    add_numbers(hasher, {s.exposure_ev, s.product->product_scale});
    add(hasher, scene.view);
    return hasher.hex();
}

std::string truth_hash(const AccuracyScene& scene, const TruthOptions& options) {
    Hasher hasher;
    hasher.add(hash_of(scene));
    add_numbers(hasher,
                {1.0 * kTracer,
                 1.0 * options.samples_per_pixel,
                 static_cast<double>(options.seed),
                 1.0 * kReferenceBounces});
    // By pixels, as those that are kept since before there were squares
    if (scene.mean_px != 1) add_numbers(hasher, {1.0 * scene.mean_px});
    return hasher.hex();
}

Truth truth_of(const AccuracyScene& scene, const TruthOptions& options, const Progress& progress) {
    Truth truth;
    truth.hash = truth_hash(scene, options);
    const std::filesystem::path file =
        options.folder.empty() ? "" : options.folder / (truth.hash + ".exr");
    auto pictures = kept(file, scene.view);
    if (!pictures) {
        const auto start = std::chrono::steady_clock::now();
        pictures.emplace();
        for (std::uint64_t k = 0; k < 2; ++k) {
            (*pictures)[k] = traced(
                scene,
                options,
                2 * options.seed + k,
                progress.part(0.5 * static_cast<double>(k), 0.5 + 0.5 * static_cast<double>(k)));
        }
        truth.seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (!file.empty()) keep(file, *pictures);
    }
    for (ImageF& picture : *pictures) picture = square_means(picture, scene.mean_px);
    std::vector<float> apart = colour_differences((*pictures)[0], (*pictures)[1]);
    for (float& difference : apart) difference *= 0.5f;
    truth.floor = statistics_of(apart);
    truth.p99 = static_cast<double>(quantile(apart, 0.99));
    truth.radiance_working = std::move((*pictures)[0]);
    for (std::size_t i = 0; i < truth.radiance_working.pixel_count(); ++i) {
        // Colours are means over what covers a pixel: each counts as much as it saw of that
        float* a = truth.radiance_working.values.data() + 4 * i;
        const float* b = (*pictures)[1].values.data() + 4 * i;
        const float sum = a[3] + b[3];
        for (int c = 0; c < 3 && sum > 0.0f; ++c) a[c] = (a[c] * a[3] + b[c] * b[3]) / sum;
        a[3] = 0.5f * sum;
    }
    return truth;
}

}  // namespace livery
