#include "gl/window_picture.h"

#include <array>

#include <epoxy/gl.h>

#include "gl/check.h"
#include "gl/program.h"

namespace livery {

WindowBlit::~WindowBlit() {
    if (framebuffer_ != 0) glDeleteFramebuffers(1, &framebuffer_);
}

void WindowBlit::black(glm::ivec2 window_px) {
    constexpr std::array<float, 4> kBlack = {0.0f, 0.0f, 0.0f, 1.0f};
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    // The scissor also cuts clears and blits.
    glDisable(GL_SCISSOR_TEST);
    // Says the window's size anew: drivers look after a resized window here.
    glViewport(0, 0, window_px.x, window_px.y);
    glClearNamedFramebufferfv(0, GL_COLOR, 0, kBlack.data());
    check_gl("clearing a window");
}

void WindowBlit::show(unsigned texture,
                      glm::ivec2 texture_px,
                      const PixelRect& target,
                      glm::ivec2 window_px) {
    black(window_px);
    if (framebuffer_ == 0) glCreateFramebuffers(1, &framebuffer_);
    // Attached anew each time: that is when another context's work on it becomes visible here.
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, texture, 0);
    const bool exact = texture_px == glm::ivec2(target.width, target.height);
    glBlitNamedFramebuffer(framebuffer_,
                           0,
                           0,
                           0,
                           texture_px.x,
                           texture_px.y,
                           target.x,
                           window_px.y - target.y,
                           target.x + target.width,
                           window_px.y - target.y - target.height,
                           GL_COLOR_BUFFER_BIT,
                           exact ? GL_NEAREST : GL_LINEAR);
    check_gl("copying a picture into a window");
    glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, 0, 0);
}

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
