#include "live/preview_picture.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/colour.h"

namespace livery {

namespace {

constexpr int kLongSide = 160;
constexpr int kRays = 64;

/// Twice a box of three: what is left of the rays' noise.
void smooth(std::vector<float>& values, int width, int height) {
    for (int pass = 0; pass < 2; ++pass) {
        const std::vector<float> from = values;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                float sum = 0.0f;
                for (int v = y - 1; v <= y + 1; ++v) {
                    for (int u = x - 1; u <= x + 1; ++u) {
                        const int row = std::clamp(v, 0, height - 1);
                        const int column = std::clamp(u, 0, width - 1);
                        sum += from[static_cast<std::size_t>(row * width + column)];
                    }
                }
                values[static_cast<std::size_t>(y * width + x)] = sum / 9.0f;
            }
        }
    }
}

}  // namespace

GroundShadow ground_shadow(const Product& product, const Tracer& tracer) {
    const Bounds bounds = bounds_of(product.mesh);
    const glm::dvec3 extent = bounds.high - bounds.low;
    const double margin = 0.35 * std::max({extent.x, extent.y, extent.z, 1e-3});
    GroundShadow shadow;
    shadow.height_mm = bounds.low.y;
    shadow.corner_mm = {bounds.low.x - margin, bounds.low.z - margin};
    shadow.size_mm = glm::dvec2(extent.x, extent.z) + 2.0 * margin;
    const double texel_mm = std::max(shadow.size_mm.x, shadow.size_mm.y) / kLongSide;
    const int width = std::max(1, static_cast<int>(std::lround(shadow.size_mm.x / texel_mm)));
    const int height = std::max(1, static_cast<int>(std::lround(shadow.size_mm.y / texel_mm)));

    std::vector<glm::vec3> places, up;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            // A touch below the product, so that what stands on the ground hides it
            places.emplace_back(shadow.corner_mm.x + (x + 0.5) * shadow.size_mm.x / width,
                                shadow.height_mm - 1e-3 * margin,
                                shadow.corner_mm.y + (y + 0.5) * shadow.size_mm.y / height);
            up.emplace_back(0.0f, 1.0f, 0.0f);
        }
    }
    std::vector<float> open = ambient_openness(tracer, places, up, kRays, 1e30f);
    smooth(open, width, height);

    shadow.hidden = Image8(width, height, 1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            // The picture's border shows no edge
            const double u = std::abs(2.0 * (x + 0.5) / width - 1.0);
            const double v = std::abs(2.0 * (y + 0.5) / height - 1.0);
            const double far = std::clamp((std::max(u, v) - 0.75) / 0.25, 0.0, 1.0);
            const double fade = 1.0 - far * far * (3.0 - 2.0 * far);
            const double hidden = fade * (1.0 - open[static_cast<std::size_t>(y * width + x)]);
            shadow.hidden.at(x, y) = static_cast<std::uint8_t>(std::lround(255.0 * hidden));
        }
    }
    return shadow;
}

void PreviewEncoder::set_ground(const GroundShadow* ground) {
    ground_.reset();
    shadow_ = Texture2D();
    if (!ground) return;
    ground_ = *ground;
    const Image8& hidden = ground->hidden;
    shadow_ = Texture2D({hidden.width, hidden.height}, TexelFormat::r8, TexelFilter::linear);
    shadow_.upload(std::span<const std::uint8_t>(hidden.values));
}

Program& PreviewEncoder::program_for(bool ground, bool highlight) {
    const auto found = programs_.find({ground, highlight});
    if (found != programs_.end()) return found->second;
    const ShaderSource source = load_shader(
        "preview.frag",
        {fmt::format("GROUND {}", ground ? 1 : 0), fmt::format("HIGHLIGHT {}", highlight ? 1 : 0)});
    return programs_.emplace(std::pair(ground, highlight), Program::screen_pass(source))
        .first->second;
}

void PreviewEncoder::encode(RasterPreview& preview,
                            const View& view,
                            std::optional<int> highlighted_part,
                            bool with_ground,
                            const Framebuffer& into,
                            const std::optional<PixelRect>& only) {
    const bool ground = with_ground && ground_;
    Program& program = program_for(ground, highlighted_part.has_value());
    program.set("u_radiance", 0);
    program.set("u_rec709_from_working", glm::mat3(rec709_from_working()));
    if (ground) {
        const glm::dmat3 direction_from_pixel(1.0 / view.focal_px.x,
                                              0.0,
                                              0.0,
                                              0.0,
                                              1.0 / view.focal_px.y,
                                              0.0,
                                              -view.principal_px.x / view.focal_px.x,
                                              -view.principal_px.y / view.focal_px.y,
                                              1.0);
        program.set(
            "u_world_from_pixel",
            glm::mat3(glm::transpose(view.view_from_world.rotation) * direction_from_pixel));
        program.set("u_centre_mm", glm::vec3(centre_in_world(view)));
        program.set("u_ground_mm", static_cast<float>(ground_->height_mm));
        program.set("u_shadow_area", glm::vec4(ground_->corner_mm, 1.0 / ground_->size_mm));
        program.set("u_shadow", 1);
        shadow_.bind(1);
    }
    if (highlighted_part) {
        const unsigned part =
            preview.draw_part_coverage(static_cast<std::size_t>(*highlighted_part));
        program.set("u_part", 2);
        bind_texture(2, part);
    }
    bind_texture(0, preview.texture());
    DrawState state;
    state.scissor = only;
    screen_.run(program, into, state);
}

}  // namespace livery
