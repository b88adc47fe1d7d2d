#include "gl/timer.h"

#include <initializer_list>
#include <utility>

#include <epoxy/gl.h>

namespace livery {

Fence Fence::after_everything_so_far() {
    Fence fence;
    fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    // Another context waits for it: without a flush it might never be handed to the device.
    glFlush();
    return fence;
}

Fence::Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}

Fence& Fence::operator=(Fence&& other) noexcept {
    std::swap(sync_, other.sync_);
    return *this;
}

Fence::~Fence() {
    if (sync_) glDeleteSync(static_cast<GLsync>(sync_));
}

void Fence::wait_on_device() const {
    if (sync_) glWaitSync(static_cast<GLsync>(sync_), 0, GL_TIMEOUT_IGNORED);
}

bool Fence::is_reached() const { return wait_for(0.0); }

bool Fence::wait_for(double seconds) const {
    if (!sync_) return true;
    const auto nanoseconds = static_cast<GLuint64>(seconds * 1e9);
    const GLenum status = glClientWaitSync(static_cast<GLsync>(sync_), 0, nanoseconds);
    return status == GL_ALREADY_SIGNALED || status == GL_CONDITION_SATISFIED;
}

namespace gl_detail {
void delete_query(unsigned name) { glDeleteQueries(1, &name); }
}  // namespace gl_detail

Query::Query() {
    GLuint name = 0;
    glCreateQueries(GL_TIMESTAMP, 1, &name);
    name_ = GlName<gl_detail::delete_query>(name);
}

void Query::stamp() {
    glQueryCounter(name_.get(), GL_TIMESTAMP);
    stamped_ = true;
}

bool Query::is_ready() const {
    if (!stamped_) return false;
    GLint ready = GL_FALSE;
    glGetQueryObjectiv(name_.get(), GL_QUERY_RESULT_AVAILABLE, &ready);
    return ready == GL_TRUE;
}

std::uint64_t Query::time_ns() const {
    if (!stamped_) return 0;
    GLuint64 time = 0;
    glGetQueryObjectui64v(name_.get(), GL_QUERY_RESULT, &time);
    return time;
}

double GlTimer::milliseconds() const {
    return static_cast<double>(end_.time_ns() - begin_.time_ns()) * 1e-6;
}

namespace gl_detail {

GlCounters& counted() {
    thread_local GlCounters counters;
    return counters;
}

}  // namespace gl_detail

const GlCounters& gl_counters() { return gl_detail::counted(); }

GlCounters operator-(const GlCounters& later, const GlCounters& earlier) {
    GlCounters apart;
    for (const auto member : {&GlCounters::programs,
                              &GlCounters::shader_bytes,
                              &GlCounters::textures,
                              &GlCounters::texture_bytes,
                              &GlCounters::buffers,
                              &GlCounters::buffer_bytes,
                              &GlCounters::framebuffers,
                              &GlCounters::upload_bytes,
                              &GlCounters::draws,
                              &GlCounters::dispatches}) {
        apart.*member = later.*member - earlier.*member;
    }
    return apart;
}

}  // namespace livery
