#include "support/kept_truth.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

#include "appearance/material_json.h"
#include "core/hash.h"
#include "core/image_io.h"
#include "core/json.h"

namespace livery::testing {

namespace {

/// Six digits: compilers round the rest of what is computed differently.
std::string six(double value) { return fmt::format("{:.5e} ", value == 0.0 ? 0.0 : value); }
std::string six(const glm::dvec3& v) { return six(v.x) + six(v.y) + six(v.z); }

std::string text_of(const Mesh& mesh) {
    struct Extent {
        glm::vec3 low{1e30f}, high{-1e30f};
        std::size_t triangles = 0;
    };
    std::vector<Extent> extents(mesh.parts.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        Extent& extent = extents[mesh.triangle_part[t]];
        ++extent.triangles;
        for (int c = 0; c < 3; ++c) {
            const glm::vec3& place = mesh.positions_mm[mesh.triangles[t][c]];
            extent.low = glm::min(extent.low, place);
            extent.high = glm::max(extent.high, place);
        }
    }
    std::string text;
    for (std::size_t k = 0; k < extents.size(); ++k) {
        text += fmt::format("{} {} ", mesh.parts[k].name, extents[k].triangles);
        for (int c = 0; c < 3; ++c)
            text += fmt::format("{:.1f} {:.1f} ", extents[k].low[c], extents[k].high[c]);
    }
    return text;
}

std::string text_of(const Environment& environment) {
    double sum = 0.0;
    for (const float value : environment.radiance_working.values) sum += static_cast<double>(value);
    const ImageF& picture = environment.radiance_working;
    return fmt::format("{}x{} {} {} {}",
                       picture.width,
                       picture.height,
                       fmt::format("{:.3e}", sum),
                       six(environment.rotation_rad),
                       six(environment.scale));
}

std::string text_of(const View& view) {
    std::string text = fmt::format("{}x{} ", view.width, view.height);
    for (const double value :
         {view.focal_px.x, view.focal_px.y, view.principal_px.x, view.principal_px.y})
        text += six(value);
    for (const double value : view.distortion) text += six(value);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            text += fmt::format("{:.5f} ", view.view_from_world.rotation[column][row] + 0.0);
    return text + six(view.view_from_world.translation);
}

/// To the eleven bits of a half float.
float rounded(float value) {
    int exponent = 0;
    const float mantissa = std::frexp(value, &exponent);
    return std::ldexp(std::round(mantissa * 2048.0f) / 2048.0f, exponent);
}

/// Both are the same sum of samples but for a rounding here and there, which sends a path
/// elsewhere: 99% of the pixels agree within 1% or a hundredth of design white, and the sum within
/// a thousandth.
void compare(const std::string& file, const ImageF& kept, const ImageF& traced) {
    if (kept.values.size() != traced.values.size())
        throw std::runtime_error(file + ": another size than the picture that is traced");
    double sum = 0.0, kept_sum = 0.0;
    std::size_t off = 0;
    for (std::size_t i = 0; i < kept.values.size(); ++i) {
        const double a = static_cast<double>(kept.values[i]),
                     b = static_cast<double>(traced.values[i]);
        kept_sum += a;
        sum += b;
        off += !(std::abs(a - b) <= 0.01 * std::max(1.0, std::abs(b)));
    }
    if (off > kept.values.size() / 100 || !(std::abs(kept_sum - sum) <= 1e-3 * std::abs(sum)))
        throw std::runtime_error(fmt::format(
            "{}: {} of {} values differ from those traced now, and their sum is {:.5f} of theirs",
            file,
            off,
            kept.values.size(),
            kept_sum / sum));
}

}  // namespace

std::string text_of(const Scene& scene, const View& view) {
    std::string text = text_of(scene.product->mesh) + text_of(view) + six(scene.eye_in_world_mm) +
                       six(scene.exposure_ev);
    if (scene.environment) text += text_of(*scene.environment);
    for (const Material& material : scene.part_materials) text += json_of(material).dump();
    for (const DirectionalLight& light : scene.lights)
        text += six(light.direction) + six(light.radiance_rec709) + six(light.angle_rad);
    return text;
}

ImageF kept_picture(const std::string& name,
                    const std::string& depends_on,
                    const std::function<ImageF()>& make) {
    Hasher hasher;
    hasher.add(depends_on);
    const char* elsewhere = std::getenv("LIVERY_TRUTHS_FOLDER");
    const std::filesystem::path folder = elsewhere && *elsewhere
                                             ? std::filesystem::path(elsewhere)
                                             : std::filesystem::path(LIVERY_TEST_DATA) / "truths";
    const std::filesystem::path file =
        folder / fmt::format("{}-{}.exr", name, hasher.hex().substr(0, 12));
    const char* asked = std::getenv("LIVERY_TRUTHS");
    const std::string how = asked ? asked : "";
    if (how == "write") {
        ImageF made = make();
        for (float& value : made.values) value = rounded(value);
        std::filesystem::create_directories(file.parent_path());
        write_exr(file, made);
        return made;
    }
    if (!std::filesystem::exists(file))
        throw std::runtime_error(file.string() +
                                 ": no such file; LIVERY_TRUTHS=write and this test write it");
    ImageF kept = read_image(file).image;
    if (how == "check") compare(file.string(), kept, make());
    return kept;
}

ImageF kept_truth(const std::string& name,
                  const Scene& scene,
                  const View& view,
                  const ReferenceOptions& options) {
    const std::string sampling = fmt::format("{} {} {} {} {}",
                                             options.samples_per_pixel,
                                             options.bounces,
                                             options.seed,
                                             options.shade_for_eye,
                                             static_cast<int>(options.sampling));
    return kept_picture(name, text_of(scene, view) + sampling, [&] {
        return trace_reference(scene, view, options).radiance_working;
    });
}

}  // namespace livery::testing
