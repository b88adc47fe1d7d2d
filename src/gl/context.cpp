#include "gl/context.h"

#include <array>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

namespace livery {

namespace {

constexpr std::array<EGLint, 7> kContextAttributes = {EGL_CONTEXT_MAJOR_VERSION,
                                                      4,
                                                      EGL_CONTEXT_MINOR_VERSION,
                                                      5,
                                                      EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                                      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                                      EGL_NONE};

struct Candidate {
    EGLenum platform = 0;
    void* native = nullptr;
    std::string name;
};

bool contains(const char* list, std::string_view word) {
    return list != nullptr && std::string_view(list).find(word) != std::string_view::npos;
}

std::string egl_error() {
    const EGLint error = eglGetError();
    switch (error) {
        case EGL_SUCCESS:
            return "no error code";
        case EGL_NOT_INITIALIZED:
            return "EGL_NOT_INITIALIZED";
        case EGL_BAD_MATCH:
            return "EGL_BAD_MATCH";
        case EGL_BAD_ALLOC:
            return "EGL_BAD_ALLOC";
        case EGL_BAD_PARAMETER:
            return "EGL_BAD_PARAMETER";
        default:
            return "EGL error " + std::to_string(error);
    }
}

std::vector<Candidate> candidates_for(bool software) {
    std::vector<Candidate> list;
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    // Devices carry whether they are software, which a surfaceless display only tells afterwards.
    if (contains(client, "EGL_EXT_device_enumeration") || contains(client, "EGL_EXT_device_base")) {
        std::array<EGLDeviceEXT, 16> devices{};
        EGLint count = 0;
        if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) {
            for (EGLint i = 0; i < count; ++i) {
                EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
                const bool is_software = contains(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS),
                                                  "EGL_MESA_device_software");
                if (is_software == software) {
                    list.push_back(
                        {EGL_PLATFORM_DEVICE_EXT,
                         device,
                         (software ? "software device " : "graphics device ") + std::to_string(i)});
                }
            }
        }
    }
    if (contains(client, "EGL_MESA_platform_surfaceless")) {
        list.push_back({EGL_PLATFORM_SURFACELESS_MESA,
                        reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY),
                        "Mesa surfaceless display"});
    }
    return list;
}

bool names_software(std::string_view renderer) {
    for (const std::string_view word : {"llvmpipe", "softpipe", "swrast", "SWR"}) {
        if (renderer.find(word) != std::string_view::npos) return true;
    }
    return false;
}

std::string gl_text(GLenum name) {
    const auto* text = reinterpret_cast<const char*>(glGetString(name));
    return text ? text : "";
}

}  // namespace

struct HeadlessContext::State {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;

    // The display stays initialised: EGL counts no users of it, and terminating it would take
    // down every other context of the process.
    void release() {
        if (context == EGL_NO_CONTEXT) return;
        if (eglGetCurrentContext() == context) {
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        }
        eglDestroyContext(display, context);
        context = EGL_NO_CONTEXT;
    }
    ~State() { release(); }

    /// Empty on success, else why not.
    std::string open(const Candidate& candidate, EGLContext share) {
        display = eglGetPlatformDisplayEXT(candidate.platform, candidate.native, nullptr);
        if (display == EGL_NO_DISPLAY) return "no display (" + egl_error() + ")";
        if (!eglInitialize(display, nullptr, nullptr)) {
            return "cannot be initialised (" + egl_error() + ")";
        }
        if (!contains(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
            return "has no EGL_KHR_surfaceless_context";
        }
        if (!eglBindAPI(EGL_OPENGL_API)) return "has no desktop OpenGL";
        context = eglCreateContext(display, EGL_NO_CONFIG_KHR, share, kContextAttributes.data());
        if (context == EGL_NO_CONTEXT) {
            return "no OpenGL 4.5 core context (" + egl_error() + ")";
        }
        if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
            const std::string why = egl_error();
            release();
            return "context cannot be made current (" + why + ")";
        }
        return {};
    }
};

bool GlContext::is_software() const { return names_software(renderer_); }

bool current_context_is_software() { return names_software(gl_text(GL_RENDERER)); }

void GlContext::read_names() {
    renderer_ = gl_text(GL_RENDERER);
    version_ = gl_text(GL_VERSION);
}

HeadlessContext::HeadlessContext(GlDevice device, const HeadlessContext* share)
    : state_(std::make_unique<State>()) {
    const EGLContext shared = share ? share->state_->context : EGL_NO_CONTEXT;
    std::string tried;
    for (const bool software : {false, true}) {
        if (device == GlDevice::software && !software) continue;
        if (device == GlDevice::hardware && software) continue;
        for (const Candidate& candidate : candidates_for(software)) {
            std::string why = state_->open(candidate, shared);
            if (why.empty()) read_names();
            if (why.empty() && is_software() != software) {
                why = "gives " + renderer();
                state_->release();
            }
            if (why.empty()) return;
            tried += "\n  " + candidate.name + ": " + why;
        }
    }
    const char* wanted = device == GlDevice::hardware   ? "no graphics card gives OpenGL 4.5"
                         : device == GlDevice::software ? "no software OpenGL 4.5"
                                                        : "no OpenGL 4.5";
    throw std::runtime_error(
        std::string(wanted) + ". Tried:" +
        (tried.empty() ? " nothing, EGL offers neither devices nor a surfaceless display" : tried) +
        "\nOn Debian the packages libegl1 and libgl1-mesa-dri hold the software renderer.");
}

HeadlessContext::~HeadlessContext() = default;

void HeadlessContext::make_current() {
    if (!eglMakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, state_->context)) {
        throw std::runtime_error("OpenGL context cannot be made current: " + egl_error());
    }
}

void HeadlessContext::release() {
    eglMakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

namespace {

std::string text_of(GLenum name) {
    const auto* text = reinterpret_cast<const char*>(glGetString(name));
    return text ? text : "not said";
}

std::string number_of(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return std::to_string(value);
}

}  // namespace

std::string context_facts() {
    return "Vendor: " + text_of(GL_VENDOR) + "\nRenderer: " + text_of(GL_RENDERER) +
           "\nVersion: " + text_of(GL_VERSION) +
           "\nShading language: " + text_of(GL_SHADING_LANGUAGE_VERSION) +
           "\nExtensions: " + number_of(GL_NUM_EXTENSIONS) +
           "\nLargest texture: " + number_of(GL_MAX_TEXTURE_SIZE) +
           " pixels a side\nTexture units of a fragment shader: " +
           number_of(GL_MAX_TEXTURE_IMAGE_UNITS) +
           "\nLargest storage block: " + number_of(GL_MAX_SHADER_STORAGE_BLOCK_SIZE) + " bytes\n";
}

}  // namespace livery
