#include "gl/picture_fade.h"

#include "gl/shader_source.h"

namespace livery {

unsigned PictureFade::between(unsigned from, unsigned to, float share, glm::ivec2 size_px) {
    if (!program_) program_ = Program::screen_pass(load_shader("projection/fade.frag"));
    if (!mixed_ || glm::ivec2(mixed_.width(), mixed_.height()) != size_px) {
        target_ = {};
        mixed_ = Texture2D(size_px.x, size_px.y, TexelFormat::rgba8);
        target_ = Framebuffer({&mixed_});
    }
    // Bound anew each time: that is when another context's work on them becomes visible here
    bind_texture(0, from);
    bind_texture(1, to);
    program_.set("share", share);
    pass_.run(program_, target_);
    return mixed_.name();
}

}  // namespace livery
