#include "gl/draw.h"

#include <epoxy/gl.h>

#include "gl/program.h"
#include "gl/timer.h"

namespace livery {
namespace {

void apply(const DrawState& state) {
    if (state.blend == Blend::none) {
        glDisable(GL_BLEND);
    } else {
        glEnable(GL_BLEND);
        glBlendEquation(GL_FUNC_ADD);
        glBlendFunc(GL_ONE, state.blend == Blend::add ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA);
    }
    if (state.depth_test || state.depth_equal) {
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(state.depth_equal ? GL_EQUAL : GL_LESS);
        glDepthMask(state.depth_equal ? GL_FALSE : GL_TRUE);
    } else {
        glDisable(GL_DEPTH_TEST);
    }
    if (state.cull_back) {
        // Rows go down here: counter-clockwise on the picture is clockwise to OpenGL.
        glEnable(GL_CULL_FACE);
        glCullFace(GL_BACK);
        glFrontFace(GL_CW);
    } else {
        glDisable(GL_CULL_FACE);
    }
    if (state.scissor) {
        const PixelRect& r = *state.scissor;
        glEnable(GL_SCISSOR_TEST);
        glScissor(r.x, r.y, r.width, r.height);
    } else {
        glDisable(GL_SCISSOR_TEST);
    }
    glEnable(GL_PROGRAM_POINT_SIZE);
}

GLenum mode_of(Primitive primitive) {
    switch (primitive) {
        case Primitive::points:
            return GL_POINTS;
        case Primitive::triangles:
            return GL_TRIANGLES;
        case Primitive::triangle_strip:
            return GL_TRIANGLE_STRIP;
        case Primitive::lines:
            return GL_LINES;
    }
    return GL_TRIANGLES;
}

void prepare(const Program& program,
             const VertexArray& vertices,
             const Framebuffer& target,
             const DrawState& state) {
    target.bind();
    apply(state);
    program.use();
    vertices.bind();
    ++gl_detail::counted().draws;
}

}  // namespace

void draw(const Program& program,
          const VertexArray& vertices,
          const Framebuffer& target,
          Primitive primitive,
          int first,
          int count,
          const DrawState& state,
          int instances) {
    prepare(program, vertices, target, state);
    glDrawArraysInstanced(mode_of(primitive), first, count, instances);
    check_gl("drawing");
}

void draw_indexed(const Program& program,
                  const VertexArray& vertices,
                  const Framebuffer& target,
                  Primitive primitive,
                  int first,
                  int count,
                  const DrawState& state,
                  int instances) {
    prepare(program, vertices, target, state);
    const auto offset = static_cast<std::size_t>(first) * sizeof(std::uint32_t);
    glDrawElementsInstanced(mode_of(primitive),
                            count,
                            GL_UNSIGNED_INT,
                            reinterpret_cast<const void*>(offset),
                            instances);
    check_gl("drawing indexed");
}

void ScreenPass::run(const Program& program,
                     const Framebuffer& target,
                     const DrawState& state) const {
    draw(program, no_inputs_, target, Primitive::triangles, 0, 3, state);
}

void flush_gl() { glFlush(); }

void finish_gl() { glFinish(); }

}  // namespace livery
