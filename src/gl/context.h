// An OpenGL 4.5 core context, headless through EGL.
#pragma once

#include <memory>
#include <string>

namespace livery {

enum class GlDevice { automatic, software, hardware };

/// Makes a context current on the calling thread for its lifetime. Needs no display. `automatic`
/// takes the first graphics card that gives a 4.5 core context, else the software renderer; the
/// choice never touches the environment. Throws std::runtime_error that names what was tried and
/// why each failed. Whatever is made inside a context must be destroyed before it.
class HeadlessContext {
  public:
    explicit HeadlessContext(GlDevice device);
    ~HeadlessContext();
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

    /// Makes it current again (after another context was used on this thread).
    void make_current();

    std::string renderer() const;  ///< GL_RENDERER, e.g. "llvmpipe (LLVM 15.0.6, 256 bits)"
    std::string version() const;   ///< GL_VERSION, e.g. "4.5 (Core Profile) Mesa 22.3.6"
    bool is_software() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
