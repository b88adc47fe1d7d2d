#include "live/preview_picture.h"

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "core/colour.h"

namespace livery {

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
