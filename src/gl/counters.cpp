#include "gl/counters.h"

#include <initializer_list>

namespace livery {

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
