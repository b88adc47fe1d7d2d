#include "jobs/render/render.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/channels.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/image_io.h"
#include "jobs/comparison.h"
#include "radiance/renderer.h"

namespace livery {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

int reference_samples(Quality quality) {
    switch (quality) {
        case Quality::draft:
            return 4;
        case Quality::normal:
            return 16;
        case Quality::high:
            return 64;
        case Quality::reference:
            return 256;
    }
    throw std::invalid_argument("reference_samples: unknown quality");
}

RenderedFrame render_by_reference(const RenderRequest& request, const Progress& progress) {
    ReferenceOptions options;
    options.samples_per_pixel = request.samples_per_pixel > 0 ? request.samples_per_pixel
                                                              : reference_samples(request.quality);
    // A limit of time or error alone must not be cut short by a sample limit.
    if ((request.seconds > 0.0 || request.error > 0.0) && request.samples_per_pixel == 0)
        options.samples_per_pixel = 1 << 20;
    options.seconds = request.seconds;
    options.error = request.error;
    options.bounces = request.bounces;
    options.seed = request.seed;
    options.projected = request.projected;
    ReferenceResult traced = trace_reference(request.scene, request.view, options, progress);

    RenderedFrame frame;
    frame.radiance_working = std::move(traced.radiance_working);
    frame.renderer = "reference";
    frame.plan = plan_frame(request.scene, Quality::reference, request.stage);
    PlannedPass& pass = *find_pass(frame.plan, PassKind::path_tracer);
    pass.work_items =
        std::accumulate(traced.samples.values.begin(), traced.samples.values.end(), 0.0);
    pass.ms = 1000.0 * traced.seconds;
    frame.traced = std::move(traced);
    return frame;
}

void write_traced(const std::filesystem::path& file,
                  const ImageF& over_black,
                  const ReferenceResult& traced) {
    ImageF all(over_black.width, over_black.height, 7);
    for (std::size_t i = 0; i < all.pixel_count(); ++i) {
        float* v = all.values.data() + 7 * i;
        std::copy_n(over_black.values.data() + 4 * i, 4, v);
        v[4] = traced.standard_error.values[i] * traced.standard_error.values[i];
        v[5] = traced.confidence.values[i];
        v[6] = traced.samples.values[i];
    }
    write_exr(file, all, {"R", "G", "B", "A", "variance.Y", "confidence.Y", "samples.Y"});
}

void compensate_frame(RenderedFrame& frame, const CompensationTable& table) {
    const auto start = Clock::now();
    frame.drive = compensate(table, frame.radiance_working, &frame.compensation);
    PlannedPass& pass = *find_pass(frame.plan, PassKind::compensation);
    pass.ms = milliseconds_since(start);
    pass.work_items = static_cast<double>(table.pixels.size());
}

}  // namespace

RenderedFrame render_frame(const RenderRequest& request, const Progress& progress) {
    if (request.stage == FrameStage::projector) {
        check_argument(request.compensation != nullptr,
                       "render_frame: the projector stage needs a calibration");
        check_argument(request.compensation->width == request.view.width &&
                           request.compensation->height == request.view.height,
                       "render_frame: the calibration is for a projector of another size");
    }
    const auto start = Clock::now();
    RenderedFrame frame;
    if (request.backend == RenderBackend::reference) {
        frame = render_by_reference(request, progress);
    } else {
        const HeadlessContext context(request.gl_device);
        const EffectLevels levels = request.levels.value_or(levels_of(request.quality));
        RadianceRenderer renderer(std::make_shared<const FrameGeometry>(
            request.scene.product, request.view, progress, sub_samples_of(levels)));
        frame.renderer = context.renderer();
        frame.plan = plan_frame(request.scene, levels, request.stage);
        renderer.render(request.scene, frame.plan, progress);
        frame.radiance_working = renderer.read_back();
    }
    if (request.stage == FrameStage::projector) compensate_frame(frame, *request.compensation);
    frame.ms_total = milliseconds_since(start);
    return frame;
}

void check_frame_file(const std::filesystem::path& file, FrameStage stage) {
    const auto suffix = file.extension();
    const std::string found = suffix.empty() ? "none" : suffix.string();
    if (stage == FrameStage::projector && suffix != ".png") {
        throw FileError(file, "suffix", found, ".png for projector input");
    }
    if (suffix != ".png" && suffix != ".exr") {
        throw FileError(file, "suffix", found, ".exr or .png");
    }
    const auto folder = file.parent_path();
    if (std::error_code error; !folder.empty() && !std::filesystem::is_directory(folder, error)) {
        throw FileError(file, "folder", "no folder " + folder.string(), "a folder that is there");
    }
}

void write_frame(const std::filesystem::path& file, const RenderedFrame& frame, FrameStage stage) {
    check_frame_file(file, stage);
    const auto suffix = file.extension();
    if (stage == FrameStage::projector) {
        write_png(file, frame.drive);
        return;
    }
    // Over black: what a pixel that the product half covers sends, and OpenEXR's associated alpha
    ImageF over_black = frame.radiance_working;
    for (std::size_t i = 0; i < over_black.pixel_count(); ++i) {
        float* v = over_black.values.data() + 4 * i;
        for (int c = 0; c < 3; ++c) v[c] *= v[3];
    }
    if (suffix == ".png") {
        write_png(file, srgb_from_working(over_black));
        return;
    }
    for (std::size_t i = 0; i < over_black.pixel_count(); ++i) {
        float* v = over_black.values.data() + 4 * i;
        const glm::dvec3 rgb = rec709_from_working() * glm::dvec3(v[0], v[1], v[2]);
        for (int c = 0; c < 3; ++c) v[c] = static_cast<float>(rgb[c]);
    }
    if (frame.traced) return write_traced(file, over_black, *frame.traced);
    write_exr(file, over_black, {"R", "G", "B", "A"});
}

TargetPicture read_target_picture(const std::filesystem::path& file, int width, int height) {
    const ImageFile picture = read_image(file);
    if (!picture.floating_point) {
        throw FileError(file, "pixels", "integers", "linear floating point (.exr)");
    }
    if (picture.image.width != width || picture.image.height != height) {
        throw FileError(
            file,
            "size",
            std::to_string(picture.image.width) + "x" + std::to_string(picture.image.height),
            "the calibrated projector's " + std::to_string(width) + "x" + std::to_string(height));
    }
    const std::array<int, 3> colour = colour_channels(file, picture);
    const int alpha = channel_named(picture, "A");
    ImageF wanted(width, height, 4, 1.0f);
    const auto channels = static_cast<std::size_t>(picture.image.channels);
    for (std::size_t i = 0; i < wanted.pixel_count(); ++i) {
        const float* v = picture.image.values.data() + channels * i;
        glm::dvec3 rgb =
            working_from_rec709() * glm::dvec3(v[colour[0]], v[colour[1]], v[colour[2]]);
        float* out = wanted.values.data() + 4 * i;
        if (alpha >= 0) {
            out[3] = v[alpha];
            // The colour of what covers the pixel; nothing does where A is 0
            if (v[alpha] > 0.0f) rgb /= static_cast<double>(v[alpha]);
        }
        for (int c = 0; c < 3; ++c) out[c] = static_cast<float>(rgb[c]);
    }
    return {std::move(wanted), alpha >= 0};
}

std::shared_ptr<const ProjectedLight> read_projected_picture(const std::filesystem::path& file,
                                                             const View& projector,
                                                             const Mesh& mesh) {
    const ImageFile picture = read_image(file);
    const ImageF& from = picture.image;
    if (from.width != projector.width || from.height != projector.height) {
        throw FileError(file,
                        "size",
                        fmt::format("{}x{}", from.width, from.height),
                        fmt::format("the projector's {}x{}", projector.width, projector.height));
    }
    const std::array<int, 3> colour = colour_channels(file, picture);
    ImageF light(from.width, from.height, 3);
    for (int y = 0; y < from.height; ++y) {
        for (int x = 0; x < from.width; ++x) {
            glm::dvec3 rgb;
            for (int c = 0; c < 3; ++c) {
                const double value = from.at(x, y, colour[static_cast<std::size_t>(c)]);
                rgb[c] = picture.floating_point ? value : srgb_decode(value / picture.full_scale);
                if (!std::isfinite(rgb[c]) || rgb[c] < 0.0) {
                    throw FileError(file,
                                    fmt::format("pixel ({}, {})", x, y),
                                    fmt::format("{}", rgb[c]),
                                    "light: 0 or more");
                }
            }
            rgb = working_from_rec709() * rgb;
            for (int c = 0; c < 3; ++c) {
                light.at(x, y, c) = static_cast<float>(std::max(rgb[c], 0.0));
            }
        }
    }
    const Bounds bounds = bounds_of(mesh);
    const glm::dvec3 middle = 0.5 * (bounds.low + bounds.high);
    const double distance_mm = (projector.view_from_world * middle).z;
    if (!(distance_mm > 0.0)) {
        throw FileError(file,
                        "projector",
                        "a product behind it",
                        "--projector FILE of one that looks at the product");
    }
    return std::make_shared<const ProjectedLight>(projector, std::move(light), distance_mm);
}

View view_of_all(const Mesh& mesh, const glm::dvec3& eye_mm, int width, int height) {
    const Bounds bounds = bounds_of(mesh);
    View view = look_at(eye_mm, 0.5 * (bounds.low + bounds.high), 1.0, width, height);
    // As long a lens as has all corners in the picture
    double farthest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at(corner & 1 ? bounds.high.x : bounds.low.x,
                            corner & 2 ? bounds.high.y : bounds.low.y,
                            corner & 4 ? bounds.high.z : bounds.low.z);
        const glm::dvec3 in_view = view.view_from_world * at;
        const double depth = std::max(in_view.z, 1e-3 * glm::length(in_view));
        farthest = std::max({farthest,
                             std::abs(in_view.x) / depth / (0.5 * width),
                             std::abs(in_view.y) / depth / (0.5 * height)});
    }
    constexpr double kMargin = 0.95;
    if (farthest > 0.0) view.focal_px = glm::dvec2(kMargin / farthest);
    return view;
}

}  // namespace livery
