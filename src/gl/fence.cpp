#include "gl/fence.h"

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

}  // namespace livery
