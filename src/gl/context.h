// OpenGL 4.5 core contexts: headless through EGL here, a window's in gl/window.h.
#pragma once

#include <memory>
#include <string>

namespace livery {

enum class GlDevice { automatic, software, hardware };

/// A context that one thread at a time has current. Whatever is made inside a context must be
/// destroyed before it, with it current. Textures, buffers, programs and fences are seen by every
/// context of a share group; framebuffers, vertex arrays and timers are not, and programs are not
/// to be used from two threads (uniforms are program state).
class GlContext {
  public:
    virtual ~GlContext() = default;
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    virtual void make_current() = 0;  ///< on the calling thread
    virtual void release() = 0;       ///< so that another thread may take it

    const std::string& renderer() const { return renderer_; }  ///< GL_RENDERER
    const std::string& version() const { return version_; }    ///< GL_VERSION
    bool is_software() const;  ///< shading runs on the processor (llvmpipe and its like)

  protected:
    GlContext() = default;
    void read_names();  ///< with the context current

  private:
    std::string renderer_, version_;
};

/// The same of whichever context is current on this thread.
bool current_context_is_software();

/// Needs no display. `automatic` takes the first graphics card that gives a 4.5 core context, else
/// the software renderer; the choice never touches the environment. Current on the calling thread
/// after construction. Throws std::runtime_error that names what was tried and why each failed.
class HeadlessContext : public GlContext {
  public:
    explicit HeadlessContext(GlDevice device, const HeadlessContext* share = nullptr);
    ~HeadlessContext() override;

    void make_current() override;
    void release() override;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Vendor, renderer, versions and limits of the context that is current on this thread, a line
/// each.
std::string context_facts();

}  // namespace livery
